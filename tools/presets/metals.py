# SPDX-License-Identifier: GPL-3.0-or-later
"""The metals: name | page of refractiveindex.info (shelf/book/page) | description | tags."""

METALS = """
Aluminium | main/Al/Cheng | Epitaxial film | light, white, aluminum
Beryllium | main/Be/Rakic-BB | Model fitted to several measurements | light, gray
Brass | other/Cu-Zn/Querry-Cu70Zn30 | 70 % copper, 30 % zinc | alloy, yellow
Caesium | main/Cs/Smith | Alkali metal, gold in colour | alkali, yellow, cesium
Calcium | main/Ca/Mathewson | Pure, at 298 K | alkaline earth, white
Chromium | main/Cr/Rakic-BB | Model fitted to several measurements | plating, gray, chrome
Cobalt | main/Co/Johnson | Pure, at room temperature | magnetic, gray
Commercial Bronze | other/Cu-Zn/Querry-Cu90Zn10 | 90 % copper, 10 % zinc | alloy, red, bronze
Copper | main/Cu/McPeak | Evaporated smooth film | red
Electrum | other/Au-Ag/Rioux-Au50Ag50 | 50 % gold, 50 % silver | alloy, precious, yellow
Gallium Arsenide | main/GaAs/Aspnes | Crystal, n-doped | semiconductor, gray
Germanium | main/Ge/Jellison | Crystal | semiconductor, gray
Gold | main/Au/Olmon-ev | Evaporated film | precious, yellow
Gold Single Crystal | main/Au/Olmon-sc | Single crystal | precious, yellow
Graphite | main/C/Djurisic-o | Ordinary ray; fitted to several measurements | mineral, black, carbon
Green Gold | other/Au-Ag/Rioux-Au70Ag30 | 70 % gold, 30 % silver | alloy, precious, yellow
Hematite | main/Fe2O3/Querry-o | Iron oxide, ordinary ray | mineral, black, iron oxide
Indium | main/In/Mathewson-298K | Pure, at 298 K | soft, white
Iridium | main/Ir/Schmitt-MS | Sputtered film | precious, white
Iron | main/Fe/Johnson | Pure iron without rust | magnetic, gray
Lead | main/Pb/Mathewson-298K | Pure, at 298 K | heavy, gray
Lithium | main/Li/Mathewson-298K | Pure, at 298 K | alkali, white
Lutetium | main/Lu/Garcia-Cortes | Film | rare earth, gray
Magnesium | main/Mg/Palm | Evaporated film, 25 nm | light, white
Magnetite | main/Fe3O4/Querry | Iron oxide | mineral, black, iron oxide
Manganese | main/Mn/Querry | Pure metal | gray
Mercury | main/Hg/Inagaki | Liquid at room temperature | liquid, white
Molybdenum | main/Mo/Kirillova | Pure metal | refractory, gray
Nickel | main/Ni/Johnson | Pure, as in nickel plating | plating, magnetic, white
Niobium | main/Nb/Golovashkin-293K | Pure, at 293 K | refractory, gray
Osmium | main/Os/Nemoshkalenko-o | Ordinary ray of the crystal | precious, blue
Palladium | main/Pd/Palm | Evaporated film, 200 nm | precious, white
Pale Gold | other/Au-Ag/Rioux-Au90Ag10 | 90 % gold, 10 % silver | alloy, precious, yellow
Permalloy | other/Ni-Fe/Tikuisis_bare150nm | Film of 80 % nickel, 20 % iron | alloy, magnetic, gray
Platinum | main/Pt/Tselin | Evaporated film, 80 nm | precious, white
Platinum Aluminide | other/PtAl2/Chen | PtAl2, bulk | alloy, precious, yellow
Potassium | main/K/Smith | Pure metal without oxide | alkali, white
Purple Gold | other/AuAl2/Chen | AuAl2, bulk; purple jewellery alloy | alloy, precious, purple
Red Brass | other/Cu-Zn/Querry-Cu85Zn15 | 85 % copper, 15 % zinc | alloy, red
Rhodium | main/Rh/Weaver | Pure, as in the plating of white gold | plating, precious, white
Rubidium | main/Rb/Smith | Pure metal without oxide | alkali, white
Silicon | main/Si/Green-2008 | Crystal, at 300 K | semiconductor, gray
Silver | main/Ag/McPeak | Evaporated smooth film | precious, white
Sodium | main/Na/Inagaki | Pure metal without oxide | alkali, white
Stainless Steel | other/stainless_steel/Karlsson-austenitic | Austenitic, as 316 | alloy, gray
Stainless Steel Ferritic | other/stainless_steel/Karlsson-ferritic | Ferritic | alloy, gray
Titanium | main/Ti/Johnson | Pure, at room temperature | light, gray
Titanium Nitride | main/TiN/Beliaev-sputtering | Sputtered film, gold in colour | coating, yellow
Tungsten | main/W/Weaver | Pure metal | refractory, gray, wolfram
Vanadium | main/V/Johnson | Pure, at room temperature | gray
White Electrum | other/Au-Ag/Rioux-Au30Ag70 | 30 % gold, 70 % silver | alloy, precious, white
Zinc | main/Zn/Werner-DFT | Calculated by density-functional theory | gray, galvanized
Zirconium | main/Zr/Querry | Pure metal | refractory, gray
"""
