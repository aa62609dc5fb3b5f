# SPDX-License-Identifier: GPL-3.0-or-later
"""What the facets of a rough surface do with light: mirrors, glass, or matte.

A path that arrives from ``v`` at a facet of normal ``m`` goes on to ``o``. A direction is in the
frame of the side of the surface that the path is on. Above, that is the common frame. Below, it is
the common frame with all directions negated. So ``z`` points away from the surface on both sides,
and a facet's normal has the same components, ``m.z > 0``. ``o`` is in the frame of the side that
the path is on afterwards. The path may leave on that side if ``o.z > 0``.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from .checks import LARGEST, SMALLEST, number
from .fresnel import Fresnel, White, dielectric_reflectance, rgb
from .vectors import dot, half_vector, mirrored, normalize, to_common, vector


class Scattered(NamedTuple):
    """Where paths go: ``o`` ``(n, 3)``, whether they ``crossed`` the surface ``(n,)``, and the
    factors on their weights ``(n, C)``."""

    o: np.ndarray
    crossed: np.ndarray
    weight: np.ndarray


@dataclass(frozen=True)
class Bounce:
    """What ``n`` paths do at a facet.

    ``walk`` ``(n,)``: the paths' numbers. On arrival: ``v`` ``(n, 3)``, and ``below`` ``(n,)``, the
    side they are on. ``m`` ``(n, 3)``: the facet's normal. Afterwards: ``o`` ``(n, 3)``, and
    whether they ``crossed`` the surface ``(n,)``.
    """

    walk: np.ndarray
    v: np.ndarray
    below: np.ndarray
    m: np.ndarray
    o: np.ndarray
    crossed: np.ndarray

    @property
    def below_after(self) -> np.ndarray:
        """The side after the bounce, ``(n,)``."""
        return self.below ^ self.crossed

    @property
    def direction(self) -> np.ndarray:
        """Direction of travel after the bounce in the common frame, ``(n, 3)``."""
        return to_common(self.o, self.below_after)


class Turn(NamedTuple):
    """The vertex term of turning from v to o, in its parts.

    ``density`` ``(...)``, per steradian of o, is the integral over facets of <v,m> D(m) times the
    density of turning from v to o at a facet. For rough facets it is the integrand at the facet m,
    per steradian of m as well. ``weight`` ``(..., C)`` is the factor on the light, and
    ``choice`` ``(...)`` the chance with which `Material.scatter` reflects or transmits as asked.
    """

    density: np.ndarray
    weight: np.ndarray
    choice: np.ndarray


class Material(ABC):
    """What facets do with light.

    ``channels`` is 3 (red, green, blue), or 1 if channels are equal. ``transmits``: whether light
    may cross the surface. ``smooth``: whether v and o determine the facet's normal.
    """

    channels: int
    transmits: bool
    smooth: bool

    @abstractmethod
    def scatter(
        self, v: np.ndarray, m: np.ndarray, below: np.ndarray, rng: np.random.Generator
    ) -> Scattered:
        """Draw where paths go that come from ``v`` ``(n, 3)`` to facets ``m`` ``(n, 3)``.

        The paths are on the side ``below`` ``(n,)``, and <v,m> > 0.
        """

    @abstractmethod
    def turn(
        self,
        v: np.ndarray,
        o: np.ndarray,
        m: np.ndarray,
        below: np.ndarray,
        crossed: np.ndarray,
        D: Callable[[np.ndarray], np.ndarray],
    ) -> Turn:
        """The vertex term; ``m`` matters only if facets are not smooth. Arguments broadcast."""

    def at_facet(self, o: np.ndarray, m: np.ndarray, crossed: np.ndarray) -> np.ndarray:
        """Weighted density of turning to ``o`` at the facet ``m``, per steradian, ``(..., C)``;
        ``TypeError`` if facets are smooth, because they send light one way alone."""
        raise TypeError(f"{self} has smooth facets, which have no density; use turn")


@dataclass(frozen=True)
class Conductor(Material):
    """Mirrors: o = 2 <v,m> m - v, with the factor F(<v,m>)."""

    fresnel: Fresnel = field(default_factory=White)
    transmits = False
    smooth = True

    def __post_init__(self) -> None:
        if not callable(self.fresnel):
            raise TypeError(
                f"fresnel is {self.fresnel!r}; give White, F82Tint, IndexOfRefraction or a function"
            )

    @property
    def channels(self) -> int:
        """1 if the Fresnel factor is the same for all colours, else 3."""
        return self.fresnel(np.ones(1)).shape[-1]

    def scatter(
        self, v: np.ndarray, m: np.ndarray, below: np.ndarray, rng: np.random.Generator
    ) -> Scattered:
        """Reflect."""
        cosine = np.maximum(dot(v, m), 0.0)
        return Scattered(mirrored(v, m, cosine), np.zeros(cosine.shape, bool), self.fresnel(cosine))

    def turn(
        self,
        v: np.ndarray,
        o: np.ndarray,
        m: np.ndarray,
        below: np.ndarray,
        crossed: np.ndarray,
        D: Callable[[np.ndarray], np.ndarray],
    ) -> Turn:
        """D(h) / 4 = <v,h> D(h) / (4 <v,h>), h midway between v and o (Walter et al. 2007, eqs.
        13-14)."""
        h = half_vector(v, o)
        weight = self.fresnel(np.maximum(dot(v, h), 0.0))
        density = np.where(crossed, 0.0, 0.25 * D(h))
        return Turn(density, weight, np.ones_like(density))


@dataclass(frozen=True)
class Dielectric(Material):
    """Glass: reflected with the chance F(<v,m>), else refracted; nothing is absorbed.

    ``ior``: index of refraction below the surface over that above it, 1e-8 to 1e8; else
    ``ValueError``. Densities are those of energy. Radiance that crosses from index n1 to n2 takes
    another (n2/n1)^2.
    """

    ior: float = 1.5
    transmits = True
    smooth = True
    channels = 1

    def __post_init__(self) -> None:
        number(self.ior, "ior", SMALLEST, LARGEST, "ratio")

    def eta(self, below: np.ndarray) -> np.ndarray:
        """Index beyond the surface over that on the path's side, ``(...)``."""
        return np.where(below, 1.0 / self.ior, self.ior)

    def scatter(
        self, v: np.ndarray, m: np.ndarray, below: np.ndarray, rng: np.random.Generator
    ) -> Scattered:
        """Reflect or refract by chance; weights stay 1."""
        eta = self.eta(below)
        cosine = np.clip(dot(v, m), 0.0, 1.0)
        crossed = rng.random(cosine.size) >= dielectric_reflectance(cosine, eta)
        reflected = mirrored(v, m, cosine)
        # Snell: in the frame of the other side o = v/eta + (cos_t - cos_i/eta) m
        cos_t = np.sqrt(np.maximum(1.0 - (1.0 - cosine * cosine) / (eta * eta), 0.0))
        refracted = v / eta[:, None] + (cos_t - cosine / eta)[:, None] * m
        o = np.where(crossed[:, None], normalize(refracted), reflected)
        return Scattered(vector(*o.T), crossed, np.ones((cosine.size, 1)))

    def turn(
        self,
        v: np.ndarray,
        o: np.ndarray,
        m: np.ndarray,
        below: np.ndarray,
        crossed: np.ndarray,
        D: Callable[[np.ndarray], np.ndarray],
    ) -> Turn:
        """<v,h> D(h) F / (4 <v,h>), or <v,h> D(h) (1 - F) eta^2 <o,h> / (<v,h> - eta <o,h>)^2
        (Walter et al. 2007, eqs. 16-17; o in the frame of the other side)."""
        if self.ior == 1.0:
            raise ValueError(
                "ior is 1, where all light goes straight on and has no density; give another ior"
            )
        eta = self.eta(below)
        # v - eta o is parallel to the facet's normal, and points inwards if eta > 1
        along = (v - eta[..., None] * o) * np.where(eta > 1.0, -1.0, 1.0)[..., None]
        h = np.where(crossed[..., None], normalize(along), half_vector(v, o))
        cos_i, cos_o = dot(v, h), dot(o, h)
        facing = (cos_i > 0.0) & (cos_o > 0.0)
        length2 = np.where(crossed, dot(along, along), 1.0)
        refracted = eta * eta * cos_i * cos_o / np.where(length2 > 0.0, length2, 1.0)
        density = np.where(facing, D(h) * np.where(crossed, refracted, 0.25), 0.0)
        reflectance = dielectric_reflectance(np.maximum(cos_i, 0.0), eta)
        choice = np.where(crossed, 1.0 - reflectance, reflectance)
        return Turn(density, choice[..., None], choice)


@dataclass(frozen=True)
class Diffuse(Material):
    """Matte facets: o is cosine-distributed about m, with the factor ``albedo``.

    ``albedo``: three numbers in 0..1, else ``ValueError``.
    """

    albedo: Sequence[float] = (1.0, 1.0, 1.0)
    transmits = False
    smooth = False

    def __post_init__(self) -> None:
        rgb(self.albedo, "albedo", 1.0)

    @property
    def channels(self) -> int:
        """1 for grey, else 3."""
        return 1 if len(set(self.albedo)) == 1 else 3

    def scatter(
        self, v: np.ndarray, m: np.ndarray, below: np.ndarray, rng: np.random.Generator
    ) -> Scattered:
        """Draw from the cosine about m: a point of the unit sphere that touches the facet."""
        n = v.shape[0]
        z = 2.0 * rng.random(n) - 1.0
        phi = 2.0 * np.pi * rng.random(n)
        radius = np.sqrt(1.0 - z * z)
        o = normalize(m + vector(radius * np.cos(phi), radius * np.sin(phi), z))
        return Scattered(o, np.zeros(n, bool), np.broadcast_to(self._weight, (n, self.channels)))

    def turn(
        self,
        v: np.ndarray,
        o: np.ndarray,
        m: np.ndarray,
        below: np.ndarray,
        crossed: np.ndarray,
        D: Callable[[np.ndarray], np.ndarray],
    ) -> Turn:
        """<v,m> D(m) <o,m> / pi (Heitz, Dupuy 2015, the integrand over facets)."""
        density = np.maximum(dot(v, m), 0.0) * D(m) * self._cosine(o, m, crossed)
        weight = np.broadcast_to(self._weight, (*density.shape, self.channels))
        return Turn(density, weight, np.ones_like(density))

    def at_facet(self, o: np.ndarray, m: np.ndarray, crossed: np.ndarray) -> np.ndarray:
        """albedo <o,m> / pi, per steradian of o ``(..., C)``, of the facet ``m``."""
        return self._weight * self._cosine(o, m, crossed)[..., None]

    def _cosine(self, o: np.ndarray, m: np.ndarray, crossed: np.ndarray) -> np.ndarray:
        return np.where(crossed, 0.0, np.maximum(dot(o, m), 0.0) / np.pi)

    @property
    def _weight(self) -> np.ndarray:
        return np.asarray(self.albedo, dtype=np.float64)[: self.channels]
