# pyright: basic
"""Projections that `scalar` and `packed` share: holds, volumes and contacts of one pose."""

from numba import njit

from risorius.solvers.kernels.formulas import FLAGS

__all__ = ["add_cross", "open_caps", "project_contacts", "project_holds", "project_volumes"]


@njit(**FLAGS)
def project_holds(p, t, targets, pushed, compliant):
    """Draw particles to their targets, rows of four whose w is the particle's.

    A hold is three constraints p - q = 0, one per axis.
    """
    for c in range(t.hold_particles.size):
        i = 4 * t.hold_particles[c]
        w = p[i + 3]
        k = t.hold_stiffness[c]
        if w > 0:
            for axis in range(3):
                gap = p[i + axis] - targets[4 * c + axis]
                if compliant:
                    step = (gap - k * pushed[3 * c + axis]) / (w + k)
                    pushed[3 * c + axis] += step
                    p[i + axis] -= w * step
                else:
                    p[i + axis] -= k * gap


@njit(**FLAGS)
def add_cross(g, row, b, c, p):
    """Add the cross product of the particles at b and c to the entry of `g` at `row`."""
    g[row] += p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1]
    g[row + 1] += p[b + 2] * p[c] - p[b] * p[c + 2]
    g[row + 2] += p[b] * p[c + 1] - p[b + 1] * p[c]


@njit(**FLAGS)
def open_caps(p, v, volume):
    """Put the centroid of each hole of a volume into its row."""
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        row = 4 * v.cap_rows[cap]
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        for axis in range(3):
            total = p[row] * 0
            for entry in range(first, last):
                total += p[4 * v.rims[entry] + axis]
            p[row + axis] = total / (last - first)


@njit(**FLAGS)
def _close_caps(g, v, volume):
    """Hand the gradient at each centroid over to the rim, in equal shares."""
    for cap in range(v.cap_start[volume], v.cap_start[volume + 1]):
        row = 4 * v.cap_rows[cap]
        first, last = v.rim_start[cap], v.rim_start[cap + 1]
        for axis in range(3):
            share = g[row + axis] / (last - first)
            g[row + axis] = 0
            for entry in range(first, last):
                g[4 * v.rims[entry] + axis] += share


@njit(**FLAGS)
def project_volumes(p, g, v, rest, pushed, compliant):
    """Bring each volume to `rest`; `g` is scratch of the shape of `p`.

    Sums are six times the volume and its gradient.
    """
    for volume in range(v.stiffness.size):
        open_caps(p, v, volume)
        touched = v.particles[v.particle_start[volume] : v.particle_start[volume + 1]]
        for particle in touched:
            row = 4 * particle
            g[row] = 0
            g[row + 1] = 0
            g[row + 2] = 0
        total = g[0] * 0
        for face in range(v.face_start[volume], v.face_start[volume + 1]):
            a = 4 * v.faces[3 * face]
            b = 4 * v.faces[3 * face + 1]
            c = 4 * v.faces[3 * face + 2]
            x = p[b + 1] * p[c + 2] - p[b + 2] * p[c + 1]
            y = p[b + 2] * p[c] - p[b] * p[c + 2]
            z = p[b] * p[c + 1] - p[b + 1] * p[c]
            total += p[a] * x + p[a + 1] * y + p[a + 2] * z
            g[a] += x
            g[a + 1] += y
            g[a + 2] += z
            add_cross(g, b, c, a, p)
            add_cross(g, c, a, b, p)
        _close_caps(g, v, volume)
        weight = total * 0
        for particle in touched:
            row = 4 * particle
            weight += p[row + 3] * (g[row] ** 2 + g[row + 1] ** 2 + g[row + 2] ** 2)
        k = v.stiffness[volume]
        if weight <= 0:
            continue
        gap = total - 6 * rest[volume]
        if compliant:
            step = (gap - k * pushed[volume]) / (weight + k)
            pushed[volume] += step
        else:
            step = k * gap / weight
        for particle in touched:
            row = 4 * particle
            part = step * p[row + 3]
            p[row] -= part * g[row]
            p[row + 1] -= part * g[row + 1]
            p[row + 2] -= part * g[row + 2]


@njit(**FLAGS)
def project_contacts(p, c):
    """Push particles that are behind their planes back onto them."""
    for contact in range(c.particles.size):
        i = 4 * c.particles[contact]
        if p[i + 3] > 0:
            row = 3 * contact
            depth = p[i] * 0
            for axis in range(3):
                depth += (p[i + axis] - c.points[row + axis]) * c.normals[row + axis]
            if depth < 0:
                for axis in range(3):
                    p[i + axis] -= c.stiffness[0] * depth * c.normals[row + axis]
