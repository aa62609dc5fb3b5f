# SPDX-License-Identifier: GPL-3.0-or-later
"""Light paths through the microgeometry, and what each one contributes.

A path of k bounces is k vertices. Vertex i receives it from v_i and sends it to o_i; v_1 = wi,
v_{i+1} = -o_i, and o_k = wo. The density with which light from wi leaves along wo on such a path is
a product of one term per vertex (section 2 of the supplement: vertex terms times segment terms):

    f = 1/sigma(wi) * product over i < k of V_i p_stay_i / sigma(-o_i) * V_k p_exit_k

V_i is the vertex term (`Material.turn`). With |d_i.z| for the cosine of the direction d_i = o_i
between vertices i and i + 1, p_stay_i / sigma(-o_i) is e_i p_i / |d_i.z|, where

    uncorrelated   e_i p_i = (1 - G1(d_i)) G1(-d_i), and G1(-d_i) for d_i downwards   eqs. 18-24
    correlated     1/sigma(wi) ... p_exit multiply up to G2(i<k)(v_i, o_i) ... G2(i=k)  eqs. 25-26

Logarithms keep the products of many densities finite.
"""

from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np

from .masking import exit_odds
from .ndf import D, sigma
from .surface import HEIGHT_TRACKED, Surface
from .vectors import dot, to_side
from .visible import sample


@dataclass(frozen=True)
class Path:
    """``n`` paths of k vertices.

    ``v``, ``o`` and facets ``m`` ``(k, n, 3)`` are in the frames of their sides (materials.py).
    ``below``, the side on arrival, and ``crossed`` are ``(k, n)``.
    """

    v: np.ndarray
    o: np.ndarray
    m: np.ndarray
    below: np.ndarray
    crossed: np.ndarray

    def reversed(self) -> "Path":
        """The same paths, walked from wo to wi."""
        backwards = Path(self.o, self.v, self.m, self.below ^ self.crossed, self.crossed)
        return replace(
            backwards, **{f.name: getattr(backwards, f.name)[::-1] for f in fields(backwards)}
        )


@dataclass(frozen=True)
class Terms:
    """What each vertex of paths contributes: logarithms ``(k, n)``, and ``weight`` ``(k, n, C)``.

    ``weight`` = V's factor on the light; ``turn`` = V without it; ``area`` = sigma(v);
    ``stay`` = p_stay / sigma(-o) and ``leave`` = p_exit. Densities of drawing the vertex:
    ``forward``, o from v (and m); ``backward``, v from o (and m); ``facet``, of m alone when both
    are given.
    """

    turn: np.ndarray
    weight: np.ndarray
    area: np.ndarray
    stay: np.ndarray
    leave: np.ndarray
    forward: np.ndarray
    backward: np.ndarray
    facet: np.ndarray

    def __getitem__(self, index: int | slice) -> "Terms":
        return Terms(*(getattr(self, f.name)[index] for f in fields(self)))

    @classmethod
    def joined(cls, *parts: "Terms") -> "Terms":
        """Terms of paths whose vertices are those of ``parts``, one after the other."""
        return cls(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(cls)))


def terms(path: Path, surface: Surface) -> Terms:
    """`Terms` of every vertex.

    Raises ``ValueError`` for a dielectric of IOR 1, and for the height-tracked model, because
    directions alone do not determine its paths.
    """
    if surface.model == HEIGHT_TRACKED:
        raise ValueError(
            f"model is {HEIGHT_TRACKED!r}, whose paths need heights; use another model"
        )
    v, o, m, below, crossed = (getattr(path, f.name) for f in fields(path))
    density = partial(D, surface=surface)
    turn = surface.material.turn(v, o, m, below, crossed, density)
    back = surface.material.turn(o, v, m, below ^ crossed, crossed, density)
    area, area_o, area_back = (sigma(w, surface) for w in (v, o, -o))
    odds = exit_odds(v, area, o, area_back, crossed, None, surface.model)
    with np.errstate(divide="ignore"):  # log(0) = -inf is right for an impossible path
        log_area = np.log(area)
        facet = np.zeros(area.shape)
        if not surface.material.smooth:
            facet = np.log(np.maximum(dot(v, m), 0.0) * D(m, surface)) - _finite(log_area)
        return Terms(
            turn=np.log(turn.density),
            weight=turn.weight,
            area=log_area,
            stay=np.log(odds.p_stay) - _finite(np.log(area_back)),
            leave=np.log(odds.p_exit),
            forward=np.log(turn.density * turn.choice) - _finite(log_area),
            backward=np.log(back.density * back.choice) - _finite(np.log(area_o)),
            facet=facet,
        )


def log_contribution(found: Terms) -> np.ndarray:
    """Logarithm of f without its weight, ``(n,)``.

    f is per steradian of all directions but wi, and of all facets if they are not smooth.
    """
    total = found.turn.sum(axis=0) + found.stay[:-1].sum(axis=0) + found.leave[-1]
    return total - _finite(found.area[0])


def contribution(path: Path, surface: Surface) -> np.ndarray:
    """f, shape ``(n, C)``, as in `log_contribution`; errors as in `terms`."""
    found = terms(path, surface)
    return np.exp(log_contribution(found))[:, None] * found.weight.prod(axis=0)


def random_paths(start: np.ndarray, surface: Surface, count: int, rng: np.random.Generator) -> Path:
    """Paths of ``count`` vertices from ``start`` ``(n, 3)``; none leaves, none is thinned.

    Visible normals and the material alone decide on their directions.
    """
    v, below = to_side(start)
    rows = []
    for _ in range(count):
        m = sample(v, surface, rng)
        o, crossed, _ = surface.material.scatter(v, m, below, rng)
        rows.append((v, o, m, below, crossed))
        v, below = -o, below ^ crossed
    if not rows:
        none = v[None][:0]
        return Path(none, none, none, below[None][:0], below[None][:0])
    return Path(*(np.stack(column) for column in zip(*rows, strict=True)))


def _finite(log_area: np.ndarray) -> np.ndarray:
    """Logarithms of an area to divide by; if it is 0, the density over it is 0 as well."""
    return np.where(np.isneginf(log_area), 0.0, log_area)
