# SPDX-License-Identifier: GPL-3.0-or-later
"""The comparison of times finds a slowdown and ignores the noise of a busy machine."""

import json
from dataclasses import replace

import numpy as np
import pytest

from blender_tests.tools.bench.synthetic import MACHINE, ROUNDS, timed
from tools.bench import __main__ as command
from tools.bench import check
from tools.bench.plan import PLANS

# Made-up seconds of a sample for the quick plan's variants.
SECONDS = {
    scene.name: {v.name: 0.02 + 0.005 * number for number, v in enumerate(scene.variants)}
    for scene in PLANS["quick"]
}


def busy(seed: int, rounds: int = ROUNDS, spread: float = 0.25) -> dict:
    """Findings on a machine whose other work adds a random share of time, `spread` in the mean."""
    random = np.random.default_rng(seed)
    return {
        scene.name: timed(
            scene,
            SECONDS[scene.name],
            1.0 + random.exponential(spread, (len(scene.variants), rounds)),
        )
        for scene in PLANS["quick"]
    }


def slowed(found: dict, scene: str, variant: str, factor: float) -> dict:
    one = found[scene]
    curve = one.curves[variant]
    slow = replace(curve, cpu=tuple(factor * time for time in curve.cpu))
    return found | {scene: replace(one, curves=one.curves | {variant: slow})}


@pytest.fixture
def stored() -> dict[str, check.Ratio]:
    return check.ratios(busy(0, spread=0.02))


def settled(stored, seed: int, change=lambda found: found) -> list[check.Growth]:
    calls = []

    def measured(names, times):
        calls.append(times)
        found = change(busy(seed, times * ROUNDS))
        return {name: found[name] for name in names}

    growths = check.settled(stored, measured)
    assert calls in ([1], [1, 3])
    return growths


def test_a_ratio_is_that_of_the_least_times():
    scene = PLANS["quick"][1]
    load = np.array([[1.5, 1.0, 1.1], [2.0, 1.0, 1.04]])
    one = timed(scene, {"Walk": 3.0, "Single": 2.0}, load)
    found = check.ratio(one.curves["Walk"], one.curves["Single"])
    assert found.value == pytest.approx(1.5)
    assert found.error == pytest.approx(np.hypot(0.1, 0.04))


def test_noise_passes(stored):
    assert not any(v.slower for seed in range(1, 41) for v in settled(stored, seed))


@pytest.mark.parametrize(("scene", "ours", "theirs"), check.CHECKED)
def test_a_slowdown_of_a_third_is_found_and_named(stored, scene, ours, theirs):
    for seed in range(1, 6):
        growths = settled(stored, seed, lambda found: slowed(found, scene, ours, 1.35))
        worst = {growth.name for growth in growths if growth.slower}
        assert f"{scene}: {ours} / {theirs}" in worst


def test_of_what_changed_by_1_3_with_little_noise_each_is_found(stored):
    for scene, ours, theirs in check.CHECKED:
        found = slowed(busy(3, spread=0.02), scene, ours, 1.3)
        (growth,) = (
            v
            for v in check.compare(stored, check.ratios(found))
            if v.name == f"{scene}: {ours} / {theirs}"
        )
        assert growth.slower
        assert 0.2 < growth.change < 0.4
        assert f"{growth.change:.0%} slower" in str(growth)


def test_the_margin_follows_the_spread_between_its_bounds():
    def margin(stored: float, found: float) -> float:
        return check.Growth("a: b / c", check.Ratio(1.0, stored), check.Ratio(1.0, found)).margin

    assert margin(0.0, 0.01) == check.SMALLEST_MARGIN
    assert margin(0.04, 0.03) == pytest.approx(3 * np.hypot(0.04, 0.03))
    assert margin(0.3, 5.0) == check.LARGEST_MARGIN < 0.3


def test_what_got_faster_passes(stored):
    growths = settled(stored, 1, lambda found: slowed(found, "showcase", "Walk", 0.5))
    assert not any(growth.slower for growth in growths)
    assert any("faster" in str(growth) for growth in growths)


def test_ratios_are_read_as_they_were_written(stored, tmp_path):
    path = tmp_path / "ratios.json"
    path.write_text(check.write_ratios(stored, MACHINE.as_dict()))
    found = check.read_ratios(path, "5.2.0")
    assert set(found) == set(stored)
    for name, one in found.items():
        assert one.value == pytest.approx(stored[name].value, abs=1e-5)


def damaged(how):
    content = json.loads(check.write_ratios(check.ratios(busy(0)), MACHINE.as_dict()))
    how(content)
    return json.dumps(content)


NAME = "showcase: Walk / Single"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "holds no ratios"),
        ("[1, 2]", "holds no ratios"),
        ('{"machine": {"blender": "5.2.3"}}', "holds no ratios"),
        (damaged(lambda c: c["ratios"].update({NAME: 3})), "holds no ratios"),
        (damaged(lambda c: c["ratios"][NAME].update(value=-1.0)), f"no positive ratio of {NAME}"),
        (damaged(lambda c: c["ratios"][NAME].update(error=float("nan"))), "no positive ratio"),
        (damaged(lambda c: c["ratios"].pop(NAME)), rf"another plan \({NAME}\)"),
        (damaged(lambda c: c["machine"].update(blender="4.5.3")), "with Blender 4.5.3"),
    ],
)
def test_stored_ratios_that_do_not_fit_are_refused(text, message, tmp_path):
    path = tmp_path / "ratios.json"
    path.write_text(text)
    with pytest.raises(check.RatiosError, match=message) as caught:
        check.read_ratios(path, "5.2.3")
    assert "--quick --record" in str(caught.value)


def test_a_missing_file_is_told(tmp_path):
    with pytest.raises(check.RatiosError, match=r"cannot be read .*--quick --record"):
        check.read_ratios(tmp_path / "ratios.json", "5.2.3")


def test_the_command_fails_with_names(stored, tmp_path, monkeypatch, capsys):
    path = tmp_path / "ratios.json"
    path.write_text(check.write_ratios(stored, command.this_machine().as_dict()))
    monkeypatch.setattr(command, "RATIOS", path)
    found = busy(1)
    monkeypatch.setattr(
        command, "_measured", lambda _, scenes, *__: {s.name: found[s.name] for s in scenes}
    )
    arguments = ["--check", "--cache", str(tmp_path)]
    assert command.main(arguments) == 0
    found = slowed(found, "slab_0.6", "Fitted", 2.0)
    assert command.main(arguments) == 1
    printed = capsys.readouterr()
    assert "SLOWER  slab_0.6: Fitted / Single" in printed.out
    assert "grew past their margins" in printed.err
    path.unlink()
    assert command.main(arguments) == 1
    assert "cannot be read" in capsys.readouterr().err
