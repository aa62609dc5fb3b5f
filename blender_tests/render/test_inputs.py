# SPDX-License-Identifier: GPL-3.0-or-later
"""Bad input: whatever is linked to the material, every pixel is finite, not negative and not black.

Values reach the shader through attributes of the mesh, as a texture's or a node's would: the limits
of the node's own fields do not apply there.
"""

import bpy
import numpy as np
import pytest

from addon.core.parameter import Parameter
from addon.core.parameters import CONDUCTOR
from addon.material.node import new_material
from scenes import common, pictures

NUMBERS = [float("nan"), float("inf"), float("-inf"), -1.0, 2.0, 1e30, -1e30, 0.0]
VECTORS = [
    (0.0, 0.0, 0.0),
    (float("nan"), 0.0, 1.0),
    (float("inf"), float("inf"), float("inf")),
    (1e30, 1e30, 1e30),
    (1e-30, 0.0, 0.0),
    (-2.0, 3.0, -4.0),
]
QUALITIES = ("Single", "Fitted", "Walk", "Exact")
SIZE = 24
# In a uniform world of radiance 1 nothing that conserves energy is brighter; noise of a few samples
# and the compensation of the kernels' horizon add to that.
BRIGHTEST = 2.0


def scene_with(linked: dict[str, object], kind: str = "CONDUCTOR", **values: object) -> None:
    """A tilted plane in a white world, with constant attributes linked by the socket's name."""
    scene = common.start_scene((SIZE, SIZE), samples=8)
    common.set_world(scene, (1.0, 1.0, 1.0))
    common.add_front_camera(scene)
    material = new_material(kind, "Bad inputs", **values)
    mesh = bpy.data.meshes.new("Disc")
    mesh.from_pydata([(-2, -1, -2), (2, -1, -2), (2, 1, 2), (-2, 1, 2)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material)
    common.add_object("Disc", mesh)
    tree = material.node_tree
    node = next(node for node in tree.nodes if node.bl_idname == "ShaderNodeGroup")
    for index, (label, value) in enumerate(linked.items()):
        vector = isinstance(value, tuple)
        data_type = "FLOAT_VECTOR" if vector else "FLOAT"
        attribute = mesh.attributes.new(f"value {index}", data_type, "FACE")
        attribute.data.foreach_set("vector" if vector else "value", np.float32([value]).ravel())
        source = tree.nodes.new("ShaderNodeAttribute")
        source.attribute_name = f"value {index}"
        tree.links.new(source.outputs["Vector" if vector else "Fac"], node.inputs[label])


def assert_sound(image: np.ndarray) -> None:
    assert np.all(np.isfinite(image))
    assert np.all(image >= 0.0)
    blocks = image.reshape(SIZE // 8, 8, SIZE // 8, 8, 3).mean(axis=(1, 3))
    # One channel may be black where a colour of 0 was linked.
    assert blocks.max(axis=-1).min() > 0.02, "black"
    assert blocks.max() < BRIGHTEST


def _fast_quality(parameter: Parameter) -> str:
    """The quality of the fast tier: the default, or the one that uses the parameter."""
    return "Walk" if parameter.identifier in ("Walks", "Kernel", "BounceOnly") else "Fitted"


@pytest.mark.parametrize(
    ("parameter", "quality"),
    [
        pytest.param(
            parameter,
            quality,
            id=f"{parameter.identifier}-{quality}",
            marks=[] if quality == _fast_quality(parameter) else pytest.mark.nightly,
        )
        for parameter in CONDUCTOR
        for quality in QUALITIES
        # Single has no second bounce to show alone.
        if (parameter.identifier, quality) != ("BounceOnly", "Single")
    ],
)
def test_linked_values(parameter, quality: str) -> None:
    if parameter.identifier == "Quality":
        values = {"Roughness": 0.7}
    else:
        values = {"Roughness": 0.7, "Anisotropy": 0.5, "Quality": quality}
    if parameter.identifier in ("IOR", "Extinction"):
        values["Fresnel"] = "n and k"
    for value in VECTORS if parameter.is_vector else NUMBERS:
        if parameter.identifier == "BaseColor" and max(value) < 1e-6:
            continue  # black metal is what was asked for
        scene_with({parameter.label: value}, **values)
        assert_sound(pictures.picture(8))


@pytest.mark.parametrize("quality", QUALITIES)
def test_smallest_and_largest_legal_values(quality: str) -> None:
    """Roughness and anisotropy 0 and 1 with every distribution."""
    for roughness in (0.0, 1e-3, 1.0):
        for anisotropy in (0.0, 1.0):
            for distribution in ("GGX", "Beckmann"):
                scene_with(
                    {},
                    Roughness=roughness,
                    Anisotropy=anisotropy,
                    Distribution=distribution,
                    Quality=quality,
                )
                assert_sound(pictures.picture(8))


@pytest.mark.parametrize("quality", QUALITIES)
def test_normals_beyond_the_horizon(quality: str) -> None:
    """Normals that face away from the viewer are bent into view."""
    for normal in ((0.0, 1.0, 0.0), (0.99, 0.1, 0.0), (0.0, 1.0, -1.0)):
        scene_with({"Normal": normal}, Roughness=0.8, Quality=quality)
        assert_sound(pictures.picture(16))


@pytest.mark.parametrize("kind", ["CONDUCTOR", "DIELECTRIC", "DIFFUSE"])
def test_an_anisotropy_that_is_none_leaves_fitted_as_it_is(kind: str) -> None:
    def with_anisotropy(value: float) -> np.ndarray:
        scene_with({"Anisotropy": value}, kind, Roughness=0.7, Quality="Fitted")
        return pictures.picture(8)

    isotropic = with_anisotropy(0.0)
    for value in (float("nan"), float("inf"), float("-inf"), -1.0):
        assert np.array_equal(with_anisotropy(value), isotropic), value
