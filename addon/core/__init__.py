# SPDX-License-Identifier: GPL-3.0-or-later
"""Everything of the extension that needs no Blender: plain Python, testable on its own."""

VERSION = "0.1.0"
