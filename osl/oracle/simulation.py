# SPDX-License-Identifier: GPL-3.0-or-later
"""Light that bounces on a height field: the surface that the models stand for.

Nothing here uses Smith's theory. Rays start evenly spread on a plane above the sheet. The material
scatters them at every facet they hit. They leave when they pass the highest point upwards or the
lowest point downwards. The sheet is periodic, so a ray that reaches its side goes on from the
opposite one. Rays that the tracer loses are dropped and counted (ray_tracer.py).
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from weakref import WeakSet

import numpy as np

from .checks import count, generator
from .estimate import Bounces, Energies
from .height_field import HeightField
from .materials import Bounce, Material
from .ray_tracer import Tracer
from .vectors import outside, to_common, to_side


@dataclass(frozen=True)
class Hit(Bounce):
    """One bounce of the ``n`` rays that met the sheet once more.

    Besides `Bounce`: ``weight`` ``(n, C)`` after the bounce. ``left`` ``(n,)``: rays that leave
    now; ``lost`` ``(n,)``: rays dropped on their way to the next bounce; all others go on.
    ``dropped``: number of rays dropped so far, these included.
    """

    weight: np.ndarray
    left: np.ndarray
    lost: np.ndarray
    dropped: int

    @property
    def leaving(self) -> np.ndarray:
        """Weight that leaves at this bounce, ``(n, C)``."""
        return self.weight * self.left[:, None]

    @property
    def staying(self) -> np.ndarray:
        """Weight that goes on to the next bounce, ``(n, C)``."""
        return self.weight * ~(self.left | self.lost)[:, None]


@dataclass(frozen=True)
class SimulatedEnergies(Energies):
    """Energies per bounce, and the share of rays that were ``lost`` ``(...)``."""

    lost: np.ndarray


def simulate(
    tracer: Tracer,
    wi: np.ndarray,
    material: Material,
    max_bounces: int = 16,
    rays: int = 100_000,
    rng: np.random.Generator | int = 0,
) -> Iterator[Hit]:
    """Bounce 1, 2, ... of rays from ``wi`` ``(3,)``, until ``max_bounces`` or until no ray is left.

    ``wi`` is above the surface, or on either side if the material transmits. ``rng`` a Generator or
    a seed. Raises ``ValueError`` for a direction that is not such a unit vector, and for counts
    that are too small; ``TypeError`` for counts that are not whole numbers, and for anything but a
    `Tracer`.
    """
    if not isinstance(tracer, Tracer):
        raise TypeError(f"tracer is a {type(tracer).__name__}; give a Tracer of a HeightField")
    wi = outside(wi, "wi", material.transmits)
    if wi.shape != (3,):
        raise ValueError(f"wi has shape {wi.shape}; a simulation has one direction, shape (3,)")
    max_bounces, rays = count(max_bounces, "max_bounces", 1), count(rays, "rays", 1)
    return _simulate(tracer, wi, material, max_bounces, rays, generator(rng))


def _simulate(
    tracer: Tracer,
    wi: np.ndarray,
    material: Material,
    max_bounces: int,
    rays: int,
    rng: np.random.Generator,
) -> Iterator[Hit]:
    v, below = to_side(np.broadcast_to(wi, (rays, 3)))
    walk = np.arange(rays)
    weight = np.ones((rays, material.channels))
    there = tracer.follow(tracer.start(rays, wi[2] < 0.0, rng), to_common(-v, below), below)
    dropped = int(there.lost.sum())
    for _ in range(max_bounces):
        on = np.flatnonzero(~(there.left | there.lost))
        if on.size == 0:
            return
        walk, v, below, m, point, weight = (
            one[on] for one in (walk, v, below, there.m, there.point, weight)
        )
        o, crossed, factor = material.scatter(v, m, below, rng)
        weight = weight * factor
        after = below ^ crossed
        there = tracer.follow(tracer.off(point, after), to_common(o, after), after)
        dropped += int(there.lost.sum())
        yield Hit(walk, v, below, m, o, crossed, weight, there.left, there.lost, dropped)
        v, below = -o, after


def simulated_energies(
    tracers: Iterable[Tracer],
    wi: np.ndarray,
    material: Material,
    max_bounces: int = 16,
    rays: int = 100_000,
    rng: np.random.Generator | int = 0,
) -> SimulatedEnergies:
    """Energy that leaves at each bounce of rays from ``wi`` ``(..., 3)``, mean over height fields.

    ``tracers``: at least two independent fields of one kind; a generator's are held one at a time.
    ``rays`` per field and direction. Variances come from the scatter of the fields, which limits
    the accuracy more than the number of rays. Errors as in `simulate`; ``ValueError`` also for no
    direction at all, and for a tracer that is given twice.
    """
    wi = outside(wi, "wi", material.transmits)
    if wi.size == 0:
        raise ValueError(f"wi has shape {wi.shape}; give one direction or more")
    max_bounces, rays = count(max_bounces, "max_bounces", 1), count(rays, "rays", 1)
    rng = generator(rng)
    runs = [
        _shares(tracer, one, material, max_bounces, rays, rng)
        for tracer in _distinct(tracers)
        for one in wi.reshape(-1, 3)
    ]
    directions = wi.shape[:-1]
    fields = len(runs) // math.prod(directions)
    if fields < 2:
        raise ValueError(f"tracers has {fields}; give 2 or more, to see how they scatter")
    leaving, remaining, lost = (
        np.reshape(part, (fields, *directions, *np.shape(part)[1:]))
        for part in zip(*runs, strict=True)
    )

    def variance(values: np.ndarray) -> np.ndarray:
        return values.var(axis=0, ddof=1) / fields

    def over_fields(values: np.ndarray, inside: np.ndarray) -> Bounces:
        return Bounces(
            np.moveaxis(values.mean(axis=0), -2, 0),
            np.moveaxis(variance(values), -2, 0),
            variance(values.sum(axis=-2)),
            inside,
        )

    reflected, transmitted = leaving[..., 0, :, :], leaving[..., 1, :, :]
    inside = remaining.mean(axis=0)
    unknown = np.full_like(inside, np.nan)
    return SimulatedEnergies(
        over_fields(reflected, unknown if material.transmits else inside),
        over_fields(transmitted, unknown if material.transmits else np.zeros_like(inside)),
        over_fields(reflected + transmitted, inside),
        lost.mean(axis=0),
    )


def _distinct(tracers: Iterable[Tracer]) -> Iterator[Tracer]:
    """The tracers, one at a time; ``ValueError`` for one that came before."""
    if isinstance(tracers, Tracer | HeightField):
        raise TypeError(f"tracers is a {type(tracers).__name__}; give 2 Tracers or more")
    before: WeakSet[Tracer] = WeakSet()  # weak, so that each one is freed after use
    for number, tracer in enumerate(tracers):
        if isinstance(tracer, Tracer):  # `simulate` names what is not
            if tracer in before:
                raise ValueError(f"tracers has one twice, number {number}; give independent fields")
            before.add(tracer)
        yield tracer


def _shares(
    tracer: Tracer,
    wi: np.ndarray,
    material: Material,
    max_bounces: int,
    rays: int,
    rng: np.random.Generator,
) -> tuple[np.ndarray, np.ndarray, float]:
    """Energy reflected and transmitted at each bounce, ``(2, max_bounces, 3)``; what remains
    ``(3,)``; and the share of rays lost."""
    leaving, remaining, dropped = np.zeros((2, max_bounces, 3)), np.zeros(3), rays
    for k, hit in enumerate(simulate(tracer, wi, material, max_bounces, rays, rng)):
        through = hit.below_after ^ (wi[2] < 0.0)
        leaving[0, k] = hit.leaving[~through].sum(axis=0) / rays
        leaving[1, k] = hit.leaving[through].sum(axis=0) / rays
        remaining[:] = hit.staying.sum(axis=0) / rays
        dropped = hit.dropped
    return leaving, remaining, dropped / rays
