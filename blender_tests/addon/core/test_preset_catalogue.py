# SPDX-License-Identifier: GPL-3.0-or-later
"""The presets that the extension brings: their form, their physics, and files that are broken."""

import math
import re
import shutil
import time
import tomllib

import bpy
import numpy as np
import pytest

from addon.core.kinds import KINDS
from addon.core.presets import catalogue as library
from addon.core.presets.catalogue import finishes, preset, presets, problems
from addon.core.presets.files import Finish, Preset, PresetError
from blender_tests.addon.support import small_scene
from osl.oracle.fresnel import COS_82, F82Tint, IndexOfRefraction

GOLD = (library.FOLDER / "conductor" / "gold.toml").read_text(encoding="utf-8")

# The effective n and k reflect as much as a finite index can; 1 is beyond that.
MOST = 0.99

# Indices at 587.6 nm from handbooks and makers' data sheets, to three decimals.
PUBLISHED_INDICES = {
    "water": 1.333,
    "ice": 1.310,
    "ethanol": 1.361,
    "fused_quartz": 1.4585,
    "bk7_glass": 1.5168,
    "flint_glass": 1.6200,
    "dense_flint_glass": 1.8052,
    "acrylic": 1.491,
    "polycarbonate": 1.585,
    "salt": 1.5443,
    "fluorite": 1.4338,
    "calcite": 1.6584,
    "quartz": 1.5443,
    "sapphire": 1.768,
    "diamond": 2.417,
    "cubic_zirconia": 2.158,
}

# Linear colours at normal incidence and F82 tints that physicallybased.info published for the same
# measurements, worked out by others with other code.
PUBLISHED_COLOURS = {
    "aluminium": ((0.916, 0.923, 0.924), (0.91, 0.936, 0.959)),
    "brass": ((0.91, 0.778, 0.423), None),
    "beryllium": ((0.539, 0.533, 0.534), None),
    "iron": ((0.53, 0.513, 0.494), None),
    "manganese": ((0.606, 0.592, 0.573), None),
    "mercury": ((0.781, 0.78, 0.778), None),
    "nickel": ((0.697, 0.641, 0.563), None),
    "palladium": ((0.734, 0.7036, 0.662), None),
    "stainless_steel": ((0.669, 0.639, 0.598), None),
    "zinc": ((0.808, 0.844, 0.865), None),
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A copy of the presets that a test may damage."""
    copy = tmp_path / "presets"
    shutil.copytree(library.FOLDER, copy)
    monkeypatch.setattr(library, "FOLDER", copy)
    return copy


def test_there_are_enough_and_all_are_sound():
    assert problems() == ()
    counts = {kind: len(presets(kind)) for kind in KINDS}
    assert counts["CONDUCTOR"] >= 40
    assert counts["DIELECTRIC"] >= 40
    assert counts["DIFFUSE"] >= 15
    assert 16 <= len(finishes()) <= 24
    assert sum(counts.values()) == len(presets())


@pytest.mark.parametrize("made", [*presets(), *finishes()], ids=lambda made: made.identifier)
def test_values_are_legal_and_the_source_is_free(made):
    kinds = made.kinds if isinstance(made, Finish) else (made.kind,)
    for kind in kinds:
        for identifier, value in made.values.items():
            assert KINDS[kind].by_identifier[identifier].checked(value) == value
    assert made.source.licence == "CC0-1.0"
    if isinstance(made, Preset):
        assert re.fullmatch(r"https://[!-~]+", made.source.url)
        assert made.tags == tuple(tag.strip() for tag in made.tags)
        assert all(made.tags)
    else:
        assert (made.source.title, made.source.url) == ("Own choice", "")
    assert made.name == made.name.strip()
    assert "\n" not in made.description
    assert not made.description.endswith(".")


def test_they_are_sorted_and_no_name_comes_twice():
    kinds = [made.kind for made in presets()]
    assert kinds == sorted(kinds, key=list(KINDS).index)
    for group in (*(presets(kind) for kind in KINDS), finishes()):
        names = [made.name.casefold() for made in group]
        assert names == sorted(set(names))


def test_each_kind_gets_its_finishes():
    for kind in KINDS:
        assert finishes(kind) == tuple(made for made in finishes() if kind in made.kinds)
        assert len(finishes(kind)) >= 4
    assert library.finish("finish/matte").kinds == tuple(KINDS)
    brushed = library.finish("finish/brushed").values
    across = library.finish("finish/brushed_across").values
    assert brushed["Anisotropy"] >= 0.5
    assert dict(across) == dict(brushed) | {"Rotation": 0.25}


@pytest.mark.parametrize(("name", "index"), PUBLISHED_INDICES.items())
def test_indices_are_the_published_ones(name, index):
    assert preset(f"dielectric/{name}").values["IOR"] == pytest.approx(index, abs=1e-3)


@pytest.mark.parametrize(("name", "colours"), PUBLISHED_COLOURS.items())
def test_metals_have_the_published_colours(name, colours):
    values = preset(f"conductor/{name}").values
    base, tint = colours
    assert values["BaseColor"] == pytest.approx(base, abs=0.003)
    if tint:
        assert values["EdgeTint"] == pytest.approx(tint, abs=0.003)


def test_metals_look_as_they_should():
    def base(name):
        return preset(f"conductor/{name}").values["BaseColor"]

    for yellow in ("gold", "brass", "copper", "titanium_nitride", "caesium"):
        assert base(yellow)[0] > base(yellow)[1] > base(yellow)[2] + 0.1, yellow
    assert base("copper")[2] > base("gold")[2]
    assert min(base("silver")) > 0.95
    assert min(base("aluminium")) > 0.9
    assert base("purple_gold")[1] == min(base("purple_gold"))
    # more silver, less yellow
    alloys = ("pale_gold", "green_gold", "electrum", "white_electrum")
    assert np.all(np.diff([base(name)[2] for name in alloys]) > 0.05)


@pytest.mark.parametrize("made", presets("CONDUCTOR"), ids=lambda made: made.identifier)
def test_n_and_k_reflect_what_the_tint_does(made):
    values = {name: np.array(value) for name, value in made.values.items()}
    n, k = values["IOR"], values["Extinction"]
    normal = ((n - 1.0) ** 2 + k**2) / ((n + 1.0) ** 2 + k**2)
    assert normal == pytest.approx(np.minimum(values["BaseColor"], MOST), abs=0.003)
    # Where the tint is at its limit 1, the metal reflects more than the tint can say.
    cosine = np.array([COS_82])
    exact = IndexOfRefraction(n, k)(cosine)[0]
    tinted = F82Tint(values["BaseColor"], values["EdgeTint"])(cosine)[0]
    sayable = values["EdgeTint"] < 1.0
    assert exact[sayable] == pytest.approx(np.minimum(tinted, MOST)[sayable], abs=0.005)
    assert np.all(exact[~sayable] > np.minimum(tinted, MOST)[~sayable] - 0.005)


@pytest.mark.parametrize("made", presets("DIFFUSE"), ids=lambda made: made.identifier)
def test_facets_are_lighter_than_the_matte_surface_they_make(made):
    path = library.FOLDER / f"{made.identifier}.toml"
    measured = tomllib.loads(path.read_text(encoding="utf-8"))["measured"]["albedo"]
    facets = np.array(made.values["Color"])
    if made.values["Roughness"] == 0.0:
        assert facets == pytest.approx(measured, abs=1e-4)
    else:
        assert np.all(facets > measured)
        assert np.all(facets <= 1.0)


@pytest.mark.parametrize("name", ["brick", "office_paper"])
def test_a_rendered_matte_preset_has_the_measured_albedo(name, tmp_path):
    """A sphere seen by parallel rays shows each direction by its cosine, so the mean over its disc
    in a white world is the total albedo. Facets of the measured albedo would be 5 to 30 % darker.
    """
    from addon.material.node import new_material

    made = preset(f"diffuse/{name}")
    path = library.FOLDER / f"{made.identifier}.toml"
    measured = tomllib.loads(path.read_text(encoding="utf-8"))["measured"]["albedo"]
    scene, sphere = small_scene(osl=True)
    for light in [obj for obj in bpy.data.objects if obj.type == "LIGHT"]:
        bpy.data.objects.remove(light)
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1.0
    scene.cycles.max_bounces, scene.cycles.samples = 1, 256
    scene.render.film_transparent = True
    scene.camera.data.type, scene.camera.data.ortho_scale = "ORTHO", 2.2
    scene.camera.location, scene.camera.rotation_euler = (0, -5, 0), (math.pi / 2, 0, 0)
    sphere.data.materials.append(new_material("DIFFUSE", made.name, **made.values))
    scene.render.filepath = str(tmp_path / "sphere.exr")
    scene.render.image_settings.color_mode = "RGBA"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.array(image.pixels[:]).reshape(-1, 4).sum(axis=0)
    assert pixels[:3] / pixels[3] == pytest.approx(measured, rel=0.015)


@pytest.mark.nightly
@pytest.mark.timing
def test_all_are_read_in_little_more_time_than_their_toml(report):
    """Least of the processor's times of interleaved rounds, which say nothing of the machine."""
    files = list(library.FOLDER.glob("*/*.toml"))
    ours, toml = [], []
    for _ in range(7):
        library.clear_cache()
        start = time.process_time()
        presets(), finishes()
        middle = time.process_time()
        for path in files:
            tomllib.loads(path.read_text(encoding="utf-8"))
        ours.append(middle - start)
        toml.append(time.process_time() - middle)
    assert len(files) == len(presets()) + len(finishes())
    ratio = min(ours) / min(toml)
    value = f"{1e3 * min(ours):.0f} ms, {ratio:.2f} times what their TOML takes"
    report(f"reading {len(files)} presets and finishes", value, "2 times")
    assert ratio < 2.0


def test_files_are_read_once_and_anew_when_asked(folder):
    first = presets()
    assert presets()[0] is first[0]
    (folder / "conductor" / "gold.toml").unlink()
    assert len(presets()) == len(first)
    library.clear_cache()
    assert len(presets()) == len(first) - 1


def test_values_cannot_be_changed():
    gold = preset("conductor/gold")
    with pytest.raises(TypeError):
        gold.values["Roughness"] = 0.0
    with pytest.raises(AttributeError):
        gold.name = "Lead"


@pytest.mark.parametrize(
    ("lookup", "wrong", "message"),
    [
        (preset, "conductor/golf", "no preset 'conductor/golf' .did you mean conductor/gold"),
        (preset, "gold", "no preset 'gold'"),
        (preset, "", "no preset ''"),
        (preset, "finish/brushed", "no preset 'finish/brushed'"),
        (library.finish, "finish/brush", "did you mean finish/brushed"),
        (library.finish, "conductor/gold", "no finish 'conductor/gold'"),
    ],
)
def test_unknown_identifiers_are_refused_with_close_ones(lookup, wrong, message):
    with pytest.raises(PresetError, match=message):
        lookup(wrong)


@pytest.mark.parametrize("ask", [presets, finishes])
def test_unknown_kinds_are_refused(ask):
    with pytest.raises(ValueError, match="is 'METAL': use one of CONDUCTOR"):
        ask("METAL")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name = 'Gold", "is not TOML .*To mend it, correct that line"),
        (b'name = "\xff"', "is not UTF-8 .*To mend it, save it as UTF-8"),
        ("", "name is None"),
        (GOLD.replace("BaseColor", "BaseColour"), "'BaseColour' .did you mean BaseColor"),
        (GOLD.replace("BaseColor = [1.0", "BaseColor = [1.5"), "BaseColor is .*goes from 0 to 1"),
        (GOLD.replace("BaseColor = [1.0", "BaseColor = [nan"), "BaseColor is .*goes from 0 to 1"),
        (GOLD.replace("BaseColor = [1.0", "BaseColor = [true"), "true or false in it: give numb"),
        (GOLD.replace("BaseColor = [1.0, ", "BaseColor = ["), "BaseColor is .*give three numbers"),
        (GOLD.replace("[values]", "[values]\nRoughness = true"), "true or false in it: give numb"),
        (GOLD.replace("[values]", "[value]"), r"the table \[values\] is missing"),
        (GOLD.replace("[source]", "[sources]"), r"the table \[source\] is missing"),
        (re.sub(r"(?s)\[values\].*?\n\n", "[values]\n", GOLD), r"\[values\] is empty"),
        (GOLD.replace('licence = "CC0-1.0"', ""), "licence is None"),
        (GOLD.replace('name = "Gold"', "name = 79"), "name is 79 and not a line of text"),
        (GOLD.replace('name = "Gold"', 'name = " "'), "name is ' ' and not a line"),
        (GOLD.replace('name = "Gold"', 'name = "Gold\\nAu"'), "not a line of text"),
        (re.sub("tags = .*", 'tags = "yellow"', GOLD), "tags is 'yellow' and not a list"),
        (re.sub("tags = .*", "tags = [1]", GOLD), r"tags is \[1\] and not a list"),
    ],
)
def test_a_broken_file_is_named_with_its_remedy_and_the_others_stay(folder, text, message):
    path = folder / "conductor" / "gold.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(PresetError, match=f"gold.toml: .*{message}") as raised:
        library.read(path)
    assert "To mend it, " in str(raised.value)
    assert problems() == (str(raised.value),)
    names = [made.name for made in presets("CONDUCTOR")]
    assert "Gold" not in names
    assert {"Silver", "Copper"} <= set(names)
    with pytest.raises(PresetError, match="no preset 'conductor/gold'"):
        preset("conductor/gold")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (r"kinds = .*", "kinds = []", "kinds is empty"),
        (r"kinds = .*", 'kinds = ["METAL"]', "The kind of material is 'METAL': use one of"),
        (r"kinds = .*\n", "", "kinds is None"),
        (r'"Beckmann"', '"Blinn"', "Distribution is 'Blinn': use one of"),
        (r"Roughness = .*", "BaseColor = [1, 1, 1]", "DIELECTRIC has no 'BaseColor'"),
    ],
)
def test_a_broken_finish_is_refused(folder, old, new, message):
    path = folder / "finish" / "etched.toml"
    path.write_text(re.sub(old, new, path.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(PresetError, match=f"etched.toml: {message}"):
        library.read(path)
    assert len(problems()) == 1
    assert "Brushed" in [made.name for made in finishes()]


def test_other_files_folders_and_a_missing_one(folder, tmp_path):
    with pytest.raises(PresetError, match=r"cannot be read .*install the extension again"):
        library.read(folder / "conductor" / "none.toml")
    strange = tmp_path / "metal" / "gold.toml"
    strange.parent.mkdir()
    strange.write_text(GOLD, encoding="utf-8")
    with pytest.raises(PresetError, match="the folder 'metal' is not one of conductor, dielectric"):
        library.read(strange)
    (folder / "conductor" / "directory.toml").mkdir()
    shutil.rmtree(folder / "finish")
    assert finishes() == ()
    unreadable, missing = problems()
    assert "directory.toml: cannot be read" in unreadable
    assert "there are no presets here. Install the extension again" in missing
    assert len(presets("CONDUCTOR")) >= 40
