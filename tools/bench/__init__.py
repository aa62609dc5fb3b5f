# SPDX-License-Identifier: GPL-3.0-or-later
"""What the accuracy of each quality costs in time: ``make bench``, ``make bench-check``.

`plan` says which scenes and variants are measured, and how long. A child process a scene, `child`,
opens it with `stage`, renders with `measure` and keeps each result with `store`; `runner` starts
the children. `errors`, `findings` and `curves` read errors, times and their ratios from the
results, `targets` holds them against the project's aims, `check` against the ratios of an earlier
run. `draw` makes plots, `tables` CSV and JSON files, and `page`, with `verdict`, the README of
``docs/benchmarks``. `estimate` tells how long the whole takes; `synthetic` makes data for tests.
"""
