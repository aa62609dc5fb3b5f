# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders fixture scenes with given parameters, and compares them with references."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from addon.material.update import update_materials
from osl.oracle import exr
from scenes import fixtures, render, variants

SCENES = Path(__file__).resolve().parent
REFERENCES = SCENES.parent / "blender_tests" / "references"
WHITE = {"BaseColor": (1.0, 1.0, 1.0), "EdgeTint": (1.0, 1.0, 1.0)}
BLOCK = 8  # pixels on a side
NUDGE = 1e-5


@dataclass(frozen=True)
class Widths:
    """A pair of alphas, with the inputs that give them."""

    alpha_x: float
    alpha_y: float

    @property
    def name(self) -> str:
        """The part of a reference's file name."""
        if self.alpha_x == self.alpha_y:
            return f"{self.alpha_x:g}"
        return f"{self.alpha_x:g}_{self.alpha_y:g}"

    @property
    def inputs(self) -> dict[str, float]:
        """Roughness and Anisotropy: alpha^2 = alpha_x alpha_y, aspect^2 = alpha_y / alpha_x."""
        return {
            "Roughness": (self.alpha_x * self.alpha_y) ** 0.25,
            "Anisotropy": (1.0 - self.alpha_y / self.alpha_x) / 0.9,
        }


def open_scene(name: str) -> variants.Material:
    """Open scenes/`name`.blend and return its first material, with today's shader."""
    bpy.ops.wm.open_mainfile(filepath=str(SCENES / f"{name}.blend"))
    update_materials()
    return variants.find_materials()[0]


def picture(samples: int, seed: int = 0) -> np.ndarray:
    """Render the open scene; return linear radiance, float64 (rows, columns, 3), top row first."""
    with tempfile.TemporaryDirectory() as folder:
        passes, _ = render.render_passes(
            Path(folder, "picture.exr"), samples, seed, Path(folder, "log")
        )
        return render.combined(passes).astype(np.float64)


def independent_pictures(samples: int, count: int, first_seed: int = 0) -> np.ndarray:
    """Renders of the open scene with seeds from `first_seed` on, (count, rows, columns, 3).

    Cycles puts some samples of two seeds at the same place in a pixel, where the shader draws the
    same numbers. The two then share 5 to 10 % of the variance. So the camera moves aside by NUDGE
    from one render to the next, less than a thousandth of a pixel.
    """
    scene = bpy.context.scene
    camera = scene.camera
    start = camera.location.x
    pictures = []
    for number in range(count):
        # Keeps compiled shaders until the last render. Later changes would not reach a kept scene.
        scene.render.use_persistent_data = number < count - 1
        camera.location.x = start + number * NUDGE
        pictures.append(picture(samples, first_seed + number))
    camera.location.x = start
    return np.array(pictures)


def relative_noise(samples: int, count: int, mask: np.ndarray) -> float:
    """Root mean square noise of a pixel in `mask` over the mean radiance there.

    It is that of the open scene at `samples`, from `count` renders.
    """
    found = independent_pictures(samples, count).mean(axis=-1)[:, mask]
    return float(np.sqrt(found.var(axis=0, ddof=1).mean()) / found.mean())


def render_fixture(name: str, samples: int, seed: int = 0, **values: object) -> np.ndarray:
    """Render a fixture scene with parameters of its material set by identifier."""
    set_values(open_scene(name), values)
    return picture(samples, seed)


def set_values(material: variants.Material, values: dict[str, object]) -> None:
    """Set parameters by identifier."""
    for identifier, value in values.items():
        material.set(identifier, value)


def open_lit(light: str, kind: str) -> variants.Material:
    """Open the fixture of this kind under a light of the references; return its material.

    light -- "sun", "back" (a sun from behind), "inside" (the same, seen inside the solid) or "slab"
    """
    material = open_scene(f"{'slab' if light == 'slab' else 'sphere_sun'}_{kind.lower()}")
    if light in ("back", "inside"):
        fixtures.aim_sun(fixtures.BACK_SUN)
    if light == "inside":
        fixtures.turn_inside_out()
    return material


def open_solid_sphere(roughness: float) -> variants.Material:
    """Open the glass furnace, let light travel on inside the sphere; return its material."""
    glass = open_scene("furnace_dielectric")
    glass.set("Roughness", roughness)
    scene = bpy.context.scene
    scene.cycles.max_bounces = scene.cycles.transmission_bounces = 8
    for ray in ("diffuse", "glossy", "transmission", "shadow"):
        setattr(bpy.data.objects["Sphere"], f"visible_{ray}", True)
    return glass


def reference(name: str) -> dict[str, np.ndarray]:
    """Layers of the oracle's picture by name, `mask` as bool. Raises OSError if it is missing."""
    layers, _ = exr.read(REFERENCES / f"{name}.exr")
    return layers | {"mask": layers["mask"] > 0.5}


def l2_error(found: np.ndarray, wanted: np.ndarray, mask: np.ndarray) -> float:
    """Image L2 error: the norm of `found` - `wanted` over the norm of `wanted`, in the mask."""
    difference = found[mask] - wanted[mask]
    return float(np.sqrt(np.sum(difference**2) / np.sum(wanted[mask] ** 2)))


def unbiased_l2_error(
    a: np.ndarray, b: np.ndarray, wanted: np.ndarray, mask: np.ndarray
) -> tuple[float, float]:
    """`l2_error` of a converged picture, and its standard error, from independent renders `a`, `b`.

    The mean of (a - wanted) (b - wanted) is the squared bias, because the renders' noise is
    independent. If noise outweighs the bias, the sum may be negative and the error is 0. The
    channels of a pixel count as one sample.
    """
    product = ((a - wanted) * (b - wanted))[mask].mean(axis=-1)
    return converged_error(product, np.mean(wanted[mask] ** 2))


def converged_error(product: np.ndarray, power: float) -> tuple[float, float]:
    """An error and its standard error from products of independent differences, one per pixel.

    power -- mean square of the reference
    """
    squared = product.mean() / power
    spread = product.std(ddof=1) / np.sqrt(product.size) / power  # of `squared`
    error = np.sqrt(max(squared, 0.0))
    return float(error), float(0.5 * spread / max(error, np.sqrt(spread)))


def energy_ratio(found: np.ndarray, wanted: np.ndarray, mask: np.ndarray) -> float:
    """Mean of `found` over the mask, relative to the mean of `wanted`."""
    return float(found[mask].mean() / wanted[mask].mean())


def block_means(image: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Means (blocks, 3) over squares of BLOCK x BLOCK pixels that lie wholly in the mask."""
    rows, columns = mask.shape
    shape = (rows // BLOCK, BLOCK, columns // BLOCK, BLOCK, 3)
    return image.reshape(shape).mean(axis=(1, 3))[_blocks(mask)]


def rim_mean(image: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """Mean (3,) over the pixels of the mask outside the squares of block_means()."""
    return image[mask & ~np.kron(_blocks(mask), np.ones((BLOCK, BLOCK), dtype=bool))].mean(axis=0)


def _blocks(mask: np.ndarray) -> np.ndarray:
    """Whether each square of BLOCK x BLOCK pixels lies wholly in the mask."""
    rows, columns = mask.shape
    return mask.reshape(rows // BLOCK, BLOCK, columns // BLOCK, BLOCK).all(axis=(1, 3))


def seeds(name: str, samples: int, count: int, **values: object) -> tuple[np.ndarray, np.ndarray]:
    """Mean of `count` independent renders, and the variance of that mean, (rows, columns, 3)."""
    set_values(open_scene(name), values)
    pictures = independent_pictures(samples, count)
    return pictures.mean(axis=0), pictures.var(axis=0, ddof=1) / count


def block_z(
    found: np.ndarray, variance: np.ndarray, wanted: np.ndarray, error: np.ndarray, mask: np.ndarray
) -> np.ndarray:
    """Difference of the blocks' means from the reference's, in standard errors, (blocks, 3)."""
    both = block_means(variance + error**2, mask) / BLOCK**2  # pixels are independent
    return (block_means(found, mask) - block_means(wanted, mask)) / np.sqrt(both)
