# SPDX-License-Identifier: GPL-3.0-or-later
"""Microbounce: Cycles materials that keep the light of every microfacet bounce."""
