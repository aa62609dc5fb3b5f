# SPDX-License-Identifier: GPL-3.0-or-later
"""These tests need a real Blender with a window. `make test-window` looks for one."""

import os

collect_ignore_glob = [] if os.environ.get("BLENDER") else ["test_*.py"]
