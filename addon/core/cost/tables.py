# SPDX-License-Identifier: GPL-3.0-or-later
"""A report as CSV, as JSON, and as a table of text."""

import csv
import io
import json

from .advice import UNTIMED, bias_text, duration, seconds, spent
from .results import CostReport, Measured


def to_json(report: CostReport) -> str:
    """Return a whole report. Null means never reached, or not measured."""
    return json.dumps(report.as_dict(), indent=2, allow_nan=False) + "\n"


def to_csv(report: CostReport) -> str:
    """Return a line for each variant. Empty means never reached, or not measured.

    Seconds per sample are those of all rounds with spaces between.
    """
    stream = io.StringIO()
    rows = report.rows()
    writer = csv.DictWriter(stream, rows[0])
    writer.writeheader()
    for row in rows:
        times = " ".join(f"{time:.6g}" for time in row["seconds_per_sample"])
        writer.writerow(row | {"seconds_per_sample": times})
    return stream.getvalue()


def headings(report: CostReport) -> tuple[str, ...]:
    """Return the headings of the columns of cells()."""
    time = report.equal_time
    return (
        "Variant",
        f"Time to {100 * report.setting.error:g} %",
        "Error at equal time" if time is None else f"Error at {duration(time)}",
        "Bias",
        "Noise",
        "Time",
        "Processor",
        "Start",
        "Memory",
    )


def cells(report: CostReport, variant: Measured) -> tuple[str, ...]:
    """Return the texts of a variant's row."""
    row = next(row for row in report.rows() if row["key"] == variant.key)
    memory = row["memory_mb"]
    return (
        variant.title,
        seconds(variant, report.setting.error),
        f"{100 * row['error_at_equal_time']:.2f} %" if row["timed"] else UNTIMED,
        bias_text(variant),
        f"{100 * row['noise']:.2f} %",
        spent(row["seconds"]),
        spent(row["processor_seconds"]),
        duration(row["start_seconds"]),
        "not measured" if memory is None else f"{memory:.{0 if memory >= 10.0 else 1}f} MB",
    )


def sort_keys(report: CostReport, variant: Measured) -> tuple[object, ...]:
    """Return the keys that sort the columns of cells(); None comes last."""
    row = next(row for row in report.rows() if row["key"] == variant.key)
    names = ("variant", "seconds_to_error", "error_at_equal_time", "bias", "noise", "seconds")
    more = ("processor_seconds", "start_seconds", "memory_mb")
    return tuple(row[name] for name in (*names, *more))


def to_text(report: CostReport) -> str:
    """Return the table and the sentence in plain text."""
    rows = [headings(report), *(cells(report, variant) for variant in report.ranked())]
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = []
    for row in rows:
        rest = (cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))
        lines.append("  ".join([row[0].ljust(widths[0]), *rest]))
    return "\n".join([*lines, "", report.sentence, *report.setting.notes, ""])
