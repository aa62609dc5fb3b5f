# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixture scenes, the scripts that build them, their rendering and timing, and the demos."""
