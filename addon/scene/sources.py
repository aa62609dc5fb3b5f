# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads what enters node trees from outside, animation and images, each once in an analysis."""

import math
import time
from collections.abc import Iterable

import bpy

from ..core.intervals import Interval, hull
from .animated import Animated, animated_values
from .image_range import ImageRange, UnreadableImageError, image_range

ANIMATED = "animated or driven"

_SOCKETS = (".inputs[", ".outputs[")


class Sources:
    """Reads animation and images, and says why values vary or are unknown.

    causes -- ANIMATED and clauses about images, since it was last cleared
    unread -- full names of images that were left out for lack of time
    """

    def __init__(self, seconds: float = math.inf, unread: Iterable[str] = ()) -> None:
        """Start. No image is read after `seconds`, and none of `unread`."""
        self.causes: list[str] = []
        self.unread = set(unread)
        self._end = time.monotonic() + seconds
        self._images: dict[str, ImageRange | str] = {}
        self._trees: dict[bpy.types.NodeTree, Animated] = {}

    def image(self, image: bpy.types.Image | None) -> ImageRange | None:
        """Return the ranges of an image's channels, None if they are unknown."""
        if image is None:
            self.causes.append("an image texture has no image")
            return None
        name = image.name_full
        if name not in self._images:
            self._images[name] = self._read(image)
        found = self._images[name]
        if isinstance(found, str):
            self.causes.append(found)
            return None
        return found

    def over_time(
        self, socket: bpy.types.NodeSocket, values: tuple[Interval, ...]
    ) -> tuple[Interval, ...]:
        """Return `values` of a socket, widened by all values that its animation gives."""
        curves = self._animated(socket.id_data)
        if not curves:
            return values
        path = socket.path_from_id("default_value")
        found = tuple(hull((one, curves.get((path, i), one))) for i, one in enumerate(values))
        if found != values:
            self.causes.append(ANIMATED)
        return found

    def animates(self, socket: bpy.types.NodeSocket) -> bool:
        """Return whether the value of a socket has curves or drivers."""
        wanted = socket.path_from_id("default_value")
        return any(path == wanted for path, _ in self._animated(socket.id_data))

    def animates_settings(self, node: bpy.types.Node) -> bool:
        """Return whether a node has curves or drivers besides those of its sockets."""
        curves = self._animated(node.id_data)
        if not curves:
            return False
        prefix = node.path_from_id()
        rests = [path.removeprefix(prefix) for path, _ in curves if path.startswith(prefix)]
        found = any(not rest.startswith(_SOCKETS) for rest in rests)
        if found:
            self.causes.append(ANIMATED)
        return found

    def _read(self, image: bpy.types.Image) -> ImageRange | str:
        """Return the ranges, or why there are none."""
        name = image.name_full
        if name in self.unread or time.monotonic() > self._end:
            self.unread.add(name)
            return f"there was no time to read the image '{name}'"
        try:
            return image_range(image)
        except UnreadableImageError as error:
            return str(error)

    def _animated(self, tree: bpy.types.NodeTree) -> Animated:
        if tree not in self._trees:
            self._trees[tree] = animated_values(tree)
        return self._trees[tree]
