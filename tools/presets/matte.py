# SPDX-License-Identifier: GPL-3.0-or-later
"""The matte materials of physicallybased.info: name | name there | description | tags."""

MATTE = """
Asphalt | Asphalt (Fresh) | Fresh asphalt | ground, black
Blackboard | Blackboard | Surface to write on with chalk | paint, black
Bone | Bone | Bone | natural, white
Brick | Brick | Brick | building, red
Cardboard | Cardboard | Corrugated fibreboard | paper, brown
Charcoal | Charcoal | Charred wood | natural, black
Chocolate | Chocolate | Chocolate | food, brown
Concrete | Concrete | Concrete | building, gray, cement
Egg Shell Brown | Egg Shell (Brown) | Shell of a brown hen egg | natural, food, brown
Egg Shell White | Egg Shell (White) | Shell of a white hen egg | natural, food, white
Grass | Grass | Grass | natural, plant, green
Gray Card | Gray Card | Photographer's card of 18 percent | reference, gray
Lemon | Lemon | Lemon peel | food, plant, yellow
Musou Black | Musou Black | Very dark paint | paint, reference, black
Office Paper | Office Paper | White paper with optical brighteners | paper, white
Orange | Orange | Orange peel | food, plant, orange
Polystyrene Foam | Polystyrene (Foam) | Foamed polystyrene | plastic, white
Porcelain | Porcelain | Colour of porcelain, without its gloss | ceramic, white
Sand | Sand | Sand | ground, natural, yellow
Skin I | Skin I | Skin of type I on a scale from I, light, to VI, dark | body, skin
Skin II | Skin II | Skin of type II on a scale from I, light, to VI, dark | body, skin
Skin III | Skin III | Skin of type III on a scale from I, light, to VI, dark | body, skin
Skin IV | Skin IV | Skin of type IV on a scale from I, light, to VI, dark | body, skin
Skin V | Skin V | Skin of type V on a scale from I, light, to VI, dark | body, skin
Skin VI | Skin VI | Skin of type VI on a scale from I, light, to VI, dark | body, skin
Snow | Snow | Snow | ground, natural, white
Spectralon | Spectralon | Reference white of optics | reference, white
Terracotta | Terracotta | Fired clay | ceramic, building, clay, red
Tire | Tire | Rubber of a car tire | rubber, black
Toilet Paper | Toilet Paper | Paper tissue | paper, white
Toner | Toner (Black) | Black laser print on paper | paper, black
"""
