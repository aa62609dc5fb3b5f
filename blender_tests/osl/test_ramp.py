# SPDX-License-Identifier: GPL-3.0-or-later
"""The energy of Oren and Nayar's lobe (ramp.h) against an integral over the hemisphere."""

import numpy as np

from osl.tables.closures import oren_nayar
from osl.tables.fitting import exits, view

from .probe import evaluate

RULE = exits(200)


def test_nayar_energy() -> None:
    """From along the normal to the horizon; the rule's own error is 1e-5."""
    cosine = np.array([0.0, 1e-6, 1e-3, 0.01, 0.1, 0.3, 0.5, 0.8, 0.99, 1.0], dtype=np.float32)
    found = evaluate("ramp.h", "result = nayar_energy(cosine);", cosine=cosine)[:, 0]
    wanted = [RULE.energy(oren_nayar(RULE.o, view(float(c)))) for c in cosine]
    assert np.abs(found - wanted).max() < 2e-5
