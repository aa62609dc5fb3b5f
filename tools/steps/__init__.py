# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures addon/core/analysis/step_errors.toml: `python -m tools.steps`."""
