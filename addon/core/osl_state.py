# SPDX-License-Identifier: GPL-3.0-or-later
"""Decides whether the shaders run in a scene, and says why not and what to do."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Status:
    """Whether the shaders run. Where `ok` is False, `reason` and `remedy` are short sentences.

    `can_enable` is True if switching Open Shading Language on is what is missing.
    """

    ok: bool
    reason: str = ""
    remedy: str = ""
    can_enable: bool = False

    @property
    def message(self) -> str:
        """Reason and remedy in one text, "" if the shaders run."""
        return " ".join(part for part in (self.reason, self.remedy) if part)


def osl_state(built_with_osl: bool, engine: str, shading_system: bool, device: str) -> Status:
    """Return the status for a scene.

    built_with_osl -- whether this Blender has Cycles with Open Shading Language
    engine         -- the scene's render engine, such as "CYCLES"
    shading_system -- the scene's switch for Open Shading Language
    device         -- what Cycles renders on: "CPU", or the type of the GPUs, such as "OPTIX"
    """
    if not built_with_osl:
        return Status(
            False,
            "This Blender was built without Open Shading Language; Cycles' own material shows.",
            "Use a Blender from blender.org.",
        )
    if engine != "CYCLES":
        return Status(
            False,
            "The render engine is not Cycles; Cycles' own material shows.",
            "Choose Cycles in the render properties.",
        )
    if not shading_system:
        return Status(
            False,
            "Open Shading Language is off; Cycles' own material shows.",
            "Switch it on in the render properties.",
            can_enable=True,
        )
    if device not in ("CPU", "OPTIX"):
        return Status(
            False,
            f"{device} devices have no Open Shading Language; Cycles' own material shows.",
            "Render on the CPU or with OptiX.",
        )
    return Status(True)
