# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds how much of the camera's picture each material fills, by a grid of rays.

Rays end at the first surface; through our glass they also go straight on, so that what stands
behind it counts as well. Reflections are not followed. What the viewport hides is not met.
"""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
from mathutils import Vector

WIDTH = 64  # rays across the longer side of the picture
# A surface that no ray meets may still be seen in a mirror, or be smaller than a ray's pixel.
SMALLEST_SHARE = 0.005

_MOST_SURFACES = 8  # along a ray
_STEP = 1e-4  # beyond a surface, relative to its distance


@dataclass(frozen=True)
class Shares:
    """The parts of the picture, 0 to 1, by the materials' names in full.

    has_camera -- False where no share could be found, as without a camera or with a panorama's
    """

    by_name: dict[str, float]
    has_camera: bool = True

    def of(self, materials: list[bpy.types.Material], count: int) -> float:
        """Return the share of these materials together, of `count` surfaces that are analysed.

        It is at least SMALLEST_SHARE. Where no share could be found all surfaces have the same.
        """
        if not self.has_camera:
            return 1.0 / max(count, 1)
        found = sum(self.by_name.get(material.name_full, 0.0) for material in materials)
        return min(max(found, SMALLEST_SHARE), 1.0)


def picture_shares(
    context: bpy.types.Context,
    is_clear: Callable[[bpy.types.Material], bool],
    progress: Callable[[float], None] = lambda part: None,
) -> Shares:
    """Return the materials' shares of the picture of the scene's camera at the current frame.

    is_clear -- whether rays go on through a material
    progress -- is told the part that is done, from 0 to 1
    """
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    rays = list(_camera_rays(scene, depsgraph))
    if not rays:
        return Shares({}, has_camera=False)
    hits: Counter[str] = Counter()
    slots, hidden = _Slots(depsgraph), _hidden_objects(scene)
    for number, (origin, direction, length) in enumerate(rays):
        if number % WIDTH == 0:
            progress(number / len(rays))
        met = set()
        for material in _materials_met(scene, depsgraph, slots, hidden, origin, direction, length):
            met.add(material.name_full)
            if not is_clear(material):
                break
        hits.update(met)
    return Shares({name: count / len(rays) for name, count in hits.items()})


def shown_materials(context: bpy.types.Context) -> list[bpy.types.Material]:
    """Return the materials of all that the scene renders, also by instances and geometry nodes."""
    found: dict[str, bpy.types.Material] = {}
    hidden = _hidden_objects(context.scene)

    def add(thing: bpy.types.Object) -> None:
        materials = [slot.material for slot in thing.material_slots]
        materials += list(getattr(thing.data, "materials", ()))
        for material in materials:
            if material is not None:
                found[material.name_full] = material.original

    seen = set()
    # An instance is valid within its turn alone.
    for instance in context.evaluated_depsgraph_get().object_instances:
        original = instance.object.original
        if original not in seen and original not in hidden and not original.hide_render:
            seen.add(original)
            add(instance.object)
    for thing in context.scene.objects:  # the viewport may hide what is rendered
        if thing not in hidden and thing not in seen:
            add(thing)
    return list(found.values())


def _hidden_objects(scene: bpy.types.Scene) -> set[bpy.types.Object]:
    """Return the scene's objects that are not rendered, by themselves or by their collections."""
    shown: set[bpy.types.Object] = set()
    waiting = [scene.collection]
    while waiting:
        collection = waiting.pop()
        if not collection.hide_render:
            shown.update(collection.objects)
            waiting += collection.children
    return {thing for thing in scene.objects if thing.hide_render or thing not in shown}


class _Slots:
    """The material of a polygon of an evaluated object; meshes are made once."""

    def __init__(self, depsgraph: bpy.types.Depsgraph) -> None:
        self.depsgraph = depsgraph
        self.indices: dict[str, list[int]] = {}

    def material(self, thing: bpy.types.Object, polygon: int) -> bpy.types.Material | None:
        """Return it, None where the polygon has none."""
        evaluated = thing.evaluated_get(self.depsgraph)
        key = thing.name_full
        if key not in self.indices:
            mesh = evaluated.to_mesh()
            self.indices[key] = (
                [one.material_index for one in mesh.polygons] if mesh is not None else []
            )
            evaluated.to_mesh_clear()
        indices = self.indices[key]
        index = indices[polygon] if 0 <= polygon < len(indices) else 0
        slots = evaluated.material_slots
        if len(slots):
            found = slots[min(index, len(slots) - 1)].material
        else:  # geometry nodes may give materials without slots
            own = [one for one in getattr(evaluated.data, "materials", ()) if one is not None]
            found = own[min(index, len(own) - 1)] if own else None
        return found.original if found is not None else None


def _camera_rays(
    scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph
) -> Iterator[tuple[Vector, Vector, float]]:
    """Yield origins, directions and lengths of rays through the middles of the picture's cells."""
    camera = scene.camera
    if camera is None or camera.type != "CAMERA" or camera.data.type not in ("PERSP", "ORTHO"):
        return
    evaluated = camera.evaluated_get(depsgraph)
    frame = [Vector(corner) for corner in evaluated.data.view_frame(scene=scene)]
    place = evaluated.matrix_world.normalized()
    top_right, bottom_right, bottom_left, top_left = frame
    wide = (top_right - top_left).length
    high = (top_left - bottom_left).length
    columns, rows = (round(WIDTH * side / max(wide, high)) or 1 for side in (wide, high))
    start, end = evaluated.data.clip_start, evaluated.data.clip_end
    for row in range(rows):
        for column in range(columns):
            x, y = (column + 0.5) / columns, (row + 0.5) / rows
            point = top_left.lerp(top_right, x).lerp(bottom_left.lerp(bottom_right, x), y)
            if evaluated.data.type == "ORTHO":
                origin = Vector((point.x, point.y, -start))
                along = Vector((0.0, 0.0, -1.0))
                reach = 1.0
            else:
                along = point.normalized()
                reach = 1.0 / max(-along.z, 1e-6)  # of a ray whose depth is 1
                origin = along * start * reach
            yield place @ origin, place.to_3x3() @ along, (end - start) * reach


def _materials_met(
    scene: bpy.types.Scene,
    depsgraph: bpy.types.Depsgraph,
    slots: _Slots,
    hidden: set[bpy.types.Object],
    origin: Vector,
    direction: Vector,
    length: float,
) -> Iterator[bpy.types.Material]:
    """Yield the materials along a ray; it passes through what is not rendered or not seen."""
    gone = 0.0
    for _ in range(_MOST_SURFACES):
        hit, place, _normal, polygon, thing, _matrix = scene.ray_cast(
            depsgraph, origin + direction * gone, direction, distance=max(length - gone, 0.0)
        )
        if not hit:
            return
        gone = (place - origin).length
        gone += _STEP * max(gone, 1.0)
        original = thing.original
        if original in hidden or original.hide_render or not original.visible_camera:
            continue
        material = slots.material(thing, polygon)
        if material is None:
            return
        yield material
