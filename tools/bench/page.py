# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the README of ``docs/benchmarks``, with all numbers from the data."""

import math
import statistics
from collections.abc import Mapping, Sequence

from tools.figures.markdown import table, wrap

from .curves import FEWEST_ROUNDS, Curve, time_ratio, time_ratios
from .draw import note
from .findings import SceneFindings
from .plan import (
    BOUNCES,
    CYCLES,
    CYCLES_SVM,
    FITTED,
    ONE_WALK,
    PERCENTAGES,
    SINGLE,
    WALK,
    WALK_COUNTS,
    WHOLE_WALK,
)
from .targets import TOLD_AT, Target
from .verdict import losses, moment, wins

TO_REACH = (0.1, 0.05, 0.02)  # the page has the times to reach these errors


def page(found: Mapping[str, SceneFindings], aims: Sequence[Target]) -> str:
    """The whole page."""
    compared = [one for one in found.values() if not one.scene.is_sweep]
    sections = [
        _introduction(found),
        _aims(aims),
        _losses(compared),
        _headline(found),
        *(_scene(one) for one in compared),
        _sweeps(found),
    ]
    return wrap("\n\n".join(section for section in sections if section))


def headline_table(found: Mapping[str, SceneFindings]) -> str:
    """The table of docs/cost.md, a row for each scene."""
    header = (
        "scene", "time", "Cycles", "Fitted", "Walk", "Fitted's sample over Cycles'",
        "Walk's over Single's",
    )  # fmt: skip
    rows = []
    for one in found.values():
        if one.scene.is_sweep or not {SINGLE, FITTED, WALK, CYCLES} <= one.curves.keys():
            continue
        seconds = moment(one)[1]
        curves = one.curves
        rows.append(
            (
                one.scene.title,
                _time(seconds),
                *(_error(curves[name].error_at(seconds)) for name in (CYCLES, FITTED, WALK)),
                f"{time_ratio(curves[FITTED], curves[CYCLES]):.2f}",
                f"{time_ratio(curves[WALK], curves[SINGLE]):.2f}",
            )
        )
    return table(header, rows)


def _introduction(found: Mapping[str, SceneFindings]) -> str:
    one = next(iter(found.values()))
    rounds = [len(curve.cpu) for scene in found.values() for curve in scene.curves.values()]
    few = (
        f" **Fewer than {FEWEST_ROUNDS} rounds: this is a trial, and its times mean little.**"
        if min(rounds) < FEWEST_ROUNDS
        else ""
    )
    return f"""# What accuracy costs in time

Measured on {one.machine}. `make bench` measures anew and writes this page, the plots and the files.
Every number here comes from the data, and so does every verdict. [curves.csv](curves.csv) has
error over time, [costs.csv](costs.csv) the time of a sample and the bias, and
[results.json](results.json) everything. `make gains` measures
[what each change gained](gains.md) that made the shaders faster.

**Time** is processor time, summed over all threads. Other work on the machine changes it less than
the time that passes. The files have both. The first render after each switch compiles the shaders.
It is left out, and has its own column. The time of a sample is the median of at least
{min(rounds)} rounds, in which the variants take turns. Its range over the rounds is beside
it.{few} Denoiser, adaptive sampling and clamping are off.

**Error** is the root mean square of the difference from the reference, over the reference's own
root mean square. The samples of a render are one sequence, and the error is taken after 1, 2, 4 ...
of them. *Converged* is the error without noise, from independent renders
(`addon/core/cost/statistics.py`), with its standard error. A plot's dotted line is the reference's
own noise. Errors below it cannot be measured.

**Variants.** *{SINGLE}*, *{FITTED}*, *{WALK}* (4 walks, height-correlated) and *Exact* are our
qualities. Exact cannot hit a sun without size, so scenes with such a sun lack it. *{CYCLES}* and
*{CYCLES_SVM}* are Cycles' own closure with the same values: Multiscatter GGX, or Diffuse BSDF for
matte surfaces. The aims compare with two plain estimators, which are our shader with a changed
source. *{ONE_WALK}* takes one random walk per shading point, with the same kernel. Its first vertex
has one candidate instead of four, so nothing is stratified. Its first bounce is Walk's.
*{WHOLE_WALK}* takes all bounces from one walk, even the first, smoothed by the same kernel."""


def _aims(aims: Sequence[Target]) -> str:
    if not aims:
        return ""
    texts = []
    for aim in dict.fromkeys(one.aim for one in aims):
        some = [one for one in aims if one.aim == aim]
        rows = [(one.scene, _measured(one), _outcome(one)) for one in some]
        reached = sum(one.reached for one in some)
        title = f"**{aim}**: reached in {reached} of {len(some)}."
        texts.append(f"{title}\n\n{table(('scene', 'measured', ''), rows)}")
    reached = sum(aim.reached for aim in aims)
    every = "\n\n".join(texts)
    return f"""## The project's aims

{reached} of {len(aims)} aims are reached. A ratio of times is the median of the rounds, with their
range. Errors at equal time are compared at the time of {TOLD_AT} samples of the plain estimator, or
at the nearest time that both variants have. The range covers all times that both have.

{every}"""


def _measured(aim: Target) -> str:
    if math.isnan(aim.value):
        return "no time that both have"
    return f"{_number(aim.value)} ({_number(aim.low)} to {_number(aim.high)} over {aim.span})"


def _outcome(aim: Target) -> str:
    if math.isnan(aim.value):
        return "unknown"
    verdict = "reached" if aim.reached else "**not reached**"
    if aim.low <= aim.limit <= aim.high:
        verdict += f", but not in all {aim.span}" if aim.reached else f", but in some {aim.span}"
    return verdict


def _losses(found: Sequence[SceneFindings]) -> str:
    lost, won = losses(found), wins(found)
    if not lost and not won:
        return ""
    lines = "\n".join(f"- {line}" for line in lost) or "- In none of these scenes."
    better = "\n".join(f"- {line}" for line in won) or "- In none of these scenes."
    return f"""## Where it loses against Cycles' own closures

{lines}

## Where it wins

{better}"""


def _headline(found: Mapping[str, SceneFindings]) -> str:
    rows = headline_table(found)
    if rows.count("\n") < 2:
        return ""
    return f"""## At a glance

![Error over time of a few scenes](headline.svg)

Errors are those at the time of {TOLD_AT} samples of {ONE_WALK}, or of Cycles if a scene lacks it.

{rows}"""


def _scene(one: SceneFindings) -> str:
    baseline, seconds = moment(one)
    cycles = one.curves.get(CYCLES)
    rows = [_row(curve, cycles, one.curves[baseline], seconds) for curve in one.curves.values()]
    header = (
        "", "ms a sample", "over Cycles", "first render", f"error in {_time(seconds)}",
        f"squared error, {baseline}'s over its own", "converged",
        *(f"time to {100 * error:g} %" for error in TO_REACH),
    )  # fmt: skip
    drawn = any(curve.known for curve in one.curves.values())
    picture = f"![Error over time of all variants]({one.scene.name}.svg)\n\n" if drawn else ""
    return f"""## {one.scene.title}

{picture}{note(one) if drawn else "There is no reference, so there are only times."}{_models(one)}

{table(header, rows)}"""


def _models(one: SceneFindings) -> str:
    if one.scene.others:
        return " The other models have their own picture from the oracle."
    if one.scene.directional and any("uncorrelated" in name for name in one.curves):
        return (
            " The reference is of the height-correlated model, so the difference of the other"
            " models counts as their error."
        )
    return ""


def _row(curve: Curve, cycles: Curve | None, base: Curve, seconds: float) -> tuple[str, ...]:
    low, high = curve.spread
    mine, other = curve.squared_at(seconds), base.squared_at(seconds)
    bias = curve.bias
    converged = "–" if bias is None else f"{100 * bias.bias:.2f} ± {100 * bias.bias_se:.2f} %"
    return (
        curve.variant,
        f"{1e3 * curve.a_sample:.2f} ({1e3 * low:.2f} to {1e3 * high:.2f})",
        "–" if cycles is None else f"{time_ratio(curve, cycles):.2f}",
        f"{statistics.median(curve.start):.2f} s",
        _error(curve.error_at(seconds)),
        "–" if mine is None or other is None else f"{_number(other / mine)}",
        converged,
        *(_reached(curve, error) for error in TO_REACH),
    )


def _sweeps(found: Mapping[str, SceneFindings]) -> str:
    """The tables of time over the bounce limit, the walks and the picture's size."""
    texts = []
    for name, form, values, words in (
        ("bounces", "MaxBounces {}", BOUNCES, "Max Bounces"),
        ("walks", "Walks {}", WALK_COUNTS, "Walks"),
        ("sizes", "{} %", PERCENTAGES, "Width"),
    ):
        rows = []
        for scene in (one for key, one in found.items() if key.startswith(name)):
            for quality in (SINGLE, FITTED, WALK, CYCLES):
                names = [f"{quality}, {form.format(value)}" for value in values]
                if all(one in scene.curves for one in names):
                    cells = [_swept(scene.curves[one], scene.curves[names[0]]) for one in names]
                    rows.append((scene.scene.title, quality, *cells))
        if rows:
            header = ("", "", *(form.format(value) for value in values))
            texts.append(f"**{words}.**\n\n{table(header, rows)}")
    if not texts:
        return ""
    every = "\n\n".join(texts)
    return f"""## What bounces, walks and pixels cost

![Time over the limit of bounces, the number of walks, and the size](sweeps.svg)

The numbers are the milliseconds of a sample. In parentheses is the ratio to the first column, with
its range over the rounds. A scene with a reference also has the error after all samples.

{every}"""


def _swept(curve: Curve, first: Curve) -> str:
    ratios = time_ratios(curve, first)
    text = f"{1e3 * curve.a_sample:.2f}"
    if curve is not first:
        text += f" ({statistics.median(ratios):.2f}, {min(ratios):.2f} to {max(ratios):.2f})"
    return f"{text}, {_error(math.sqrt(curve.squared[-1]))}" if curve.known else text


def _error(error: float | None) -> str:
    return "–" if error is None else f"{100.0 * error:.2f} %"


def _reached(curve: Curve, error: float) -> str:
    """The time to reach an error: "never" if the bias is larger, "?" if it is about as large."""
    if not curve.known:
        return "–"
    seconds = curve.seconds_to(error)
    if seconds is not None:
        return _time(seconds)
    later = f"> {_time(curve.seconds[-1])}"
    if curve.bias is None or curve.bias.doubtful(error):
        return f"{later}?"
    return "never" if curve.bias.bias > error else later


def _time(seconds: float) -> str:
    return f"{1e3 * seconds:.0f} ms" if seconds < 0.9995 else f"{seconds:.2f} s"


def _number(value: float) -> str:
    return f"{value:.2f}" if value < 9.995 else f"{value:.0f}"
