# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomials in four variables from -1 to 1, as sums of products of Chebyshev polynomials."""

import re
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.polynomial.chebyshev import chebvander

DIGITS = 4  # of a coefficient
RIDGE = 1e-4  # the cost of a coefficient of 1, as a root of squared error
ROUNDS = 6  # of least squares; each weighs the largest errors more


@dataclass(frozen=True)
class Polynomial:
    """A polynomial of the first ``variables``, and the limits of its value."""

    name: str
    meaning: str
    degree: int
    variables: int
    low: float
    high: float

    @property
    def exponents(self) -> list[tuple[int, ...]]:
        """The exponents of its terms, whose sum is at most its degree."""
        powers = [range(self.degree + 1) if i < self.variables else (0,) for i in range(4)]
        return [e for e in product(*powers) if sum(e) <= self.degree]

    def terms(self, place: np.ndarray) -> np.ndarray:
        """Its terms ``(n, m)`` at ``place`` ``(n, 4)``, without coefficients."""
        values = chebvander(place, self.degree)
        every = [[values[:, i, e[i]] for i in range(4)] for e in self.exponents]
        return np.stack([np.prod(one, axis=0) for one in every], axis=-1)

    def limited(self, place: np.ndarray, coefficients: np.ndarray) -> np.ndarray:
        """Its values ``(n,)``."""
        return np.clip(self.terms(place) @ coefficients, self.low, self.high)

    def text(self, coefficients: np.ndarray) -> str:
        """Its value in OSL, of the vectors a0, a1 ... and the products b10, b01 ... that `function`
        names."""
        numbers = dict(zip(self.exponents, (_number(c) for c in coefficients), strict=True))
        parts = []
        for e in dict.fromkeys(e[2:] for e in self.exponents):
            row = [numbers.get(pair + e, "0") for pair in _pairs(self.degree - sum(e))]
            dots = [f"dot(vector({', '.join(one)}), a{i})" for i, one in enumerate(_triples(row))]
            parts.append(f"b{e[0]}{e[1]} * ({' + '.join(dots)})" if any(e) else " + ".join(dots))
        return f"clamp({' + '.join(parts)}, {self.low:g}, {self.high:g})"


def least(rows: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Coefficients ``(m,)`` whose errors ``rows`` ``(n, m)`` @ coefficients - ``wanted`` are
    small, the largest above all."""
    count = rows.shape[1]
    weight = np.ones(len(rows))
    for _ in range(ROUNDS):
        root = np.sqrt(weight / weight.mean())[:, None]
        matrix = np.concatenate([root * rows, RIDGE * np.eye(count)])
        found = np.linalg.lstsq(matrix, np.append(root[:, 0] * wanted, np.zeros(count)))[0]
        errors = np.abs(rows @ found - wanted)
        weight *= 0.5 + errors / np.sqrt(np.mean(errors**2))
    return found


def _pairs(degree: int) -> list[tuple[int, int]]:
    """Exponents of two variables whose sum is at most ``degree``, the smallest sums first."""
    return [(i, total - i) for total in range(degree + 1) for i in range(total + 1)]


def _triples(texts: Sequence[str]) -> list[tuple[str, str, str]]:
    """``texts`` by threes, and as many zeros as that takes."""
    filled = [*texts, *["0"] * (-len(texts) % 3)]
    return list(zip(filled[::3], filled[1::3], filled[2::3], strict=True))


def _number(value: float) -> str:
    return re.sub(r"(?<!\d)0\.", ".", f"{value:.{DIGITS}g}".replace("e-0", "e-"))


FUNCTION = """\
{comment}
void {name}(int distribution, float x0, float x1, float x2, float x3,
{indent}output float values[{count}])
{{
{products}
  if (distribution) {{
{second}
  }}
  else {{
{first}
  }}
}}
"""


def function(
    name: str,
    comment: str,
    polynomials: Sequence[Polynomial],
    coefficients: Sequence[Sequence[np.ndarray]],
) -> str:
    """An OSL function of all ``polynomials``, by the ``coefficients`` of GGX, then Beckmann.

    It has no loop and no array. So OSL folds all that depends on the surface alone, as a render
    starts with a surface that is the same everywhere. Three terms make one operation, because OSL
    reads each operation for every metal, needed or not. Raises ValueError if a coefficient is not
    finite.
    """
    if not all(np.isfinite(one).all() for both in coefficients for one in both):
        raise ValueError(f"{name}: a coefficient is not finite")
    degree = max(one.degree for one in polynomials)
    first, second = (
        "\n".join(
            _wrapped(f"values[{i}] = {p.text(c)};")
            for i, (p, c) in enumerate(zip(polynomials, both, strict=True))
        )
        for both in coefficients
    )
    return FUNCTION.format(
        name=name,
        indent=" " * len(f"void {name}("),
        comment=comment,
        count=len(polynomials),
        products="\n".join(_vectors("x0", "x1", degree) + _products("b", "x2", "x3", degree)),
        first=first,
        second=second,
    )


def _vectors(x: str, y: str, degree: int) -> list[str]:
    """Lines for the vectors a0, a1 ... of all products of the Chebyshev polynomials of two
    variables, in the order of `_pairs`."""
    names = [f"p{i}{j}" if i or j else "1" for i, j in _pairs(degree)]
    threes = enumerate(_triples(names))
    vectors = [f"  vector a{k} = vector({', '.join(three)});" for k, three in threes]
    return _products("p", x, y, degree) + vectors


def _products(letter: str, x: str, y: str, degree: int) -> list[str]:
    """Lines for the products of the Chebyshev polynomials of two variables: with the letter b, b23
    is T2(x) T3(y)."""
    lines = []
    for variable, name in ((x, letter + "{}0"), (y, letter + "0{}")):
        rules = [variable, f"2 * {variable} * {variable} - 1"]
        rules += [
            f"2 * {variable} * {name.format(k - 1)} - {name.format(k - 2)}"
            for k in range(3, degree + 1)
        ]
        lines += [f"  float {name.format(k)} = {rule};" for k, rule in enumerate(rules, start=1)]
    pairs = [(i, j) for i in range(1, degree) for j in range(1, degree - i + 1)]
    return lines + [f"  float {letter}{i}{j} = {letter}{i}0 * {letter}0{j};" for i, j in pairs]


def _wrapped(line: str, width: int = 98) -> str:
    return textwrap.fill(line, width, initial_indent="    ", subsequent_indent="        ")
