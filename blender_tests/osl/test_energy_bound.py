# SPDX-License-Identifier: GPL-3.0-or-later
"""The bound that decides whether further bounces are worth a walk (accuracy.h)."""

import numpy as np
import pytest

from osl.oracle.materials import Dielectric, Diffuse
from osl.oracle.surface import Surface
from osl.oracle.vectors import direction
from osl.oracle.walk import bounces

from .probe import evaluate
from .samples import DISTRIBUTIONS, SURFACE, Rows

THETA = np.array([0.0, 0.4, 0.7, 1.0, 1.2, 1.3, 1.4, 1.5])
WIDTHS = [(a, a) for a in (0.01, 0.03, 0.1, 0.3, 0.6, 1.0)] + [(1.0, 0.1)]
MATERIALS = {"matte": Diffuse()} | {
    f"glass of {ior:.3g}": Dielectric(ior) for ior in (1.1, 1.5, 2.4, 1 / 1.05, 1 / 1.5, 1 / 2.4)
}


@pytest.mark.parametrize("distribution", DISTRIBUTIONS)
@pytest.mark.parametrize("name", MATERIALS)
def test_no_walk_is_left_out_that_the_tolerance_asks_for(name: str, distribution: str) -> None:
    """The bound is never below the energy that stays after the first bounce (within 4 standard
    errors, and 1e-4 where nearly nothing stays). Along the normal of nearly smooth glass it is
    below the default Tolerance, so that no walk is made."""
    material = MATERIALS[name]
    surfaces = tuple(Surface(*both, distribution, material) for both in WIDTHS)
    rows = Rows(surfaces, len(THETA))
    wi = direction(THETA)
    matte = isinstance(material, Diffuse)
    ior = 1.0 if matte else material.ior
    bound = evaluate(
        "accuracy.h",
        f"{SURFACE} Material material; material.kind = {'DIFFUSE' if matte else 'DIELECTRIC'}; "
        f"material.ior = {ior}; result = further_energy_bound(surface, material, wi);",
        alpha=rows.alpha,
        wi=np.tile(wi, (len(WIDTHS), 1)),
    )[:, 0]
    mean, error = np.array([_staying(surface, w) for surface in surfaces for w in wi]).T
    assert np.all(bound >= mean - 4.0 * error - 1e-4)
    if not matte:
        assert bound[0] < 1e-3


def _staying(surface: Surface, wi: np.ndarray, walks: int = 20_000) -> tuple[float, float]:
    """Energy that stays after the first bounce, and its standard error."""
    first = next(bounces(np.tile(wi, (walks, 1)), surface, 1, np.random.default_rng(3)))
    return first.staying.mean(), first.staying.std() / np.sqrt(walks)
