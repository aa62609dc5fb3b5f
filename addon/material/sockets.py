# SPDX-License-Identifier: GPL-3.0-or-later
"""Parameters as sockets of nodes."""

from ..core.parameter import Parameter

SocketValue = float | int | bool | str | list[float]

SOCKET_TYPES = {
    "COLOR": "NodeSocketColor",
    "FLOAT": "NodeSocketFloat",
    "INT": "NodeSocketInt",
    "VECTOR": "NodeSocketVector",
    "NORMAL": "NodeSocketVector",
    "TANGENT": "NodeSocketVector",
}


def socket_value(parameter: Parameter, value: object) -> object:
    """Return `value`, checked, as a node socket of this parameter takes it (colours have alpha)."""
    checked = parameter.checked(value)
    return (*checked, 1.0) if parameter.type == "COLOR" else checked


def plain_value(value: object) -> SocketValue:
    """Return the value of a socket as plain data: vectors and colours as lists."""
    return list(value) if hasattr(value, "__len__") and not isinstance(value, str) else value


def value_text(value: SocketValue) -> str:
    """Return `value` in words for users."""
    if isinstance(value, list):
        return "(" + ", ".join(map(value_text, value)) + ")"
    return str(value) if isinstance(value, bool | str) else f"{value:.4g}"
