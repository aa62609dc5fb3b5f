# SPDX-License-Identifier: GPL-3.0-or-later
"""What accuracy costs in time: what is rendered, the statistics, and how they are told."""
