# SPDX-License-Identifier: GPL-3.0-or-later
"""Fresnel factors of conductors (by colour and edge tint, or by complex index) and dielectrics.

A conductor's factor takes cosines ``(...)`` of the angle between direction and micronormal. It
returns reflectances ``(..., C)`` in 0..1. C is 3 (red, green, blue), or 1 if channels are equal.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

COS_82 = 1.0 / 7.0  # the angle, about 82 degrees, at which the edge tint is defined


class Fresnel(Protocol):
    """Reflectance as a function of the cosine of incidence."""

    def __call__(self, cos_theta: np.ndarray) -> np.ndarray:
        """Reflectances ``(..., C)`` at ``cos_theta`` ``(...)``."""


@dataclass(frozen=True)
class White:
    """A lossless mirror: 1 at every angle."""

    def __call__(self, cos_theta: np.ndarray) -> np.ndarray:
        """Ones, shape ``(..., 1)``."""
        return np.ones((*np.shape(cos_theta), 1))


@dataclass(frozen=True)
class F82Tint:
    """Schlick's factor, lowered so that at ``cos = 1/7`` it is ``edge_tint`` times Schlick's.

    F(c) = F0 + (1 - F0)(1 - c)^5 - B c (1 - c)^6, with B from the condition at 1/7 (Kutz, Hasan,
    Edmondson 2021, "Novel aspects of the Adobe Standard Material"), clamped to 0..1 as Cycles does.
    ``base_color`` (F0) and ``edge_tint``: three numbers in 0..1, else ``ValueError``.
    """

    base_color: Sequence[float]
    edge_tint: Sequence[float] = (1.0, 1.0, 1.0)

    def __post_init__(self) -> None:
        for name in ("base_color", "edge_tint"):
            rgb(getattr(self, name), name, 1.0)

    def __call__(self, cos_theta: np.ndarray) -> np.ndarray:
        """Reflectances ``(..., 3)``."""
        f0 = np.asarray(self.base_color, dtype=np.float64)
        tint = np.asarray(self.edge_tint, dtype=np.float64)
        edge = 1.0 - COS_82
        schlick_82 = f0 + (1.0 - f0) * edge**5
        b = schlick_82 * (1.0 - tint) / (COS_82 * edge**6)
        c = np.clip(cos_theta, 0.0, 1.0)[..., None]
        s = 1.0 - c
        s5 = (s * s) * (s * s) * s
        return np.clip(f0 + (1.0 - f0) * s5 - b * c * s5 * s, 0.0, 1.0)


@dataclass(frozen=True)
class IndexOfRefraction:
    """Unpolarised reflectance of a conductor of complex index ``n + i k`` in air.

    ``n``, ``k``: three numbers >= 0 each, not both 0 in a channel, else ``ValueError``.
    """

    n: Sequence[float]
    k: Sequence[float]

    def __post_init__(self) -> None:
        n = rgb(self.n, "n", np.inf)
        k = rgb(self.k, "k", np.inf)
        if np.any(n + k == 0.0):
            raise ValueError(f"n is {self.n} and k is {self.k}; in each channel one must exceed 0")

    def __call__(self, cos_theta: np.ndarray) -> np.ndarray:
        """Reflectances ``(..., 3)``."""
        # At grazing both amplitudes can be 0/0. The floor is far below any angle that matters.
        c = np.clip(cos_theta, 1e-9, 1.0)[..., None]
        eta2 = (np.asarray(self.n, dtype=np.float64) + 1j * np.asarray(self.k)) ** 2
        q = np.sqrt(eta2 - (1.0 - c * c))  # eta times the cosine of refraction
        r_s = (c - q) / (c + q)
        r_p = (eta2 * c - q) / (eta2 * c + q)
        return 0.5 * (r_s.real**2 + r_s.imag**2 + r_p.real**2 + r_p.imag**2)


def dielectric_reflectance(cos_theta: np.ndarray, eta: np.ndarray | float) -> np.ndarray:
    """Unpolarised reflectance ``(...)`` of an interface of real relative index ``eta`` > 0:
    Fresnel's equations (Born, Wolf, Principles of Optics, section 1.5.2).

    ``cos_theta`` ``(...)`` is the cosine of incidence in 0..1; ``eta`` the index beyond the
    interface over that on this side. The result is 1 beyond the critical angle. With g = eta
    cos(theta_t), so g^2 = eta^2 - 1 + c^2, the differences in Fresnel's amplitudes (c - g)/(c + g)
    and (eta^2 c - g)/(eta^2 c + g) are multiplied out, which keeps all digits for eta near 1.
    """
    c = np.clip(cos_theta, 0.0, 1.0)
    eta2 = np.square(eta)
    rise = np.subtract(eta, 1.0) * np.add(eta, 1.0)  # eta^2 - 1
    g = np.sqrt(np.maximum(rise + c * c, 0.0))
    # c + g is 0 only at grazing with eta <= 1, and the reflectance is 1 there
    sum_s, sum_p = c + g, eta2 * c + g
    r_s = rise / np.where(sum_s > 0.0, sum_s, 1.0) ** 2
    r_p = rise * ((eta2 + 1.0) * c * c - 1.0) / np.where(sum_p > 0.0, sum_p, 1.0) ** 2
    total = (rise + c * c <= 0.0) & (rise != 0.0)
    return np.where(total, 1.0, np.minimum(0.5 * (r_s * r_s + r_p * r_p), 1.0))


def rgb(values: Sequence[float], name: str, highest: float) -> np.ndarray:
    """``values`` as an array ``(3,)``; ``ValueError`` unless in 0..``highest`` and finite."""
    try:
        colour = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} is {values!r}; give three numbers") from error
    legal = (colour >= 0.0) & (colour <= highest) & np.isfinite(colour)
    if colour.shape != (3,) or not np.all(legal):
        limits = "from 0 to 1" if highest == 1.0 else "of 0 or more"
        raise ValueError(f"{name} is {values}; give three finite numbers {limits}")
    return colour
