# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a real Blender with its window, as an artist does, and uses the extension in it."""
