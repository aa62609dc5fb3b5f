# SPDX-License-Identifier: GPL-3.0-or-later
"""The check of the OSL sources' form."""

import pytest

from tools.check_osl import LICENCE, complaints

GOOD = f"{LICENCE}\n#ifndef A_H\n#define A_H\nfloat f() {{ return 1.0; }}\n#endif\n"


def written(tmp_path, text, name="a.h"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_good_header_passes(tmp_path):
    assert complaints(written(tmp_path, GOOD)) == []


def test_shader_needs_no_guard(tmp_path):
    assert complaints(written(tmp_path, f"{LICENCE}\nshader s() {{}}\n", "s.osl")) == []


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (GOOD.replace("GPL", "MIT"), "first line"),
        (GOOD.replace("#define A_H", "#define B_H"), "guard"),
        (GOOD.replace("#endif\n", ""), "guard"),
        (GOOD.replace("#ifndef A_H\n", ""), "guard"),
        (GOOD.replace("float f", "\tfloat f"), "tab"),
        (GOOD.replace("1.0;", "1.0;" + " " * 100), "characters"),
        (GOOD + "// more\n" * 300, "lines"),
        ("", "first line"),
    ],
)
def test_bad_header_is_named(tmp_path, wrong, words):
    path = written(tmp_path, wrong)
    found = complaints(path)
    assert any(words in line for line in found)
    assert all(str(path) in line for line in found)
