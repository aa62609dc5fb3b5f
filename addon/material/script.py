# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiles OSL and fills a script node, so that the file renders without this extension."""

import hashlib
import re
import sys
import tempfile
from pathlib import Path

import bpy

from ..core.oso import check_against
from ..core.parameter import Parameter
from .capture import captured_output
from .sockets import SOCKET_TYPES, socket_value

_FOLDER = re.compile(r'%filename\{"[^"]*[/\\]')


class OslUnavailableError(RuntimeError):
    """This Blender has no OSL compiler."""


class ShaderCompileError(RuntimeError):
    """The compiler refused a shader, or its files could not be written."""


def osl_compiler_available() -> bool:
    """Return whether this Blender has Cycles with Open Shading Language."""
    try:
        import _cycles
    except ImportError:
        return False
    return bool(_cycles.with_osl) and hasattr(_cycles, "osl_compile")


def compile_source(source: str) -> str:
    """Return the bytecode (.oso text) of an OSL source without includes of its own.

    Works only in the temporary folder. Raises OslUnavailableError if Blender has no OSL and
    ShaderCompileError, with the compiler's message, if it fails.
    """
    if not osl_compiler_available():
        raise OslUnavailableError(
            "This Blender was built without Open Shading Language. Use one from blender.org"
        )
    import _cycles

    try:
        with tempfile.TemporaryDirectory(prefix="microbounce_") as folder:
            osl, oso = Path(folder, "shader.osl"), Path(folder, "shader.oso")
            osl.write_text(source, encoding="utf-8")
            ok, message = captured_output(lambda: _cycles.osl_compile(str(osl), str(oso)))
            if not ok or not oso.is_file():
                detail = message.strip().replace(str(osl), osl.name) or "no message was given"
                raise ShaderCompileError(f"The shader does not compile: {detail}")
            return _without_paths(oso.read_text(encoding="utf-8"))
    except OSError as error:
        raise ShaderCompileError(
            f"The shader cannot be compiled in the temporary folder: {error}. Set a writable "
            "folder in the environment variable TMPDIR (TEMP on Windows)"
        ) from error


def _without_paths(bytecode: str) -> str:
    """Drop comments and shorten file names, so that a source gives the same bytecode everywhere."""
    lines = [line for line in bytecode.splitlines() if not line.startswith("#")]
    return _FOLDER.sub(r'%filename{"', "\n".join(lines)) + "\n"


def fill_script_node(
    node: bpy.types.Node,
    parameters: tuple[Parameter, ...],
    source: str,
    bytecode: str,
    text_name: str,
) -> bpy.types.Text:
    """Give a script node the sockets, source text and bytecode it lacks; return the text block.

    With an empty `bytecode` (no compiler in this Blender) the node never runs. Raises ValueError
    if the bytecode does not declare `parameters`; then nothing is changed.
    """
    if bytecode:
        check_against(parameters, bytecode)
    text = node.script
    if text is None:
        text = bpy.data.texts.new(text_name)
        text.from_string(source)
        node.mode = "INTERNAL"
        _assign_text(node, text)
    _ensure_sockets(node, parameters)
    set_bytecode(node, bytecode)
    return text


def set_bytecode(node: bpy.types.Node, bytecode: str) -> None:
    """Give a script node its bytecode, "" to take it away."""
    node.bytecode = bytecode
    # Cycles keeps shaders by this string, so it must change with the bytecode.
    node.bytecode_hash = hashlib.sha256(bytecode.encode()).hexdigest()[:32] if bytecode else ""


def _assign_text(node: bpy.types.Node, text: bpy.types.Text) -> None:
    """Set `node.script`.

    Blender then asks Cycles to compile. That fails with a traceback if `oslquery` cannot be
    imported (bpy from a wheel). It means nothing to the user, because sockets and bytecode are set
    here, so it is dropped. All other output goes to the console.
    """

    def assign() -> None:
        node.script = text

    _, printed = captured_output(assign)
    if printed and "No module named 'oslquery'" not in printed:
        print(printed, end="", file=sys.stderr)


def _ensure_sockets(node: bpy.types.Node, parameters: tuple[Parameter, ...]) -> None:
    present = {socket.identifier for socket in node.inputs}
    for parameter in parameters:
        if parameter.identifier in present:  # Cycles made them while the text was assigned
            continue
        socket = node.inputs.new(
            SOCKET_TYPES[parameter.type], parameter.label, identifier=parameter.identifier
        )
        socket.default_value = socket_value(parameter, parameter.default)
        socket.hide_value = parameter.type in ("NORMAL", "TANGENT")
    present = {socket.identifier for socket in node.outputs}
    for kind, name in (("NodeSocketShader", "BSDF"), ("NodeSocketFloat", "Active")):
        if name not in present:
            node.outputs.new(kind, name, identifier=name)
