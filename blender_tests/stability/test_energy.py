# SPDX-License-Identifier: GPL-3.0-or-later
"""White furnace at the extremes: whatever the index, the widths, the model and the side, a surface
that loses nothing shows the world's radiance, 1.

One picture shows every case of a material: a row of facets each, tilted as those of a sphere are,
evenly in the area that the camera sees of it. The mean of a row is what a sphere shows.
"""

from dataclasses import dataclass
from itertools import product

import bpy
import numpy as np
import pytest

from scenes import common, pictures
from scenes.pictures import Widths

from .linked import linked_material, set_attribute

pytestmark = pytest.mark.nightly

ALPHAS = [Widths(a, a) for a in (1e-4, 0.1, 0.5, 1.0)] + [Widths(1.0, 0.1)]
DISTRIBUTIONS = ("GGX", "Beckmann")
MODELS = ("height-correlated", "height-uncorrelated", "height-tracked")
INDICES = (1.0, 1.0001, 1.1, 1.5, 2.4, 5.0, 0.2)
# From inside 5 is 0.2, 0.2 is 5, and 1 is 1.
INSIDE = (1.0001, 1.1, 1.5, 2.4)
LINKED = ("Roughness", "Anisotropy", "Distribution", "Model")
WHITE = {
    "CONDUCTOR": pictures.WHITE,
    "DIELECTRIC": {"Color": (1.0, 1.0, 1.0)},
    "DIFFUSE": {"Color": (1.0, 1.0, 1.0)},
}
# By quality: samples, and the limit.
PROMISES = {"Exact": (16, 0.003), "Walk": (64, 0.01)}
FACETS = 8
PIXELS = 4  # of a facet, on a side
# No further bounce is left out that would be missed.
ALL = {"MaxBounces": 64, "Tolerance": 0.0}


@dataclass(frozen=True)
class Case:
    """A surface that loses nothing."""

    widths: Widths
    distribution: int
    model: int
    index: float = 1.0
    inside: bool = False

    @property
    def name(self) -> str:
        """For the table."""
        side = f", index {self.index}{', inside' * self.inside}"
        return f"{DISTRIBUTIONS[self.distribution]} {self.widths.name}, {MODELS[self.model]}{side}"

    @property
    def inputs(self) -> dict[str, float]:
        """Parameters by identifier."""
        linked = {"Distribution": self.distribution, "Model": self.model, "IOR": self.index}
        return {**self.widths.inputs, **linked}


def cases_of(kind: str) -> list[Case]:
    """Every lossless case of a kind of material."""
    surfaces = product(ALPHAS, range(len(DISTRIBUTIONS)), range(len(MODELS)))
    if kind != "DIELECTRIC":
        return [Case(*surface) for surface in surfaces]
    sides = [(index, False) for index in INDICES] + [(index, True) for index in INSIDE]
    return [Case(*surface, *side) for surface in surfaces for side in sides]


def build(kind: str, quality: str, cases: list[Case]) -> None:
    """The facets under a camera that looks down on them, in a white world."""
    rows = len(cases)
    scene = common.start_scene((FACETS * PIXELS, rows * PIXELS), samples=1)
    common.use_box_filter(scene)
    common.set_world(scene, (1.0, 1.0, 1.0))
    scene.cycles.max_bounces = 1
    linked = (*LINKED, "IOR") if kind == "DIELECTRIC" else LINKED
    mesh = bpy.data.meshes.new("Facets")
    corners = _corners(rows)
    order = np.arange(4 * rows * FACETS).reshape(rows, FACETS, 4)
    inside = np.array([case.inside for case in cases], dtype=bool)
    order[inside] = order[inside][..., ::-1]
    mesh.from_pydata(corners.reshape(-1, 3).tolist(), [], order.reshape(-1, 4).tolist())
    for name in linked:
        set_attribute(mesh, name, np.repeat([case.inputs[name] for case in cases], FACETS))
    mesh.materials.append(
        linked_material(kind, "White", linked, Quality=quality, **WHITE[kind], **ALL)
    )
    common.show_to_camera_only(common.add_object("Facets", mesh))
    data = bpy.data.cameras.new("Camera")
    data.type = "ORTHO"
    data.ortho_scale = max(FACETS, rows)
    data.clip_end = 100.0
    scene.camera = common.add_object("Camera", data)
    scene.camera.location = (0.5 * FACETS, 0.5 * rows, 50.0)


def _corners(rows: int) -> np.ndarray:
    """Corners (rows, FACETS, 4, 3): unit squares as seen from above, row 0 on top."""
    sine2 = (np.arange(FACETS) + 0.5) / FACETS
    slope = np.sqrt(sine2 / (1.0 - sine2))
    azimuth = 2.4 * np.arange(FACETS) + np.arange(rows)[:, None]
    square = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    along = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1) @ square.T
    x = np.arange(FACETS)[:, None] + 0.5 + square[:, 0]
    y = np.arange(rows)[::-1, None, None] + 0.5 + square[:, 1]
    return np.stack(np.broadcast_arrays(x, y, slope[:, None] * along), axis=-1)


def measure(
    kind: str, quality: str, cases: list[Case], samples: int
) -> tuple[np.ndarray, np.ndarray]:
    """Mean radiance of each case, and its standard error, (n,)."""
    build(kind, quality, cases)
    image = pictures.picture(samples).mean(axis=-1)
    facets = image.reshape(len(cases), PIXELS, FACETS, PIXELS).swapaxes(1, 2)
    facets = facets.reshape(len(cases), FACETS, PIXELS**2)
    # Pixels are independent, and facets differ by more than noise.
    variance = facets.var(axis=2, ddof=1).mean(axis=1) / (FACETS * PIXELS**2)
    return facets.mean(axis=(1, 2)), np.sqrt(variance)


@pytest.mark.parametrize("quality", PROMISES)
@pytest.mark.parametrize("kind", WHITE)
def test_furnace(kind: str, quality: str, report) -> None:
    """Each case is 1 within the limit, with a standard error of at most a third of it. Cases that
    three standard errors may take beyond the limit are rendered again with more samples."""
    samples, limit = PROMISES[quality]
    cases = cases_of(kind)
    means, noise = measure(kind, quality, cases, samples)
    doubtful = np.flatnonzero(np.abs(means - 1.0) + 3.0 * noise > limit)
    if doubtful.size:
        chosen = [cases[i] for i in doubtful]
        means[doubtful], noise[doubtful] = measure(kind, quality, chosen, 8 * samples)
    off = np.abs(means - 1.0)
    wrong = [
        f"{means[i]:.4f} +- {noise[i]:.4f}: {cases[i].name}"
        for i in np.argsort(-off)
        if not off[i] <= limit
    ]
    name = f"furnaces, {kind.lower()}, {quality}, {len(cases)} cases"
    found = f"{means.min():.4f} .. {means.max():.4f}, noise {noise.max():.4f}"
    report(name, f"{found}, {len(wrong)} outside", f"1 +- {limit}")
    assert not wrong, "\n".join([f"{len(wrong)} of {len(cases)} cases:", *wrong])
    assert noise.max() <= limit / 3.0
