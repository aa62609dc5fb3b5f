# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures one scene in a process of its own: ``python -m tools.bench.child``.

Kept results are not rendered again. The child reports on standard error: a line ``STEP paths`` has
the number of paths just rendered (Scene.work), ``KEPT paths`` that of a kept result.
"""

import argparse
import sys
from pathlib import Path

from scenes.leave import leave

from . import plan, store
from .measure import Measure


def main() -> None:
    """Measure the scene that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("plan", choices=plan.PLANS)
    parser.add_argument("scene")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--log", type=Path, required=True)
    parser.add_argument("--repeat", type=int, default=1, help="times the plan's rounds")
    arguments = parser.parse_args()
    scenes = {one.name: one for one in plan.PLANS[arguments.plan]}
    if arguments.scene not in scenes:
        parser.error(f"{arguments.scene}: the scenes of this plan are {', '.join(scenes)}")
    scene = scenes[arguments.scene]
    measure_scene(scene.repeated(arguments.repeat), arguments.folder, arguments.log)


def measure_scene(scene: plan.Scene, folder: Path, log: Path) -> None:
    """Render what `folder` lacks of a scene: its reference, then rounds of all variants."""
    measure = Measure(scene, log)
    path = store.reference_path(folder, scene)
    reference = store.load(path)
    kept = reference is not None
    if not kept:
        reference = measure.reference()
        store.save(path, reference)
    _tell(kept, scene.work(None, 2 * scene.reference_samples))
    for turn, top in enumerate(scene.tops):
        for variant in scene.variants:
            path = store.run_path(folder, scene, variant, turn)
            kept = store.load(path) is not None
            if not kept:
                store.save(path, measure.run(variant, turn, reference))
            _tell(kept, scene.work(variant, top))


def _tell(kept: bool, paths: int) -> None:
    print(f"{'KEPT' if kept else 'STEP'} {paths}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
    leave()
