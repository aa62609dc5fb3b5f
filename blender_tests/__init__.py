# SPDX-License-Identifier: GPL-3.0-or-later
"""Tests that run inside Blender's Python, and the model they test against."""
