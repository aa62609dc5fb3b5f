# SPDX-License-Identifier: GPL-3.0-or-later
"""Translates texts that are put together at run time; Blender itself translates plain literals."""

from bpy.app.translations import pgettext_iface, pgettext_rpt


def label(template: str, **values: object) -> str:
    """Return `template` in the interface's language with `values` in its {places}."""
    return _filled(pgettext_iface(template), template, values)


def message(template: str, **values: object) -> str:
    """Return `template` in the language of reports with `values` in its {places}."""
    return _filled(pgettext_rpt(template), template, values)


def _filled(translated: str, template: str, values: dict[str, object]) -> str:
    """Fill in the values; a translation whose places do not fit gives way to the template."""
    if not values:
        return translated
    try:
        return translated.format(**values)
    except (KeyError, IndexError, ValueError):
        return template.format(**values)
