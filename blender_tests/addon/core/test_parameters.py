# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts that need no Blender: parameters, versions, the OSL status."""

import ast
import math
import subprocess
import sys
import tomllib

import numpy as np
import pytest

from addon.core import VERSION
from addon.core.kinds import KINDS, kind_named
from addon.core.osl_state import osl_state
from addon.core.oso import check_against, oso_parameters
from addon.core.parameter import Parameter
from addon.core.parameters import CONDUCTOR
from blender_tests.addon.support import ROOT

BY_NAME = {parameter.identifier: parameter for parameter in CONDUCTOR}
CORE = sorted((ROOT / "addon" / "core").glob("*.py"))


@pytest.mark.parametrize("path", CORE, ids=lambda path: path.name)
def test_core_imports_nothing_of_blender(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            assert node.level <= 1, f"{path.name} imports from outside core: {node.module}"
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.level == 0:
            modules = [node.module]
        for module in modules:
            assert module.split(".")[0] in sys.stdlib_module_names, f"{path.name}: {module}"


def test_core_is_importable_without_loading_blender():
    script = "import sys, addon.core.parameters, addon.core.osl_state; print('bpy' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "False"


def test_manifest_agrees_with_the_code_and_the_rules():
    manifest = tomllib.loads((ROOT / "addon/blender_manifest.toml").read_text(encoding="utf-8"))
    assert manifest["version"] == VERSION
    assert manifest["id"] == "microbounce"
    assert manifest["blender_version_min"] == "4.5.0"
    assert len(manifest["tagline"]) <= 64
    assert manifest["tagline"][-1].isalnum()
    assert list(manifest["permissions"]) == ["files"], "neither network nor clipboard"
    assert len(manifest["permissions"]["files"]) <= 64
    assert manifest["permissions"]["files"][-1].isalnum()


@pytest.mark.parametrize(
    "parameter",
    [
        pytest.param(parameter, id=f"{kind.label} {parameter.identifier}")
        for kind in KINDS.values()
        for parameter in kind.parameters
    ],
)
def test_parameter_is_described_and_its_ranges_nest(parameter):
    low, high = parameter.legal
    assert low <= parameter.useful[0] <= parameter.useful[1] <= high
    assert len(parameter.tooltip) > 20
    assert not parameter.tooltip.endswith(".")
    for number, name in enumerate(parameter.choices):
        assert f"{number} {name}" in parameter.description


def test_kinds_share_the_parameters_that_all_have():
    common = set.intersection(*({p.identifier for p in kind.parameters} for kind in KINDS.values()))
    assert {"Roughness", "Quality", "Model", "BounceOnly", "Kernel", "Normal"} <= common
    for identifier in common:
        assert len({id(kind.by_identifier[identifier]) for kind in KINDS.values()}) == 1


def test_kinds_are_named():
    assert {kind.name: kind.shader for kind in KINDS.values()} == {
        "Microbounce Conductor": "microbounce_conductor",
        "Microbounce Dielectric": "microbounce_dielectric",
        "Microbounce Diffuse": "microbounce_diffuse",
    }
    with pytest.raises(ValueError, match="is 'GLASS': use one of CONDUCTOR, DIELECTRIC, DIFFUSE"):
        kind_named("GLASS")


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("Roughness", 1, 1.0),
        ("Roughness", np.float32(0.5), 0.5),
        ("Quality", "Exact", 3),
        ("Quality", "exact", 3),
        ("Quality", np.int64(1), 1),
        ("BaseColor", (1, 0.5, 0, 1), (1.0, 0.5, 0.0)),
        ("IOR", np.array([1.0, 2.0, 3.0]), (1.0, 2.0, 3.0)),
    ],
)
def test_checked_accepts(name, value, expected):
    assert BY_NAME[name].checked(value) == expected


@pytest.mark.parametrize(
    ("name", "value", "error", "words"),
    [
        ("Roughness", 1.5, ValueError, "Roughness is 1.5: it goes from 0 to 1"),
        ("Roughness", math.nan, ValueError, "Roughness is nan"),
        ("Roughness", 10**400, ValueError, "it goes from 0 to 1"),
        ("Roughness", "0.5", TypeError, "give a number"),
        ("Walks", 2.5, TypeError, "give a whole number"),
        ("Walks", 0, ValueError, "it goes from 1 to 16"),
        ("Quality", "best", ValueError, "use one of ('Single', 'Fitted', 'Walk', 'Exact')"),
        ("BaseColor", (1, 0.5), TypeError, "give three numbers"),
        ("BaseColor", (1, 0.5, math.inf), ValueError, "it goes from 0 to 1"),
        ("IOR", (1, 2, 3, 4), TypeError, "give three numbers"),
        ("IOR", "abc", TypeError, "give three numbers"),
    ],
)
def test_checked_refuses_and_says_why(name, value, error, words):
    with pytest.raises(error) as caught:
        BY_NAME[name].checked(value)
    assert words in str(caught.value)


def test_specification_refuses_contradictions():
    with pytest.raises(ValueError, match="type 'DOUBLE'"):
        Parameter("A", "A", "DOUBLE", 0.0, (0, 1), (0, 1))
    with pytest.raises(ValueError, match="2 choices"):
        Parameter("A", "A", "INT", 0, (0, 2), (0, 2), choices=("x", "y"))
    with pytest.raises(ValueError, match="it goes from 0 to 1"):
        Parameter("A", "A", "FLOAT", 2.0, (0, 1), (0, 1))


OSO = """OpenShadingLanguage 1.00
shader toy
param\tcolor\tTint\t0.5 0.25 1\t\t%meta{string,label,"A 1 2"}  %read{1,1}
param\tint\tMode\t2\t\t%read{1,1}
param\tnormal\tNormal\t0 0 0\t\t%read{5,5} %write{0,0} %initexpr
oparam\tclosure color\tBSDF\t\t\t%read{1,1}
local\tfloat\tx\t%read{1,1}
"""


def test_compiled_parameters_are_read():
    tint, mode, normal, bsdf = oso_parameters(OSO)
    assert (tint.name, tint.type, tint.default) == ("Tint", "color", (0.5, 0.25, 1.0))
    assert (mode.type, mode.default, mode.computed, mode.output) == ("int", (2.0,), False, False)
    assert normal.computed
    assert (bsdf.name, bsdf.type, bsdf.output) == ("BSDF", "closure color", True)
    with pytest.raises(ValueError, match="not a compiled shader"):
        oso_parameters("shader toy() {}")


def test_shader_and_specification_that_differ_are_refused():
    tint = Parameter("Tint", "Tint", "COLOR", (0.5, 0.25, 1), (0, 1), (0, 1))
    mode = Parameter("Mode", "Mode", "INT", 2, (0, 3), (0, 3))
    normal = Parameter("Normal", "Normal", "NORMAL", (0, 0, 0), (-1, 1), (-1, 1))
    check_against((tint, mode, normal), OSO)
    with pytest.raises(ValueError, match="declares Tint, Mode, Normal; the extension expects"):
        check_against((mode, tint, normal), OSO)
    number = Parameter("Mode", "Mode", "FLOAT", 2.0, (0, 3), (0, 3))
    with pytest.raises(ValueError, match="declares Mode as int; the extension expects float"):
        check_against((tint, number, normal), OSO)


@pytest.mark.parametrize(
    ("state", "ok", "can_enable", "words"),
    [
        ((True, "CYCLES", True, "CPU"), True, False, ""),
        ((True, "CYCLES", True, "OPTIX"), True, False, ""),
        ((True, "CYCLES", True, "HIP"), False, False, "HIP devices have no"),
        ((True, "CYCLES", False, "CPU"), False, True, "Switch it on"),
        ((True, "BLENDER_EEVEE", True, "CPU"), False, False, "Choose Cycles"),
        ((False, "CYCLES", True, "CPU"), False, False, "built without"),
    ],
)
def test_osl_state(state, ok, can_enable, words):
    status = osl_state(*state)
    assert (status.ok, status.can_enable) == (ok, can_enable)
    assert words in status.message
    assert bool(status.message) != ok
