#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_formats.py DEBOND: unstructured meshes of a square and a cube, as Gmsh
makes them of random sizes at the corners, in many formats: J is the same to
1e-12, also from the geometry itself. Where a format keeps no names, Parts name
the sides by their places.
"""

import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

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
           "I-deas": ("unv", "-format unv -setnumber Mesh.SaveGroupsOfNodes 0",
                      True),
           "Nastran": ("bdf", "-format bdf -setnumber Mesh.BdfFieldFormat 1",
                       False),
           "Inria": ("mesh", "-format mesh", False)}
PLACES = {"left": "x < 1e-6", "right": "x > 1 - 1e-6", "bottom": "y < 1e-6"}


def geometry(dim, rng):
    sizes = [rng.uniform(0.1, 0.4) for _ in range(4)]
    corners = zip([(0, 0), (1, 0), (1, 1), (0, 1)], sizes)
    text = [f"Point({n}) = {{{x}, {y}, 0, {size!r}}};"
            for n, ((x, y), size) in enumerate(corners, 1)]
    text += ["Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};",
             "Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4};",
             "Plane Surface(1) = {1};"]
    if dim == 2:
        sides, kind, body = [1, 2, 4], "Curve", "Physical Surface"
        whole = "1"
    else:
        text.append("out[] = Extrude {0, 0, 1} { Surface{1}; };")
        sides, kind, body = ["out[2]", "out[3]", "out[5]"], "Surface", \
            "Physical Volume"
        whole = "out[1]"
    text += [f'Physical {kind}("{name}") = {{{side}}};'
             for name, side in zip(["bottom", "right", "left"], sides)]
    text.append(f'{body}("body") = {{{whole}}};')
    return "\n".join(text) + "\n"


def functional(debond, dim, file, named):
    settings = [f"Dimension={dim}", "Mesh/Source=file", f"Mesh/File={file}",
                "Loads/Traction right=0.001; -0.001" + "; 0" * (dim - 2),
                "Output/Directory=output", "Output/Body VTU=false",
                "Output/Contact VTU=false",
                "Boundary conditions/Clamped boundaries=left",
                "Boundary conditions/Contact boundary=bottom"]
    if not named:
        settings += [f"Parts/{name}=boundary: {place}"
                     for name, place in PLACES.items()]
    result = subprocess.run([debond, "scene.prm"] +
                            [f"--set={entry}" for entry in settings],
                            capture_output=True, text=True, check=False)
    if result.returncode != 0:
        return result.stderr
    return json.loads(pathlib.Path("output/summary.json").read_text())[
        "functional"]


def main(debond):
    failures = 0
    rng = random.Random(1)
    pathlib.Path("scene.prm").write_text("")
    for dim, _ in (2, 1), (2, 2), (3, 1):
        pathlib.Path("body.geo").write_text(geometry(dim, rng))
        J = functional(debond, dim, "body.geo", True)
        print(f"{dim}D: J = {J!r}")
        for name, (extension, options, named) in FORMATS.items():
            file = "body-file." + extension
            subprocess.run(["gmsh", f"-{dim}", "body.geo", "-o", file] +
                           options.split(), check=True,
                           stdout=subprocess.DEVNULL)
            found = functional(debond, dim, file, named)
            # Nastran's files have few digits.
            tolerance = 1e-5 if name == "Nastran" else 1e-12
            if not isinstance(found, float) or abs(found / J - 1.) > tolerance:
                failures += 1
                print(f"  {name}: {found!r}")
    return 1 if failures else 0


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as FOLDER:
        os.chdir(FOLDER)
        sys.exit(main(PROGRAM))
