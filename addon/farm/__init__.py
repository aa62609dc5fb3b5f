# SPDX-License-Identifier: GPL-3.0-or-later
"""Will a file render on a farm, without the extension, as it does here? `check.py` answers."""
