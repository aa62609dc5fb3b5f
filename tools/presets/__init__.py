# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes the presets in addon/presets from measured data: `python -m tools.presets`."""
