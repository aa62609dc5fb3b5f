# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds what users install: the zip (`make addon`) and the asset library (`make assets`)."""
