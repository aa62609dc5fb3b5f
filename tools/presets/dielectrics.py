# SPDX-License-Identifier: GPL-3.0-or-later
"""The dielectrics: clear and tinted ones of refractiveindex.info, and physicallybased.info's."""

# name | page (shelf/book/page) | description | tags
CLEAR = """
Acetone | organic/acetone/Rheims | Solvent | liquid
Acrylic | organic/poly_methyl_methacrylate/Sultanova | PMMA, plexiglass | plastic
ALON | other/AlN-Al2O3/Hartnett-6.69 | Aluminium oxynitride, clear armour | ceramic
Barium Fluoride | main/BaF2/Malitson | Optical crystal | crystal
Benzene | organic/benzene/Moutzouris | Solvent | liquid
BK7 Glass | specs/SCHOTT-optical/N-BK7 | Borosilicate crown, the common optical glass | glass
Borosilicate Glass | specs/SCHOTT-misc/BOROFLOAT33 | Laboratory and kitchen glass | glass, Pyrex
Calcite | main/CaCO3/Ghosh-o | Ordinary ray | crystal, mineral
Carbon Disulfide | main/CS2/Chemnitz | Solvent of high dispersion | liquid
Cellulose | organic/cellulose/Sultanova | Clear film | plastic
Chloroform | organic/chloroform/Kedenburg | Solvent | liquid
Chrysoberyl | main/BeAl2O4/Walling-β | Middle index of the crystal | crystal, gem, mineral
Crown Glass | specs/SCHOTT-optical/N-K5 | N-K5 | glass
Cubic Zirconia | other/ZrO2-Y2O3/Wood | Zirconia with 12 % yttria | crystal, gem
Cyclo Olefin Polymer | other/ZeonexE48R/Sultanova | Zeonex E48R, for lenses | plastic
Cyclohexane | organic/cyclohexane/Rheims | Solvent | liquid
Dense Flint Glass | specs/SCHOTT-optical/SF6 | SF6, leaded | glass, lead crystal
Diamond | main/C/Peter | Gem of high dispersion | crystal, gem, mineral
Display Glass | specs/CORNING-display/EagleXG | Thin alkali-free glass of screens | glass
Ethanol | organic/ethanol/Rheims | Alcohol | liquid, spirit
Ethylene Glycol | organic/ethylene_glycol/El-Kashef | Antifreeze | liquid
Flint Glass | specs/SCHOTT-optical/F2 | F2, leaded | glass
Fluorite | main/CaF2/Malitson | Calcium fluoride | crystal, mineral
Fluorozirconate Glass | glass/ZBLAN/Gan | ZBLAN | glass
Fused Quartz | main/SiO2/Malitson | Pure silica glass | glass, silica
Gallium Phosphide | main/GaP/Jellison | Orange semiconductor, without its colour | crystal
Glycerol | organic/glycerol/Gupta | Thick sweet liquid | liquid, glycerin
Heavy Flint Glass | specs/SCHOTT-optical/N-SF11 | N-SF11 | glass
Ice | main/H2O/Warren-2008 | Water ice at -7 degrees Celsius | natural, water
Isopropanol | organic/propanol/Kozma | Rubbing alcohol | liquid
Lanthanum Flint Glass | specs/SCHOTT-optical/N-LASF9 | N-LASF9, of high index | glass
Lithium Fluoride | main/LiF/Li | Optical crystal of low index | crystal
Lithium Niobate | main/LiNbO3/Zelmon-o | Ordinary ray | crystal
Magnesium Fluoride | main/MgF2/Dodge-o | Ordinary ray; lens coatings | crystal, coating
Magnesium Oxide | main/MgO/Stephens | Periclase | crystal, mineral
Methanol | organic/methanol/Moutzouris | Alcohol | liquid
Moissanite | main/SiC/Wang-6H-o | Silicon carbide 6H, ordinary ray | crystal, gem
Polycarbonate | organic/polycarbonate/Sultanova | Tough clear plastic | plastic, PC
Polyetherimide | organic/polyetherimide/Zhang | Ultem, without its amber colour | plastic, PEI
Polyethylene Terephthalate | organic/polyethylene_terephthalate/Zhang | Bottles | plastic, PET
Polylactic Acid | organic/polylactic_acid/Bodurov | Bioplastic | plastic, PLA
Polystyrene | organic/polystyrene/Sultanova | Clear brittle plastic | plastic, PS
Polyvinyl Alcohol | organic/polyvinyl_alcohol/Schnepf | Soluble film | plastic, PVA
Polyvinyl Chloride | organic/polyvinil_chloride/Zhang | Clear film | plastic, PVC, vinyl
Quartz | main/SiO2/Ghosh-o | Rock crystal, ordinary ray | crystal, mineral
Rutile | main/TiO2/Devore-o | Titanium dioxide, ordinary ray | crystal, mineral
Salt | main/NaCl/Li | Halite, table salt | crystal, mineral
Sapphire | main/Al2O3/Malitson-o | Colourless corundum, ordinary ray | crystal, gem, mineral
Silicone | organic/polydimethylsiloxane/Schneider-Sylgard184 | PDMS rubber, Sylgard 184 | plastic
Soda-Lime Glass | glass/soda-lime/Rubin-clear | Windows and bottles | glass
Sphalerite | main/ZnS/Debenham | Cubic zinc sulfide | crystal, mineral
Spinel | main/MgAl2O4/Tropf | Magnesium aluminate | crystal, gem, mineral
Strontium Titanate | main/SrTiO3/Bond | Diamond simulant | crystal, gem
Styrene Acrylonitrile | other/C8H8_n-C3H3N_m/Sultanova | Clear plastic of housewares | plastic, SAN
Sylvite | main/KCl/Li | Potassium chloride | crystal, mineral
Toluene | organic/toluene/Moutzouris | Solvent | liquid
Water | main/H2O/Daimon-20.0C | 20 degrees Celsius | liquid, natural
YAG | main/Y3Al5O12/Zelmon | Yttrium aluminium garnet | crystal, gem
Zinc Selenide | main/ZnSe/Connolly | Yellow infrared glass, without its colour | crystal
"""

# name | page | description | tags | thickness of the pane in mm that has this colour
TINTED = """
Soda-Lime Glass Bronze | glass/soda-lime/Rubin-bronze | Tinted window | glass, tinted | 6
Soda-Lime Glass Gray | glass/soda-lime/Rubin-grey | Tinted window | glass, tinted | 6
Soda-Lime Glass Green | glass/soda-lime/Rubin-green | Tinted window | glass, tinted | 6
"""

# name | name at physicallybased.info | description | tags
COLOURED = """
Amber | Amber | Fossil resin | natural, gem, yellow
Apple Juice | Juice (Apple) | Apple juice; its colour depends on the depth | liquid, drink, yellow
Beer | Beer (Pale Lager) | Pale lager; its colour depends on the depth | liquid, drink, yellow
Coffee | Coffee | Black coffee; its colour depends on the depth | liquid, drink, brown
Cola | Cola | Cola; its colour depends on the depth | liquid, drink, brown
Cooking Oil | Cooking Oil | Vegetable oil | liquid, food, yellow
Cornea | Eye (Cornea) | Front of the eye | body
Gasoline | Gasoline | Fuel | liquid, yellow
Honey | Honey (Liquid) | Liquid honey | liquid, food, yellow
Polypropylene | Plastic (PP) | Tough plastic | plastic, PP
Polyurethane | Plastic (PUR) | Clear coats of paint | plastic, PUR, coating
Red Wine | Wine (Red) | Red wine; its colour depends on the depth | liquid, drink, red
White Wine | Wine (White) | White wine; its colour depends on the depth | liquid, drink, yellow
"""
