# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiled shaders are compared by what they do, whichever compiler wrote them."""

import pytest

from addon.core.oso import same_program

A_PROGRAM = """OpenShadingLanguage 1.00
# Compiled by one
shader small
param float Width 0.5 %meta{string,label,"Width"} %read{0,1}
local float ___1_x %read{1,2}
const float $const1 2
temp float $tmp1
code ___main___
	mul $tmp1 Width $const1 %line{3} %argrw{"wrr"}
	assign ___1_x $tmp1
	end
"""


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("___1_x", "___7_x", True),
        ("$tmp1", "$tmp9", True),
        ("# Compiled by one\n", "", True),
        ("%line{3}", "%line{8}", True),
        ("const1 2", "const1 3", False),
        ("mul", "add", False),
        ("Width 0.5", "Width 0.6", False),
        ("mul $tmp1 Width $const1", "mul $tmp1 $const1 Width", False),
        ("temp float", "temp color", False),
        ("\tend\n", "", False),
    ],
)
def test_same_program(old, new, same):
    assert old in A_PROGRAM
    assert same_program(A_PROGRAM, A_PROGRAM.replace(old, new)) is same
