# SPDX-License-Identifier: GPL-3.0-or-later
"""Analyses all our materials of a scene, and applies the proposals."""

import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import bpy

from ..core.analysis.picture_error import picture_error
from ..core.analysis.prediction import Surface
from ..core.analysis.proposal import Option, Proposal, Shown, propose, time_ratio, total_error
from ..core.run import Pieces, done_at_once
from ..scene.share import Shares, share_pieces, shown_materials
from ..scene.sources import Sources
from .surfaces import Found, apply_choice, found_nodes, read_choice, read_surface, why_fixed

# The part of the time in which reading an image may begin. The rest is for the rays.
_PART_OF_IMAGES = 0.5


@dataclass(frozen=True)
class Row:
    """The finding and the proposal for one node.

    key  -- finds the node again
    name -- the material's name, and the node's if it has one of its own
    surface -- the surface that the proposal is made for
    notes -- what is unknown, in short sentences without full stops
    """

    key: tuple[str, str, str]
    name: str
    surface: Surface
    proposal: Proposal
    notes: tuple[str, ...] = ()

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        one = self.proposal
        return {
            "material": self.name,
            "kind": self.surface.kind,
            "share": round(one.share, 4),
            "now": asdict(one.now),
            "then": asdict(one.then),
            "error_now": round(one.error_now, 5),
            "error_then": round(one.error_then, 5),
            "energy_lost_now": round(one.loss_now, 5),
            "energy_lost_then": round(one.loss_then, 5),
            "steps": [_step(option, one.share) for option in one.steps],
            "changes": one.changes,
            "reason": one.reason,
            "notes": list(self.notes),
        }


def _step(option: Option, share: float) -> dict[str, object]:
    """Return the prediction for a Quality, as JSON takes it.

    `picture_error` is the picture's error from this surface alone, `time` the cost.
    """
    return asdict(option.choice) | {
        "error": round(option.error, 5),
        "picture_error": round(picture_error([(share, option.error)]), 5),
        "energy_lost": round(option.loss, 5),
        "time": round(option.cost, 3),
    }


@dataclass(frozen=True)
class Analysis:
    """The analysis of a scene: the rows by falling share.

    has_camera -- False if no shares could be found, so that all materials weigh the same
    part       -- part of the rays that found the shares, 0 to 1; below 1 if time ran out
    empty      -- part of the picture that shows only the world, 0 to 1
    unread     -- full names of images for which there was no time
    """

    scene: str
    tolerance: float
    rows: tuple[Row, ...]
    has_camera: bool
    part: float = 1.0
    empty: float = 0.0
    unread: frozenset[str] = frozenset()

    @property
    def changes(self) -> tuple[Row, ...]:
        """The rows that propose something."""
        return tuple(row for row in self.rows if row.proposal.changes)

    @property
    def proposals(self) -> list[Proposal]:
        """Those of all rows."""
        return [row.proposal for row in self.rows]

    @property
    def error_now(self) -> float:
        """The predicted error of the picture, as image L2, if all materials are equally bright."""
        return total_error(self.proposals)[0]

    @property
    def error_then(self) -> float:
        """The same with all proposals applied."""
        return total_error(self.proposals)[1]

    @property
    def within_tolerance(self) -> bool:
        """Whether the picture is within the tolerance with all proposals."""
        return self.error_then <= self.tolerance

    @property
    def time_ratio(self) -> float:
        """The predicted time of a sample with all proposals, over the time now."""
        return time_ratio(self.proposals, self.empty)

    def as_dict(self) -> dict[str, object]:
        """Return it as JSON takes it."""
        return {
            "scene": self.scene,
            "tolerance": self.tolerance,
            "has_camera": self.has_camera,
            "part": round(self.part, 4),
            "error_now": round(self.error_now, 5),
            "error_then": round(self.error_then, 5),
            "within_tolerance": self.within_tolerance,
            "time_ratio": round(self.time_ratio, 3),
            "materials": [row.as_dict() for row in self.rows],
        }


def analyse(
    context: bpy.types.Context,
    tolerance: float,
    progress: Callable[[float], None] = lambda part: None,
    seconds: float = math.inf,
) -> Analysis:
    """Analyse the scene of `context` and return the proposals. Nothing is changed.

    tolerance -- how far off the picture may be, as image L2, above 0 to 1; else ValueError
    progress  -- gets the part that is done, from 0 to 1
    seconds   -- for reading images and finding the shares. Preparing the scene and reading the last
                 image come on top
    """
    return done_at_once(analysis_pieces(context, tolerance, seconds), progress)


def analysis_pieces(
    context: bpy.types.Context, tolerance: float, seconds: float = math.inf
) -> Pieces[Analysis]:
    """Do the work of analyse(); nothing of the scene may change meanwhile."""
    if not 0.0 < tolerance <= 1.0:
        raise ValueError(f"The tolerance is {tolerance:g}: give a number above 0, at most 1")
    end = time.monotonic() + seconds
    found = found_nodes(shown_materials(context))
    sources = Sources(_PART_OF_IMAGES * seconds)
    read = []
    for one in found:
        yield 0.0
        read.append((*read_surface(one, sources), why_fixed(one, sources)))
    shares = yield from share_pieces(context, end - time.monotonic(), sources)
    shown = [_shown(*row, shares, len(found)) for row in zip(found, read, strict=True)]
    proposals = propose([one for one, _notes in shown], tolerance)
    rows = [
        Row(one.key, one.name, shows.surface, proposal, notes)
        for one, (shows, notes), proposal in zip(found, shown, proposals, strict=True)
    ]
    rows.sort(key=lambda row: (-row.proposal.share, row.name))
    name = context.scene.name
    unread = frozenset(sources.unread)
    camera = shares.has_camera
    return Analysis(name, tolerance, tuple(rows), camera, shares.part, shares.empty, unread)


def apply_analysis(context: bpy.types.Context, analysis: Analysis) -> tuple[list[str], list[str]]:
    """Set what `analysis` proposes; return the names of the nodes that were set and left.

    A node is left if it has changed since: it is gone, cannot be set, or is another surface.
    """
    found = {one.key: one for one in found_nodes(shown_materials(context))}
    sources = Sources(unread=analysis.unread)
    done, left = [], []
    for row in analysis.changes:
        one = found.get(row.key)
        if one is None or not _is_still(row, one, sources):
            left.append(row.name)
            continue
        apply_choice(one, row.proposal.then)
        done.append(row.name)
    return done, left


def _is_still(row: Row, found: Found, sources: Sources) -> bool:
    """Return whether the proposal was made for the node as it is now."""
    if why_fixed(found, sources):
        return False
    surface, _notes = read_surface(found, sources)
    return (surface, read_choice(found)) == (row.surface, row.proposal.now)


def _shown(
    found: Found, read: tuple[Surface, tuple[str, ...], str], shares: Shares, count: int
) -> tuple[Shown, tuple[str, ...]]:
    """Return one of `count` nodes as it is shown, and notes on what is unknown.

    `read` is its surface, the notes on that, and why it stays.
    """
    surface, notes, why = read
    if shares.are_unmet(found.materials):
        notes = (*notes, f"Rays cannot meet all that shows it: its share is at least 1 of {count}")
    share = shares.of(found.materials, count)
    return Shown(surface, read_choice(found), share, why), notes
