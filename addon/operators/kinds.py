# SPDX-License-Identifier: GPL-3.0-or-later
"""The choice between the kinds of material that the operators share."""

from ..core.kinds import KINDS

KIND_ITEMS = [(identifier, kind.label, kind.surface) for identifier, kind in KINDS.items()]
