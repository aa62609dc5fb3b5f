# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how much time the accuracy of each quality costs: ``make bench``, ``make bench-check``.

`plan` lists the scenes, their variants and samples. `runner` starts a process per scene, `child`.
It opens the scene with `stage`, renders it with `measure` and keeps each result with `store`.
`findings` reads errors and times from the results as `curves`. `targets` compares them with the
project's aims, `check` with the ratios of an earlier run. `draw` makes the plots, `tables` the CSV
and JSON files, and `page`, with `verdict`, the README of ``docs/benchmarks``. `estimate` predicts
how long a run takes. `gains` is a command of its own.
"""
