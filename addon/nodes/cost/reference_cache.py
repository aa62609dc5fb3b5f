# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps references on disk, each by a digest of all that it depends on."""

import hashlib
import os
import shutil
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

import bpy

from ...core import VERSION
from ...core.cost.plan import Options, reference_variant

# Older references are removed when there are more.
_MOST = 8
_FOLDER = "cost_references"
# Of the extension as Blender knows it.
_EXTENSION = __package__.removesuffix(".nodes.cost")


def cache_folder() -> Path:
    """Return the folder of the references, which need not exist yet."""
    try:
        return Path(bpy.utils.extension_path_user(_EXTENSION, path=_FOLDER))
    except ValueError:  # not installed as an extension
        return Path(tempfile.gettempdir(), f"microbounce_{_FOLDER}")


def clear_cache() -> int:
    """Remove all references and return how many there were. Raises OSError where it cannot."""
    folder = cache_folder()
    count = len(list(folder.glob("*.npz")))
    if folder.exists():
        shutil.rmtree(folder)
    return count


def cache_file(scene: bpy.types.Scene, layer: str, options: Options) -> str:
    """Return where the reference of the scene is kept, "" where it must not be.

    That is a file that was never saved or has changes that are not: nothing tells what they are.
    (In the background Blender calls every file changed; there it counts as it was opened.)
    """
    if not bpy.data.filepath or (bpy.data.is_dirty and not bpy.app.background):
        return ""
    digest = hashlib.sha256()
    for part in _parts(scene, layer, options):
        digest.update(repr(part).encode())
    return str(cache_folder() / f"{digest.hexdigest()[:32]}.npz")


def load_reference(path: str) -> "list[numpy.ndarray] | None":
    """Return the two pictures of a reference, None where there is none that can be read."""
    import numpy as np

    if not path:
        return None
    try:
        with np.load(path, allow_pickle=False) as kept:
            pictures = [kept["first"], kept["second"]]
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
        return None
    os.utime(path)
    return pictures


def store_reference(path: str, pictures: "list[numpy.ndarray]") -> bool:
    """Keep the two pictures of a reference; return whether that went well, "" is never kept."""
    import numpy as np

    if not path:
        return False
    target = Path(path)
    unfinished = target.with_suffix(".part")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(unfinished, "wb") as stream:
            np.savez(stream, first=pictures[0], second=pictures[1])
        os.replace(unfinished, target)
        by_age = sorted(target.parent.glob("*.npz"), key=lambda file: file.stat().st_mtime)
        for old in by_age[:-_MOST]:
            old.unlink()
    except OSError:
        return False
    return True


def _parts(scene: bpy.types.Scene, layer: str, options: Options) -> Iterator:
    """Yield all that a reference depends on, as far as Python can tell at little cost."""
    yield VERSION, bpy.app.version_string, layer, scene.name
    yield scene.frame_current, scene.frame_subframe, scene.cycles.samples
    yield options.samples, options.reference, options.reference_samples
    yield options.percentage, options.region, reference_variant(options.reference)
    for path in (bpy.data.filepath, *_outer_files()):
        try:
            state = os.stat(path)
            yield path, state.st_mtime_ns, state.st_size
        except OSError:
            yield path, "missing"
    for part in (scene.render, scene.cycles, scene.view_layers[layer].cycles):
        yield from _values(part)
    for kind in (bpy.data.worlds, bpy.data.lights, bpy.data.cameras, bpy.data.materials):
        for data in kind:
            yield from _values(data)
            if data.node_tree if hasattr(data, "node_tree") else None:
                yield from _tree(data.node_tree)
    for group in bpy.data.node_groups:
        yield from _tree(group)
    for thing in scene.objects:
        yield thing.name, tuple(map(tuple, thing.matrix_world)), thing.hide_render
        yield [slot.material.name_full if slot.material else "" for slot in thing.material_slots]


def _outer_files() -> Iterator[str]:
    for data in (*bpy.data.libraries, *bpy.data.images):
        if data.filepath:
            yield bpy.path.abspath(data.filepath, library=data.library)


def _tree(tree: bpy.types.NodeTree) -> Iterator:
    for node in tree.nodes:
        yield from _values(node)
        for socket in node.inputs:
            yield from _values(socket)
    for link in tree.links:
        yield link.from_node.name, link.from_socket.identifier
        yield link.to_node.name, link.to_socket.identifier, link.is_muted


def _values(struct: bpy.types.bpy_struct) -> Iterator:
    """Yield the plain values of a struct, and the names of what it points to."""
    for prop in struct.bl_rna.properties:
        if prop.is_readonly or prop.type == "COLLECTION" or getattr(prop, "is_deprecated", False):
            continue
        value = getattr(struct, prop.identifier, None)
        if getattr(prop, "is_array", False):
            value = tuple(value)
        elif prop.type == "POINTER":
            value = getattr(value, "name_full", None)
        yield prop.identifier, value
