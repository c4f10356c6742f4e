#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_orthotropic.py DEBOND: materials with axes. Isotropic ones in nine numbers; axes that
are exchanged or turn with the body; uniform strains, uniaxial stresses and heat beside sums
over the components of tensors; certificates. The double cantilever beam of Alfano and
Crisfield (2001) is in program/cookbook."""
import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
E, NU, G, ALPHA = (1000., 400., 300.), (0.3, 0.2, 0.25), (200., 150., 120.), (1e-3, 2e-3, -5e-4)
PAIRS = ((0, 1), (0, 2), (1, 2))


def three(numbers):
    return ", ".join(map(repr, numbers))


def material(moduli=E, ratios=NU, shear=G, angle=0., region=""):
    return [f"Young moduli{region}={three(moduli)}", f"Poisson ratios{region}={three(ratios)}",
            f"Shear moduli{region}={three(shear)}", f"Axis angle{region}={angle}"]


# ------------------------------------------------------------------ by hand

def compliance():
    """Of the material in its axes, for (11, 22, 33, 2 x 12, 2 x 13, 2 x 23)."""
    S = [[0.] * 6 for _ in range(6)]
    for i in range(3):
        S[i][i] = 1 / E[i]
    for k, (i, j) in enumerate(PAIRS):
        S[i][j] = S[j][i] = -NU[k] / E[i]
        S[3 + k][3 + k] = 1 / G[k]
    return S


def solved(A, b):
    """By Gauss."""
    n, rows = len(b), [list(row) + [x] for row, x in zip(A, b)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(n):
            if i != k:
                part = rows[i][k] / rows[k][k]
                rows[i] = [x - part * y for x, y in zip(rows[i], rows[k])]
    return [rows[k][n] / rows[k][k] for k in range(n)]


def along_axes(strain, angle):
    """A symmetric 3 x 3 matrix as a vector in the axes, shears twice."""
    c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    R = ((c, s, 0), (-s, c, 0), (0, 0, 1))
    turned = [[sum(R[i][k] * strain[k][l] * R[j][l] for k in range(3) for l in range(3))
               for j in range(3)] for i in range(3)]
    return [turned[i][i] for i in range(3)] + [2 * turned[i][j] for i, j in PAIRS]


def energy(strain, angle, is_plane_stress):
    """Per volume, of strains in the body's frame; in plane stress the least one over the
    strain along z."""
    def of(e):
        return sum(x * y for x, y in zip(e, solved(compliance(), e))) / 2
    e = along_axes(strain, angle)
    if is_plane_stress:
        z = [0., 0., 1., 0., 0., 0.]
        mixed = sum(x * y for x, y in zip(e, solved(compliance(), z)))
        e[2] -= mixed / (2 * of(z))
    return of(e)


# ------------------------------------------------------------------- checks

NO_CONTACT = ["Clamped boundaries=", "Contact boundary="]
KINDS = (("plane stress", 2, True, []), ("plane strain", 2, False, ["Hypothesis=plane strain"]),
         ("3D", 3, False, ["Dimension=3"]))


def box(dim, *more):
    return solve("Lengths=" + ", ".join(["2", "1", "1"][:dim]),
                 "Cells=" + ", ".join(["2", "2", "1"][:dim]), *NO_CONTACT, *more)


def check_uniform_strains():
    """Prescribed on all of the boundary."""
    strains = ((1, 0, 0, 0, 0, 0), (0, 1, 0, 0, 0, 0), (0, 0, 0, 1, 0, 0),
               (.3, -.7, .2, .5, .4, -.6))
    for (name, dim, is_plane_stress, more), angle, e in itertools.product(
            KINDS, (0, 30, 90, 127), strains):
        strain = [[e[0], e[3], e[4]], [e[3], e[1], e[5]], [e[4], e[5], e[2]]]
        strain = [[1e-3 * strain[i][j] * (max(i, j) < dim) for j in range(3)] for i in range(3)]
        motion = "; ".join(" + ".join(f"({strain[i][j]!r}) * {'xyz'[j]}" for j in range(dim))
                           for i in range(dim))
        sides = ["left", "right", "bottom", "top"] + ["back", "front"] * (dim == 3)
        J = box(dim, *more, *material(angle=angle), *(
            f"Displacement {side}={motion}" for side in sides))["functional"]
        close(f"{name}, {angle} degrees, {e}", J, 2 * energy(strain, angle, is_plane_stress), 1e-12)


def check_uniaxial():
    """Free along y and z but for plane strain, with heat."""
    S = compliance()
    for name, dim, is_plane_stress, more in KINDS:
        rollers = "left, bottom" + ", back" * (dim == 3)
        is_strain = name == "plane strain"
        for sigma, heat in ((2., 0.), (0., 3.), (2., 3.)):
            # Stresses along z where strains along it are held.
            z = (-(S[2][0] * sigma + ALPHA[2] * heat) / S[2][2]) if is_strain else 0.
            e = [S[i][0] * sigma + S[i][2] * z + ALPHA[i] * heat for i in range(2)]
            result = box(dim, *more, *material(), f"Thermal expansion={three(ALPHA)}",
                         "Roller boundaries=" + rollers, f"Traction right={sigma}; 0" + "; 0"
                         * (dim == 3), *([f"Temperature change={heat}"] if heat else []))
            right, top = (result["mean_displacements"][side] for side in ("right", "top"))
            close(f"{name}, {sigma}, {heat}: along x", right[0], 2 * e[0], 1e-12)
            close(f"{name}, {sigma}, {heat}: along y", top[1], e[1], 1e-12)


def compare(name, one, other, tolerance, without=()):
    for key in ("functional", "largest_von_mises", "estimated_error", "largest_opening",
                "largest_displacement"):
        if key in one and key not in without:
            close(f"{name}: {key}", one[key], other[key], tolerance)


def check_equal_materials():
    nu = 0.3
    isotropic = ["Young modulus=1000", f"Poisson ratio={nu}"]
    strip = ["Lengths=4, 1", "Cells=16, 4", "Contact boundary=bottom", "Clamped boundaries=left",
             "Traction right=-0.5; 2", "Bond stiffness=100", "Bond strength=1"]
    solid = ["Dimension=3", "Lengths=4, 1, 1", "Cells=8, 2, 2", "Traction right=-0.5; 2; 0.1"]
    nine = material((1000,) * 3, (nu,) * 3, (1000 / (2 + 2 * nu),) * 3, 30)
    for name, more in (("plane stress", []), ("plane strain", ["Hypothesis=plane strain"]),
                       ("degree 2", ["Degree=2", "Quadrature=gauss 3"]), ("3D", solid),
                       ("multigrid", ["Linear solver=multigrid"]),
                       ("multigrid in 3D", [*solid, "Linear solver=multigrid"]),
                       ("certificate", ["Certificate/Kind=global"]),
                       ("heat", ["Thermal expansion=1e-3", "Temperature change=x"]),
                       ("Euclidean bundle", ["Method=euclidean bundle", "Cells=8, 2"])):
        one, other = (solve(*strip, *more, *of) for of in (isotropic, nine))
        check(name + " arrives", one["status"] == other["status"] == "success")
        compare(name + ", isotropic in nine numbers", one, other,
                1e-6 if "bundle" in name else 1e-10, ["estimated_error"])
        # Which has a formula of its own for materials with axes.
        check(name + ": error of the mesh", "estimated_error" not in one or
              0.7 < one["estimated_error"] / other["estimated_error"] < 1.4)
        if name == "certificate":
            close(name, one["certificate"]["lower"], other["certificate"]["lower"], 1e-10)
    # Axis 1 along y is axis 2 along x.
    exchanged = material((E[1], E[0], E[2]), (NU[0] * E[1] / E[0], NU[2], NU[1]),
                         (G[0], G[2], G[1]))
    for name, more in (("plane stress", []), ("plane strain", ["Hypothesis=plane strain"]),
                       ("3D", solid)):
        compare(name + ", turned by 90 degrees", solve(*strip, *more, *material(angle=90)),
                solve(*strip, *more, *exchanged), 1e-11)
    # All turned.
    c, s = math.cos(math.radians(37)), math.sin(math.radians(37))
    turned = ["Rotation=37", f"Traction right={-.5 * c - 2 * s!r}; {-.5 * s + 2 * c!r}"]
    for name, more in (("nodal", []), ("degree 2", ["Degree=2", "Quadrature=gauss 3"]),
                       ("multigrid", ["Linear solver=multigrid"])):
        compare(name + ", body and axes turned", solve(*strip, *more, *material(angle=20)),
                solve(*strip, *more, *turned, *material(angle=57)), 1e-10,
                ["largest_von_mises"] * (name == "multigrid"))
    # Of regions.
    halves = ["Parts/soft=region: x > 2"]
    compare("the same region", solve(*strip, *halves, *material(), *material(region=" soft")),
            solve(*strip, *material()), 1e-12)
    compare("an isotropic region in an orthotropic body",
            solve(*strip, *halves, *material(), "Young modulus soft=1000",
                  f"Poisson ratio soft={nu}"),
            solve(*strip, "Parts/hard=region: x <= 2", *isotropic, *material(region=" hard")),
            1e-12)


def check_certificates():
    """The J of a finer mesh is in the interval for the continuous problem."""
    strip = ["Lengths=4, 0.5", "Contact boundary=bottom", "Clamped boundaries=left",
             "Traction right=0; 2", "Bond stiffness=400", "Bond strength=5"]
    hard = ((4000., 300., 300.), (0.3, 0.3, 0.4), (250., 250., 100.))
    for angle, tangential in ((0, "fixed"), (35, "fixed"), (-35, "free")):
        tangential = "Tangential displacement=" + tangential
        finer = solve(*strip, *material(*hard, angle), tangential, "Cells=256, 32")
        for kind in ("global", "fixed state"):
            found = solve(*strip, *material(*hard, angle), tangential, "Cells=32, 4",
                          "Certificate/Kind=" + kind)["certificate"]
            check(f"{angle}, {kind}: holds the J of a fine mesh",
                  found["lower"] <= finer["functional"] <= found["upper"], found)
            # Turned.
            for rotation in (25, 180):
                c, s = math.cos(math.radians(rotation)), math.sin(math.radians(rotation))
                same = solve(*strip, *material(*hard, angle + rotation), tangential, "Cells=32, 4",
                             "Certificate/Kind=" + kind, f"Rotation={rotation}",
                             f"Traction right={-2 * s!r}; {2 * c!r}")["certificate"]
                close(f"{angle}, {kind}, turned by {rotation}", same["lower"], found["lower"], 1e-8)


scenes.all_of(globals())
