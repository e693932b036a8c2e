"""Pictures of molecules and crystals from ASE's atoms (https://wiki.fysik.dtu.dk/ase): its colors, radii and cell.

ASE is imported when it is asked for only; what it reads, this draws. SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Optional, Union

import numpy as np

from ._colors import srgb
from ._errors import UsageError
from .image import Image
from .looks import Look
from .scene import Scene

FINISH = "ambient 0.25 diffuse 0.75 specular 0.25 roughness 0.03"


def scene(atoms, radius_scale: float = 0.5, bonds: Union[bool, np.ndarray] = True, bond_radius: float = 0.15,
          cell: bool = True, finish: Optional[str] = None, look: Union[str, Look, None] = None) -> Scene:
    """A Scene of the atoms, in ångström, with two lights on white, or in a look of Scene.

    radius_scale  of ASE's covalent radii
    bonds   True: between atoms that are nearer than 1.15 times the sum of their covalent radii; or pairs (m, 2)
    cell    the edges of the cell, where there is one
    """
    from ase.data import covalent_radii  # pylint: disable=import-outside-toplevel
    from ase.data.colors import jmol_colors  # pylint: disable=import-outside-toplevel
    numbers, places = atoms.get_atomic_numbers(), atoms.get_positions()
    if len(numbers) == 0:
        raise UsageError("there are no atoms to draw")
    made, colors = Scene(look=look), srgb(jmol_colors[numbers])
    finish = FINISH if finish is None and look is None else finish
    made.spheres(places, radius_scale * covalent_radii[numbers], colors, finish, name="atoms")
    if bonds is True:
        from ase.neighborlist import neighbor_list  # pylint: disable=import-outside-toplevel
        open_atoms = atoms.copy()
        open_atoms.pbc = False
        first, second = neighbor_list("ij", open_atoms, list(1.15 * covalent_radii[numbers]))
        bonds = np.stack((first, second), axis=1)[first < second]
    if bonds is not False:
        made.bonds(places, bonds, bond_radius, center_colors=colors, finish=finish)
    edges = np.array(atoms.cell)
    if cell and np.any(edges):
        corners = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
        pairs = np.array([(i, i | 1 << k) for i in range(8) for k in range(3) if not i >> k & 1])
        pairs = pairs[[bool(np.any(edges[int(np.log2(b - a))])) for a, b in pairs]]
        made.bonds(corners @ edges, pairs, 0.04, (0.2, 0.2, 0.2), name="cell",
                   finish="ambient 0.5" if look is None else None)
    if look is not None:
        return made
    low, high = made.box()
    size = float(np.linalg.norm(high - low))
    made.light((low + high) / 2 + size * np.array((-2.0, 3.0, 4.0)), 0.9)
    made.light((low + high) / 2 + size * np.array((4.0, 1.0, 2.0)), 0.35, shadowless=True)
    made.background(1.0)
    return made


def render(atoms, width: int = 640, height: int = 480, direction=(0.0, 0.0, -1.0), up=(0.0, 1.0, 0.0),
           samples: Optional[float] = None, parallel: bool = True, **more) -> Image:
    """A picture of the atoms that fills the frame, seen along `direction`; `parallel` is ASE's own projection.

    What `scene` and Scene.render take besides may be given, too: bonds=False, target_error=0.002.
    """
    names = ("radius_scale", "bonds", "bond_radius", "cell", "finish", "look")
    has_goal = more.get("target_error") or more.get("time_limit")
    samples = 16 if samples is None and more.get("look") is None and not has_goal else samples
    with scene(atoms, **{name: more.pop(name) for name in names if name in more}) as made:
        made.camera(fit=True, direction=direction, up=up, width=0 if parallel else None)
        return made.render(width, height, samples=samples, **more)
