# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of a measurement, spelled once.

The operator's properties and the subcommand's arguments are made from OPTIONS.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from .plan import REFERENCE_FACTOR, REFERENCES, STEPS, Options, PlanError

OUTPUT = "//microbounce_cost"  # // is the folder of the file
_DEFAULT = Options()


def listed(values: Iterable[object]) -> str:
    """Return values as parse_numbers() and parse_steps() read them."""
    return ", ".join(f"{value:g}" if isinstance(value, float) else str(value) for value in values)


@dataclass(frozen=True)
class CostOption:
    """One option.

    name    -- of the property; the argument has hyphens for its underscores
    label   -- shown beside the property
    default -- tells its type: bool, int, float or str
    help    -- a tooltip without a full stop
    limits  -- smallest and largest number the property takes
    percent -- whether it is a percentage
    choices -- a choice's names with their tooltips
    metavar -- what stands for its value in the subcommand's help
    """

    name: str
    label: str
    default: bool | int | float | str
    help: str
    limits: tuple[float, float] = (0, 2**31 - 1)
    percent: bool = False
    choices: tuple[tuple[str, str], ...] = ()
    metavar: str = "LIST"


OPTIONS = (
    CostOption(
        "samples",
        "Samples",
        _DEFAULT.samples,
        "Samples of each picture; 0 takes the scene's. Times and noise at other numbers follow "
        "from these",
        (0, 65536),
        metavar="N",
    ),
    CostOption(
        "percentage",
        "Size",
        _DEFAULT.percentage,
        "Width and height in percent of the scene's resolution; 0 takes the scene's percentage",
        (0, 100),
        percent=True,
        metavar="P",
    ),
    CostOption(
        "rounds",
        "Rounds",
        _DEFAULT.rounds,
        "How often each variant is rendered and timed, each time with other noise",
        (2, 32),
        metavar="N",
    ),
    CostOption(
        "error",
        "Target Error",
        100.0 * _DEFAULT.error,
        "Times are given to this error, in percent of the reference",
        (0.01, 99.0),
        percent=True,
        metavar="PERCENT",
    ),
    CostOption(
        "steps", "Qualities", listed(_DEFAULT.steps), "Qualities to compare, with commas between"
    ),
    CostOption(
        "bounces",
        "Bounces",
        listed(_DEFAULT.bounces),
        "Limits of the bounces to compare, in Walk, with commas between; none leaves them out",
    ),
    CostOption(
        "walks",
        "Walks",
        listed(_DEFAULT.walks),
        "Numbers of walks to compare, in Walk, with commas between; none leaves them out",
    ),
    CostOption(
        "kernels",
        "Kernels",
        listed(_DEFAULT.kernels),
        "Radii of the lobe to compare, in Walk, with commas between; none leaves them out",
    ),
    CostOption(
        "baselines",
        "Cycles' Own",
        _DEFAULT.baselines,
        "Compare Cycles' own materials of the same values too, with Open Shading Language on and "
        "off",
    ),
    CostOption(
        "reference",
        "Reference",
        _DEFAULT.reference,
        "What the pictures are compared with",
        choices=tuple(
            zip(
                REFERENCES,
                (
                    "Many narrow walks: sees all lights",
                    "No bias, but noise; not for lights that have no size",
                ),
                strict=True,
            )
        ),
    ),
    CostOption(
        "reference_samples",
        "Reference Samples",
        _DEFAULT.reference_samples,
        f"Samples of the reference; 0 takes {REFERENCE_FACTOR} times those of a picture",
        metavar="N",
    ),
    CostOption(
        "output",
        "Output",
        OUTPUT,
        "Folder for the page, the tables and the plot; // is the file's own",
        metavar="FOLDER",
    ),
)


def options_of(values: Mapping[str, object], region: str = "") -> Options:
    """Return what is asked for by `values` of OPTIONS, by name, and by a text of four numbers.

    Raises PlanError for a value that makes no sense.
    """
    return Options(
        samples=values["samples"],
        percentage=values["percentage"],
        steps=parse_steps(values["steps"]),
        bounces=parse_numbers(values["bounces"]),
        walks=parse_numbers(values["walks"]),
        kernels=parse_numbers(values["kernels"], float),
        baselines=values["baselines"],
        rounds=values["rounds"],
        reference=values["reference"],
        reference_samples=values["reference_samples"],
        error=values["error"] / 100.0,
        region=parse_region(region) if region else None,
    )


def parse_numbers(text: str, number: type = int) -> tuple:
    """Return the numbers in a text such as "1, 2, 4"; "" and "none" give none.

    Raises PlanError for a word that is not a number.
    """
    return tuple(_parsed(word, number) for word in _words(text))


def parse_steps(text: str) -> tuple[str, ...]:
    """Return the steps named in a text such as "fitted, walk", in the ladder's order.

    Raises PlanError for an unknown name.
    """
    named = {word.title() for word in _words(text)}
    for word in named.difference(STEPS):
        raise PlanError(f"Step cannot be {word}: give {', '.join(STEPS)}")
    return tuple(step for step in STEPS if step in named)


def parse_region(text: str) -> tuple[float, float, float, float]:
    """Return the four parts in a text such as "0.2,0.2,0.8,0.8". Raises PlanError."""
    parts = parse_numbers(text, float)
    if len(parts) != 4:
        raise PlanError(f"Region cannot be {text}: give four numbers x0,y0,x1,y1 from 0 to 1")
    return parts


def _words(text: str) -> list[str]:
    return [] if text.strip().lower() == "none" else text.replace(",", " ").split()


def _parsed(word: str, number: type) -> float:
    try:
        return number(word)
    except ValueError:
        noun = "whole numbers" if number is int else "numbers"
        raise PlanError(f"{word!r} is no number: give {noun} such as 1, 2, 4") from None
