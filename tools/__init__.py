# SPDX-License-Identifier: GPL-3.0-or-later
"""Tools of the project's own make targets and tests."""
