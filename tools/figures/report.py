# SPDX-License-Identifier: GPL-3.0-or-later
"""The README of ``docs/figures``: the pictures, and what they say, with numbers.

All numbers are filled in from the data, and so are the words that depend on them.
"""

import numpy as np

from .cases import MASKING, RECIPROCITY, Effort, LobeFigure, alpha_text
from .estimators import MAX_BOUNCES
from .findings import Comparison, Findings, Panels, lobe_distance, to_simulated, to_tracked
from .gains import FAR, KNOWN, totals, work, z_scores
from .lobes import AZIMUTHS, BANDS, LOBE_NAMES, LOBES, by_lobe
from .markdown import percent, picture, table, thousandths, wrap
from .traced import RESOLUTION
from .verdict import agreement, bounces, claim, largest


def report(found: Findings, effort: Effort) -> str:
    """The whole page."""
    simulated = to_simulated(found)
    sections = [
        _introduction(found, simulated, effort),
        agreement(simulated),
        largest(found, simulated),
        bounces(found),
        claim(to_tracked(found)),
        _masking(found),
        *(_lobe_figure(figure, simulated) for figure in found.lobes),
        _reciprocity(found),
        _estimators(found, effort),
    ]
    return wrap("\n\n".join(sections))


def _introduction(found: Findings, simulated: list[Comparison], effort: Effort) -> str:
    panels = [lobes for figure in found.lobes.values() for lobes in figure.values()]
    errors = [one.energies.error.max() for one in panels]
    noise = [one.noise[-1] for one in simulated]
    finer, unstretched = (
        " and ".join(_change(figure, found.lobes[figure], panels) for figure, panels in one.items())
        for one in (found.finer, found.unstretched)
    )
    scatter = np.concatenate(
        [
            panel.energies.error[bright] / found.lobes[figure][where].energies.error[bright]
            for figure, panels in found.unstretched.items()
            for where, panel in panels.items()
            for bright in [found.lobes[figure][where].energies.mean > 0.01]
        ]
    )
    inside = max(one.remaining for one in panels)
    return f"""# The supplement's figures

Figs. 2 and 5 to 17 of the supplement of Wang et al. (2022), by the oracle in
`osl/oracle/`. `make figures` makes this page, the pictures and the CSV files; every
number here is filled in from the data.

**Columns.** *Uncorrelated* and *correlated* are the paper's models, *height-tracked* is the random
walk of Heitz et al. (2016). *Simulated* is what rays do that Embree traces on random Gaussian
height fields, whose slopes have the same Beckmann distribution: {effort.sheets} sheets of
{effort.cells} x {effort.cells} samples and {effort.sheets * effort.rays / 1e6:.1f} million rays a
panel. Each model takes {effort.walks / 1e6:.1f} million walks a panel. Nothing is absorbed, so
E_r + E_t = 1: diffuse facets have albedo 1, conductors reflect all light, and all dielectrics here
have IOR 1.5 and are lit from the outside.

**Lobes.** A panel counts where light leaves, by the angle of its direction projected on the plane
of incidence. The radius is the square root of the energy per radian, so that areas are proportional
to energy. All columns have the same estimator. The light comes from the upper left, θ radians from
the normal; the α_x of an anisotropic surface lies in the plane of incidence.

**Distance** of two columns. The sphere of directions is parted into cells of equal solid angle
({BANDS} bands of height by {2 * AZIMUTHS} azimuths, mirror images taken together). Half the sum of
the absolute differences between the cells is the share of the light that one column sends
elsewhere. Noise alone would make {percent(min(noise))} to {percent(max(noise))} % of no difference
at all, by the differences between two halves of each column. The CSV files
([to simulated](distances_to_simulated.csv), [to height-tracked](distances_to_height_tracked.csv))
have the distances d as found, with their noise n; in the text and its tables the noise is taken
off, sqrt(d² − n²), which leaves an uncertainty of about n/3.

**Accuracy.** The standard errors of the energies are {np.median(errors):.4f} in the median panel,
{max(errors):.4f} at most; for the simulated surface they come from the scatter of the sheets. At
most {max(one.lost for one in panels):.0e} of a panel's rays were lost, and
{f"at most {inside:.0e}" if inside else "nothing"} of its energy was still inside at the end. The
facets are flat, {RESOLUTION:g} to a correlation length; on {effort.fine} sheets with twice as many
the energies differ {finer}.

**Slopes of a sheet.** The sheets are finite, so that the slopes of each would have a variance a
little off that of Beckmann's distribution, which only their mean over all sheets has. Therefore
each sheet is stretched along x and y such that its own variance is exact. On the same
{effort.sheets} sheets without that the energies differ {unstretched}; their errors are
{np.median(scatter):.1f} times as large, in the median."""


def _change(figure: LobeFigure, usual: Panels, other: Panels) -> str:
    """How far the simulated column of a figure is from the one found in another way."""
    energies = [
        np.abs(by_lobe(panel.energies.mean - usual[where].energies.mean)).max()
        for where, panel in other.items()
    ]
    error = max(panel.energies.error.max() for panel in other.values())
    lobes = [lobe_distance(panel, usual[where]) for where, panel in other.items()]
    distance, noise = max((distance[-1], noise[-1]) for distance, noise in lobes)
    return (
        f"by at most {max(energies):.4f} in Fig. {figure.number} (standard errors up to"
        f" {error:.4f}; lobes at most {percent(distance)} % apart, noise {percent(noise)} %)"
    )


def _masking(found: Findings) -> str:
    apart = []
    for one in found.masking.values():
        finite = np.isfinite(one["formula"])
        apart.append(np.abs(one["integral"][finite] / one["formula"][finite] - 1.0).max())
    return f"""## Fig. {MASKING}: masking on the full sphere

{picture(MASKING, "Masking over the angle from the normal, for GGX and Beckmann")}

Eq. (3) and the numeric integral (4) differ by {max(apart):.0e} at most, relatively."""


def _lobe_figure(figure: LobeFigure, comparisons: list[Comparison]) -> str:
    surface = figure.material, figure.alpha
    mine = [one for one in comparisons if (one.material, one.alpha) == surface]
    sides = range(2 if figure.transmits else 1)
    header = [f"E_{'rt'[side]} {bounce}" for side in sides for bounce in LOBE_NAMES]
    header += [f"d {bounce}" for bounce in (*LOBE_NAMES, "all")]
    rows = [
        (
            f"{one.theta:g}",
            one.model,
            *(thousandths(one.difference[k, side], True) for side in sides for k in range(LOBES)),
            *(thousandths(value) for value in one.distance),
            thousandths(one.noise[-1]),
        )
        for one in mine
    ]
    error = max(one.error.max() for one in mine)
    return f"""## Fig. {figure.number}: {figure.material}, {alpha_text(figure.alpha)}

{picture(figure.number, figure.title)}

<details><summary>Differences from the simulated surface</summary>

In thousandths of the light: energies by bounce, less the simulated ones (standard errors up to
{1000 * error:.1f}); distances d of the lobes; and what noise alone would make of the last.

{table(("θ", "model", *header, "noise"), rows)}

</details>"""


def _reciprocity(found: Findings) -> str:
    rows = []
    for model, pairs in found.pairs.items():
        mean, error = pairs.mean_difference
        centred = "yes" if abs(mean) < 4.0 * error else "no"
        spread = pairs.z.std(ddof=1)
        texts = f"{mean:.5f} ± {error:.5f}", f"{pairs.z.mean():.2f}", f"{spread:.2f}", centred
        rows.append((model, *(text.replace("-", "−") for text in texts)))
    header = "GGX conductor, α = 1", "mean, per steradian", "mean of z", "deviation of z", "centred"
    count = next(iter(found.pairs.values())).error.size
    return f"""## Fig. {RECIPROCITY}: reciprocity

{picture(RECIPROCITY, "Histograms of the difference of the BSDF both ways, for two models")}

A white rough conductor, GGX, α = 1. The difference
ρ(ωi, ωo) − ρ(ωo, ωi) for {count} random pairs, of which ωi is always the more
grazing direction: were the two exchangeable, any model would be centred on zero. z is the
difference in its own standard errors, which for a reciprocal model has mean 0 and standard
deviation 1. Centred: the mean is less than 4 standard errors from zero. That is said of this
surface alone; `blender_tests/oracle/test_path.py` has the reciprocity of others.

{table(header, rows)}"""


def _estimators(found: Findings, effort: Effort) -> str:
    pairs, walks = effort.estimates
    (drawn, connected), both_ways = work()
    dearer = sum(both_ways) / (drawn + connected)
    rows, better = [], []
    for (model, material, alpha), gain in found.gains.items():
        case = f"{model}, {material}, {alpha_text(alpha)}"
        texts = []
        each = zip(gain.ratio, gain.deviation.T, strict=True)
        for bounce, (ratio, deviation) in enumerate(each, 2):
            texts.append(f"{_finite(ratio)} ({' / '.join(map(_finite, deviation))})")
            if np.isfinite(ratio) and ratio > dearer:
                better.append(f"{case}, bounce {bounce}")
        rows.append((case, *texts))
    ratios = np.concatenate([gain.ratio for gain in found.gains.values()])
    judged, blind = (int(found.sum()) for found in (np.isfinite(ratios), np.isposinf(ratios)))
    header = "GGX", *(f"bounce {k}" for k in range(2, MAX_BOUNCES + 1))
    return f"""## The walk and the bidirectional estimator

Values of the BSDF for {pairs} random pairs of directions, {walks} walks each: by the one-way walk,
which connects every vertex to ωo, and by bidirectional path sampling with as many walks from both
ends. The dielectric has IOR 1.5. First the ratio of the variances, the walk's over the other's;
then the relative standard deviations of one walk / of one pair of walks. All three are medians over
the pairs that light was found for. An estimator does not know its error where the relative standard
error is above {100 * KNOWN:g} %, or where it finds nothing while the other does. That counts as
infinite; where both do not know theirs the ratio leaves the pair out. A dash is a median that is
not finite. Numbers, with those of the unknown errors: [estimators.csv](estimators.csv).

{table(header, rows)}

For bounces up to {MAX_BOUNCES} a walk draws {drawn} vertices and connects {connected} of them. A
pair of walks draws {both_ways[0]}, joins halves at {both_ways[1]}, and adds up the terms of
{both_ways[2]}, because all ways to divide a path are weighed against each other. With all of them
counted alike that is {dearer:.1f} times the work. So at equal work the one-way walk has the smaller
variance in {judged - len(better)} of {judged} medians, and the bidirectional estimator in
{len(better)}: {"; ".join(better) or "none"}. In {blind} more it knows its error and the walk does
not. What else it is for is to check the walk.

{_settled(found, effort)}"""


def _settled(found: Findings, effort: Effort) -> str:
    """The differences of the two estimators, and what became of the large ones."""
    z = np.concatenate([z_scores(one) for one in found.estimates.values()])
    text = f"""The two differ by up to {np.abs(z).max():.1f} standard errors in the sum of these
bounces, and by more than {FAR:g} in {len(found.settled)} of {z.size} pairs; the bounces of one walk
are taken as independent here, which they are not quite."""
    if not found.settled:
        return text
    rows, after, low = [], [], 0
    for ((model, material, alpha), pair), (_, result) in found.settled.items():
        before = found.estimates[model, material, alpha]
        after.append(z_scores(result)[0])
        low += totals(before)[0][0, pair] < totals(result)[0][0, 0]
        values = [
            f"{total:.2e} ± {error:.0e}"
            for found_so, one in ((before, pair), (result, 0))
            for total, error in zip(*(each[:, one] for each in totals(found_so)), strict=True)
        ]
        case = f"{model}, {material}, {alpha_text(alpha)}, pair {pair}"
        zs = (f"{one:.1f}" for one in (z_scores(before)[pair], after[-1]))
        rows.append((case, *(one.replace("-", "−") for one in (*values, *zs))))
    far = int((np.abs(after) > FAR).sum())
    one_way, both_ways = effort.settle
    header = "walk, few", "bidirectional, few", "walk, many", "bidirectional, many", "z, few"
    return f"""{text} These were computed once more, with {one_way:,} walks and {both_ways:,} pairs
of walks. Then {far or "none"} of {len(after)} differ by more than {FAR:g}, and the largest
difference is {np.abs(after).max():.1f}. In {low} of the {len(after)} the few walks had found less
than the many: they met narrow peaks too rarely to know their own error. Directions:
[estimators_settled.csv](estimators_settled.csv).

{table(("GGX", *header, "z, many"), rows)}"""


def _finite(value: float) -> str:
    return f"{value:.2g}" if np.isfinite(value) else "–"
