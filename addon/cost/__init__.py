# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the variants of a scene in another Blender, from a copy of the file.

So the open file never changes, and Blender stays usable meanwhile. `run.py` works in the open
Blender, `measure.py` and its imports in the other.
"""
