# SPDX-License-Identifier: GPL-3.0-or-later
"""Pieces of the README: tables, pictures, numbers and cases in words."""

import re
import textwrap
from collections.abc import Iterable, Sequence

from .cases import LOBE_FIGURES, Alpha, alpha_text, name

# Or an item of a list; tables, headings, pictures and HTML stay as they are.
_PARAGRAPH = re.compile(r"^(?![|#!<]).+(?:\n(?!- ).+)*", re.MULTILINE)


def wrap(page: str) -> str:
    """The page with its paragraphs and list items filled to lines of 100 characters."""
    return _PARAGRAPH.sub(_fill, page) + "\n"


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def picture(number: int, text: str) -> str:
    """A figure with its alternative text, and links to its numbers."""
    start = name(number)
    kinds = ["_energies", "_lobes"] if any(f.number == number for f in LOBE_FIGURES) else [""]
    links = " and ".join(f"[{start}{kind}.csv]({start}{kind}.csv)" for kind in kinds)
    return f"![{text}]({start}.svg)\n\nNumbers: {links}."


def percent(share: float) -> str:
    """A share in per cent, without the sign."""
    return f"{100.0 * share:.1f}"


def thousandths(share: float, signed: bool = False) -> str:
    """A share in thousandths, with a plus sign if ``signed``."""
    text = f"{1000.0 * share:{'+' if signed else ''}.1f}"
    return "0.0" if text in ("+0.0", "-0.0") else text.replace("-", "−")


def in_words(found: Iterable[tuple[str, Alpha, float]]) -> str:
    """Cases (material, alpha, theta) in words, grouped by surface."""
    angles: dict[tuple[str, Alpha], list[str]] = {}
    for material, alpha, theta in found:
        angles.setdefault((material, alpha), []).append(f"{theta:g}")
    texts = [
        f"{material}, {alpha_text(alpha)} (θ = {', '.join(thetas)})"
        for (material, alpha), thetas in angles.items()
    ]
    return "; ".join(texts) or "none"


def _fill(paragraph: re.Match) -> str:
    return textwrap.fill(
        " ".join(paragraph[0].split()),
        100,
        subsequent_indent="  " if paragraph[0].startswith("- ") else "",
        break_long_words=False,
        break_on_hyphens=False,
    )
