# SPDX-License-Identifier: GPL-3.0-or-later
"""Polynomials as OSL has them, against the sums of terms that were fitted."""

from pathlib import Path

import numpy as np

from osl.tables.polynomial import Polynomial, function

from .probe import evaluate

# Degrees whose numbers of terms do and do not come in threes; the last one reaches its limits.
SOME = (
    Polynomial("A", "of four variables", 5, 4, -20.0, 20.0),
    Polynomial("B", "of three", 4, 3, -20.0, 20.0),
    Polynomial("C", "of two", 3, 2, -20.0, 20.0),
    Polynomial("D", "of one", 4, 1, -20.0, 20.0),
    Polynomial("E", "constant", 0, 4, -20.0, 20.0),
    Polynomial("F", "limited", 2, 4, -0.25, 0.5),
)
PLACES = 256


def test_values(tmp_path: Path) -> None:
    """Random coefficients of both distributions, at random places."""
    rng = np.random.default_rng(8)
    both = [[np.round(rng.uniform(-1.0, 1.0, len(p.exponents)), 3) for p in SOME] for _ in range(2)]
    header = tmp_path / "some.h"
    header.write_text(function("some_values", "// Of a test.", SOME, both), encoding="utf-8")
    place = rng.uniform(-1.0, 1.0, (PLACES, 4)).astype(np.float32)
    arguments = {f"x{i}": place[:, i] for i in range(4)}
    for distribution, coefficients in enumerate(both):
        found = np.concatenate(
            [
                evaluate(
                    str(header),
                    f"float values[{len(SOME)}];"
                    f"some_values({distribution}, x0, x1, x2, x3, values);"
                    f"result = vector(values[{i}], values[{i + 1}], values[{i + 2}]);",
                    **arguments,
                )
                for i in range(0, len(SOME), 3)
            ],
            axis=1,
        )
        pairs = zip(SOME, coefficients, strict=True)
        wanted = [p.limited(place.astype(float), c) for p, c in pairs]
        np.testing.assert_allclose(found, np.stack(wanted, axis=1), rtol=1e-5, atol=1e-5)
        limits = found[:, -1]
        assert limits.min() == -0.25
        assert limits.max() == 0.5
