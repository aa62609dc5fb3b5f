# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps references on disk, each by a digest of all that it depends on."""

import contextlib
import hashlib
import os
import shutil
import tempfile
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path

import bpy

from ..core import VERSION
from ..core.cost.plan import Options, reference_variant

# Raise it if references are rendered in another way. Older ones are then ignored.
_REVISION = 2
# Above this number, older references are removed.
_MOST = 8
_FOLDER = "cost_references"
# Of the extension as Blender knows it.
_EXTENSION = __package__.removesuffix(".cost")


def cache_folder() -> Path:
    """Return the folder of the references, which need not exist yet."""
    try:
        return Path(bpy.utils.extension_path_user(_EXTENSION, path=_FOLDER))
    except ValueError:  # not installed as an extension
        return Path(tempfile.gettempdir(), f"microbounce_{_FOLDER}")


def clear_cache() -> int:
    """Remove all references and return how many there were. Raises OSError if it cannot."""
    folder = cache_folder()
    count = len(list(folder.glob("*.npz")))
    if folder.exists():
        shutil.rmtree(folder)
    return count


def cache_file(
    scene: bpy.types.Scene, layer: str, options: Options, unchanged: bool = False
) -> str:
    """Return where the reference of the scene is kept, "" if it must not be.

    It must not be kept for a file that was never saved or may have unsaved changes, because these
    are unknown. In the background Blender keeps no track of changes; there the caller tells that
    the file is `unchanged`.
    """
    dirty = bpy.data.is_dirty or bpy.app.background
    if not bpy.data.filepath or (dirty and not unchanged):
        return ""
    digest = hashlib.sha256()
    for part in _parts(scene, layer, options):
        digest.update(repr(part).encode())
    return str(cache_folder() / f"{digest.hexdigest()[:32]}.npz")


def load_reference(path: str) -> "list[numpy.ndarray] | None":
    """Return the two pictures of a reference, None if none can be read."""
    import numpy as np

    if not path:
        return None
    try:
        with np.load(path, allow_pickle=False) as kept:
            first, second = kept["first"], kept["second"]
    # TypeError is for a file of one array.
    except (OSError, KeyError, TypeError, ValueError, EOFError, zipfile.BadZipFile, zlib.error):
        return None
    if first.ndim != 3 or first.shape != second.shape:
        return None
    with contextlib.suppress(OSError):  # of a folder that only others may write
        os.utime(path)  # the oldest are removed first
    return [first, second]


def store_reference(path: str, pictures: "list[numpy.ndarray]") -> bool:
    """Keep the two pictures of a reference and return whether that worked; it does not for ""."""
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
    yield VERSION, _REVISION, bpy.app.version_string, layer, scene.name
    yield scene.frame_current, scene.frame_subframe, scene.cycles.samples
    yield options.samples, options.reference, options.reference_samples
    yield options.percentage, options.region, reference_variant(options.reference)
    yield from _files()
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


def _files() -> Iterator:
    """Yield the states of all files that the scene is read from.

    All files in the folder of a texture or cache count, because it may be one of a sequence.
    """
    blends, folders = {bpy.data.filepath}, set()
    for path in bpy.utils.blend_paths(absolute=True):
        if path.endswith(".blend"):
            blends.add(path)
        else:
            folders.add(os.path.dirname(path))
    for path in sorted(blends):
        yield path, *_state(path)
    for folder in sorted(folders):
        try:
            names = sorted(entry.name for entry in os.scandir(folder) if entry.is_file())
        except OSError:
            names = []
        for name in names:
            path = os.path.join(folder, name)
            yield path, *_state(path)


def _state(path: str) -> tuple:
    try:
        state = os.stat(path)
    except OSError:
        return ("missing",)
    return state.st_mtime_ns, state.st_size


def _tree(tree: bpy.types.NodeTree) -> Iterator:
    for node in tree.nodes:
        yield from _values(node)
        for socket in node.inputs:
            yield from _values(socket)
    for link in tree.links:
        yield link.from_node.name, link.from_socket.identifier
        yield link.to_node.name, link.to_socket.identifier, link.is_muted


def _values(struct: bpy.types.bpy_struct) -> Iterator:
    """Yield the plain values of a struct, and the names of the data it points to."""
    for prop in struct.bl_rna.properties:
        if prop.is_readonly or prop.type == "COLLECTION" or getattr(prop, "is_deprecated", False):
            continue
        value = getattr(struct, prop.identifier, None)
        if getattr(prop, "is_array", False):
            value = tuple(value)
        elif prop.type == "POINTER":
            value = getattr(value, "name_full", None)
        yield prop.identifier, value
