# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws what a check found."""

from collections.abc import Iterable

import bpy

from ..core.finding import Finding
from ..text import message
from .panels import draw_text

ICONS = {"error": "CANCEL", "warning": "ERROR", "note": "INFO"}


def draw_findings(
    layout: bpy.types.UILayout, context: bpy.types.Context, findings: Iterable[Finding]
) -> None:
    """Draw each finding with its remedy in a box, or that there are none."""
    found = False
    for finding in findings:
        found = True
        parts = (f"{finding.subject}:", message(finding.message), message(finding.remedy))
        draw_text(layout, context, " ".join(parts).strip(), ICONS[finding.level])
    if not found:
        layout.label(text="Nothing was found", icon="CHECKMARK")
