# SPDX-License-Identifier: GPL-3.0-or-later
"""A report as one HTML page with its style, plot and pictures inside."""

import base64
import html
from collections.abc import Callable
from dataclasses import dataclass

from .page_style import SCRIPT, STYLE
from .plot import color_of, draw_plot, svg
from .results import CostReport, Measured
from .tables import cells, headings, sort_keys

MOST_BYTES = 3_000_000
ENLARGED = 4.0  # a difference is shown this many times as large; 1 is the range of the display
# Widths of a picture in pixels, the largest first: as large as the page may grow.
_WIDTHS = (640, 480, 400, 320, 260, 200, 140, 90, 40)


@dataclass(frozen=True)
class Pictures:
    """The pictures of a variant, as PNG.

    picture    -- one render
    difference -- the mean of all renders less the reference, in colours
    """

    picture: bytes
    difference: bytes


# Draws the reference and, by the variants' keys, their pictures, at most so many pixels wide.
Drawer = Callable[[int], tuple[bytes, dict[str, Pictures]]]


def to_html(report: CostReport, drawer: Drawer) -> str:
    """Return the page, at most MOST_BYTES long."""
    for width in _WIDTHS:
        page = _page(report, *drawer(width))
        if len(page.encode()) <= MOST_BYTES:
            break
    return page


def _page(report: CostReport, reference: bytes, pictures: dict[str, Pictures]) -> str:
    setting = report.setting
    title = html.escape(f"What accuracy costs: {setting.file}")
    notes = "".join(f"<li>{html.escape(note)}</li>" for note in setting.notes)
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>{STYLE}</style>
</head>
<body>
<header><p class="brand">Microbounce</p><h1>{title}</h1>
<p class="sentence">{html.escape(report.sentence)}</p></header>
<section><h2>Error over time</h2>
<figure class="plot">{svg(draw_plot(report))}</figure>
<p class="hint">Dots are what was rendered. Each line goes on from there: noise falls with the root
of the time, bias stays. The dashed line is the target of {100 * setting.error:g} %.</p></section>
<section><h2>Figures</h2><div class="scroll">{_table(report)}</div>
<p class="hint">Errors are relative to the root mean square of the reference, over all pixels. Times
are those of {setting.samples} samples, median of {setting.rounds} rounds, without the start of the
render; Processor is the time of all threads together. A question mark: the noise leaves open
whether the bias is below the target. Click a heading to sort.</p></section>
<section><h2>Pictures</h2><div class="cards">
<article class="reference"><h3>Reference</h3>{_figure(reference, "")}
<p class="hint">{html.escape(setting.reference)}, {setting.reference_samples} samples, noise
{100 * setting.reference_noise:.2f} %.</p></article>
{"".join(_card(report, v, pictures[v.key]) for v in report.ranked() if v.key in pictures)}
</div></section>
<section><h2>How it was measured</h2>{_facts(report)}<ul>{notes}</ul></section>
<script>{SCRIPT}</script>
</body>
</html>
"""


def _table(report: CostReport) -> str:
    heads = "".join(
        f'<th scope="col"><button type="button">{html.escape(head)}</button></th>'
        for head in headings(report)
    )
    rows = []
    for variant in report.ranked():
        keys = sort_keys(report, variant)
        texts = cells(report, variant)
        swatch = f'<i style="background:{color_of(report, variant)}"></i>'
        line = [f'<th scope="row">{swatch}{html.escape(texts[0])}</th>']
        for key, text in zip(keys[1:], texts[1:], strict=True):
            sort = "" if key is None else f"{key:.8g}"
            line.append(f'<td data-sort="{sort}">{html.escape(text)}</td>')
        rows.append(f"<tr>{''.join(line)}</tr>")
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def _card(report: CostReport, variant: Measured, shown: Pictures) -> str:
    swatch = f'<i style="background:{color_of(report, variant)}"></i>'
    figures = [
        _figure(shown.picture, "picture"),
        _figure(shown.difference, f"difference, {ENLARGED:g} times: blue darker, red brighter"),
    ]
    heading = f"<h3>{swatch}{html.escape(variant.title)}</h3>"
    return f'<article>{heading}<div class="two">{"".join(figures)}</div></article>'


def _figure(png: bytes, caption: str) -> str:
    text = f"<figcaption>{html.escape(caption)}</figcaption>" if caption else ""
    alt = html.escape(caption or "reference", quote=True)
    data = base64.b64encode(png).decode("ascii")
    return f'<figure><img src="data:image/png;base64,{data}" alt="{alt}">{text}</figure>'


def _facts(report: CostReport) -> str:
    setting = report.setting
    facts = {
        "File": f"{setting.file}, scene {setting.scene}, frame {setting.frame}",
        "Picture": f"{setting.width} × {setting.height} pixels, {setting.samples} samples, "
        f"{setting.rounds} rounds with seeds of their own",
        "Reference": f"{setting.reference}, {setting.reference_samples} samples"
        + (", kept from before" if setting.reference_kept else ""),
        "Date": setting.date,
        **setting.hardware,
        "Memory": setting.memory_source,
    }
    items = "".join(
        f"<dt>{html.escape(name)}</dt><dd>{html.escape(text)}</dd>" for name, text in facts.items()
    )
    return f"<dl>{items}</dl>"
