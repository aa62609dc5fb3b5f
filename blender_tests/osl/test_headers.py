# SPDX-License-Identifier: GPL-3.0-or-later
"""Each header includes what it needs: it compiles by itself, whatever came before."""

import pytest

from addon.core.shader_source import shader_directory
from addon.material.script import compile_source

FOLDER = shader_directory()
HEADERS = sorted([*FOLDER.glob("include/*.h"), *FOLDER.glob("tables/*.h")])


@pytest.mark.parametrize("header", HEADERS, ids=[path.stem for path in HEADERS])
def test_a_header_compiles_alone(header) -> None:
    source = f'#include "{header.as_posix()}"\nshader probe(output color result = 0)\n{{\n}}\n'
    assert "shader probe" in compile_source(source)
