#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_normals.py DEBOND: curved contact boundaries, from Gmsh files. J is the
same to 1e-10 for all orders of a mesh's elements and for a body that is turned
together with its loads, also where faces differ by the angles of regular
polygons; a disc under a radial force has the J of a closed form in the limit of
its polygons. A boundary without a contact node, and a body without a free
vertex, are told so and have the J that one can compute by hand.
"""

import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh

GROUPS = {1: "contact", 2: "base", 3: "cut"}


def write_mesh(name, points, faces, cells, order=None):
    """Faces are (group, vertices). Elements in the given order."""
    names = {(len(points[0]) - 1, group): name for group, name in GROUPS.items()}
    pathlib.Path(name).write_text(msh.text(
        points, [((group,), face) for group, face in faces],
        [((9,), cell) for cell in cells], names, order=order))


def disc(sides, rings=1):
    """A regular polygon about the unit circle's points, glued all around."""
    points = [(0., 0.)]
    points += [(r / rings * math.cos(2 * math.pi * k / sides),
                r / rings * math.sin(2 * math.pi * k / sides))
               for r in range(1, rings + 1) for k in range(sides)]

    def at(r, k):
        return 0 if r == 0 else 1 + (r - 1) * sides + k % sides

    cells = []
    for r in range(rings):
        for k in range(sides):
            cells.append((at(r, k), at(r + 1, k), at(r + 1, k + 1)))
            if r > 0:
                cells.append((at(r, k), at(r + 1, k + 1), at(r, k + 1)))
    return points, [(1, (at(rings, k), at(rings, k + 1)))
                    for k in range(sides)], cells


def dome(draw, rough):
    """The upper part of an ellipsoid on a flat base, its vertices moved at
    random: tetrahedra from its triangles to a point within."""
    around, levels = 7, 4
    points, rows = [], []
    for level in range(levels):
        angle = 0.5 * math.pi * level / levels
        rows.append(range(len(points), len(points) + around))
        for k in range(around):
            turn = 2 * math.pi * (k + 0.5 * level) / around
            r = 1. + rough * draw.uniform(-1., 1.)
            points.append((1.3 * r * math.cos(angle) * math.cos(turn),
                           r * math.cos(angle) * math.sin(turn),
                           0.8 * r * math.sin(angle) if level else 0.))
    tip, centre, foot = len(points), len(points) + 1, len(points) + 2
    points += [(0., 0., 0.8), (0., 0., 0.3), (0., 0., 0.)]
    faces = []
    for lower, upper in zip(rows, rows[1:]):
        for k in range(around):
            a, b = lower[k], lower[(k + 1) % around]
            c, d = upper[k], upper[(k + 1) % around]
            faces += [(1, (a, b, c)), (1, (b, d, c))]
    for k in range(around):
        faces += [(1, (rows[-1][k], rows[-1][(k + 1) % around], tip)),
                  (2, (rows[0][k], foot, rows[0][(k + 1) % around]))]
    return points, faces, [(*face, centre) for _, face in faces]


def cone(slope):
    """The tip of a regular cone of 14 sides whose normals are at this angle
    to its axis."""
    sides = 14
    points = [(math.cos(2 * math.pi * k / sides),
               math.sin(2 * math.pi * k / sides), 0.) for k in range(sides)]
    height = math.tan(slope)
    points += [(0., 0., height), (0., 0., 0.3 * height), (0., 0., 0.)]
    faces = []
    for k in range(sides):
        a, b = k, (k + 1) % sides
        faces += [(1, (a, b, sides)), (2, (b, a, sides + 2))]
    return points, faces, [(*face, sides + 1) for _, face in faces]


def turned(points, angle):
    """About the last axis, or the origin."""
    c, s = math.cos(angle), math.sin(angle)
    return [(c * p[0] - s * p[1], s * p[0] + c * p[1], *p[2:]) for p in points]


def main(debond):
    failures = []

    def run(settings):
        result = subprocess.run(
            [debond, "scene.prm", "--set=Mesh/Source=file",
             "--set=Mesh/File=mesh.msh", "--set=Output/Directory=output",
             "--set=Output/Body VTU=false", "--set=Output/Contact VTU=false"]
            + [f"--set={entry}" for entry in settings],
            capture_output=True, text=True, check=False)
        if result.returncode != 0:
            return result, {}
        return result, json.loads(
            pathlib.Path("output/summary.json").read_text())

    def solved(what, settings):
        result, summary = run(settings)
        if not summary or summary["status"] != "success":
            failures.append(f"{what}: exit code {result.returncode}, "
                            f"{result.stderr}")
            return {"functional": math.nan, "notes": [], "contact_nodes": -1}
        return summary

    def same(what, values):
        if not max(values) - min(values) <= 1e-10 * abs(values[0]):
            failures.append(f"{what}: J = {values}")

    def close(what, value, expected, tolerance=1e-12):
        if not abs(value - expected) <= tolerance * max(abs(expected), 1e-30):
            failures.append(f"{what}: {value!r}, expected {expected!r}")

    pathlib.Path("scene.prm").write_text("")
    held = ["Material/Young modulus=70", "Material/Poisson ratio=0.25",
            "Boundary conditions/Clamped boundaries=",
            "Boundary conditions/Contact boundary=contact",
            "Contact law/Bond stiffness=9", "Contact law/Bond threshold=0.02"]
    solid = held + ["Dimension=3", "Boundary conditions/Clamped boundaries=base"]

    # Regular polygons, turned.
    for sides in (10, 11, 12, 13):
        points, faces, cells = disc(sides)
        found = []
        for degrees in (0, 17, 30, 90, 123):
            angle = math.radians(degrees)
            write_mesh("mesh.msh", turned(points, angle), faces, cells)
            force = turned([(0.3, -1.1)], angle)[0]
            found.append(solved(
                f"{sides} sides turned by {degrees} degrees",
                held + ["Loads/Body force=%r; %r" % force]))
        same(f"{sides} sides", [f["functional"] for f in found])
        expected = sides if sides > 11 else 0
        if any(f["contact_nodes"] != expected
               or any("at 30.4 to 32.4 degrees" in note for note in f["notes"])
               or any("no contact node" in note for note in f["notes"])
               == (sides > 11) for f in found):
            failures.append(f"{sides} sides: {found}")

    # A disc under the radial force -k r: u_r = A r + c r^3, with the stress
    # -a u_r at the rim, r = 1. Fixed tangential displacements are those of it.
    k, E, nu, a = 0.7, 70., 0.25, 9.
    c = k * (1. - nu ** 2) / (8. * E)
    plane = E / (1. - nu ** 2)
    A = -c * (plane * (3. + nu) + a) / (plane * (1. + nu) + a)
    exact = math.pi * k * (A / 4. + c / 6.)
    errors = []
    for sides in (12, 24, 48):
        write_mesh("mesh.msh", *disc(sides, sides // 6))
        found = solved(f"disc of {sides} sides",
                       held + [f"Loads/Body force=-{k} * x; -{k} * y"])
        errors.append(found["functional"] / exact - 1.)
    if not (all(3.3 < e / f < 4.7 for e, f in zip(errors, errors[1:]))
            and abs(errors[-1]) < 0.02):
        failures.append(f"J of polygons beside the disc's: {errors}")

    # Rough domes, in other orders and turned.
    for number in range(3):
        draw = random.Random(number)
        points, faces, cells = dome(draw, (0., 0.02, 0.06)[number])
        for extra in (["Contact law/Tangential displacement=fixed"],
                      ["Contact law/Tangential displacement=fixed",
                       "Mesh/Degree=2", "Contact law/Quadrature=gauss 3"]):
            values = []
            for order in range(4):
                angle = order * 0.77
                write_mesh("mesh.msh", turned(points, angle), faces, cells,
                           random.Random(order))
                force = turned([(0.5, -0.2)], angle)[0]
                values.append(solved(
                    f"dome {number} in order {order}",
                    solid + extra + ["Loads/Body force=%r; %r; 0.4" % force]
                )["functional"])
            same(f"dome {number} {extra}", values)

    # The tip of a cone is smooth, but for that of a needle.
    for slope, nodes in ((25., 1), (80., 1), (87., 0)):
        write_mesh("mesh.msh", *cone(math.radians(slope)))
        found = solved(f"cone of {slope} degrees",
                       solid + ["Loads/Body force=0; 0; -1"])
        if found["contact_nodes"] != nodes:
            failures.append(f"cone of {slope} degrees: {found}")
    result, _ = run(solid + ["Loads/Body force=0; 0; -1",
                             "Contact law/Tangential displacement=free"])
    if (result.returncode != 2 or "14 different normals meet at (0, 0, "
            not in result.stderr):
        failures.append(f"needle: exit code {result.returncode}, "
                        f"{result.stderr}")

    # Faces that differ by 30.9 degrees.
    height = math.tan(math.radians(15.45))
    write_mesh("mesh.msh", [(-1., 0.), (0., -height), (1., 0.), (0., 1.)],
               [(1, (0, 1)), (1, (1, 2)), (2, (2, 3)), (2, (3, 0))],
               [(0, 1, 3), (1, 2, 3)])
    found = solved("a flat corner", held + [
        "Boundary conditions/Clamped boundaries=base", "Loads/Body force=0; 1"])
    if found["contact_nodes"] != 1:
        failures.append(f"a flat corner: {found}")

    # No free vertex: at rest, and stretched along x by e.
    triangle = [(0., 0.), (1.5, 0.), (0., 2.)], [
        (1, (0, 1)), (2, (1, 2)), (3, (2, 0))], [(0, 1, 2)]
    tetrahedron = [(0., 0., 0.), (1.5, 0., 0.), (0., 2., 0.), (0., 0., 0.5)], [
        (1, (0, 2, 1)), (2, (1, 2, 3)), (3, (0, 1, 3)), (3, (0, 3, 2))], [
        (0, 1, 2, 3)]
    e = 1e-3
    energies = {2: 1.5 * (0.5 * plane * e ** 2 - 2. * e * 0.5),
                3: 0.25 * (0.5 * E * (1. - nu) / ((1. + nu) * (1. - 2. * nu))
                           * e ** 2 - 2. * e * 0.375)}
    kinds = [["Solver/Method=" + m] for m in
             ("automatic", "euclidean bundle", "energy bundle")]
    kinds += [["Solver/Method=majorise minimise"] + extra for extra in
              (["Solver/Linear solver=direct"], ["Solver/Linear solver=multigrid"],
               ["Solver/Prove=true"], ["Solver/Search=full"],
               ["Load path/Factors=0.5, 1"], ["Contact law/Law=none"],
               ["Contact law/Quadrature=gauss 8"])]
    for dim, mesh in ((2, triangle), (3, tetrahedron)):
        write_mesh("mesh.msh", *mesh)
        force = "Loads/Body force=2; -1" + "; 0.5" * (dim == 3)
        rest = "; 0" * (dim - 1)
        for kind in kinds + [["Mesh/Degree=2", "Contact law/Quadrature=gauss 3"]
                             ] * (dim == 3):
            if dim == 3 and kind[-1] == "Contact law/Quadrature=gauss 8":
                continue
            entries = held + kind + [f"Dimension={dim}", force]
            found = solved(f"{dim}D at rest, {kind}", entries + [
                "Boundary conditions/Clamped boundaries=base, cut"])
            stretched = solved(f"{dim}D stretched, {kind}", entries + [
                f"Boundary conditions/Displacement base={e} * x" + rest,
                f"Boundary conditions/Displacement cut={e} * x" + rest])
            close(f"{dim}D at rest, {kind}", found["functional"], 0.)
            close(f"{dim}D stretched, {kind}", stretched["functional"],
                  energies[dim])
            for one in (found, stretched):
                for text in ("nothing to solve", "no contact node"):
                    if not any(text in note for note in one["notes"]):
                        failures.append(f"{dim}D, {kind}: no note '{text}', "
                                        f"{one['notes']}")

    for failure in failures:
        print(failure)
    return 1 if failures else 0


with tempfile.TemporaryDirectory() as directory:
    program = str(pathlib.Path(sys.argv[1]).resolve())
    os.chdir(directory)
    sys.exit(main(program))
