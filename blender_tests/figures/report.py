# SPDX-License-Identifier: GPL-3.0-or-later
"""The README of ``docs/figures``: the pictures, and what they say, with numbers.

All numbers are filled in from the data, and so are the words that depend on them.
"""

import numpy as np

from .cases import FINER, MASKING, RECIPROCITY, Effort, LobeFigure, alpha_text
from .findings import Comparison, Findings, to_simulated, to_tracked
from .lobes import AZIMUTHS, BANDS, LOBE_NAMES, LOBES, by_lobe
from .markdown import percent, picture, table, thousandths, wrap
from .traced import RESOLUTION
from .verdict import agreement, bounces, claim


def report(found: Findings, effort: Effort) -> str:
    """The whole page."""
    simulated = to_simulated(found)
    sections = [
        _introduction(found, simulated, effort),
        agreement(simulated),
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
    coarse = found.lobes[FINER]
    changes = [
        (by_lobe(fine.energies.mean - coarse[where].energies.mean)[:, 0], fine.energies.error.max())
        for where, fine in found.finer.items()
    ]
    change, spread = (max(np.abs(one).max() for one in some) for some in zip(*changes, strict=True))
    inside = max(one.remaining for one in panels)
    return f"""# The supplement's figures

Figs. 2 and 5 to 17 of the supplement of Wang et al. (2022), by the oracle in
`blender_tests/oracle/`. `make figures` makes this page, the pictures and the CSV files; every
number here is filled in from the data.

**Columns.** *Uncorrelated* and *correlated* are the paper's models, *height-tracked* is the random
walk of Heitz et al. (2016). *Simulated* is what rays do that Embree traces on random Gaussian
height fields, whose slopes have the same Beckmann distribution: {effort.sheets} sheets of
{effort.cells} x {effort.cells} samples and {effort.sheets * effort.rays / 1e6:.1f} million rays a
panel. Each model takes {effort.walks / 1e6:.1f} million walks a panel. Nothing is absorbed, so
E_r + E_t = 1.

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
facets are flat, {RESOLUTION:g} to a correlation length; on {effort.fine} sheets with twice as many,
the energies of Fig. {FINER.number} differ by at most {change:.4f}, with standard errors up to
{spread:.4f}."""


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
    header = "model", "mean, per steradian", "mean of z", "deviation of z", "centred on zero"
    count = next(iter(found.pairs.values())).error.size
    return f"""## Fig. {RECIPROCITY}: reciprocity

{picture(RECIPROCITY, "Histograms of the difference of the BSDF both ways, for two models")}

The difference ρ(ωi, ωo) − ρ(ωo, ωi) for {count} random pairs, of which ωi is always the more
grazing direction: were the two exchangeable, any model would be centred on zero. z is the
difference in its own standard errors, which for a reciprocal model has mean 0 and standard
deviation 1. Centred: the mean is less than 4 standard errors from zero.

{table(header, rows)}"""


def _estimators(found: Findings, effort: Effort) -> str:
    rows = [
        (
            f"{model}, {material}, {alpha_text(alpha)}",
            *(f"{one:.2g}" for one in gain.ratio),
            f"{np.abs(gain.z).max():.1f}",
        )
        for (model, material, alpha), gain in found.gains.items()
    ]
    pairs, walks = effort.estimates
    count = sum(gain.z.size for gain in found.gains.values())
    far = sum(int((np.abs(gain.z) > 4.0).sum()) for gain in found.gains.values())
    first = next(iter(found.gains.values()))
    header = "GGX", *(f"bounce {k}" for k in range(2, 2 + first.ratio.size)), "largest abs. z"
    return f"""## The walk and the bidirectional estimator

Values of the BSDF for {pairs} random pairs of directions, {walks} walks each: variance of the
one-way walk, which connects every vertex to ωo, over that of bidirectional path sampling with as
many walks from both ends, median over the pairs. z is the difference of their means, over all these
bounces, in standard errors; its absolute value exceeds 4 in {far} of {count} pairs. Such pairs see
narrow peaks that the one-way walk meets too rarely to know its own error
(`blender_tests/oracle/test_bidirectional.py` has one and settles it by counting walks). A pair of
walks takes many times as long as one walk, because all ways to join its halves are evaluated: what
it is for is to check the walk, and to find such peaks.

{table(header, rows)}"""
