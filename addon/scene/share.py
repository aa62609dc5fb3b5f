# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds how much of the camera's picture each material fills, by a grid of rays.

A ray ends at the first surface that is neither clear nor a mirror. So surfaces behind glass or in a
mirror count, and so does the glass or mirror itself.
"""

import math
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import bpy
from mathutils import Vector

from ..core.run import Pieces, done_at_once
from .passage import Passage, passage
from .rendered import rendered_materials, rendered_objects
from .sources import Sources

WIDTH = 64  # rays across the longer side of the picture
# A surface that no ray meets may still show in a rough reflection, or be smaller than a ray's
# pixel.
SMALLEST_SHARE = 0.005

_MOST_SURFACES = 8  # along a ray
_STEP = 1e-4  # beyond a surface, relative to its distance
_FAR = 1e30
# Types of objects that rays can meet. Hair, points and volumes are not among them.
_SOLID = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


@dataclass(frozen=True)
class Shares:
    """The parts of the picture, 0 to 1, by the materials' names in full.

    has_camera -- False if no share could be found: there is no camera, or it is a panorama
    unmet      -- names of materials that rays cannot meet: on hair, points, volumes, and objects
                  that the viewport hides
    part       -- part of the rays that were sent before time ran out, 0 to 1
    empty      -- part of the picture that shows only the world, 0 to 1
    """

    by_name: dict[str, float]
    has_camera: bool = True
    unmet: frozenset[str] = frozenset()
    part: float = 1.0
    empty: float = 0.0

    def of(self, materials: list[bpy.types.Material], count: int) -> float:
        """Return the share of these materials together, of `count` surfaces that are analysed.

        It is at least SMALLEST_SHARE, and an equal part for `unmet` materials. If no share could be
        found, all surfaces have an equal part.
        """
        equal = 1.0 / max(count, 1)
        if not self.has_camera:
            return equal
        found = sum(self.by_name.get(material.name_full, 0.0) for material in materials)
        least = equal if self.are_unmet(materials) else SMALLEST_SHARE
        return min(max(found, least), 1.0)

    def are_unmet(self, materials: list[bpy.types.Material]) -> bool:
        """Return whether rays cannot meet some of these materials."""
        return any(material.name_full in self.unmet for material in materials)


def picture_shares(
    context: bpy.types.Context,
    progress: Callable[[float], None] = lambda part: None,
    seconds: float = math.inf,
) -> Shares:
    """Return the materials' shares of the picture of the scene's camera at the current frame.

    progress -- gets the part that is done, from 0 to 1
    seconds  -- after these, only the rays sent until then count
    """
    return done_at_once(share_pieces(context, seconds, Sources(seconds)), progress)


def share_pieces(context: bpy.types.Context, seconds: float, sources: Sources) -> Pieces[Shares]:
    """Do the work of picture_shares(); nothing of the scene may change meanwhile."""
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    rays = list(_camera_rays(scene, depsgraph))
    if not rays:
        return Shares({}, has_camera=False)
    hits: Counter[str] = Counter()
    sight = _Sight(scene, depsgraph, sources)
    sent, empty, end = 0, 0, time.monotonic() + seconds
    for number in _spread(len(rays)):
        if sent % WIDTH == 0:
            yield sent / len(rays)
        if sent and time.monotonic() > end:
            break
        met = {material.name_full for material in sight.along(*rays[number])}
        hits.update(met)
        empty += not met
        sent += 1
    by_name = {name: count / sent for name, count in hits.items()}
    unmet = _unmet(context, depsgraph)
    return Shares(by_name, unmet=unmet, part=sent / len(rays), empty=empty / sent)


def shown_materials(context: bpy.types.Context) -> list[bpy.types.Material]:
    """Return all materials that the scene renders, instances and geometry nodes included."""
    found = dict.fromkeys(rendered_materials(context.scene))
    seen = set()
    # An instance is valid only within its turn.
    for instance in context.evaluated_depsgraph_get().object_instances:
        thing = instance.object
        original = thing.original
        if instance.is_instance and original not in seen and not original.hide_render:
            seen.add(original)
            found |= dict.fromkeys(one.original for one in _materials(thing) if one is not None)
    return list(found)


def _materials(thing: bpy.types.Object) -> list[bpy.types.Material | None]:
    """Return the materials of an evaluated object by their indices."""
    slots = [slot.material for slot in thing.material_slots]
    # Geometry nodes may give materials without slots.
    return slots or list(getattr(thing.data, "materials", None) or ())


def _unmet(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph) -> frozenset[str]:
    """Return the names of rendered materials that rays cannot meet."""
    met = {thing.original for thing in depsgraph.objects if thing.type in _SOLID}
    return frozenset(
        slot.material.name_full
        for thing in set(rendered_objects(context.view_layer))
        for slot in thing.material_slots
        if slot.material is not None and (thing not in met or thing.particle_systems)
    )


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


class _Sight:
    """Follows rays through the scene; it looks at each material and curve once."""

    def __init__(
        self, scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph, sources: Sources
    ) -> None:
        self.scene, self.depsgraph, self.sources = scene, depsgraph, sources
        self.hidden = _hidden_objects(scene)
        self.passages: dict[str, Passage] = {}
        self.indices: dict[str, list[int]] = {}

    def along(
        self, origin: Vector, direction: Vector, length: float
    ) -> Iterator[bpy.types.Material]:
        """Yield the materials along a ray. It passes through objects that are not rendered or
        seen."""
        for _ in range(_MOST_SURFACES):
            hit, place, normal, face, thing, _matrix = self.scene.ray_cast(
                self.depsgraph, origin, direction, distance=max(length, 0.0)
            )
            if not hit:
                return
            gone = (place - origin).length
            step = _STEP * max(gone, 1.0)
            gone += step
            length -= gone
            original = thing.original
            if original in self.hidden or original.hide_render or not original.visible_camera:
                origin = origin + direction * gone
                continue
            material = self._material(thing, face)
            if material is None:
                return
            yield material
            way = self._passage(material)
            if way is Passage.ENDS:
                return
            if way is Passage.MIRRORED:
                direction = direction.reflect(normal)
                origin, length = place + direction * step, _FAR
            else:
                origin = origin + direction * gone

    def _passage(self, material: bpy.types.Material) -> Passage:
        name = material.name_full
        if name not in self.passages:
            self.passages[name] = passage(material, self.sources)
        return self.passages[name]

    def _material(self, thing: bpy.types.Object, face: int) -> bpy.types.Material | None:
        """Return the material of a face, None if it has none."""
        evaluated = thing.evaluated_get(self.depsgraph)
        materials = _materials(evaluated)
        index = self._index(evaluated, face) if len(materials) > 1 else 0
        found = materials[min(index, len(materials) - 1)] if materials else None
        return found.original if found is not None else None

    def _index(self, evaluated: bpy.types.Object, face: int) -> int:
        if isinstance(evaluated.data, bpy.types.Mesh):
            faces = evaluated.data.polygons
            return faces[face].material_index if 0 <= face < len(faces) else 0
        name = evaluated.name_full
        if name not in self.indices:  # of a curve or text
            mesh = evaluated.to_mesh()
            self.indices[name] = [one.material_index for one in mesh.polygons] if mesh else []
            evaluated.to_mesh_clear()
        indices = self.indices[name]
        return indices[face] if 0 <= face < len(indices) else 0


def _spread(count: int) -> Iterator[int]:
    """Yield 0 to count - 1 in an order whose first numbers are spread over the whole range."""
    step = max(round(count * 0.618), 1)
    while math.gcd(step, count) != 1:
        step += 1
    return (number * step % count for number in range(count))


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
