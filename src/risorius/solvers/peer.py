# pyright: basic
"""The same constraints in PositionBasedDynamics (pypbd), where it is installed, to compare with."""

from __future__ import annotations

from collections.abc import Callable

from risorius.solvers.model import Model

__all__ = ["peer_iteration"]


def peer_iteration(model: Model) -> Callable[[int], None] | None:
    """Return a function that iterates `model` in pypbd so many times, or None without pypbd.

    Distances, dihedral bends and a strain constraint per triangle; pypbd has neither the global
    volume nor targets. Its simulation is global: a second call replaces the first.
    """
    try:
        import pypbd  # pyright: ignore[reportMissingImports]
    except ImportError:
        return None
    simulation = pypbd.Simulation.getCurrent()
    simulation.initDefault()
    peer = simulation.getModel()
    c = model.constraints
    faces = c.areas.particles
    peer.addTriangleModel(model.rest_positions, faces.ravel().tolist(), testMesh=False)
    for row, k in zip(c.distances.particles.tolist(), c.distances.stiffness.tolist(), strict=True):
        peer.addDistanceConstraint(*row, k)
    for row, k in zip(c.bends.particles.tolist(), c.bends.stiffness.tolist(), strict=True):
        peer.addDihedralConstraint(row[2], row[3], row[0], row[1], k)
    for row in faces.tolist():
        peer.addStrainTriangleConstraint(*row, 0.5, 0.5, 0.5, False, False)
    peer.initConstraintGroups()
    stepper = simulation.getTimeStep()
    controller = pypbd.TimeStepController
    stepper.setValueUInt(controller.NUM_SUB_STEPS, 1)

    def iterate(count: int) -> None:
        stepper.setValueUInt(controller.MAX_ITERATIONS, count)
        stepper.step(peer)

    return iterate
