#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_joints.py DEBOND: two bodies that are glued to each other. Two equal strips are twice the
half of them on a foundation; strips of different stiffness and bonds that soften beside a
program of its own (dense matrices, a change of basis, full enumeration); bonds without end make
one body; a film on a substrate that is as good as rigid; arms of different thickness beside beam
theory; quarter rings from Gmsh; supports of either side; bodies that only bonds hold."""
import itertools
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes, turned

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
NODAL, FREE = "Quadrature=nodal", "Tangential displacement=free"
NO_HEALING = "Bonds heal=false"
JOINT = ["Lengths=40, 4", "Cells=20, 4", "Cuts=y = 2", "Parts/upper=y > 2", "Parts/tl=left: y > 3",
         "Parts/bl=left: y < 1", "Poisson ratio=0.3", "Clamped boundaries=right",
         "Contact boundary=cut_1"]


def ends(upper, lower):
    return ["Displacement tl=" + upper, "Displacement bl=" + lower]


def bonds(stiffness, threshold):
    return [f"Bond stiffness={stiffness!r}", f"Bond threshold={threshold!r}"]


def check_different_strips():
    """E 1000 above 2000: J from rest, and the least one over all states."""
    table = {"fixed": ((.2, 3.773938581183e-01, 3.303907810615e-01),
                       (.6, 1.275625332398, 1.216779655958), (1., 2.775499044327, 2.635338038816),
                       (1.5, 5.370488170676, 5.215716899210)),
             "free": ((.2, 3.181851038168e-01, 2.798324281873e-01),
                      (.6, 9.495981660160e-01, 8.405892559315e-01),
                      (1., 1.730525710921, 1.645934390332), (1.5, 3.196842193184, 3.054051243393))}
    for tangential, rows in table.items():
        for factor, from_rest, least in rows:
            scene = [*JOINT, NODAL, "Tangential displacement=" + tangential, "Young modulus=2000",
                     "Young modulus upper=1000", *bonds(50, 0.0282842712474619),
                     *ends(f"{.2 * factor!r}; {factor!r}", f"free; {-.2 * factor!r}")]
            name = f"{tangential}, {factor}"
            result = solve(*scene, "Search=none")
            close(name + ", from rest", result["functional"], from_rest, 1e-10)
            result = solve(*scene, "Prove=true")
            close(name + ", least", result["functional"], least, 1e-10)
            check(name + " is proved", result["proof"]["status"] == "proved")
            check(name + ", balance", result["force_imbalance"] < 1e-10)
        # One path, on which the displacements at the end stay the last ones.
        path = solve(*scene, "Displacement factors=" + ", ".join(
            repr(factor / rows[-1][0]) for factor, *_ in rows),
                     "Global branch=prove")["path"]
        for row, (factor, _, least) in zip(path, rows, strict=True):
            close(f"{tangential}, {factor}, on a path", row["global_J"], least, 1e-10)
            check("is proved", row["global_minimum"] == "global")


def check_twice_the_half():
    factors = [NO_HEALING, "Displacement factors=0.05, 0.1, 0.3, 0.6, 1, 1.5, 1, 0.3, 0, 2"]
    k, M = 50., math.sqrt(2 * 0.02 / 50)
    strips = [*JOINT, "Young modulus=1000", FREE]
    half = ["Lengths=40, 2", "Cells=20, 2", "Parts/tl=left: y > 1", FREE, "Young modulus=1000",
            "Poisson ratio=0.3", "Clamped boundaries=right", "Contact boundary=bottom",
            "Displacement tl=free; 0.5"]

    def compare(name, two, one, length=1., tolerance=1e-10):
        check(name + " has all steps", len(two) == len(one) == 10, (len(two), len(one)))
        for a, b in zip(two, one):
            at = f"{name} at {b['displacement_factor']}"
            close(at + ": J", a["J"], 2 * b["J"], tolerance, one[-1]["J"])
            close(at + ": dissipated", a["dissipated_energy"], 2 * b["dissipated_energy"],
                  tolerance, one[-1]["J"])
            close(at + ": opening", a["largest_gap"], 2 * b["largest_gap"], tolerance, length)
            close(at + ": force", a["normal_force"], b["normal_force"], tolerance,
                  max(abs(row["normal_force"]) for row in one))

    for name, more in (("nodal", [NODAL]), ("midpoint", ["Quadrature=midpoint"]),
                       ("degree 2", ["Degree=2", "Quadrature=gauss 3"]),
                       ("multigrid", [NODAL, "Linear solver=multigrid"]),
                       ("energy bundle", [NODAL, "Method=energy bundle"])):
        two = solve(*strips, *ends("free; 0.5", "free; -0.5"), *bonds(k, M), *factors, *more)
        one = solve(*half, *bonds(2 * k, M / 2), *factors, *more)
        compare(name, two["path"], one["path"],
                tolerance=1e-8 if name in ("multigrid", "energy bundle") else 1e-10)
        if name in ("nodal", "degree 2"):
            close(name + ": error of the mesh", two["estimated_error"], one["estimated_error"],
                  0.05)
    one = solve(*half, *bonds(2 * k, M / 2), *factors, NODAL)["path"]
    # Also unequal in the supports: only the arm above moves, twice as far.
    for degrees in (37, 180, -90):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        moved = [f"{-.5 * s!r}; {.5 * c!r}", f"{.5 * s!r}; {-.5 * c!r}"]
        rolled = solve(*(turned(e, degrees) if e.startswith("Parts") else e for e in strips),
                       *ends(*moved), f"Rotation={degrees}", *bonds(k, M), *factors, NODAL)
        straight = solve(*strips, *ends("0; 0.5", "0; -0.5"), *bonds(k, M), *factors, NODAL)
        check(f"turned by {degrees} arrives", len(rolled["path"]) == 10, rolled["errors"])
        for a, b in zip(rolled["path"], straight["path"]):
            close(f"turned by {degrees} at {b['displacement_factor']}", a["J"], b["J"], 1e-10,
                  straight["path"][-1]["J"])
    # Cut along x: left and right, as the axes are named otherwise.
    across = solve("Lengths=4, 40", "Cells=4, 20", "Cuts=x = 2", "Parts/tl=bottom: x > 3",
                   "Parts/bl=bottom: x < 1", FREE, NODAL, "Young modulus=1000", "Poisson ratio=0.3",
                   "Clamped boundaries=top", "Contact boundary=cut_1", *ends("0.5; free",
                                                                             "-0.5; free"),
                   *bonds(k, M), *factors)
    compare("cut in x", across["path"], one)
    metres = solve("Lengths=0.04, 0.004", *JOINT[1:2], "Cuts=y = 0.002", "Parts/tl=left: y > 0.003",
                   "Parts/bl=left: y < 0.001", FREE, NODAL, "Young modulus=1e9", *JOINT[6:],
                   *ends("free; 5e-4", "free; -5e-4"), *bonds(k * 1e9, M * 1e-3), *factors)["path"]
    for a, b in zip(metres, one):
        close(f"m, Pa at {b['displacement_factor']}", a["J"], 2 * b["J"], 1e-10, one[-1]["J"])
    # In 3D.
    solid = ["Dimension=3", "Young modulus=1000", *JOINT[6:], FREE, NODAL,
             "Parts/tl=left: y > 3", "Parts/bl=left: y < 1"]
    two = solve(*solid, "Lengths=10, 4, 2", "Cells=5, 4, 1", "Cuts=y = 2",
                *ends("free; 0.1; free", "free; -0.1; free"), *bonds(k, M), *factors)
    one = solve("Dimension=3", *half[2:3], *half[3:8], NODAL, "Lengths=10, 2, 2", "Cells=5, 2, 1",
                "Displacement tl=free; 0.1; free", *bonds(2 * k, M / 2), *factors)
    compare("3D", two["path"], one["path"])


def check_softening():
    law = ["Law=bilinear", "Bond stiffness=100",
           "Bond strength=1", "Fracture energy=0.02", FREE, NODAL]
    strips = [*JOINT, "Young modulus=2000", "Young modulus upper=1000", *law]
    rows = ((.2, .2864078722124, .1754830054967), (.6, .8467306761819, .34),
            (1, 1.652375239849, .46), (1.5, 3.060742443207, .58), (1, 1.682552196981, .58),
            (.5, .8556380492452, .58), (0, .58, .58), (1, 1.682552196981, .58),
            (2, 4.939875760118, .6603608497643))
    path = solve(*strips, *ends("0.2; 1", "free; -0.2"), NO_HEALING,
                 "Displacement factors=" + ", ".join(str(row[0]) for row in rows))["path"]
    check("all steps", len(path) == len(rows))
    for row, (factor, total, dissipated) in zip(path, rows):
        close(f"total at {factor}", row["J"], total, 1e-8)
        close(f"dissipated at {factor}", row["dissipated_energy"], dissipated, 1e-6)
    for b, least in ((.1, .1129336508311), (.3, .2380871003703), (.5, .3211289199003),
                     (1, .4783148178381), (2, .7050006315771)):
        result = solve(*strips, *ends(f"free; {b / 2!r}", f"free; {-b / 2!r}"), "Prove=true")
        close(f"least at {b}", result["functional"], least, 1e-9)
        check(f"{b} is proved", result["proof"]["status"] == "proved")
    arc = solve(*strips, *ends("free; 0.5", "free; -0.5"), "Arc=true",
                "Displacement factors=0:0.1:2")
    found = arc["load_path"]["arc"]
    check("74 corners, 27 segments are unstable", (found["states"], found["unstable"]) == (75, 27))
    close("the longest way back", found["back_from"] - found["back_to"], .4227714142, 1e-8)
    for row, corner in zip(arc["arc"][1:], (.01205812654710, .03950052612617, .03998748699107,
                                            .04033382741685, .04297578240915, .05228980594408)):
        close(f"corner at {corner}", row["displacement_factor"], corner, 1e-8)


def check_sliding():
    """Glue of a M = sqrt(2 100 0.1) = 4.47 that is 50 long bears 224 along itself, by Volkersen a
    little less. A fibre that is pushed out has facets whose normals have a part along its axis:
    without friction nothing should hold it."""
    lap = ["Lengths=50, 4", "Cells=50, 4", "Cuts=y = 2", "Parts/upper end=left: y > 2",
           "Parts/lower end=right: y < 2", "Young modulus=70000", "Poisson ratio=0",
           "Clamped boundaries=", "Roller boundaries=top, bottom", "Displacement lower end=0; free",
           "Contact boundary=cut_1", "Bond stiffness=100", "Bond threshold=", "Fracture energy=0.1"]
    for force, more, is_told in ((-10000, [], True), (-200, [], False),
                                 (-100, ["Tangential displacement=bonded"], False)):
        result = solve(*lap, f"Force upper end={force}; 0", *more)
        told = [note for note in result["notes"] if "Tangential displacement" in note]
        check(f"{force} {more}", result["status"] == "success" and bool(told) == is_told,
              (result["status"], result["notes"]))
    (scenes.directory / "fibre.geo").write_text(FIBRE)
    pushed = ["Dimension=3", "Source=file", "File=fibre.geo", "Cuts=matrix | fibre",
              "Parts/floor=boundary: z < 1e-6 && x^2 + y^2 > 0.25",
              "Parts/push=boundary: z > 1 - 1e-6 && x^2 + y^2 < 0.25", "Young modulus=3000",
              "Young modulus fibre=70000", "Poisson ratio=0.3", "Clamped boundaries=floor",
              "Displacement push=0; 0; -0.02", "Contact boundary=cut_1", "Law=bilinear",
              "Tangential displacement=bonded", "Bond stiffness=1e4", "Bond strength=20",
              "Fracture energy=0.1", "Displacement factors=0.1, 1", NO_HEALING]
    for more, is_told in (([], True), (["Foundation normal cut_1=x; y; 0"],
                                       False)):
        result = solve(*pushed, *more)
        told = [note for note in result["notes"] if "Foundation normal" in note]
        check(f"pushed out {more}", result["status"] == "success" and bool(told) == is_told,
              (result["status"], result["errors"], result["notes"]))


FIBRE = """SetFactory("OpenCASCADE");
Box(1) = {-1, -1, 0, 2, 2, 1};
Cylinder(2) = {0, 0, 0, 0, 0, 1, 0.5};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Mesh.CharacteristicLengthMax = 0.4;
Physical Volume("fibre") = {2};
Physical Volume("matrix") = {3};
"""


def check_limits():
    strips = [*JOINT, "Young modulus=2000", "Young modulus upper=1000",
              *ends("0.2; 0.3", "free; -0.2")]
    for name, more in (("degree 1", [NODAL]),
                       ("degree 2", ["Degree=2", "Quadrature=gauss 3"])):
        one = solve(*(e for e in strips if "Cuts" not in e and "Contact" not in e), *more,
                    "Contact boundary=")["functional"]
        last = None
        for k in (1e6, 1e8, 1e10):
            off = 1 - solve(*strips, *more, *bonds(k, 1.))["functional"] / one
            check(f"{name}, one body but for 1 / {k}", 0 < off < 1e4 / k, off)
            check(f"{name}, {k}: in proportion", last is None or abs(last / off / 100 - 1) < 0.1)
            last = off
    # A film of 1 on a block.
    film = ["Poisson ratio=0.3", "Young modulus=500", NODAL, "Clamped boundaries=",
            "Roller boundaries=right", "Displacement up=free; 0.02", *bonds(50, 0.01)]
    alone = solve(*film, "Lengths=10, 1", "Cells=20, 2", "Parts/up=left: y > 0.5",
                  "Contact boundary=bottom")
    for modulus in (1e6, 1e8):
        both = solve(*film, "Lengths=10, 3", "Cells=20, 6", "Cuts=y = 2", "Parts/up=left: y > 2.5",
                     "Parts/block=y < 2", f"Young modulus block={modulus}",
                     "Contact boundary=cut_1", "Clamped boundaries=bottom")
        close(f"film on a block of {modulus}", both["functional"], alone["functional"],
              3000 / modulus)
    # Pressure in a gap that is open and bears nothing is a load on each body.
    for side in ("cut_1_low", "cut_1_high", "cut_1"):
        result = solve(*JOINT, "Young modulus=1000", NODAL, *bonds(0, 1.),
                       f"Pressure {side}=0.01", "Clamped boundaries=left")
        close("pressure on " + side, result["applied_force"][1],
              {"cut_1_low": -.4, "cut_1_high": .4, "cut_1": 0.}[side], 1e-12, 0.4)


def check_arms():
    """C^(1/3) of an arm is linear in the length of the crack, with the slope (1 / (3 E I))^(1/3)."""
    roots = {}
    for length in (60, 80):
        result = solve("Lengths=100, 3", "Cells=100, 3", "Cuts=y = 1", "Degree=2",
                       "Quadrature=gauss 3", FREE, "Parts/up=left: y > 1", "Parts/down=left: y < 1",
                       "Parts/open=cut_1: x < " + str(length), "Bond stiffness open=0",
                       "Young modulus=1000", "Poisson ratio=0.3", "Clamped boundaries=right",
                       "Contact boundary=cut_1", *bonds(1e5, 1.), "Traction up=0; 5e-7",
                       "Traction down=0; -1e-6")
        for side in ("up", "down"):
            roots[side, length] = abs(result["mean_displacements"][side][1] / 1e-6)**(1 / 3)
    for side, thickness in (("up", 2), ("down", 1)):
        slope = (roots[side, 80] - roots[side, 60]) / 20
        close(side, slope, (4 / (1000 * thickness**3))**(1 / 3), 0.01)


def check_supports():
    """Where either body is held at the end of the interface the answer is the same."""
    base = ["Lengths=4, 2", "Cells=4, 2", "Cuts=y = 1", "Parts/tl=left: y > 1",
            "Parts/bl=left: y < 1", "Parts/tr=right: y > 1", "Parts/br=right: y < 1",
            "Young modulus=100", "Poisson ratio=0.3", NODAL, *bonds(20, 0.1),
            "Contact boundary=cut_1"]
    mirrored = {"tl": "bl", "bl": "tl", "tr": "br", "br": "tr"}
    for tangential, held, other in itertools.product(("fixed", "free"), ("tl", "bl"),
                                                     ("tr", "br", "tl", "bl")):
        if tangential == "free" and held == other:
            continue
        results = []
        for side, load, sign in ((held, other, 1), (mirrored[held], mirrored[other], -1)):
            results.append(solve(*base, "Tangential displacement=" + tangential,
                                 f"Displacement {side}=0.01; {sign * 0.02}",
                                 "Clamped boundaries=" + (load if load != side else ""),
                                 f"Traction {'tr' if sign == 1 else 'br'}=0; {sign * 0.1}"))
        a, b = results
        name = f"{tangential}, {held} and {other}"
        check(name + ", exits", a["exit_code"] == b["exit_code"], (a["errors"], b["errors"]))
        if tangential == "fixed" and {held, other} == {"tl", "bl"}:
            check(name + ", a slip is refused", "Tangential displacement = fixed" in a["errors"],
                  a["errors"])
        if a["exit_code"] == b["exit_code"] == 0:
            close(name + ", mirrored", a["functional"], b["functional"], 1e-10)
            check(name + ", balance", max(a["force_imbalance"], b["force_imbalance"]) < 1e-10)
            for key in a["reactions"]:
                for d, sign in ((0, 1), (1, -1)):
                    close(f"{name}, reaction {key} {d}", b["reactions"][mirrored.get(key, key)][d],
                          sign * a["reactions"][key][d], 1e-9,
                          max(1e-3, *(abs(x) for f in a["reactions"].values() for x in f)))
    lap = [*base, "Clamped boundaries=bl"]
    pulled = solve(*lap, "Traction tr=0.2; 0.05")
    check("bonds hold the upper body", pulled["status"] == "success", pulled["errors"])
    check("which the log says", "held by contact       translation in y of the body at"
          in pulled["log"])
    off = solve(*lap, "Traction tr=0.2; 9")
    check("it comes off", (off["status"], off["exit_code"]) == ("comes off", 0), off["status"])
    check("and how", off["comes_off"]["translation"][1] > 0, off.get("comes_off"))
    errors = solve(*lap, "Traction tr=0.2; 0", FREE)["errors"]
    check("nothing holds it along x", "translation in x of the body at" in errors, errors)


def check_refined():
    """Both sides are bisected alike, where only one of them needs it, too."""
    strips = [*JOINT, "Young modulus=100", "Young modulus upper=10000", FREE,
              *bonds(50, 0.0282842712474619), *ends("free; 0.5", "free; -0.5")]
    fine = solve(*(e for e in strips if "Cells" not in e), "Cells=320, 32", "Degree=2",
                 "Quadrature=gauss 3", "Search=none")["functional"]
    for target, more in ((0.02, [NODAL]), (0.02, [NODAL, "Cuts=y = 2 && x < 30"]),
                         (0.001, ["Degree=2", "Quadrature=gauss 3"])):
        names = {e.split("=")[0] for e in more}
        result = solve(*(e for e in strips if e.split("=")[0] not in names), *more,
                       f"Accuracy/Target={target}")
        check(f"{target}: success", result["status"] == "success", result["errors"])
        check(f"{target}: refined", result["degrees_of_freedom"] > 1000)
        check(f"{target}: balance", result["force_imbalance"] < 1e-9)
        close(f"{target}, {more}: J", result["functional"], fine, 1.5 * target)
    solid = solve("Dimension=3", "Lengths=4, 2, 1", "Cells=4, 2, 1", "Cuts=y = 1",
                  "Parts/tl=left: y > 1", "Parts/bl=left: y < 1", *JOINT[6:],
                  *ends("free; 0.01; free", "free; -0.01; free"), *bonds(50, 0.01),
                  "Accuracy/Maximum unknowns=2000")
    check("3D: success", solid["status"] == "success" and solid["degrees_of_freedom"] > 800,
          solid["errors"])


SMALL = ["Lengths=5, 2", "Cells=5, 2", "Cuts=y = 1", "Young modulus=1000", "Poisson ratio=0.3",
         "Contact boundary=cut_1", "Clamped boundaries=", "Parts/lr=right: y < 1",
         "Parts/ur=right: y > 1", "Parts/ul=left: y > 1", *bonds(10, 0.05)]
CLAMPED = "Clamped boundaries="
MOVED = "Displacement "


def small(*settings):
    names = {entry.split("=")[0] for entry in settings}
    return solve(*(e for e in SMALL if e.split("=")[0] not in names), *settings)


def check_edges():
    """What random joints, enumerated by another program, have shown to be hard."""
    # The bond at the end of the interface, which both supports stretch, is in J and in the
    # reactions, whichever way the supports are said.
    for settings in ([CLAMPED + "ur", MOVED + "lr=0; -0.03"], [MOVED + "ur=0; 0",
                     MOVED + "lr=0; -0.03"], [CLAMPED + "lr", MOVED + "ur=0; 0.03"]):
        result = small(*settings)
        close("both ends held: J", result["functional"], 9.3766e-03, 1e-5)
        # Of a parabola in what is prescribed.
        for name, sign in (("ur", 1), ("lr", -1)):
            close("reaction of " + name, result["reactions"][name][1],
                  sign * 2 * result["functional"] / 0.03, 1e-10)

    # Nothing is left of the forces.
    for settings in ([CLAMPED + "ur", MOVED + "lr=0.03; 0"],
                     [CLAMPED + "lr", "Roller boundaries=ul",
                      MOVED + "ur=free; 0.1", "Factors=0:0.1:2"]):
        result = small(FREE, *settings)
        check("without forces", result["status"] == "success", result["errors"])

    # Neither jump nor bond at the end of a cut.
    for gap, sign in ((0.01, -1), (-0.01, 1)):
        result = small("Cuts=y = 1 && x < 3", CLAMPED + "bottom, top", f"Initial gap={gap}")
        check(f"gap {gap}", result["status"] == "success", result["errors"])
        close(f"gap {gap}, supports", result["clamped_reaction"][1], 0, 1e-9, 0.1)
        check(f"gap {gap}, sign", sign * result["reactions"]["bottom"][1] > 0.1)

    # Off, about the end that its support holds, and with bonds that soften.
    off = small(CLAMPED + "bottom", MOVED + "ur=free; 0", "Traction top=0; 1")
    check("turns off", off["status"] == "comes off", off["status"])
    soft = solve("Lengths=2, 3", "Cells=4, 3", "Cuts=x = 1.5", "Poisson ratio=0.231",
                 "Contact boundary=cut_1", CLAMPED + "held", "Parts/held=top: x > 1.5",
                 "Parts/low=left: y < 1", "Parts/middle=left: y > 1 && y < 2",
                 "Traction low=0; -0.534", "Traction middle=-4.576; 0.661", "Law=bilinear",
                 "Bond stiffness=32.17", "Bond strength=2.195", "Fracture energy=0.31988")
    check("softening bonds let go", soft["status"] == "comes off", soft["status"])


RINGS = """h = 0.2;
Point(1) = {1,0,0,h}; Point(2) = {2,0,0,h}; Point(3) = {3,0,0,h};
Point(4) = {0,1,0,h}; Point(5) = {0,2,0,h}; Point(6) = {0,3,0,h}; Point(7) = {0,0,0,h};
Circle(1) = {1,7,4}; Circle(2) = {2,7,5}; Circle(3) = {3,7,6};
Line(4) = {1,2}; Line(5) = {2,3}; Line(6) = {4,5}; Line(7) = {5,6};
Curve Loop(1) = {4,2,-6,-1}; Plane Surface(1) = {1};
Curve Loop(2) = {5,3,-7,-2}; Plane Surface(2) = {2};
Physical Surface("inner") = {1}; Physical Surface("outer") = {2};
Physical Curve("bore") = {1}; Physical Curve("rim") = {3};
Physical Curve("low") = {4,5}; Physical Curve("up") = {6,7};
"""


def check_rings():
    """Against the ring as one body, and a press fit of two in closed form."""
    (scenes.directory / "rings.geo").write_text(RINGS)
    rings = ["Source=file", "File=rings.geo", "Young modulus=100", "Young modulus outer=300",
             "Poisson ratio=0.3", "Clamped boundaries=", "Roller boundaries=low, up"]
    loads = ["Pressure rim=if(x > y, -1, 0.3)"]
    glued = [*rings, "Contact boundary=cut_1"]
    for tangential, more in (("fixed", [NODAL]), ("bonded", [NODAL]),
                             ("bonded", ["Degree=2", "Quadrature=gauss 3"])):
        one = solve(*rings, *loads, *more, "Contact boundary=")["functional"]
        for cuts in ("inner | outer", "outer | inner"):
            off = []
            for k in (1e5, 1e7):
                shear = [f"Bond shear stiffness={.7 * k}"] if tangential == "bonded" else []
                result = solve(*glued, *loads, *more, "Cuts=" + cuts, *bonds(k, 1.), *shear,
                               "Tangential displacement=" + tangential, "Search=none")
                off.append(result["functional"] / one - 1)
                check(f"{cuts}, {k}: balance", result["force_imbalance"] < 1e-9)
            check(f"{cuts}, {tangential}, {more[0]}: one body but for 1 / k", 0 < off[1] < 1e-5
                  and abs(off[0] / off[1] / 100 - 1) < 0.1, off)
    # The outer ring is shrunk by heat: the pressure between both in plane stress.
    for degree, tolerance in ((1, 0.03), (2, 0.003)):
        result = solve(*glued, "Cuts=inner | outer", FREE, *bonds(0, 1.),
                       "Temperature change=-1", "Thermal expansion outer=0.01",
                       f"Degree={degree}", *(["Quadrature=gauss 3"] if degree == 2 else []))

        def yields(E, inner, outer, is_inner):
            factor = (outer**2 + inner**2) / (outer**2 - inner**2)
            return 2 * (factor - 0.3 if is_inner else factor + 0.3) / E
        pressure = 2 * 0.01 / (yields(100, 1, 2, True) + yields(300, 2, 3, False))
        close(f"press fit, degree {degree}", result["contact_reaction"][0], 2 * pressure, tolerance)


scenes.all_of(globals())
