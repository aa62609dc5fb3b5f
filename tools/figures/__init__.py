# SPDX-License-Identifier: GPL-3.0-or-later
"""The supplement's figures from the oracle, with their numbers: ``make figures``.

`cases` says what is shown. `walked` and `traced` make the lobes of the models and of the simulated
surface by one and the same estimator, `lobes`; `masking_curves` and `reciprocity` make the data of
Figs. 2 and 17, `estimators` and `gains` those of the bidirectional estimator. `cache` runs all that
and keeps it, `findings` sorts and compares it. `draw`, `draw_lobes` and `draw_curves` make pictures
of it, `tables` CSV files, and `report`, with `verdict` and `markdown`, the README of
``docs/figures``.
"""
