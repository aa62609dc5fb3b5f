# SPDX-License-Identifier: GPL-3.0-or-later
"""Compresses a .blend file harder than Blender does. Blender reads both alike.

The file has the Zstandard seekable format: frames that are compressed one by one, then a table of
their lengths. By the table Blender finds a place in the file without reading all of it.
"""

import struct
from pathlib import Path

import zstandard

_FRAME = 1 << 20  # bytes before compression, as Blender has them
_LEVEL = 19  # Blender takes 3
_SKIPPABLE, _SEEKABLE = 0x184D2A5E, 0x8F92EAB1  # magic numbers of the format


def repack(path: Path) -> None:
    """Compress the .blend file at `path` again. Raises zstandard.ZstdError for other files."""
    with path.open("rb") as file:
        reader = zstandard.ZstdDecompressor().stream_reader(file, read_across_frames=True)
        content = reader.read()
    compressor = zstandard.ZstdCompressor(level=_LEVEL)
    parts = [content[start : start + _FRAME] for start in range(0, len(content), _FRAME)]
    frames = [compressor.compress(part) for part in parts]
    table = b"".join(
        struct.pack("<II", len(frame), len(part)) for frame, part in zip(frames, parts, strict=True)
    )
    table += struct.pack("<IBI", len(frames), 0, _SEEKABLE)
    header = struct.pack("<II", _SKIPPABLE, len(table))
    path.write_bytes(b"".join([*frames, header, table]))
