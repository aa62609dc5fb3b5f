# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the variants of a scene, in a Blender of its own that has a copy of the file.

So nothing in the open file changes, whatever happens, and Blender stays at hand meanwhile.
`run.py` is the part in the open Blender, `measure.py` and what it imports are in the other.
"""
