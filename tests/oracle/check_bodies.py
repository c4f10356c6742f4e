#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_bodies.py DEBOND SCENE: the benchmark's bar, 40x4, as a box, from Gmsh
files of two versions (quadrilaterals that are crossed, triangles that are used as
they are, some turned inside out, a coarser mesh that is refined, a mesh in mm),
from a generator, and with parts and regions that make no difference: J is the same
to 1e-12, and so are the contact nodes; also of a bar in 3D. What is wrong with a
mesh or a part is told with its place.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh

def bar(nx, ny, scale=1., crossed=False):
    return msh.box((nx, ny), (0.4 * scale, 0.04 * scale), crossed)


def run(debond, settings):
    arguments = [f"--set={entry}" for entry in
                 ["Solver/Method=majorise minimise", "Output/Body VTU=false",
                  "Output/Directory=output"] + settings]
    return subprocess.run([debond, "scenes/bar.prm"] + arguments,
                          capture_output=True, text=True, check=False)


def main(debond, scene):
    failures = []
    reference = None

    def same(what, settings):
        nonlocal reference
        result = run(debond, settings)
        if result.returncode != 0:
            failures.append(f"{what}: {result.stderr}")
            return
        summary = json.loads(pathlib.Path("output/summary.json").read_text())
        if reference is None:
            reference = summary
        if (abs(summary["functional"] / reference["functional"] - 1.) > 1e-12
                or summary["bond_states"] != reference["bond_states"]):
            failures.append(f"{what}: J = {summary['functional']!r}, of the box "
                            f"{reference['functional']!r}")

    def refused(message, settings):
        result = run(debond, settings)
        if result.returncode != 2 or message not in result.stderr:
            failures.append(f"expected {message!r}, exit code 2: exit code "
                            f"{result.returncode}, {result.stderr!r}")

    pathlib.Path("scenes").mkdir()
    shutil.copy(scene, "scenes/bar.prm")
    meshes = {"quadrilaterals": bar(40, 4), "triangles": bar(40, 4, crossed=True),
              "coarse": bar(20, 2), "mm": bar(40, 4, 1000.)}
    for name, mesh in meshes.items():
        pathlib.Path(f"scenes/{name}.msh").write_text(msh.text(*mesh))
    pathlib.Path("scenes/cut.msh").write_text(msh.text(*bar(40, 4))[:-500])

    def file(name):
        return ["Mesh/Source=file", f"Mesh/File={name}.msh"]

    same("box", [])
    same("quadrilaterals", file("quadrilaterals"))
    same("triangles", file("triangles"))
    same("refined", file("coarse") + ["Mesh/Refinements=1"])
    same("scaled", file("mm") + ["Mesh/Scale=0.001"])
    for version in ("2.2", "4.1"):
        for name in ("quadrilaterals", "triangles"):
            pathlib.Path("scenes/odd.msh").write_text(
                msh.text(*meshes[name], version=version, is_odd=True))
            same(f"odd {name}, version {version}",
                 file("odd") + ["Material/Young modulus=1",
                                "Material/Young modulus all=69"])
            same(f"odd {name}, version {version}, a part of it",
                 file("odd") + ["Material/Young modulus upper=69"])
    # What was written can be run again from another folder.
    shutil.copy("output/parameters.prm", "bar-again.prm")
    again = subprocess.run([debond, "bar-again.prm"], capture_output=True,
                           text=True, check=False)
    if again.returncode != 0:
        failures.append(f"the effective scene: {again.stderr}")
    generator = ["Mesh/Source=generator",
                 "Mesh/Generator=subdivided_hyper_rectangle",
                 "Boundary conditions/Clamped boundaries=0, 1",
                 "Boundary conditions/Contact boundary=2",
                 "Loads/Traction top=",
                 "Loads/Traction 3=0; if(x < 0.2, 0.69, -0.345)"]
    same("generator",
         generator + ["Mesh/Arguments=40, 4 : 0, 0 : 0.4, 0.04 : true"])
    same("generator, refined",
         generator + ["Mesh/Arguments=10, 1 : 0, 0 : 0.4, 0.04 : true",
                      "Mesh/Refinements=2"])

    # Pieces with names of their own that make no difference.
    same("a part that is the side", [
        "Parts/glued=bottom: x > -1", "Boundary conditions/Contact boundary=glued"])
    same("tractions of parts that overlap", [
        "Parts/left half=top: x < 0.2", "Loads/Traction top=0; -0.345",
        "Loads/Traction left half=0; 1.035"])
    same("a region of the same material", [
        "Parts/upper=y > 0.02", "Material/Young modulus upper=69"])
    same("regions that are all", [
        "Parts/upper=y > 0.02", "Parts/lower=y <= 0.02",
        "Material/Young modulus=1", "Material/Young modulus upper=69",
        "Material/Young modulus lower=69"])
    # The reaction of a side is that of all of it, whatever it is divided into.
    same("a part of a clamped side", ["Parts/upper end=left: y > 0.02"])
    reactions = json.loads(
        pathlib.Path("output/summary.json").read_text())["reactions"]
    if reactions.keys() != {"left", "right"} or any(
            abs(one - other) > 1e-9 for side in reactions for one, other in
            zip(reactions[side], reference["reactions"][side])):
        failures.append(f"reactions of divided sides: {reactions}")

    # Half of a change of temperature, as such and by a load path.
    stresses = []
    for entries in (["Loads/Temperature change=30"],
                    ["Loads/Temperature change=60", "Load path/Factors=0.5"]):
        result = run(debond, ["Loads/Traction top=",
                              "Material/Thermal expansion=1e-5"] + entries)
        if result.returncode != 0:
            failures.append(f"{entries}: {result.stderr}")
        stresses.append(json.loads(pathlib.Path("output/summary.json")
                                   .read_text())["largest_von_mises"])
    if not abs(stresses[1] / stresses[0] - 1.) < 1e-9:
        failures.append(f"stresses of half a change of temperature: {stresses}")

    reference, solid = None, [
        "Dimension=3", "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345); 0.1"]
    same("solid", solid + ["Mesh/Lengths=0.4, 0.04, 0.05", "Mesh/Cells=6, 2, 1"])
    for version in ("2.2", "4.1"):
        pathlib.Path("scenes/odd.msh").write_text(msh.text(
            *msh.box((6, 2, 1), (0.4, 0.04, 0.05)), version=version, is_odd=True))
        same(f"solid, version {version}", solid + file("odd") + [
            "Material/Young modulus upper=69"])

    refused("Parts/glued: no face has its centre in this part",
            ["Parts/glued=bottom: x > 1"])
    refused("Parts/glued = botom: x > 0: the body has no boundary botom, but "
            "bottom, left, right, top", ["Parts/glued=botom: x > 0"])
    refused("Parts/top = x > 0: the body has a piece of this name",
            ["Parts/top=x > 0"])
    refused("Parts/core = x > +: ", ["Parts/core=x > +"])
    refused("the body has no region core; name one in Parts",
            ["Material/Young modulus core=1"])
    refused("Material/Young modulus core = -1: expected",
            ["Parts/core=x > 0.1", "Material/Young modulus core=-1"])
    refused("Material/Poisson ratio core = 1.1: Poisson ratio = 1.1 must lie in (-1, 1)",
            ["Parts/core=x > 0.1", "Material/Poisson ratio core=1.1"])
    refused("the region overlaps core, which has a material of its own as well",
            ["Parts/core=x > 0.1", "Parts/end=x > 0.2",
             "Material/Young modulus core=1", "Material/Poisson ratio end=0"])
    refused("Loads/Temperature change: it is not finite, ",
            ["Loads/Temperature change=log(x - 0.1)"])

    refused("Mesh/File =  (default): Source = file needs one", ["Mesh/Source=file"])
    # Layers, pulled off from below: bonds and layers are springs in a row.
    heights, width, pull = (0.07, 0.05, 0.08), 0.1, 3e-4
    for moduli in ((2., 5e8, 3.), (4e8, 2., 7e7), (3e10, 1., 2.), (1., 9e10, 4.)):
        softness = sum(h / E for h, E in zip(heights, moduli))
        stiffness = 0.7 / softness
        J = -pull**2 * width * softness / (2. * (1. + 0.7))
        result = run(debond, [
            f"Mesh/Lengths={width}, 0.2", "Mesh/Cells=5, 20",
            "Parts/middle=y > 0.07 && y < 0.12", "Parts/upper=y > 0.12",
            f"Material/Young modulus={moduli[0]}",
            f"Material/Young modulus middle={moduli[1]}",
            f"Material/Young modulus upper={moduli[2]}",
            "Material/Poisson ratio=0", "Loads/Traction top=",
            f"Loads/Traction bottom=0; {pull}",
            "Boundary conditions/Clamped boundaries=top",
            "Boundary conditions/Roller boundaries=left, right",
            f"Contact law/Bond stiffness={stiffness!r}",
            "Contact law/Bond threshold=1"])
        found = json.loads(pathlib.Path("output/summary.json").read_text())[
            "functional"] if result.returncode == 0 else None
        if found is None or abs(found / J - 1.) > 1e-12:
            failures.append(f"layers of {moduli}: J {found}, expected {J}, "
                            f"{result.stderr!r}")

    refused("scenes/none.msh cannot be read", file("none"))
    refused("Gmsh does not read this", ["Mesh/Source=file", "Mesh/File=bar.prm"])
    refused("scenes/cut.msh: Gmsh does not read this", file("cut"))
    refused("Mesh/File = mm.msh: this belongs to Source = file",
            ["Mesh/File=mm.msh"])
    refused("Mesh/Refinements = 1: a box has its Cells", ["Mesh/Refinements=1"])
    refused("A mesh of triangles or tetrahedra is not refined",
            file("triangles") + ["Mesh/Refinements=1"])
    refused("the body has no boundary glued, but bottom, left, right, top",
            file("mm") + ["Boundary conditions/Contact boundary=glued"])
    refused("the mesh has no tetrahedra or hexahedra",
            file("mm") + ["Dimension=3"])
    refused("Mesh/Generator =  (default): Source = generator needs one",
            ["Mesh/Source=generator"])

    for failure in failures:
        print(failure)
    return 1 if failures else 0


with tempfile.TemporaryDirectory() as directory:
    program, scene = (str(pathlib.Path(path).resolve())
                      for path in sys.argv[1:])
    os.chdir(directory)
    sys.exit(main(program, scene))
