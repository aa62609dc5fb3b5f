# SPDX-License-Identifier: GPL-3.0-or-later
"""Input errors, the half vector's edges, and what the oracle may import."""

import ast
import re
from pathlib import Path

import numpy as np
import pytest

from osl.oracle import (
    Conductor,
    Dielectric,
    Diffuse,
    Surface,
    energies,
    evaluate,
    first_bounce,
    lobe,
)
from osl.oracle.masking import G1, G2
from osl.oracle.ndf import Dvis
from osl.oracle.vectors import direction, half_vector

ORACLE = Path(__file__).resolve().parents[2] / "osl/oracle"

UP = direction(0.3)
WHITE = Surface(0.5, 0.5)
GLASS = Surface(0.5, 0.5, material=Dielectric(1.5))
EDGE = np.array([1.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Surface(0.0, 0.5), "alpha_x is 0.0"),
        (lambda: Surface(0.5, np.nan), "alpha_y is nan"),
        (lambda: Surface(0.5, 0.5, "PHONG"), "distribution is 'PHONG'"),
        (lambda: Surface(0.5, 1e9), "alpha_y is 1000000000.0; give a width from 1e-08 to 1e"),
        (lambda: Surface(0.5, 0.5, model="NONE"), "model is 'NONE'"),
        (lambda: Surface(0.5, 0.5, material=Conductor), "material is <class"),
        (lambda: Surface(0.5, 0.5, material=None), "material is None"),
        (lambda: Dielectric(0.0), "ior is 0.0"),
        (lambda: Dielectric(np.nan), "ior is nan"),
        (lambda: Diffuse((0.5, 1.5, 0.0)), "albedo is"),
        (lambda: Surface.from_roughness(0.0), "roughness is 0.0"),
        (lambda: energies(UP, WHITE, roulette=np.nan), "roulette is nan"),
        (lambda: energies(UP, WHITE, roulette=-1.0), "roulette is -1.0"),
        (lambda: energies(UP, WHITE, rng=-1), "rng is -1"),
        (lambda: energies(-UP, WHITE), "wi contains .*not above the surface"),
        (lambda: energies(EDGE, GLASS), "wi contains .*in the surface"),
        (lambda: evaluate(UP, EDGE, GLASS), "wo contains .*in the surface"),
        (lambda: first_bounce(UP, UP, Surface(0.5, 0.5, material=Diffuse())), "no closed first"),
        (lambda: G1(2.0 * UP, WHITE), "w contains .*not a unit vector"),
        (lambda: G2(UP, [0.0, 0.0, 2.0], WHITE), "o contains .*not a unit vector"),
        (lambda: Dvis(UP, [0.0, 1.0], WHITE), r"m has shape \(2,\)"),
        (lambda: Surface.from_roughness(1.5), "roughness is 1.5"),
        (lambda: Surface.from_roughness(0.5, -0.1), "anisotropy is -0.1"),
        (lambda: energies(np.array([0.0, 0.0, 2.0]), WHITE), "wi contains .*not a unit vector"),
        (lambda: energies(np.array([0.0, np.nan, 1.0]), WHITE), "wi contains .*not a unit vector"),
        (lambda: energies(np.array([0.0, 1.0]), WHITE), r"wi has shape \(2,\)"),
        (lambda: energies(direction(1.6), WHITE), "wi contains .*not above the surface"),
        (lambda: evaluate(UP, direction(2.0), WHITE), "wo contains .*not above the surface"),
        (lambda: first_bounce(UP, np.zeros(3), WHITE), "wo contains .*not a unit vector"),
        (lambda: lobe(np.stack([UP, UP]), UP, WHITE), r"wi has shape \(2, 3\)"),
        (lambda: energies(UP, WHITE, max_bounces=0), "max_bounces is 0"),
        (lambda: energies(UP, WHITE, walks=1), "walks is 1"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Surface("0.5", 0.5), "alpha_x is '0.5'; give a number"),
        (lambda: Surface([0.5], 0.5), "alpha_x is "),
        (lambda: Dielectric("1.5"), "ior is '1.5'"),
        (lambda: Diffuse("white"), "albedo is 'white'"),
        (lambda: Conductor("gold"), "fresnel is 'gold'"),
        (lambda: energies(UP, WHITE, walks=np.nan), "walks is nan; give a whole number"),
        (lambda: energies(UP, WHITE, max_bounces=2.0), "max_bounces is 2.0"),
        (lambda: energies(UP, WHITE, roulette=None), "roulette is None"),
    ],
)
def test_bad_types_are_named(call, message):
    with pytest.raises(TypeError, match=re.escape(message)):
        call()


def test_roughness_follows_the_metallic_bsdf():
    # roughness 0.6, anisotropy 0.9: alpha 0.36, aspect sqrt(0.19)
    surface = Surface.from_roughness(0.6, 0.9)
    assert surface.alpha_x == pytest.approx(0.36 / np.sqrt(0.19), rel=1e-14)
    assert surface.alpha_y == pytest.approx(0.36 * np.sqrt(0.19), rel=1e-14)
    assert Surface.from_roughness(0.7, 0.9).alpha_x == 1.0  # Cycles' limit


def test_half_vector_of_opposite_directions_is_zero():
    np.testing.assert_array_equal(half_vector(UP, -UP), np.zeros(3))
    np.testing.assert_allclose(half_vector(UP, UP), UP, rtol=1e-15)


def test_the_oracle_imports_nothing_of_what_it_judges():
    allowed = {
        "abc", "argparse", "ast", "collections", "dataclasses", "decimal", "functools", "hashlib",
        "json", "math", "numbers", "pathlib", "re", "statistics", "sys", "time", "typing",
        "weakref",
        "numpy", "scipy", "embreex", "pytest", "tqdm", "OpenImageIO",
    }  # fmt: skip
    files = sorted(ORACLE.glob("*.py"))
    assert len(files) > 10
    for file in files:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level <= 1, f"{file.name} imports from outside the oracle"
                modules = [] if node.level else [node.module]
            else:
                continue
            for module in modules:
                assert module.split(".")[0] in allowed, f"{file.name} imports {module}"
