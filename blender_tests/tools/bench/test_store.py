# SPDX-License-Identifier: GPL-3.0-or-later
"""Valid results are kept, and a run continues after them."""

from dataclasses import replace

import numpy as np
import pytest

from tools.bench import __main__ as command
from tools.bench import child, findings, shaders, store
from tools.bench.plan import BALLS, SINGLE, UNCORRELATED, Variant

SCENE = BALLS[0].with_variants(SINGLE, UNCORRELATED).shortened((2, 2))
RESULT = {"samples": np.array([1, 2]), "cpu": np.array(0.5)}


def test_a_result_is_read_as_it_was_kept(tmp_path):
    path = store.run_path(tmp_path / "new", SCENE, SCENE.variants[0], 0)
    assert store.load(path) is None
    store.save(path, RESULT)
    found = store.load(path)
    assert found.keys() == RESULT.keys()
    assert all(np.array_equal(found[key], value) for key, value in RESULT.items())
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 cut off", b"no archive", b"\x93NUMPY"])
def test_a_damaged_result_counts_as_none(content, tmp_path):
    path = tmp_path / "damaged.npz"
    path.write_bytes(content)
    assert store.load(path) is None


def test_a_result_cut_short_counts_as_none(tmp_path):
    path = tmp_path / "cut.npz"
    store.save(path, {"picture": np.random.default_rng(0).random((64, 64))})
    whole = path.read_bytes()
    for length in (len(whole) // 2, len(whole) - 10):
        path.write_bytes(whole[:length])
        assert store.load(path) is None
    inside = bytearray(whole)
    inside[len(whole) // 2] ^= 0xFF
    path.write_bytes(bytes(inside))
    assert store.load(path) is None


def test_a_result_holds_for_what_it_was_made_from_alone(tmp_path, monkeypatch):
    single = SCENE.variants[0]

    def path(scene=SCENE, variant=single, turn=0):
        return store.run_path(tmp_path, scene, variant, turn)

    others = [
        path(turn=1),
        path(variant=Variant(SINGLE, SINGLE, osl=False)),
        path(variant=Variant(SINGLE, SINGLE, values=(("Walks", 2),))),
        path(replace(SCENE, tops=(4, 2))),
        path(replace(SCENE, percentage=50)),
        path(replace(SCENE, values=(("Roughness", 0.2),))),
        path(replace(SCENE, reference="sun_white_ggx_0.5")),
    ]
    assert len({path(), *others}) == 1 + len(others)
    # more rounds or variants do not change the results that exist
    assert path(SCENE.repeated(3)) == path()
    assert path(SCENE.with_variants(SINGLE)) == path()
    before = path()
    monkeypatch.setattr(store, "_source_digest", lambda: "another shader")
    assert path() != before


def test_results_of_other_sources_are_refused(tmp_path, monkeypatch):
    for turn in range(2):
        for variant in SCENE.variants:
            store.save(store.run_path(tmp_path, SCENE, variant, turn), RESULT)
    store.save(store.reference_path(tmp_path, SCENE), RESULT)
    monkeypatch.setattr(store, "_source_digest", lambda: "another shader")
    with pytest.raises(findings.MissingResultError, match=r"sun_white lacks results.*measure it"):
        findings.read_scene(SCENE, tmp_path)


def test_a_scene_is_measured_and_goes_on_where_it_was(tmp_path, capfd):
    """Measures two rounds of two variants, then only the one result that was damaged."""
    log = tmp_path / "log"
    child.measure_scene(SCENE, tmp_path, log)
    assert capfd.readouterr().err.count("STEP ") == 5
    found = findings.read_scene(SCENE, tmp_path)
    single = found.curves[SINGLE]
    assert single.samples == (1, 2)
    assert 0.5 < single.squared[-1] ** 0.5 < 0.75  # all bounces but one are missing
    assert single.bias.bias == pytest.approx(single.squared[-1] ** 0.5, rel=0.05)
    assert min(single.cpu) > 0.0
    assert len(found.curves[UNCORRELATED].cpu) == 2
    assert found.machine.cores >= 1
    damaged = store.run_path(tmp_path, SCENE, SCENE.variants[1], 1)
    damaged.write_bytes(b"")
    before = {path: path.stat().st_mtime_ns for path in tmp_path.glob("*.npz")}
    child.measure_scene(SCENE, tmp_path, log)
    words = [line.partition(" ")[0] for line in capfd.readouterr().err.splitlines()]
    told = [word for word in words if word in ("KEPT", "STEP")]  # Blender may print too
    assert told == ["KEPT"] * 4 + ["STEP"]
    changed = {path for path, time in before.items() if path.stat().st_mtime_ns != time}
    assert changed == {damaged}


def test_a_missing_reference_names_its_file(tmp_path):
    lost = replace(SCENE, reference="sun_of_no_sphere", others=())
    with pytest.raises(OSError, match="sun_of_no_sphere"):
        child.measure_scene(lost, tmp_path, tmp_path / "log")


@pytest.mark.parametrize("patch", sorted(shaders.PATCHES))
@pytest.mark.parametrize("kind", ["CONDUCTOR", "DIELECTRIC", "DIFFUSE"])
def test_the_plain_estimators_are_made_from_todays_shaders(kind, patch):
    source = shaders.patched_source(kind, patch)
    assert all(new in source and old not in source for old, new in shaders.PATCHES[patch])


def test_a_patch_that_no_longer_fits_is_told(monkeypatch):
    monkeypatch.setitem(shaders.PATCHES, "old", (("int no_such_line;", ""),))
    with pytest.raises(ValueError, match="0 times, not once"):
        shaders.patched_source("DIFFUSE", "old")


def test_a_failed_scene_ends_the_command_and_keeps_the_rest(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command, "run_scenes", lambda *_: ["showcase: exit code 9"])
    assert command.main(["--trial", "--cache", str(tmp_path), "--output", str(tmp_path)]) == 1
    assert "Finished results are kept.\nshowcase: exit code 9" in capsys.readouterr().err
