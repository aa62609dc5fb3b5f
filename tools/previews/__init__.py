# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the presets' pictures in addon/previews: `make previews`."""
