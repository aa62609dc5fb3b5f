# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixed rules for integrals over micronormals, directions and heights.

Micronormals are m ~ (alpha_x r cos(psi), alpha_y r sin(psi), 1) with r = q/(1-q). So a rule over
the unit square in (q, psi) resolves every alpha alike.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr

from .ndf import D
from .surface import Surface
from .vectors import dot, vector


def gauss_legendre(count: int, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights ``(count,)`` of the Gauss-Legendre rule on an interval."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = 0.5 * (high - low)
    return low + half * (nodes + 1.0), half * weights


def stretched_normals(
    q: np.ndarray, psi: np.ndarray, surface: Surface
) -> tuple[np.ndarray, np.ndarray]:
    """Micronormals ``(..., 3)`` at ``q`` in (0, 1) and ``psi``, and steradians per dq dpsi."""
    r = q / (1.0 - q)
    x, y = surface.alpha_x * r * np.cos(psi), surface.alpha_y * r * np.sin(psi)
    length = np.sqrt(x * x + y * y + 1.0)
    measure = surface.alpha_x * surface.alpha_y * r / (length**3 * (1.0 - q) ** 2)
    return vector(x / length, y / length, 1.0 / length), measure


def stretched_coordinates(m: np.ndarray, surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """``q`` in (0, 1) and ``psi`` in turns, 0 to 1, of micronormals ``(..., 3)``."""
    x, y = m[..., 0] / (surface.alpha_x * m[..., 2]), m[..., 1] / (surface.alpha_y * m[..., 2])
    r = np.hypot(x, y)
    return r / (1.0 + r), np.mod(np.arctan2(y, x) / (2.0 * np.pi), 1.0)


def visible_normals(
    w: np.ndarray, surface: Surface, count: int = 200
) -> tuple[np.ndarray, np.ndarray]:
    """Rule over the micronormals that face ``w`` ``(3,)``: points ``(n, 3)``, weights ``(n,)``.

    w faces m if cos(psi - psi_w) > -a/r with a = w.z/t. That bounds psi exactly for each r, and the
    integrand is smooth inside. r runs from 0 to |a| and from |a| outwards. Squaring the variable
    smooths the square root at |a|.
    """
    x, y = surface.alpha_x * w[0], surface.alpha_y * w[1]
    a = w[2] / max(np.hypot(x, y), 1e-12)
    joint = abs(a) / (1.0 + abs(a))  # |a| as a value of q
    s, weight = gauss_legendre(count, 0.0, 1.0)
    parts = [(joint + (1.0 - joint) * s * s, weight * 2.0 * s * (1.0 - joint))]
    if a > 0.0:
        parts.append((joint * (1.0 - s * s), weight * 2.0 * s * joint))
    q, q_weight = (np.concatenate(one) for one in zip(*parts, strict=True))
    bound = np.arccos(np.clip(-a * (1.0 - q) / q, -1.0, 1.0))
    node, node_weight = gauss_legendre(count, -1.0, 1.0)
    psi = np.arctan2(y, x) + bound[:, None] * node
    m, measure = stretched_normals(np.broadcast_to(q[:, None], psi.shape), psi, surface)
    total = measure * (q_weight * bound)[:, None] * node_weight
    return m.reshape(-1, 3), total.ravel()


def projected_area(w: np.ndarray, surface: Surface, count: int = 80) -> float:
    """The integral of <w,m> D(m) over the micronormals that face ``w`` ``(3,)``.

    It is the denominator of eq. 4. 80 points along each axis make it good to 4e-14.
    """
    m, weight = visible_normals(w, surface, count)
    return float((np.maximum(dot(w, m), 0.0) * D(m, surface) * weight).sum())


def upper_hemisphere(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Rule over directions above the horizon, even in z and azimuth: ``(n, 3)`` and ``(n,)``."""
    z, z_weight = gauss_legendre(count, 0.0, 1.0)
    phi = 2.0 * np.pi * (np.arange(2 * count) + 0.5) / (2 * count)
    radius = np.sqrt(1.0 - z * z)[:, None]
    w = vector(radius * np.cos(phi), radius * np.sin(phi), z[:, None])
    weight = np.broadcast_to(z_weight[:, None] * np.pi / count, w.shape[:-1])
    return w.reshape(-1, 3), weight.ravel()


def basis(pole: np.ndarray) -> np.ndarray:
    """Three orthonormal vectors as the rows of ``(3, 3)``, the last of which is ``pole``."""
    helper = np.eye(3)[np.argmin(np.abs(pole))]
    x = np.cross(helper, pole)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(pole, x), pole])


@dataclass(frozen=True)
class Zone:
    """Directions o with ``z_low`` < o.z < ``z_high``, up to ``high`` radians from ``v`` ``(3,)``.

    Its coordinates are the angle from v, and a share of the azimuths about v that the two planes
    allow at that angle. The share is 0 to 1 on one side of the plane through v and z, and -1 to 0
    on the other. So a rule in them meets edges only at the angles ``breaks``. One of these may be
    the integrand's own ``kink``.
    """

    v: np.ndarray
    high: float = np.pi
    z_low: float = -1.0
    z_high: float = 1.0
    kink: float = 0.0

    @property
    def breaks(self) -> np.ndarray:
        """Ascending: 0, the kink, angles where the cone about v touches a plane, and ``high``."""
        theta = np.arccos(np.clip(self.v[2], -1.0, 1.0))
        planes = np.arccos(np.clip([self.z_low, self.z_high], -1.0, 1.0))
        touching = [*np.abs(planes - theta), *(np.pi - np.abs(np.pi - planes - theta))]
        inside = [angle for angle in (*touching, self.kink) if 0.0 < angle < self.high]
        return np.unique([0.0, *inside, self.high])

    def directions(self, angle: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Directions ``(..., 3)`` at the coordinates, and steradians per unit of both."""
        first, last = self._bounds(angle)
        phi = np.sign(share) * (first + (last - first) * np.abs(share))
        x, y, _ = self._basis()
        across = np.cos(phi)[..., None] * x + np.sin(phi)[..., None] * y
        o = np.cos(angle)[..., None] * self.v + np.sin(angle)[..., None] * across
        return o, np.sin(angle) * (last - first)

    def coordinates(self, o: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The coordinates of directions ``o`` ``(n, 3)`` in the zone."""
        x, y, z = self._basis() @ o.T
        angle = np.arctan2(np.hypot(x, y), z)
        first, last = self._bounds(angle)
        phi = np.arctan2(y, x)
        share = (np.abs(phi) - first) / np.where(last > first, last - first, 1.0)
        return angle, np.copysign(np.clip(share, 0.0, 1.0), phi)

    def rule(self, count: int = 80) -> tuple[np.ndarray, np.ndarray]:
        """Points ``(n, 3)`` and weights ``(n,)``; ``count`` nodes a coordinate between breaks. A
        cubic change of variable allows integrands that begin and end like a square root."""
        node, weight = gauss_legendre(count, 0.0, 1.0)
        smooth, slope = node * node * (3.0 - 2.0 * node), 6.0 * node * (1.0 - node)
        start, width = self.breaks[:-1, None], np.diff(self.breaks)[:, None]
        angle, angle_weight = (start + width * smooth).ravel(), (width * slope * weight).ravel()
        share, share_weight = np.concatenate([-node, node]), np.concatenate([weight, weight])
        o, measure = self.directions(*np.meshgrid(angle, share, indexing="ij"))
        return o.reshape(-1, 3), (measure * angle_weight[:, None] * share_weight).ravel()

    def _bounds(self, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest azimuth in 0..pi from the direction of z."""
        span = np.sin(angle) * max(np.hypot(self.v[0], self.v[1]), 1e-12)
        span, level = np.maximum(span, 1e-300), np.cos(angle) * self.v[2]
        limits = ((one - level) / span for one in (self.z_high, self.z_low))
        return tuple(np.arccos(np.clip(one, -1.0, 1.0)) for one in limits)

    def _basis(self) -> np.ndarray:
        """Rows x, y and v, with x towards z."""
        if np.hypot(self.v[0], self.v[1]) < 1e-9:
            return basis(self.v)
        x = np.array([0.0, 0.0, 1.0]) - self.v[2] * self.v
        x /= np.linalg.norm(x)
        return np.stack([x, np.cross(self.v, x), self.v])


def facet_zones(v: np.ndarray, eta: float | None = None) -> list[Zone]:
    """The zones of all directions to which facets, m.z > 0, turn ``v`` ``(3,)``.

    The first is of reflection. If ``eta``, the index beyond over that on this side, is given, there
    is another one of refraction, in the frame of the other side as in materials.py.
    """
    if eta is None:
        return [Zone(v, z_low=-v[2])]  # the facet's normal is along v + o
    # F has a kink at the critical angle, and o is then twice that angle away
    critical = 2.0 * np.arcsin(min(eta, 1.0))
    # the normal is along v - eta o or opposite to it; the widest turn is that of a grazing ray
    plane = np.clip(v[2] / eta, -1.0, 1.0)
    limits = (plane, 1.0) if eta > 1.0 else (-1.0, plane)
    widest = np.arccos(min(eta, 1.0 / eta))
    return [Zone(v, z_low=-v[2], kink=critical), Zone(v, widest, *limits)]


def heights() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rule over the heights h of a Gaussian surface: log(u) and log(1 - u) of their distribution
    function u, and the weights' logarithms; each ``(n,)``.

    It takes trapezoids in t with h = sinh(t). They resolve integrands u^(a-1) from a = 1e-7 (h far
    down) to a = 1e6 (h far up).
    """
    t = np.arange(-12.0, 4.5, 0.004)
    h = np.sinh(t)
    log_density = -0.5 * h * h - 0.5 * np.log(2.0 * np.pi)
    return log_ndtr(h), log_ndtr(-h), log_density + np.log(np.cosh(t) * 0.004)
