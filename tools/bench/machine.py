# SPDX-License-Identifier: GPL-3.0-or-later
"""Describes the machine that times are measured on, without host name or paths."""

import os
import platform
import subprocess
from dataclasses import asdict, dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path


@dataclass(frozen=True)
class Machine:
    """What times depend on: ``cpu`` model, usable ``cores``, ``system``, ``blender`` version."""

    cpu: str
    cores: int
    system: str
    blender: str

    def as_dict(self) -> dict[str, str | int]:
        """The fields, for JSON."""
        return asdict(self)

    def __str__(self) -> str:
        return f"{self.cpu}, {self.cores} cores, {self.system}, Blender {self.blender}"


def this_machine() -> Machine:
    """The machine of this process."""
    cores = (
        len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    )
    return Machine(cpu_model(), cores, f"{platform.system()} {platform.machine()}", version("bpy"))


@cache
def cpu_model() -> str:
    """The processor's name, or its architecture if the system does not tell."""
    try:
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass  # not Linux
    if platform.system() == "Darwin":
        command = ["sysctl", "-n", "machdep.cpu.brand_string"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.stdout.strip():
            return done.stdout.strip()
    return platform.processor() or platform.machine()
