# SPDX-License-Identifier: GPL-3.0-or-later
"""Microbounce: Cycles materials that keep the light of every microfacet bounce.

Nothing of Blender is imported before `register`, so that `core` also works in plain Python.
"""


def register() -> None:
    """Add the operators, panels and menu entries to Blender."""
    from . import registration

    registration.register()


def unregister() -> None:
    """Take them out again."""
    from . import registration

    registration.unregister()
