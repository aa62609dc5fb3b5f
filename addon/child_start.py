# SPDX-License-Identifier: GPL-3.0-or-later
"""The script that every other Blender of ours starts with (child_blender.py).

Arguments after "--": a module of the extension, such as "cost.measure", and the texts for its
run(). The extension is loaded, but not registered. An error is the last line on standard error. The
process ends when its standard input closes, so it does not outlive the Blender that started it.
"""

import importlib.util
import os
import sys
import threading
from pathlib import Path

_NAME = "microbounce_in_a_child"


def _main(module: str, *arguments: str) -> None:
    folder = Path(__file__).resolve().parent
    spec = importlib.util.spec_from_file_location(
        _NAME, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules[_NAME] = package
    spec.loader.exec_module(package)
    importlib.import_module(f"{_NAME}.{module}").run(*arguments)


def _end_with_input() -> None:
    sys.stdin.buffer.read()
    os._exit(1)


if __name__ == "__main__":
    threading.Thread(target=_end_with_input, daemon=True).start()
    status = 1
    try:
        import bpy  # noqa: F401 - Blender as a Python module starts here

        _main(*sys.argv[sys.argv.index("--") + 1 :])
        status = 0
    except Exception as error:  # noqa: BLE001 - handed on: the caller shows the last line
        print(str(error).strip().removeprefix("Error: ") or repr(error), file=sys.stderr)
    finally:
        # Blender's own tear-down was seen to hang.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
