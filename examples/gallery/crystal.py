#!/usr/bin/env python3
"""crystal.pov as ASE exports it (the Atomic Simulation Environment, Debian's python3-ase): a block of the perovskite
calcium titanate with a corner cut away. `python3 crystal.py` writes the file anew.
SPDX-License-Identifier: MIT
"""
from ase.io.pov import get_bondpairs, write_pov
from ase.spacegroup import crystal

COLOURS = {"Ca": (0.16, 0.40, 0.62), "Ti": (0.84, 0.84, 0.86), "O": (0.80, 0.10, 0.07)}
RADII = {"Ca": 0.95, "Ti": 0.62, "O": 0.48}

cell = 3.84
atoms = crystal(["Ca", "Ti", "O"], [(0.5, 0.5, 0.5), (0, 0, 0), (0.5, 0, 0)], spacegroup=221,
                cellpar=[cell, cell, cell, 90, 90, 90]).repeat((3, 3, 3))
away = [atom.index for atom in atoms if atom.x / cell + atom.y / cell + atom.z / cell > 6.2]
del atoms[away]
symbols = atoms.get_chemical_symbols()
bonds = [pair for pair in get_bondpairs(atoms, radius=0.86)
         if {symbols[pair[0]], symbols[pair[1]]} == {"Ti", "O"} and not any(pair[2])]
write_pov("crystal.pov", atoms, rotation="-68x,-32y,12z", colors=[COLOURS[name] for name in symbols],
          radii=[RADII[name] for name in symbols], show_unit_cell=0,
          povray_settings={"canvas_width": 480, "transparent": False, "bondatoms": bonds, "bondlinewidth": 0.17,
                           "textures": ["ase3"] * len(atoms), "camera_type": "perspective", "camera_dist": 60,
                           "area_light": [(20, 30, 40), "White", 8, 8, 7, 7]})
