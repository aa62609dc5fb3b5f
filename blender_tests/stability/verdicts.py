# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates a function of the shader for many cases in one picture, and finds what is wrong."""

from collections.abc import Mapping, Sequence

import numpy as np

from blender_tests.osl.probe import evaluate

from .functions import Function

LARGEST_ERROR = 1e-3
# One float32 step of a number just below 1.
ROUNDING = 2.0**-24
# Cycles renders what is not a number as black, so that the shader has to say so.
_NOT_FINITE = 1e30
_SAY_NOT_FINITE = (
    f"for (int i = 0; i < 3; ++i) if (!isfinite(result[i])) result[i] = {_NOT_FINITE};"
)

Case = Mapping[str, object]


def columns_of(cases: Sequence[Case]) -> dict[str, np.ndarray]:
    """The arguments of all cases by name, float32 (n,) or (n, 3)."""
    return {name: np.float32([case[name] for case in cases]) for name in cases[0]}


def values(function: Function, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """What the shader returns, float64 (n, 3); what is not finite is nan.

    Numbers travel as vectors: Blender 5.2 averages a float attribute's three equal channels, which
    moves its last bit.
    """
    numbers = [name for name, column in columns.items() if column.ndim == 1]
    unpacked = "".join(f"float {name} = packed_{name}[0];" for name in numbers)
    packed = {name: column for name, column in columns.items() if column.ndim == 2}
    packed |= {f"packed_{name}": np.repeat(columns[name][:, None], 3, axis=1) for name in numbers}
    statements = f"{unpacked} {function.statements} {_SAY_NOT_FINITE}"
    found = evaluate(function.header, statements, **packed).astype(float)
    return np.where(np.abs(found) >= 0.99 * _NOT_FINITE, np.nan, found)


def wanted(function: Function, columns: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest value of the oracle, (n, channels), for the arguments and for those in
    `rounded` moved by one rounding: what cannot be told from the arguments in single precision."""
    exact = {name: column.astype(float) for name, column in columns.items()}
    found = [_oracle(function, exact)]
    for name in function.rounded:
        for step in _steps(exact[name]):
            found.append(_oracle(function, {**exact, name: step}))
    return np.min(found, axis=0), np.max(found, axis=0)


def _steps(column: np.ndarray) -> list[np.ndarray]:
    moves = np.eye(3) if column.ndim == 2 else [1.0]
    # Random numbers and cosines end at 0 and 1, components of unit vectors nowhere in between.
    low = np.minimum(column.min(), 0.0)
    return [
        np.clip(column + sign * ROUNDING * move, low, np.maximum(1.0, column))
        for move in moves
        for sign in (-1.0, 1.0)
    ]


def _oracle(function: Function, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.asarray(function.oracle(**columns), dtype=float)
    return found[:, None] if found.ndim == 1 else found


def compared(function: Function, columns: Mapping[str, np.ndarray]) -> np.ndarray:
    """Which cases the oracle is asked for, (n,)."""
    exact = {name: column.astype(float) for name, column in columns.items()}
    count = len(next(iter(exact.values())))
    if _oracle(function, exact).shape[1] == 0:
        return np.zeros(count, dtype=bool)
    return np.ones(count, dtype=bool) if function.defined is None else function.defined(**exact)


def errors(function: Function, columns: Mapping[str, np.ndarray], found: np.ndarray) -> np.ndarray:
    """Largest relative error of each case, (n,); 0 if the oracle is not asked for."""
    asked = compared(function, columns)
    if not np.any(asked):
        return np.zeros(len(asked))
    low, high = wanted(function, columns)
    channels = found[:, : low.shape[1]]
    away = np.maximum(np.maximum(low - channels, channels - high), 0.0)
    size = np.maximum(np.maximum(np.abs(low), np.abs(high)), function.floor)
    with np.errstate(invalid="ignore"):
        return np.where(asked, np.max(away / size, axis=1), 0.0)


def faults(function: Function, cases: Sequence[Case]) -> list[str]:
    """What is wrong with each case in words; empty if nothing is."""
    columns = columns_of(cases)
    found = values(function, columns)
    error = errors(function, columns, found)
    exact, _ = wanted(function, columns)
    said = []
    for row, value in enumerate(found):
        if not np.all(np.isfinite(value)):
            said.append("not finite")
        elif np.any((value < function.low) | (value > function.high)):
            said.append(f"{value} is not within {function.low} to {function.high}")
        elif not error[row] <= LARGEST_ERROR:
            said.append(f"{value} is wrong by {error[row]:.2g}, the oracle has {exact[row]}")
        else:
            said.append("")
    return said
