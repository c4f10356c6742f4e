#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_normals.py DEBOND: curved contact boundaries, from Gmsh files. J is the
same to 1e-10 for all orders of a mesh's elements and for a body that is turned
together with its loads, also where faces differ by the angles of regular
polygons; a disc under a radial force has the J of a closed form in the limit of
its polygons. A boundary without a contact node, and a body without a free
vertex, are told so and have the J that one can compute by hand.
"""

import math
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
GROUPS = {1: "contact", 2: "base", 3: "cut"}


HELD = ["Source=file", "Young modulus=70", "Poisson ratio=0.25", "Clamped boundaries=",
        "Contact boundary=contact", "Bond stiffness=9", "Bond threshold=0.02"]
SOLID = HELD + ["Dimension=3", "Clamped boundaries=base"]
PLANE = 70. / (1. - 0.25**2)


def solve(mesh, *settings, order=None):
    """Of points, faces as (group, vertices) and cells, in the given order of elements."""
    points, faces, cells = mesh
    names = {(len(points[0]) - 1, group): name for group, name in GROUPS.items()}
    text = msh.text(points, [((group,), face) for group, face in faces],
                    [((9,), cell) for cell in cells], names, order=order)
    name = f"mesh-{hash(text)}.msh"
    (scenes.directory / name).write_text(text)
    return scenes.solve("File=" + name, *settings)


def same(values):
    check("the same J", max(values) - min(values) <= 1e-10 * abs(values[0]), values)


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
    return points, [(1, (at(rings, k), at(rings, k + 1))) for k in range(sides)], cells


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


def check_polygon(sides):
    """Regular polygons, turned. Of few sides each corner has two normals."""
    points, faces, cells = disc(sides)
    found = []
    for degrees in (0, 17, 30, 90, 123):
        angle = math.radians(degrees)
        force = turned([(0.3, -1.1)], angle)[0]
        found.append(solve((turned(points, angle), faces, cells), *HELD,
                           "Body force=%r; %r" % force))
    same([result["functional"] for result in found])
    for result in found:
        notes = " ".join(result["notes"])
        check("contact nodes and notes", result["contact_nodes"] == sides * (sides > 11)
              and "at 30.4 to 32.4 degrees" not in notes
              and ("no contact node" in notes) == (sides <= 11), result["notes"])


def check_disc():
    """Under the radial force -k r: u_r = A r + c r^3, with the stress -a u_r at the rim,
    r = 1. Fixed tangential displacements are those of it."""
    k, nu, a = 0.7, 0.25, 9.
    c = k * (1. - nu ** 2) / (8. * 70.)
    A = -c * (PLANE * (3. + nu) + a) / (PLANE * (1. + nu) + a)
    exact = math.pi * k * (A / 4. + c / 6.)
    errors = [solve(disc(sides, sides // 6), *HELD, f"Body force=-{k} * x; -{k} * y")[
        "functional"] / exact - 1. for sides in (12, 24, 48)]
    check("J of polygons", abs(errors[-1]) < 0.02
          and all(3.3 < e / f < 4.7 for e, f in zip(errors, errors[1:])), errors)


def check_drawn_in():
    """A quarter of a disc whose cuts and pressed rim leave u = c (x, y): along the arc's
    normal, though not along those of the facets at its ends, so that u_tau = 0 on it
    contradicts nothing. With a rim of one facet it does."""
    c = -1e-3
    sigma = 70. * c / (1. - 0.25)
    for n in (1, 6):
        arc = [(math.cos(k * math.pi / 2. / n), math.sin(k * math.pi / 2. / n))
               for k in range(n + 1)]
        mesh = ([(0., 0.), *arc],
                [(1, (k, k + 1)) for k in range(1, n + 1)] + [(2, (0, 1)), (3, (n + 1, 0))],
                [(0, k, k + 1) for k in range(1, n + 1)])
        found = solve(mesh, *HELD, "Law=none", f"Pressure contact={-sigma}",
                      "Tangential displacement=fixed", *(f"Displacement {side}={c} * x; {c} * y"
                                                         for side in ("base", "cut")))
        if n == 1:
            check("one facet", found["exit_code"] == 2
                  and "prescribed otherwise by Tangential" in found["errors"], found["errors"])
        else:
            close("J", found["functional"], -sigma * c * n / 2. * math.sin(math.pi / 2. / n), 1e-12)


def check_dome(rough, *extra):
    """In other orders and turned."""
    points, faces, cells = dome(random.Random(1), rough)
    values = []
    for order in range(4):
        angle = order * 0.77
        force = turned([(0.5, -0.2)], angle)[0]
        values.append(solve((turned(points, angle), faces, cells), *SOLID, *extra,
                            "Body force=%r; %r; 0.4" % force,
                            order=random.Random(order))["functional"])
    same(values)


def check_tips():
    """The tip of a cone is smooth, but for that of a needle; so is a corner of faces that
    differ by 30.9 degrees."""
    load = "Body force=0; 0; -1"
    for slope, nodes in ((25., 1), (80., 1), (87., 0)):
        check(f"cone of {slope} degrees", solve(
            cone(math.radians(slope)), *SOLID, load)["contact_nodes"] == nodes)
    needle = solve(cone(math.radians(87.)), *SOLID, load, "Tangential displacement=free")
    check("needle", needle["exit_code"] == 2
          and "14 different normals meet at (0, 0, " in needle["errors"], needle["errors"])
    height = math.tan(math.radians(15.45))
    flat = ([(-1., 0.), (0., -height), (1., 0.), (0., 1.)],
            [(1, (0, 1)), (1, (1, 2)), (2, (2, 3)), (2, (3, 0))], [(0, 1, 3), (1, 2, 3)])
    check("a flat corner", solve(flat, *HELD, "Clamped boundaries=base",
                                 "Body force=0; 1")["contact_nodes"] == 1)


TRIANGLE = ([(0., 0.), (1.5, 0.), (0., 2.)], [(1, (0, 1)), (2, (1, 2)), (3, (2, 0))], [(0, 1, 2)])
TETRAHEDRON = ([(0., 0., 0.), (1.5, 0., 0.), (0., 2., 0.), (0., 0., 0.5)],
               [(1, (0, 2, 1)), (2, (1, 2, 3)), (3, (0, 1, 3)), (3, (0, 3, 2))],
               [(0, 1, 2, 3)])


def check_no_free_vertex(dim, *kind):
    """At rest, and stretched along x by e."""
    e, nu = 1e-3, 0.25
    energy = 1.5 * (0.5 * PLANE * e ** 2 - 2. * e * 0.5) if dim == 2 else 0.25 * (
        0.5 * 70. * (1. - nu) / ((1. + nu) * (1. - 2. * nu)) * e ** 2 - 2. * e * 0.375)
    moved = f"={e} * x" + "; 0" * (dim - 1)
    for name, expected, *supports in (
            ("at rest", 0., "Clamped boundaries=base, cut"),
            ("stretched", energy, "Displacement base" + moved, "Displacement cut" + moved,
             "Tangential displacement=free")):
        found = solve(TRIANGLE if dim == 2 else TETRAHEDRON, *HELD, *kind, f"Dimension={dim}",
                      "Body force=2; -1" + "; 0.5" * (dim == 3), *supports)
        close(name, found["functional"], expected, 1e-12)
        for text in ("nothing to solve", "no contact node"):
            check(f"{name}, note '{text}'", any(text in note for note in found["notes"]),
                  found["notes"])


QUADRATIC = ["Degree=2", "Quadrature=gauss 3"]
MM = "Method=majorise minimise"
scenes.all_of(
    globals(), *((f"{sides} sides", check_polygon, sides) for sides in (10, 11, 12, 13)),
    *((f"dome {rough} {extra}", check_dome, rough, *extra) for rough in (0., 0.02, 0.06)
      for extra in (["Tangential displacement=fixed"],
                    ["Tangential displacement=fixed", *QUADRATIC])),
    *((f"{dim}D, {kind}", check_no_free_vertex, dim, *kind) for dim in (2, 3)
      for kind in (["Method=automatic"], ["Method=euclidean bundle"], ["Method=energy bundle"],
                   [MM, "Linear solver=direct"], [MM, "Linear solver=multigrid"],
                   [MM, "Prove=true"], [MM, "Search=full"], [MM, "Factors=0.5, 1"],
                   [MM, "Law=none"], [MM, "Quadrature=gauss 8"] if dim == 2 else QUADRATIC)))
