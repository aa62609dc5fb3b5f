# SPDX-License-Identifier: GPL-3.0-or-later
"""These tests want a real Blender with a window, which `make test-window` looks for."""

import os

collect_ignore_glob = [] if os.environ.get("BLENDER") else ["test_*.py"]
