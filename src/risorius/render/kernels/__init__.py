"""Plain functions on plain arrays, compiled; they work on a band of rows each.

Conventions: view coordinates are right, down, away from the eye, the first two multiplied by
the focal length, so that a point (X, Y, Z) falls on column X / Z and row Y / Z from the middle
of the picture. A triangle of `edges` e0, e1, e2 (e0 = v1 x v2 and so on) and `volume`
d = v0 . e0 is hit by the sample p = (column, row, 1) where all e_i . p have the sign of d; its
inverse depth there is (e0 + e1 + e2) . p / d and its barycentric coordinates are the shares of
the e_i . p. No triangle needs to be clipped: parts behind the eye have the wrong sign.
"""

__all__ = []
