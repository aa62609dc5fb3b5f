# SPDX-License-Identifier: GPL-3.0-or-later
"""The figures' style, colours and layout, and small SVG files that depend on nothing but data."""

import io
import re
from contextlib import AbstractContextManager

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

WIDTH = 9.0  # inches, shown at about 900 pixels

# The palette of Okabe and Ito, which the colour-blind can tell apart, with a darker purple.
BOUNCE_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#a0478a", "#222222")
INK, FAINT, PAPER = "#222222", "#8a8a8a", "#ffffff"

_FONTS = "'DejaVu Sans', Verdana, Arial, sans-serif"
_STYLE = {
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.labelsize": 8,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlesize": 9,
    "figure.facecolor": PAPER,
    "font.family": "sans-serif",
    "font.size": 8,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.2,
    "svg.fonttype": "none",  # text stays text, in the viewer's sans serif
    "svg.hashsalt": "microbounce",  # keeps the names of SVG elements
    "xtick.color": INK,
    "xtick.labelsize": 7,
    "xtick.major.width": 0.6,
    "ytick.color": INK,
    "ytick.labelsize": 7,
    "ytick.major.width": 0.6,
}


def style() -> AbstractContextManager:
    """Context in which figures are made and saved."""
    return mpl.rc_context(mpl.rcParamsDefault | _STYLE | {"backend": "svg"})


def svg(page: Figure, title: str) -> str:
    """The page as the text of an SVG file."""
    buffer = io.StringIO()
    page.savefig(buffer, format="svg", metadata={"Date": None, "Title": title})
    return _shorten(buffer.getvalue())


def heading(page: Figure, title: str, note: str) -> None:
    """A title at the top left, and a note in smaller type under it."""
    label(page, 0.15, 0.22, title, size=11, weight="bold")
    label(page, 0.15, 0.45, note)


def label(page: Figure, left: float, top: float, text: str, **options: object) -> None:
    """Text whose middle line begins at a place in inches from the page's top left corner."""
    options = {"va": "center", "color": INK, **options}
    page.text(left / WIDTH, 1.0 - top / page.get_figheight(), text, **options)


def place(page: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """Axes at a place in inches from the page's top left corner."""
    tall = page.get_figheight()
    return page.add_axes((left / WIDTH, 1.0 - (top + height) / tall, width / WIDTH, height / tall))


def _shorten(text: str) -> str:
    """Round the coordinates of paths to tenths of a point, and drop what has no effect."""

    def number(match: re.Match) -> str:
        return f"{float(match[0]):.1f}".removesuffix(".0")

    def path(match: re.Match) -> str:
        rounded = " ".join(re.sub(r"-?\d+\.\d+", number, match[1]).split())
        # pairs after a move or a line are lines; after a curve they would continue it
        return f' d="{re.sub("(?<=[ML])[^A-Za-z]*(?:L[^A-Za-z]*)+", _lines, rounded)}"'

    text = re.sub(r' d="([^"]*)"', path, text)
    # one family for all texts, with a fallback that every viewer has
    text = re.sub(r" font-family: [^;]*;", "", text)
    text = text.replace("butt}</style>", f"butt}} text{{font-family: {_FONTS}}}</style>")
    text = re.sub(r' transform="rotate\(-0 [^"]*\)"', "", text)
    return "\n".join(line.strip() for line in text.splitlines()) + "\n"


def _lines(match: re.Match) -> str:
    return match[0].replace("L ", "")
