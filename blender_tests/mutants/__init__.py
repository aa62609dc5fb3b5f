# SPDX-License-Identifier: GPL-3.0-or-later
"""Proves that the fast tier protects: it has to fail for every fault listed here."""
