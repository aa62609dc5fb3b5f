# SPDX-License-Identifier: GPL-3.0-or-later
"""The measurements of each variant, and what follows from them."""

import math
import statistics
from dataclasses import asdict, dataclass, field

from .statistics import ErrorSplit, error_after, samples_to_error

# Stands for a sample's seconds that cannot be told from the start of a render.
TOO_SHORT = 1e-7


@dataclass(frozen=True)
class Cost:
    """Time and memory of rendering; lists have one number a round.

    wall, processor -- seconds per sample without the start of the render; processor time is that
                       of all threads together
    start           -- seconds that a render takes before its samples
    memory          -- peak in megabytes, None if unknown
    """

    wall: tuple[float, ...]
    processor: tuple[float, ...]
    start: tuple[float, ...]
    memory: float | None = None


@dataclass(frozen=True)
class Measured:
    """A variant with its cost and its errors at `samples` samples."""

    key: str
    title: str
    family: str
    samples: int
    cost: Cost
    split: ErrorSplit

    @property
    def is_timed(self) -> bool:
        """Whether all rounds took long enough to be timed."""
        return min(self.cost.wall) > TOO_SHORT

    @property
    def per_sample(self) -> float:
        """Median seconds of a sample."""
        return statistics.median(self.cost.wall)

    @property
    def seconds(self) -> float:
        """Seconds of all samples, without the start."""
        return self.per_sample * self.samples

    @property
    def processor_seconds(self) -> float:
        """Seconds of all samples on all threads together."""
        return statistics.median(self.cost.processor) * self.samples

    @property
    def error(self) -> float:
        """Bias and noise together."""
        return error_after(self.split, 1.0)

    def seconds_to(self, error: float) -> float:
        """Return the seconds to a relative error, infinite if the bias is above it."""
        return self.per_sample * samples_to_error(self.split, self.samples, error)

    def error_at(self, seconds: float) -> float:
        """Return the error after so many seconds."""
        return error_after(self.split, seconds / self.seconds)


@dataclass(frozen=True)
class Setting:
    """Where and how it was measured; the reports tell it besides the numbers.

    seconds and errors of the variants are at `samples` samples and at this size in pixels.
    """

    file: str
    scene: str
    frame: int
    width: int
    height: int
    samples: int
    rounds: int
    error: float
    reference: str
    reference_samples: int
    reference_noise: float
    reference_kept: bool
    date: str
    hardware: dict[str, str]
    memory_source: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class CostReport:
    """A whole measurement. `files` has the paths of the written reports by their kind."""

    setting: Setting
    variants: tuple[Measured, ...]
    sentence: str
    files: dict[str, str] = field(default_factory=dict)

    @property
    def timed(self) -> tuple[Measured, ...]:
        """The variants that took long enough to be timed."""
        return tuple(variant for variant in self.variants if variant.is_timed)

    @property
    def equal_time(self) -> float | None:
        """Seconds at which errors are compared: those of Fitted, or of the first timed variant.

        None if none is.
        """
        timed = self.timed
        chosen = next((v for v in timed if v.key == "fitted"), timed[0] if timed else None)
        return chosen and chosen.seconds

    def ranked(self) -> list[Measured]:
        """Return the variants, those soonest at the target error first, then by their errors.

        Those that are too short to be timed come last, by their errors.
        """
        return sorted(self.variants, key=self._rank)

    def rows(self) -> list[dict[str, object]]:
        """Return a row of plain values for each variant. None means never, or not measured.

        A variant that is not `timed` was too short.
        """
        return [self._row(variant) for variant in self.ranked()]

    def as_dict(self) -> dict[str, object]:
        """Return all of it as JSON takes it."""
        return {
            "sentence": self.sentence,
            "setting": asdict(self.setting),
            "equal_time": self.equal_time,
            "variants": self.rows(),
            "files": self.files,
        }

    def _rank(self, variant: Measured) -> tuple[float, ...]:
        if not variant.is_timed:
            return True, variant.error
        reached = variant.seconds_to(self.setting.error)
        return False, reached, variant.error_at(self.equal_time)

    def _row(self, variant: Measured) -> dict[str, object]:
        timed = variant.is_timed
        reached = variant.seconds_to(self.setting.error) if timed else math.inf
        return {
            "key": variant.key,
            "variant": variant.title,
            "family": variant.family,
            "samples": variant.samples,
            "timed": timed,
            "seconds": variant.seconds if timed else None,
            "processor_seconds": variant.processor_seconds if timed else None,
            "seconds_per_sample": list(variant.cost.wall),
            "start_seconds": statistics.median(variant.cost.start),
            "noise": variant.split.noise,
            "bias": variant.split.bias,
            "bias_se": variant.split.bias_se,
            "bias_resolved": variant.split.resolved,
            "bias_resolution": variant.split.resolution,
            "error": variant.error,
            "seconds_to_error": reached if math.isfinite(reached) else None,
            "seconds_to_error_open": variant.split.doubtful(self.setting.error),
            "error_at_equal_time": variant.error_at(self.equal_time) if timed else None,
            "flip": None,  # not measured; scripts may read the key
            "memory_mb": variant.cost.memory,
        }
