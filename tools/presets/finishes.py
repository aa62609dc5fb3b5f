# SPDX-License-Identifier: GPL-3.0-or-later
"""The finishes: name | kinds | roughness | anisotropy | rotation | distribution | description.

Kinds are C (metal), D (glass) and M (matte). The values are our own choice, by eye and habit.
"""

FINISHES = """
Anodized | C | 0.4 | 0 | 0 | Beckmann | Even, fine-pored layer
Bead-Blasted | C D | 0.55 | 0 | 0 | Beckmann | Even satin of small round dents
Brushed | C | 0.45 | 0.8 | 0 | Beckmann | Parallel scratches along the tangent
Brushed Across | C | 0.45 | 0.8 | 0.25 | Beckmann | Parallel scratches across the tangent
Chalky | M | 1 | 0 | 0 | GGX | Loose powder, as rough as can be
Die-Cast | C | 0.5 | 0 | 0 | GGX | Skin of metal cast into a steel mould
Etched | C D | 0.45 | 0 | 0 | Beckmann | Even pits of an acid
Forged | C | 0.65 | 0 | 0 | GGX | Hammered and scaled
Frosted | D | 0.6 | 0 | 0 | GGX | Milky glass
Ground | C D | 0.8 | 0 | 0 | GGX | Coarse grinding powder
Hairline | C | 0.35 | 0.95 | 0 | Beckmann | Fine long scratches along the tangent
Honed | D M | 0.35 | 0 | 0 | Beckmann | Fine grinding without gloss
Machined | C | 0.4 | 0.6 | 0 | GGX | Traces of a lathe or a mill
Matte | C D M | 0.7 | 0 | 0 | GGX | No visible reflections
Mill Finish | C | 0.3 | 0.5 | 0 | GGX | As it leaves the rolls
Mirror | C D | 0.02 | 0 | 0 | GGX | Polished until it is clear
Polished | C D | 0.15 | 0 | 0 | GGX | Glossy with a slight haze
Raw | M | 0.85 | 0 | 0 | GGX | Broken or unworked
Sand-Cast | C | 0.9 | 0 | 0 | GGX | Grainy skin of a sand mould
Sandblasted | C D | 0.75 | 0 | 0 | Beckmann | Even, sharp grain
Satin | C D | 0.35 | 0 | 0 | GGX | Soft, wide highlights
Smooth | M | 0 | 0 | 0 | GGX | No microsurface at all
Worn | C | 0.3 | 0 | 0 | GGX | Polish that handling has dulled
"""
