# SPDX-License-Identifier: GPL-3.0-or-later
"""The supplement's figures from the oracle, with their numbers: ``make figures``.

`cases` says what the figures show. `walked` makes the lobes of the models and `traced` those of the
simulated surface, both with the estimator of `lobes`. `masking_curves` makes the data of Fig. 2 and
`reciprocity` those of Fig. 17. `estimators` and `gains` compare the bidirectional estimator with
the walk. `cache` runs these tasks and keeps their results; `findings` sorts and compares them.
`draw`, `draw_lobes` and `draw_curves` make the pictures, `tables` the CSV files. `report` makes the
README of ``docs/figures`` with `verdict` and `markdown`.
"""
