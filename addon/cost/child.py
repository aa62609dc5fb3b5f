# SPDX-License-Identifier: GPL-3.0-or-later
"""The script that the other Blender runs: measures the job in the file that is its last argument.

Its errors are the last line on standard error. It ends when its standard input closes, so that it
does not outlive the Blender that started it.
"""

import importlib.util
import os
import sys
import threading
from pathlib import Path

_NAME = "microbounce_of_the_cost"


def _main(job: str) -> None:
    folder = Path(__file__).resolve().parents[1]
    spec = importlib.util.spec_from_file_location(
        _NAME, folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    package = importlib.util.module_from_spec(spec)
    sys.modules[_NAME] = package
    spec.loader.exec_module(package)
    importlib.import_module(f"{_NAME}.cost.measure").measure_job(Path(job))


def _end_with_input() -> None:
    sys.stdin.buffer.read()
    os._exit(1)


if __name__ == "__main__":
    threading.Thread(target=_end_with_input, daemon=True).start()
    status = 1
    try:
        import bpy  # noqa: F401 - Blender as a Python module starts here

        _main(sys.argv[-1])
        status = 0
    except Exception as error:  # noqa: BLE001 - handed on: the caller shows the last line
        print(str(error).strip().removeprefix("Error: ") or repr(error), file=sys.stderr)
    finally:
        # Blender's own tear-down was seen to hang.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
