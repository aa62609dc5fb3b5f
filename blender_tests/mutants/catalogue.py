# SPDX-License-Identifier: GPL-3.0-or-later
"""The faults that the fast tier has to notice, each a small edit of one file."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mutant:
    """One fault.

    name  -- what is broken, in words
    path  -- the file, from the root of the repository
    old   -- text that occurs once in it
    new   -- what takes its place
    tests -- files or names of tests that are expected to notice; pytest's arguments
    """

    name: str
    path: str
    old: str
    new: str
    tests: tuple[str, ...]

    def apply(self, text: str) -> str:
        """Return the file's text with the fault; raises ValueError unless `old` occurs once."""
        if text.count(self.old) != 1:
            raise ValueError(
                f"{self.path} has {text.count(self.old)} times {self.old!r}, which the mutant "
                f"'{self.name}' replaces: write it as it is now"
            )
        return text.replace(self.old, self.new)


_PICTURES = ("blender_tests/render/test_pictures.py",)


def _addon(*files: str) -> tuple[str, ...]:
    return tuple(f"blender_tests/addon/{file}" for file in files)


_SHADERS = [
    Mutant(
        "anisotropic lobe tilts away from the viewer",
        "osl/include/fitted_anisotropic.h",
        "float steep = stretched_cosine(s) / s[2];",
        "float steep = -stretched_cosine(s) / s[2];",
        _PICTURES,
    ),
    Mutant(
        "anisotropic lobe stretched by the other alpha",
        "osl/include/fitted_anisotropic.h",
        "steep * vector(surface.alpha_x * s[0], surface.alpha_y * s[1], 0)",
        "steep * vector(surface.alpha_y * s[0], surface.alpha_x * s[1], 0)",
        _PICTURES,
    ),
    Mutant(
        "table axes swapped",
        "osl/include/table.h",
        "first + i * cosines + j",
        "first + j * cosines + i",
        ("blender_tests/osl/test_tables.py",),
    ),
    Mutant(
        "table cell on the wrong side of its diagonal",
        "osl/include/table.h",
        "((s > t) ? cosines : 1)",
        "((s > t) ? 1 : cosines)",
        ("blender_tests/osl/test_tables.py",),
    ),
    Mutant(
        "refraction forgets what the facets add",
        "osl/include/refraction.h",
        "float rest = sent[i] * (leave[i] - part * carried[i]);",
        "float rest = 0;",
        _PICTURES,
    ),
    Mutant(
        "refraction's facets count twice",
        "osl/include/refraction.h",
        "material.tint * (rest / facets)",
        "material.tint * (2 * rest / facets)",
        _PICTURES,
    ),
    Mutant(
        "Schlick's exponent is 4",
        "osl/include/fresnel.h",
        "float s5 = s * s * s * s * s;",
        "float s5 = s * s * s * s;",
        ("blender_tests/osl/test_fresnel.py",),
    ),
    Mutant(
        "glass reflects p-polarised light as s-polarised",
        "osl/include/fresnel.h",
        "return min(0.5 * (s * s + p * p), 1);",
        "return min(s * s, 1);",
        ("blender_tests/osl/test_fresnel.py",),
    ),
    Mutant(
        "the chance to leave counts shadowing once",
        "osl/include/smith.h",
        "return (stays > 0) ? leaves / (leaves + stays) : 1;",
        "return o[2] / (o[2] + excess);",
        ("blender_tests/osl/test_smith.py",),
    ),
    Mutant(
        "GGX's caps keep their width below the horizon",
        "osl/include/visible.h",
        "float width = (w[2] >= 0) ? 1 + w[2] :",
        "float width = (w[2] >= 0) ? 1 :",
        ("blender_tests/osl/test_visible.py",),
    ),
    Mutant(
        "light inside glass sees the index upside down",
        "osl/include/material.h",
        "return below ? 1 / material.ior : material.ior;",
        "return below ? material.ior : 1 / material.ior;",
        _PICTURES,
    ),
    Mutant(
        "a mean Fresnel factor with exponent 4",
        "osl/include/fitted.h",
        "min(s2 * s2 * s, 1)",
        "min(s2 * s2, 1)",
        ("blender_tests/osl/test_fresnel.py",),
    ),
    Mutant(
        "a series of bounces without its first weight",
        "osl/include/fitted.h",
        "return ((1 - rest) / (1 - kept)) * (1 - beyond);",
        "return (1 - rest) * (1 - beyond);",
        _PICTURES,
    ),
    Mutant(
        "Exact smooths its exits",
        "osl/include/walks.h",
        "if (accuracy.quality == QUALITY_EXACT)",
        "if (accuracy.quality > QUALITY_EXACT)",
        _addon("scene/test_exact.py"),
    ),
    Mutant(
        "walks lose the weight of their candidates",
        "osl/include/walk.h",
        "kept /= candidates;",
        "kept = 1;",
        _PICTURES,
    ),
    Mutant(
        "a path that crosses stays on its side",
        "osl/include/walk.h",
        "next.below = walker.below != vertex.crossed;",
        "next.below = walker.below;",
        _PICTURES,
    ),
    Mutant(
        "the matte lobe tilts away from the viewer",
        "osl/include/fitted_diffuse.h",
        "sin(DIFFUSE_TILT) * side",
        "-sin(DIFFUSE_TILT) * side",
        _PICTURES,
    ),
    Mutant(
        "glass sends its further light to the wrong side",
        "osl/include/fitted_dielectric.h",
        "color back = inside ? further - thinner : thinner;",
        "color back = inside ? thinner : further - thinner;",
        _PICTURES,
    ),
    Mutant(
        "a NaN reaches the closures",
        "osl/include/inputs.h",
        "return isfinite(value) ? clamp(value, low, high) : fallback;",
        "return clamp(value, low, high);",
        ("blender_tests/render/test_inputs.py",),
    ),
    Mutant(
        "Fitted is Walk",
        "osl/include/fitted.h",
        "accuracy.quality == QUALITY_FITTED",
        "accuracy.quality == QUALITY_WALK",
        _PICTURES,
    ),
    Mutant(
        "glass seen from behind keeps the index of its front",
        "osl/microbounce_dielectric.osl",
        "backfacing() ? 1 / index : index",
        "index",
        _PICTURES,
    ),
    Mutant(
        "roughness is alpha",
        "osl/include/inputs.h",
        "  alpha *= alpha;\n",
        "",
        _PICTURES,
    ),
    Mutant(
        "a number of a table",
        "osl/tables/conductor_lobes.h",
        ".01144,.02157,.02974",
        ".01144,.03157,.02974",
        ("blender_tests/osl/test_tables.py",),
    ),
    Mutant(
        "GGX and Beckmann change places",
        "osl/include/inputs.h",
        "surface.beckmann = distribution == BECKMANN;",
        "surface.beckmann = distribution == GGX;",
        _PICTURES,
    ),
]

_ADDON = [
    Mutant(
        "a socket of Principled goes to its neighbour",
        "addon/convert/principled.py",
        'Rotation="Anisotropic Rotation"',
        'Rotation="Anisotropic"',
        _addon("convert"),
    ),
    Mutant(
        "conversion loses links",
        "addon/convert/replace.py",
        "_link(tree, source, targets[other], link.is_muted)",
        "pass",
        _addon("convert"),
    ),
    Mutant(
        "conversion loses animation",
        "addon/convert/replace.py",
        "move_curves(curves, list(inputs), new, made.carried)",
        "pass",
        _addon("convert"),
    ),
    Mutant(
        "glass takes its colour unrooted",
        "addon/convert/principled.py",
        '_ROOT = Formula((Operation("GAMMA", 0.5),))',
        '_ROOT = Formula((Operation("GAMMA", 1.0),))',
        _addon("convert"),
    ),
    Mutant(
        "check ends well whatever it found",
        "addon/command/check.py",
        "return 1 if found else 0",
        "return 0",
        _addon("command"),
    ),
    Mutant(
        "files are saved without --save",
        "addon/command/files.py",
        "if arguments.save_as is None and not arguments.save:",
        "if arguments.save_as is None and arguments.save is None:",
        _addon("command"),
    ),
    Mutant(
        "a group's stamp forgets the shader",
        "addon/material/group.py",
        "hashlib.sha256(made_from.encode())",
        "hashlib.sha256(kind.identifier.encode())",
        _addon("material"),
    ),
    Mutant(
        "an update loses values",
        "addon/material/update.py",
        "if name in values:",
        "if name not in values:",
        _addon("material"),
    ),
    Mutant(
        "an update loses muted links",
        "addon/material/update.py",
        "tree.links.new(source, inputs[name]).is_muted = muted",
        "tree.links.new(source, inputs[name])",
        _addon("material"),
    ),
    Mutant(
        "the farm check misses missing bytecode",
        "addon/farm/shaders.py",
        "if not script.bytecode:",
        "if script.bytecode is None:",
        _addon("farm"),
    ),
    Mutant(
        "the fallback's matte takes our roughness",
        "addon/material/fallback.py",
        "roughness.inputs[1].default_value = MATTE_ROUGHNESS",
        "roughness.inputs[1].default_value = 1.0",
        _addon("material"),
    ),
    Mutant(
        "the cost tool counts noise as bias",
        "addon/core/cost/statistics.py",
        "bias_square = float(np.mean(to_first * to_second) - same) / ordered_pairs",
        "bias_square = float(np.mean(to_first * to_second)) / ordered_pairs",
        _addon("core"),
    ),
    Mutant(
        "the analysis takes roughness for alpha",
        "addon/core/analysis/prediction.py",
        "roughness * roughness / (1.0",
        "roughness / (1.0",
        _addon("core"),
    ),
]

_SOURCES = [
    Mutant(
        "the oracle's F82 has its dip elsewhere",
        "osl/oracle/fresnel.py",
        "COS_82 = 1.0 / 7.0",
        "COS_82 = 1.0 / 6.0",
        ("blender_tests/oracle/test_fresnel.py",),
    ),
]

MUTANTS = [*_SHADERS, *_ADDON, *_SOURCES]
