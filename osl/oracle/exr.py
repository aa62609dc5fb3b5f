# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as OpenEXR files of floats with named layers and text metadata."""

from pathlib import Path

import numpy as np
import OpenImageIO as oiio

_PREFIX = "microbounce:"


def write(
    path: Path, layers: dict[str, np.ndarray], metadata: dict[str, str], half: bool = False
) -> None:
    """Write pictures ``(rows, columns)`` or ``(rows, columns, 3)``, zip-compressed, in float32 or
    with ``half`` in float16 (relative rounding 2^-11, absolute 3e-8).

    The layer ``mean`` becomes channels R, G, B; others ``name.R`` and so on; flat ones ``name``.
    Raises ``ValueError`` for pictures of different sizes and ``OSError`` when the file cannot be
    written.
    """
    names, planes = [], []
    for layer, picture in layers.items():
        picture = np.asarray(picture, dtype=np.float32)
        if picture.ndim == 2:
            names.append(layer)
            planes.append(picture)
            continue
        for c, channel in enumerate("RGB"):
            names.append(channel if layer == "mean" else f"{layer}.{channel}")
            planes.append(picture[..., c])
    if len({plane.shape for plane in planes}) != 1:
        sizes = {name: plane.shape for name, plane in zip(names, planes, strict=True)}
        raise ValueError(f"the layers differ in size: {sizes}; give pictures of one size")
    rows, columns = planes[0].shape
    spec = oiio.ImageSpec(columns, rows, len(planes), oiio.HALF if half else oiio.FLOAT)
    spec.channelnames = names
    spec.attribute("compression", "zip")
    spec.attribute("DateTime", "1970:01:01 00:00:00")  # else the time of writing is stored
    for key, value in metadata.items():
        spec.attribute(_PREFIX + key, str(value))
    output = oiio.ImageOutput.create(str(path))
    if output is None or not output.open(str(path), spec):
        raise OSError(f"cannot write {path}: {output.geterror() if output else oiio.geterror()}")
    written = output.write_image(np.ascontiguousarray(np.stack(planes, axis=-1)))
    if not (output.close() and written):
        raise OSError(f"cannot write {path}: {output.geterror()}")


def read(path: Path) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """The layers and the metadata of a file that `write` made; pictures in float64.

    Raises ``OSError`` when the file is missing or not readable.
    """
    source = oiio.ImageInput.open(str(path))
    if source is None:
        raise OSError(f"cannot read {path}: {oiio.geterror()}; `make references` makes it")
    spec = source.spec()
    pixels = source.read_image(oiio.FLOAT)
    source.close()
    if pixels is None:
        raise OSError(f"cannot read the pixels of {path}: {source.geterror()}")
    pixels = np.asarray(pixels, dtype=np.float64).reshape(spec.height, spec.width, -1)
    planes = {name: pixels[..., i] for i, name in enumerate(spec.channelnames)}
    layers = {}
    for name in planes:
        layer, _, channel = name.rpartition(".")
        if name in "RGB":
            layer, channel = "mean", name
        if channel in "RGB":
            prefix = "" if layer == "mean" else layer + "."
            layers.setdefault(layer, np.stack([planes[prefix + c] for c in "RGB"], axis=-1))
        else:
            layers[name] = planes[name]
    metadata = {
        one.name.removeprefix(_PREFIX): one.value
        for one in spec.extra_attribs
        if one.name.startswith(_PREFIX)
    }
    return layers, metadata
