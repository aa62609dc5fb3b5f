# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of operators that say why they are not available."""

import bpy

from ..text import message


class Polled:
    """An operator that is available unless its why_not() says why not, with the remedy."""

    @classmethod
    def why_not(cls, context: bpy.types.Context) -> str:
        """Return why it is not available here; "" if it is."""
        raise NotImplementedError

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """Allow it, or show why not."""
        reason = cls.why_not(context)
        if reason:
            cls.poll_message_set(message(reason))
        return not reason
