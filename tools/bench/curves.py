# SPDX-License-Identifier: GPL-3.0-or-later
"""Error over time of a scene's variants, and how two of them compare."""

import math
import statistics
from dataclasses import dataclass

import numpy as np

from addon.core.cost.statistics import ErrorSplit

# Fewer rounds give no time worth reading.
FEWEST_ROUNDS = 5


@dataclass(frozen=True)
class Curve:
    """The measured errors and times of a variant. Processor times are those of all threads.

    samples -- 1, 2, 4 ... samples a pixel
    squared -- squared error over the reference's mean square, at each of `samples`: the median of
               the rounds that have as many; nan without a reference
    lowest, highest -- the same of the best and of the worst round
    cpu     -- processor seconds of a sample, by round
    wall    -- seconds that passed during a sample, by round
    start   -- processor seconds of the first render after the switch, by round
    bias    -- error of the converged picture; None if too few pictures show it
    piece   -- processor seconds of a render apart from its samples, median of the rounds
    """

    variant: str
    samples: tuple[int, ...]
    squared: tuple[float, ...]
    lowest: tuple[float, ...]
    highest: tuple[float, ...]
    cpu: tuple[float, ...]
    wall: tuple[float, ...]
    start: tuple[float, ...]
    bias: ErrorSplit | None = None
    piece: float = 0.0

    @property
    def a_sample(self) -> float:
        """Processor seconds of a sample, median of the rounds."""
        return statistics.median(self.cpu)

    @property
    def spread(self) -> tuple[float, float]:
        """The least and the most of `cpu`."""
        return min(self.cpu), max(self.cpu)

    @property
    def seconds(self) -> tuple[float, ...]:
        """Processor seconds at each of `samples`."""
        return tuple(count * self.a_sample for count in self.samples)

    @property
    def known(self) -> bool:
        """Whether an error was measured."""
        return not math.isnan(self.squared[0])

    def squared_at(self, seconds: float) -> float | None:
        """Squared error at a time, interpolated in both logarithms; None outside."""
        times = self.seconds
        if not self.known or not times[0] * (1 - 1e-9) <= seconds <= times[-1] * (1 + 1e-9):
            return None
        return float(np.exp(np.interp(np.log(seconds), np.log(times), np.log(self.squared))))

    def error_at(self, seconds: float) -> float | None:
        """Root of `squared_at`."""
        squared = self.squared_at(seconds)
        return None if squared is None else math.sqrt(squared)

    def seconds_to(self, error: float) -> float | None:
        """The first time at which the error is at most `error`, at least that of one sample.

        None if the error never is.
        """
        wanted = error**2
        times = self.seconds
        for index, squared in enumerate(self.squared):
            if squared <= wanted:
                if index == 0:
                    return times[0]
                pair = slice(index - 1, index + 1)
                above, below = np.log(self.squared[pair])
                start, end = np.log(times[pair])
                part = (above - math.log(wanted)) / (above - below)
                return float(np.exp(start + part * (end - start)))
        return None


def time_ratios(ours: Curve, theirs: Curve) -> tuple[float, ...]:
    """How many times as long a sample of `ours` takes, round by round.

    The two times of a round are neighbours, so load on the machine weighs on both.
    """
    return tuple(a / b for a, b in zip(ours.cpu, theirs.cpu, strict=False))


def time_ratio(ours: Curve, theirs: Curve) -> float:
    """The median of `time_ratios`."""
    return statistics.median(time_ratios(ours, theirs))


def shared_times(one: Curve, other: Curve) -> tuple[float, float] | None:
    """First and last time at which both have an error; None if there is none."""
    start = max(one.seconds[0], other.seconds[0])
    end = min(one.seconds[-1], other.seconds[-1])
    return (start, end) if start <= end and one.known and other.known else None


def advantage(ours: Curve, theirs: Curve, seconds: float) -> float | None:
    """How many times smaller the squared error of `ours` is at a time that both have, else None."""
    mine, other = ours.squared_at(seconds), theirs.squared_at(seconds)
    return None if mine is None or other is None else other / mine


def advantages(ours: Curve, theirs: Curve, count: int = 33) -> list[tuple[float, float]]:
    """(seconds, advantage) at `count` times that both have, evenly spaced in the logarithm."""
    span = shared_times(ours, theirs)
    if span is None:
        return []
    times = np.geomspace(*span, count)
    return [(float(t), found) for t in times if (found := advantage(ours, theirs, float(t)))]
