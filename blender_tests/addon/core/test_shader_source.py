# SPDX-License-Identifier: GPL-3.0-or-later
"""Headers put in place, and the errors of a damaged installation."""

import pytest

from addon.core import shader_source
from addon.core.kinds import KINDS
from addon.core.shader_source import ShaderSourceError, inlined_source, shader_directory


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "include").mkdir()
    (tmp_path / "include" / "one.h").write_text('#include "two.h"\nfloat one() { return two(); }\n')
    (tmp_path / "include" / "two.h").write_text("float two() { return 2; }\n")
    (tmp_path / "toy.osl").write_text(
        '#include "stdosl.h"\n#include "include/one.h"\n  #  include "include/two.h"\n'
        "shader toy(output float x = 0) { x = one(); }\n"
    )
    return tmp_path


def test_headers_are_put_in_place_once_and_in_order(folder):
    source = inlined_source("toy", folder)
    assert source.splitlines() == [
        '#include "stdosl.h"',
        "float two() { return 2; }",
        "float one() { return two(); }",
        "shader toy(output float x = 0) { x = one(); }",
    ]


def test_headers_that_include_each_other_end(folder):
    (folder / "include" / "two.h").write_text('#include "one.h"\nfloat two() { return 2; }\n')
    assert inlined_source("toy", folder).count("float one()") == 1


def test_shaders_have_no_include_left(kind):
    source = inlined_source(KINDS[kind].shader)
    assert f"shader {KINDS[kind].shader}" in source
    left = [line for line in source.splitlines() if line.lstrip().startswith("#include")]
    assert set(left) <= {'#include "stdcycles.h"'}, "Cycles itself provides just this one"


def test_a_missing_shader_names_path_and_remedy(folder):
    with pytest.raises(ShaderSourceError) as caught:
        inlined_source("other", folder)
    assert str(folder / "other.osl") in str(caught.value)
    assert "Reinstall the extension" in str(caught.value)


def test_a_missing_header_names_who_wants_it(folder):
    (folder / "include" / "two.h").unlink()
    with pytest.raises(ShaderSourceError, match=r"two\.h, included by one\.h, is missing"):
        inlined_source("toy", folder)


def test_an_unreadable_shader_says_why(folder):
    (folder / "other.osl").mkdir()
    with pytest.raises(ShaderSourceError, match=r"cannot be read .*Check its permissions"):
        inlined_source("other", folder)
    (folder / "latin.osl").write_bytes(b"// \xe9\n")
    with pytest.raises(ShaderSourceError, match="cannot be read"):
        inlined_source("latin", folder)


def test_a_missing_folder_names_path_and_remedy(tmp_path, monkeypatch):
    assert (shader_directory() / "microbounce_conductor.osl").is_file()
    module = tmp_path / "package" / "core" / "shader_source.py"
    monkeypatch.setattr(shader_source, "__file__", str(module))
    with pytest.raises(ShaderSourceError) as caught:
        shader_directory()
    assert str(tmp_path / "package" / "osl") in str(caught.value)
    assert "Reinstall the extension" in str(caught.value)
