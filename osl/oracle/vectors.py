# SPDX-License-Identifier: GPL-3.0-or-later
"""Directions: construction, validation and half vectors."""

import numpy as np

UNIT_TOLERANCE = 1e-6  # single-precision directions are accepted as unit vectors


def vector(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Vectors ``(..., 3)`` from their components.

    Each component is contiguous in memory, which makes componentwise arithmetic twice as fast.
    """
    x, y, z = np.broadcast_arrays(x, y, z)
    return np.moveaxis(np.stack([x, y, z], axis=0), 0, -1)


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Scalar products of vectors ``(..., 3)``, shape ``(...)``."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def normalize(w: np.ndarray) -> np.ndarray:
    """Unit vectors along ``w`` ``(..., 3)``; the zero vector stays zero."""
    length = np.sqrt(dot(w, w))
    return w / np.where(length > 0.0, length, 1.0)[..., None]


def half_vector(v: np.ndarray, o: np.ndarray) -> np.ndarray:
    """Unit vectors midway between unit vectors ``v`` and ``o``.

    Opposite directions have no half vector, and give the zero vector, whose D is 0. That is the
    right limit, because such a micronormal would lie in the plane perpendicular to both.
    """
    return normalize(v + o)


def direction(theta: float | np.ndarray, phi: float | np.ndarray = 0.0) -> np.ndarray:
    """Unit vectors at polar angle ``theta`` from z and azimuth ``phi`` from x, in radians."""
    theta, phi = np.broadcast_arrays(np.asarray(theta, float), np.asarray(phi, float))
    return vector(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta))


def unit_vectors(w: np.ndarray, name: str) -> np.ndarray:
    """``w`` as float64 unit vectors ``(..., 3)``.

    Raises ``ValueError`` naming ``name`` and the offending value when the last axis is not 3 long,
    or a vector is not finite or not of length 1 (within 1e-6).
    """
    w = np.asarray(w, dtype=np.float64)
    if w.ndim == 0 or w.shape[-1] != 3:
        raise ValueError(f"{name} has shape {w.shape}; give vectors with a last axis of length 3")
    length = np.sqrt(dot(w, w))
    bad = ~(np.abs(length - 1.0) <= UNIT_TOLERANCE)
    if np.any(bad):
        raise ValueError(f"{name} contains {w[bad][0]}, which is not a unit vector; normalise it")
    return w


def outside(w: np.ndarray, name: str, transmits: bool = False) -> np.ndarray:
    """``w`` as unit vectors that point away from the surface; else ``ValueError`` names one.

    That is ``w.z > 0``, or ``w.z != 0`` if the surface ``transmits``.
    """
    w = unit_vectors(w, name)
    bad = (w[..., 2] == 0.0) if transmits else ~(w[..., 2] > 0.0)
    if np.any(bad):
        wanted = "in the surface (z = 0)" if transmits else "not above the surface (z > 0)"
        raise ValueError(f"{name} contains {w[bad][0]}, which is {wanted}")
    return w


def mirrored(v: np.ndarray, m: np.ndarray, cosine: np.ndarray) -> np.ndarray:
    """2 <v,m> m - v, ``(n, 3)``, with ``cosine`` = <v,m> ``(n,)``."""
    return 2.0 * cosine[:, None] * m - v


def to_common(w: np.ndarray, below: np.ndarray) -> np.ndarray:
    """Directions ``(n, 3)`` of the frame of the side ``below`` ``(n,)`` in the common frame."""
    return np.where(below[:, None], -w, w)


def to_side(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Directions ``(..., 3)`` in the frame of the side they point to, and whether it is ``below``.

    That frame is the common one above the surface, and the common one with all directions negated
    below it, so the results have ``z >= 0``.
    """
    w = np.asarray(w, dtype=np.float64)
    below = w[..., 2] < 0.0
    sign = np.where(below, -1.0, 1.0)
    return vector(sign * w[..., 0], sign * w[..., 1], sign * w[..., 2]), below
