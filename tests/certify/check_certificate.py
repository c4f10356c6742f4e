#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_certificate.py DEBOND: intervals for the least J of the continuous problem,
on a mesh and on one four times as fine, whose displacements are on the sides as the
table of the coarse one says; the branches of a state that is kept, and what has no
certificate. Random scenes are in certify/certified_bounds."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
GLOBAL, FIXED = "Certificate/Kind=global", "Certificate/Kind=fixed state"
GAUSS = "Quadrature=gauss 8"
PICTURES = ["Output/Body VTU=true", "Output/Contact VTU=true"]


def solve(*settings):
    return scenes.solve("Cells=20, 2", "Method=automatic", *settings)


def interval(*settings):
    return solve(*settings)["certificate"]


def wrong_sides(sides, profile, threshold):
    """Those of a coarse mesh that the displacement of a finer one, with a J that is
    not above the upper number, is not on; the sides are at the bottom."""
    width = max(side[x] for side in sides for x in ("x0", "x1"))
    displacement = {round(row["x"] / width, 9): row["u_nu"] for row in profile}
    wrong = certain = 0
    for side in sides:
        ends = sorted((side["x0"], side["x1"]))
        middle, half = sum(ends) / 2., (ends[1] - ends[0]) / 2.
        points = [ends[0] + i * half / 2. for i in range(5)]
        # What is clamped is no contact node.
        values = [displacement.get(round(x / width, 9), 0.) for x in points]
        mean = slope = 0.
        for i in range(4):
            mean += (values[i] + values[i + 1]) / 8.
            xi = [(x - middle) / half for x in points[i:i + 2]]
            slope += 0.5 / 6. * 1.5 * (values[i] * xi[0] + values[i + 1] * xi[1]
                                       + (values[i] + values[i + 1]) * (xi[0] + xi[1]))
        linear = (mean - slope, mean + slope)
        rounding = 1e-9 * max(abs(value) for value in values)
        is_wrong = not (side["least_mean"] - rounding <= mean <= side["largest_mean"] + rounding
                        and side["least_linear"] - rounding <= min(linear)
                        and max(linear) <= side["largest_linear"] + rounding)
        if side["state"] != "uncertain":
            is_wrong |= (min(linear) < -threshold if side["state"] == "bonded"
                         else max(linear) > -threshold)
        certain += side["state"] != "uncertain"
        wrong += is_wrong
    return wrong, certain


def check_two_meshes(*entries):
    """All intervals hold for one number: lower ends are below the upper ends of the other
    mesh, which knows nothing of them."""
    coarse, fine = (solve(*entries, "Cells=" + cells, GLOBAL) for cells in ("20, 2", "80, 8"))
    wrong, certain = wrong_sides(coarse["sides"], fine["profile"], 0.002)
    one, other = coarse["certificate"], fine["certificate"]
    check("intervals", one["lower"] <= other["upper"] <= one["upper"]
          and other["lower"] <= other["upper"], (one, other))
    check("sides are where they are certain to be", wrong == 0 and certain > 0, (wrong, certain))


def check_kinds():
    """The least J is not above that with some branches kept, and both have the result above
    them."""
    least, kept = interval(GLOBAL), interval(FIXED)
    check("kinds", least["minimum"] == "global" and kept["minimum"] == "fixed state"
          and least["lower"] <= kept["upper"], (least, kept))
    check("without bonds a state is all there is",
          interval(FIXED, "Law=none")["minimum"] == "global")


def check_target(degree, target):
    """Refined until it is narrow enough, or as far as asked, which is said."""
    result = solve(GLOBAL, f"Certificate/Target={target}", f"Degree={degree}", GAUSS,
                   "Traction top=0; if(x<0.2,0.69,-0.345)",
                   "Accuracy/Maximum unknowns=3000", *PICTURES)
    found, is_met = result["certificate"], target == 2e-2
    check("width and exit code", (found["relative_width"] <= target) == is_met
          and result["exit_code"] == (0 if is_met else 3)
          and is_met == ("Certificate/Target is 0.0001" not in result["errors"]),
          (found, result["errors"]))
    check("interval", found["minimum"] == "global"
          and found["lower"] <= -5.9151e-4 <= found["upper"], found)
    for name in (b'"gap_density"', b'"equilibrated_stress_xy"', b'"certain_branch"'):
        check(f"field {name}", name in result["vtu"])


def jumps():
    """A load that jumps inside a side: on the other mesh at a vertex, so that both intervals
    are for one number; and each has J in it, whatever the quadrature."""
    jump = ["Traction top=0; if(x<0.4*7/24,0.5,-0.4)", GLOBAL]
    fine = interval(*jump, "Cells=48, 4", "Degree=2", GAUSS)
    check("at a vertex", fine["loads_are_exact"])
    cases = [(degree, quadrature, cells, target)
             for degree, quadrature in ((1, "nodal"), (1, "gauss 8"), (2, "gauss 8"))
             for cells in ("8, 1", "16, 2", "32, 2") for target in (None, 0.02)]

    def check_case(degree, quadrature, cells, target):
        result = solve(*jump, "Cells=" + cells, f"Degree={degree}", "Quadrature=" + quadrature,
                       *([f"Certificate/Target={target}", "Accuracy/Maximum unknowns=9000"]
                         if target else []))
        found = result["certificate"]
        check("loads are not exact", not found["loads_are_exact"] or target)
        check("interval", found["lower"] <= result["functional"] <= found["upper"]
              and found["lower"] <= fine["upper"] and fine["lower"] <= found["upper"], found)

    scenes.together(*((f"jump {case}", check_case, *case) for case in cases))


def check_flat_cells():
    """What rounding does not let certify has its result, and the reason."""
    flat = ["Lengths=0.0002, 0.06", "Cells=4, 3", "Clamped boundaries=top",
            "Traction bottom=0; 0.2", "Hypothesis=plane strain", "Poisson ratio=0.49999999"]
    alone, result = solve(*flat), solve(*flat, GLOBAL)
    check("result", result["functional"] == alone["functional"] and "certificate" not in result
          and any(note.startswith("There is no certificate: to rounding")
                  for note in result["notes"]), result["notes"])
    result = solve(*flat, GLOBAL, "Certificate/Target=0.1")
    # Rounding decides which matrix it is that is not definite.
    check("target", result["exit_code"] == 3 and result["profile"]
          and "There is no certificate: " in result["errors"], result["errors"])


def check_flap():
    """A flap that turns about a soft hinge opens the one contact side in reach from far below
    the threshold to far above it, while its stresses are those of the element: without the
    slope's term the bound is 5 % of the bonds' energy too high."""
    flap = interval("Lengths=0.4, 0.2", "Cells=8, 4", "Parts/flap=x > 0.05",
                    "Parts/glued=bottom: if(x>0.05,if(x<0.1,1,0),0)", "Contact boundary=glued",
                    "Clamped boundaries=left", "Young modulus=1", "Young modulus flap=1e5",
                    "Poisson ratio=0", "Traction right=-0.1*(y-0.1); 0", "Bond stiffness=8",
                    "Bond threshold=2e-4", "Tangential displacement=free", GLOBAL,
                    "Accuracy/Maximum unknowns=20000")
    check("width", 0. < flap["relative_width"] < 0.1, flap)


def check_solid():
    """The branches of the state, or J if the law has but one."""
    solid = ["Dimension=3", "Lengths=0.4, 0.1, 0.1", "Cells=8, 2, 2",
             "Traction top=0; if(x<0.2,0.69,-0.345); 0", FIXED, *PICTURES]
    for law, minimum in (("winkler", "fixed state"), ("none", "global")):
        result = solve(*solid, f"Law={law}")
        found = result["certificate"]
        check(law, found["minimum"] == minimum and 0. < found["relative_width"] < 0.15, found)
        for name in (b'"gap_density"', b'"equilibrated_stress_yz"'):
            check(f"field {name}", name in result["vtu"])
    refined = interval(*solid, "Certificate/Target=0.08", "Accuracy/Maximum unknowns=20000")
    check("refined", refined["relative_width"] <= 0.08, refined)


def check_prescribed(kind):
    """Where the displacement is linear J is known, and both numbers are J. A block that is
    too large for its place, one that is pushed over a gap onto the foundation, and one that
    bonds hold, of equal stiffness but with two thresholds."""
    for name, J, *settings in (
            ("press fit", 0.005, "Law=none", "Initial gap=-0.01", "Displacement top=free; 0"),
            ("gap", 0.02, "Law=none", "Initial gap=0.01", "Displacement top=free; -0.03"),
            ("bonds", 2.5e-5, "Displacement top=free; 0.001", "Bond stiffness=100",
             "Bond threshold=if(x < 0.5, 1, 2)")):
        found = interval("Lengths=1, 1", "Cells=4, 4", "Young modulus=100", "Poisson ratio=0",
                         "Clamped boundaries=", "Roller boundaries=left, right",
                         "Tangential displacement=free", *settings, kind)
        for end in ("lower", "upper"):
            close(f"{name}, {end}", found[end], J, 1e-4 if name == "bonds" else 1e-8)


def check_finer(kind):
    """Finer meshes have higher lower numbers and lower upper ones."""
    both = ["Clamped boundaries=left", "Displacement right=free; 0.002", "Initial gap=2e-4*x/0.4",
            "Bond stiffness=if(x<0.2,69,30)", "Bond threshold=if(x<0.3,0.002,0.001)"]
    coarse, fine = (interval(*both, kind, "Cells=" + cells) for cells in ("20, 2", "40, 4"))
    check("both ends", coarse["lower"] < fine["lower"] < fine["upper"] < coarse["upper"]
          and fine["relative_width"] < 0.4 * coarse["relative_width"], (coarse, fine))


def check_temperature(dim, kind, cold, cells, fine_cells):
    """That is constant in each cell but not in the body: intervals of degree 2 beside those
    of degree 1 on finer meshes, all for the least J of the same continuous body, so that they
    meet."""
    intervals = []
    for degree, mesh in ((2, cells), (1, fine_cells)):
        result = solve(*cold, f"Dimension={dim}", "Lengths=1, 0.5" + ", 0.5" * (dim == 3),
                       f"Degree={degree}", "Cells=" + mesh, "Young modulus=1", "Poisson ratio=0.3",
                       "Thermal expansion=1e-3", "Clamped boundaries=left", "Law=none",
                       "Quadrature=gauss " + ("8" if dim == 2 else "2"),
                       "Tangential displacement=free", "Temperature change=10", kind)
        found = result["certificate"]
        intervals.append(found)
        # What bounds J is J of the same displacement.
        check(f"degree {degree}", found["loads_are_exact"] and found["lower"] <= found["upper"])
        close(f"degree {degree}", found["upper"], result["functional"], 1e-7)
    two, one = intervals
    check("they meet", two["lower"] <= one["upper"] and one["lower"] <= two["upper"]
          and two["upper"] - two["lower"] <= -0.1 * two["upper"], intervals)


def check_named():
    """The condition of one boundary is that of all, where it is the only one."""
    own, all_of_them = (interval(GLOBAL, f"Tangential displacement{name}=free")
                        for name in (" bottom", ""))
    check("named", own == all_of_them, (own, all_of_them))


HALF = ["Parts/cold=x > 0.5", "Thermal expansion cold=0"]
SHRUNK = ["Parts/cold=y > 0.25", "Thermal expansion cold=-1e-3"]
jumps()
scenes.all_of(
    globals(),
    ("benchmark", check_two_meshes, "Traction top=0; if(x<0.2,0.69,-0.345)"),
    ("soft bonds", check_two_meshes, "Traction top=0; if(x<0.2,0.3,0.2)",
     "Bond stiffness=20"),
    ("free pad", check_two_meshes, "Lengths=0.4, 0.1", "Body force=0; 1",
     "Clamped boundaries=top", "Tangential displacement=free",
     "Traction right=0; 5*y"),
    ("in part free", check_two_meshes, "Traction top=0; if(x<0.2,0.69,-0.345)",
     "Parts/loose=bottom: if(x>0.2,1,0)", "Tangential displacement loose=free"),
    *((f"target {target}, degree {degree}", check_target, degree, target)
      for degree in (1, 2) for target in (2e-2, 1e-4)),
    *((f"{test.__name__}, {kind}", test, kind) for test in (check_prescribed, check_finer)
      for kind in (GLOBAL, FIXED)),
    *((f"temperature {case}", check_temperature, *case) for case in (
        (2, GLOBAL, HALF, "4, 2", "16, 8"), (2, FIXED, HALF, "4, 2", "16, 8"),
        (2, GLOBAL, SHRUNK, "8, 4", "32, 16"), (2, FIXED, SHRUNK, "8, 4", "32, 16"),
        (3, FIXED, HALF, "2, 1, 1", "8, 4, 4"))))
