# SPDX-License-Identifier: GPL-3.0-or-later
"""Uses the extension in the window of a real Blender, as an artist does: `make test-window`."""
