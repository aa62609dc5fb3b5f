# SPDX-License-Identifier: GPL-3.0-or-later
"""What each Quality costs and leaves out, for addon/core/analysis/step_errors.toml."""
