# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixture scenes, the scripts that build them, and the demo."""
