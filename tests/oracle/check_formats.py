#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_formats.py DEBOND: unstructured meshes of a square and a cube, as Gmsh
makes them of random sizes at the corners, in many formats: J is the same to
1e-12, also from the geometry itself. Where a format keeps no names, Parts name
the sides by their places.
"""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from random_scenes import Draw, geometry
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])

# Extension, options of Gmsh, whether there are names.
FORMATS = {"1": ("msh", "-format msh1", False),
           "2.2": ("msh", "-format msh22", True),
           "2.2 binary": ("msh", "-format msh22 -bin", True),
           "2.2 partitioned": ("msh", "-format msh22 -part 3", True),
           "4.0": ("msh", "-format msh40", True),
           "4.1": ("msh", "-format msh41", True),
           "4.1 binary": ("msh", "-format msh41 -bin", True),
           "4.1 partitioned": ("msh", "-format msh41 -part 3", True),
           "4.1, second order": ("msh", "-format msh41 -order 2", True),
           "I-deas": ("unv", "-format unv -setnumber Mesh.SaveGroupsOfNodes 0", True),
           "Nastran": ("bdf", "-format bdf -setnumber Mesh.BdfFieldFormat 1", False),
           "Inria": ("mesh", "-format mesh", False)}
PLACES = {"left": "x < 1e-6", "right": "x > 1 - 1e-6", "bottom": "y < 1e-6"}


def check_body(dim):
    """In all formats."""
    geo = scenes.directory / f"body-{dim}.geo"
    geo.write_text(geometry(dim, Draw(dim)))
    load = ["Loads/Traction right=0.001; -0.001" + "; 0" * (dim - 2), f"Dimension={dim}",
            "Mesh/Source=file", "Boundary conditions/Clamped boundaries=left",
            "Boundary conditions/Contact boundary=bottom"]
    places = [f"Parts/{name}=boundary: {place}" for name, place in PLACES.items()]
    files = []
    for name, (extension, options, named) in FORMATS.items():
        file = geo.with_name(f"body-{dim}-{name}.{extension}")
        subprocess.run(["gmsh", f"-{dim}", geo, "-o", file] + options.split(), check=True,
                       stdout=subprocess.DEVNULL)
        files.append(load + [f"Mesh/File={file.name}"] + places * (not named))
    own, *found = scenes.solve_all([load + ["Mesh/File=" + geo.name]] + files)
    for name, result in zip(FORMATS, found, strict=True):
        # Nastran's files have few digits.
        scenes.close(f"{dim}D, {name}", result.get("functional"), own["functional"],
                     1e-5 if name == "Nastran" else 1e-12)


check_body(2)
check_body(3)
scenes.end()
