# SPDX-License-Identifier: GPL-3.0-or-later
"""SVG files are shortened without a change of what they show."""

import re

import numpy as np
from matplotlib.figure import Figure

from tools.figures import draw


def segments(path):
    """A path's commands with their points, lines that follow without a letter made explicit."""
    found = []
    for command, numbers in re.findall(r"([A-Za-z])([^A-Za-z]*)", path):
        points = np.array(numbers.split(), dtype=float).reshape(-1, 2)
        count = {"M": 1, "L": 1, "Q": 2, "C": 3}.get(command, 0)
        for i in range(0, len(points), max(count, 1)):
            found.append(("L" if command == "M" and i else command, points[i : i + count]))
        if not len(points):
            found.append((command, points))
    return found


def test_paths_keep_their_segments(monkeypatch):
    page = Figure(figsize=(3.0, 2.0))
    with draw.style():
        axes = draw.place(page, 0.3, 0.3, 2.0, 1.0)
        axes.plot(np.sin(np.arange(30.0)), "o-")  # markers are curves
        axes.annotate("", xy=(3.0, 0.1), xytext=(20.0, 0.7), arrowprops={"arrowstyle": "-|>"})
        axes.fill([1.0, 5.0, 3.0], [0.1, 0.2, 0.9])
        short = draw.svg(page, "Title")
        monkeypatch.setattr(draw, "_shorten", lambda text: text)
        whole = draw.svg(page, "Title")
    paths = [re.findall(r' d="([^"]*)"', text) for text in (short, whole)]
    assert len(paths[0]) > 5
    assert any("C" in path for path in paths[0])
    for one, other in zip(*paths, strict=True):
        for (command, points), (expected, exact) in zip(
            segments(one), segments(other), strict=True
        ):
            assert command == expected
            np.testing.assert_allclose(points, exact, atol=0.0501)  # tenths of a point
    assert len(short) < len(whole)
    assert "sans-serif" in short
