# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes PNG pictures, and turns numbers into colours."""

import base64
import struct
import zlib

# Signed differences: blue is darker than the reference, red is brighter, grey is the same.
_DIVERGING = ((0.0, 0.05, 0.25), (0.1, 0.35, 0.85), (0.5, 0.5, 0.5), (0.9, 0.3, 0.1), (0.35, 0, 0))
# FLIP: from black over violet and orange to pale yellow, ever brighter.
_RISING = (
    (0.0, 0.0, 0.02),
    (0.32, 0.07, 0.48),
    (0.72, 0.22, 0.47),
    (0.98, 0.53, 0.38),
    (1, 1, 0.8),
)


def to_srgb(linear: "numpy.ndarray", exposure: float = 0.0) -> "numpy.ndarray":
    """Return linear radiance as display-referred sRGB from 0 to 1; `exposure` is in stops."""
    import numpy as np

    light = np.clip(np.asarray(linear, np.float64) * 2.0**exposure, 0.0, 1.0)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def shrunk(picture: "numpy.ndarray", width: int) -> "numpy.ndarray":
    """Return a picture, (height, width) or with channels, at most `width` wide.

    Each new pixel is the mean of those that lie in it.
    """
    import numpy as np

    if picture.shape[1] <= width:
        return picture
    height = max(1, round(picture.shape[0] * width / picture.shape[1]))
    for axis, count in ((0, height), (1, width)):
        edges = np.linspace(0, picture.shape[axis], count + 1).astype(int)
        sums = np.add.reduceat(picture, edges[:-1], axis=axis)
        shape = [1] * picture.ndim
        shape[axis] = count
        picture = sums / np.diff(edges).reshape(shape)
    return picture


def rgb_png(srgb: "numpy.ndarray") -> bytes:
    """Return a PNG of an sRGB picture from 0 to 1, (height, width, 3)."""
    return _png(_bytes(srgb), 2, b"")


def signed_png(values: "numpy.ndarray") -> bytes:
    """Return a PNG of numbers (height, width) from -1 to 1 in diverging colours."""
    return _png(_bytes(0.5 + 0.5 * values), 3, _palette(_DIVERGING))


def rising_png(values: "numpy.ndarray") -> bytes:
    """Return a PNG of numbers (height, width) from 0 to 1 in colours that grow brighter."""
    return _png(_bytes(values), 3, _palette(_RISING))


def data_uri(png: bytes) -> str:
    """Return a PNG as a page can hold it."""
    return f"data:image/png;base64,{base64.b64encode(png).decode('ascii')}"


def _bytes(values: "numpy.ndarray") -> "numpy.ndarray":
    import numpy as np

    return np.rint(255.0 * np.clip(values, 0.0, 1.0)).astype(np.uint8)


def _palette(stops: tuple[tuple[float, float, float], ...]) -> bytes:
    import numpy as np

    places = np.linspace(0.0, 1.0, 256) * (len(stops) - 1)
    channels = [
        np.interp(places, range(len(stops)), channel) for channel in zip(*stops, strict=True)
    ]
    return _bytes(np.stack(channels, axis=-1)).tobytes()


def _png(pixels: "numpy.ndarray", color_type: int, palette: bytes) -> bytes:
    """Return a PNG of bytes; color type 2 is RGB, 3 is an index into `palette`."""
    import numpy as np

    height, width = pixels.shape[:2]
    rows = pixels.reshape(height, -1)
    # Each row starts with the number of its filter; 1 keeps differences to the pixel on the left.
    step = rows.shape[1] // width
    if color_type == 2:
        rows = np.concatenate([rows[:, :step], rows[:, step:] - rows[:, :-step]], axis=1)
    filters = np.full((height, 1), 1 if color_type == 2 else 0, np.uint8)
    data = zlib.compress(np.concatenate([filters, rows], axis=1).tobytes(), 9)
    chunks = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, color_type, 0, 0, 0))]
    if palette:
        chunks.append((b"PLTE", palette))
    chunks += [(b"IDAT", data), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)


def _chunk(name: bytes, data: bytes) -> bytes:
    check = zlib.crc32(name + data)
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", check)
