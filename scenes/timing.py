# SPDX-License-Identifier: GPL-3.0-or-later
"""Times the samples of a render, without its start.

All times are processor seconds of all threads. Other work on the machine hardly changes them.
"""

import statistics
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class SampleTimes:
    """Seconds per sample of several variants, measured in interleaved rounds.

    seconds -- by variant, the seconds per sample of each round
    starts  -- by variant, the seconds of each round's render with one sample
    """

    seconds: dict[str, list[float]]
    starts: dict[str, list[float]]

    def joined(self, other: "SampleTimes") -> "SampleTimes":
        """Return the rounds of both. They must have the same variants."""
        both = [
            {name: mine[name] + theirs[name] for name in mine}
            for mine, theirs in ((self.seconds, other.seconds), (self.starts, other.starts))
        ]
        return SampleTimes(*both)

    def median(self, variant: str) -> float:
        """Return the median seconds per sample."""
        return statistics.median(self.seconds[variant])

    def start(self, variant: str) -> float:
        """Return the median of `starts`, in seconds."""
        return statistics.median(self.starts[variant])

    def ratio(self, variant: str, baseline: str) -> float:
        """Return the median of ratios().

        The two times of a round are neighbours, so passing load weighs on both.
        """
        return statistics.median(self.ratios(variant, baseline))

    def ratios(self, variant: str, baseline: str) -> list[float]:
        """Return variant / baseline for each round."""
        pairs = zip(self.seconds[variant], self.seconds[baseline], strict=True)
        return [ours / theirs for ours, theirs in pairs]


def time_samples(
    scene: bpy.types.Scene,
    variants: Mapping[str, Callable[[], None]],
    samples: int = 16,
    rounds: int = 5,
) -> SampleTimes:
    """Measure the seconds per sample of each variant of `scene`.

    variants -- by name, a function that switches the scene to the variant
    samples  -- number of timed samples, 1 or more
    rounds   -- how often all variants are timed, one after the other, 1 or more

    Each round renders a variant with 1 sample and with 1 + `samples`, and takes the difference. The
    first round begins with a render to warm up. The scene's samples, seed and persistent data are
    restored at the end.
    Raises ValueError for a number below 1, and RuntimeError if the samples take no time.
    """
    if samples < 1 or rounds < 1:
        raise ValueError(f"samples is {samples}, rounds is {rounds}: both must be 1 or more")
    seconds: dict[str, list[float]] = {name: [] for name in variants}
    starts: dict[str, list[float]] = {name: [] for name in variants}
    kept = scene.cycles.samples, scene.cycles.seed, scene.render.use_persistent_data
    # With persistent data, Cycles would not notice another number of samples.
    scene.render.use_persistent_data = False
    try:
        for turn in range(rounds):
            scene.cycles.seed = turn
            for name, switch in variants.items():
                switch()
                if turn == 0:
                    _render(scene, 1)
                starts[name].append(_render(scene, 1))
                rest = _render(scene, 1 + samples) - starts[name][-1]
                seconds[name].append(rest / samples)
                if seconds[name][-1] <= 0.0:
                    raise RuntimeError(
                        f"{name}: {samples} samples took no measurable time; time more of them"
                    )
    finally:
        scene.cycles.samples, scene.cycles.seed, scene.render.use_persistent_data = kept
    return SampleTimes(seconds, starts)


def _render(scene: bpy.types.Scene, samples: int) -> float:
    """Render without writing a picture; return the processor seconds of all threads."""
    scene.cycles.samples = samples
    begin = time.process_time()
    bpy.ops.render.render(write_still=False, scene=scene.name)
    return time.process_time() - begin
