# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds node groups and puts the shaders into script nodes."""
