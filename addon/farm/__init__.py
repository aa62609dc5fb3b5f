# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks whether a file renders on a farm, without the extension, as it does here."""
