#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_softening.py DEBOND: bonds that soften. A column by hand, in several units; paths of
a strip beside a program of its own (dense matrices, all of majorise-minimise in Python); a
cube that snaps back; least states that are proved; the limit of brittle bonds; a double
cantilever beam through its snaps."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
FREE = ["Tangential displacement=free", "Quadrature=nodal"]
NO_HEALING = "Bonds heal=false"


def law(name, stiffness, strength, energy):
    return [f"Law={name}", f"Bond stiffness={stiffness}",
            f"Bond strength={strength}", f"Fracture energy={energy}"]


def column(length, modulus, *more):
    """E 100, height 2, moved by d: its compliance C is 0.02, bonds of k 100, t 1, G 0.02."""
    return solve(f"Lengths={2 * length}, {2 * length}", "Cells=2, 2",
                 f"Young modulus={100 * modulus}", "Poisson ratio=0", "Clamped boundaries=",
                 "Roller boundaries=left", "Contact boundary=bottom",
                 f"Displacement top=free; {length}", *FREE,
                 "Displacement factors=0.005, 0.02, 0.035, 0.02, 0, 0.035, 0.04, 0.05",
                 NO_HEALING, *law("bilinear", 100 * modulus / length, modulus,
                                  0.02 * modulus * length), *more)


def check_cracks():
    """The left half of a strip has no bonds and is lifted: laws without an end have its crack."""
    for more in (law("exponential", 1e3, 10, 1), ["Law=curve",
                                                   "Curve=0:0, 0.01:10, 0.02:5, 1:5"]):
        result = solve("Lengths=40, 2", "Cells=40, 2", "Young modulus=1e4",
                       "Clamped boundaries=right", "Contact boundary=bottom",
                       "Displacement left=free; 0.1", *FREE, *more,
                       "Traction factor=if(x < 20, 0, 1)", "Displacement factors=0.5, 1")
        for row in result["path"]:
            close("broken zone", row["broken_zone"], 20, 1e-9)
            check("front", [float(x) for x in str(row["fronts"]).split()] == [20, 0], row["fronts"])


def check_column():
    # d, opening, J of the width 2: (d - p)^2 / (2 C) + j_1(p), p = (d - C t) of the line
    # t = (0.04 - p) / 0.03 or t = 100 p; back at t = 20 p.
    expected = [(0.005, 0.005 / 3, 0), (0.02, 1 / 150, 0), (0.035, 0.025, 0.01),
                (0.02, 0.02 / 1.4, 0.01), (0, 0, 0.01), (0.035, 0.025, 0.01),
                (0.04, 0.04, 0.02), (0.05, 0.05, 0.02)]
    for name, length, modulus, more in (
            ("MPa, mm", 1., 1., []), ("Pa, m", 1e-3, 1e6, []), ("GPa, m", 1e-3, 1e-3, []),
            ("degree 2", 1., 1., ["Degree=2", "Quadrature=gauss 3"]),
            ("midpoint", 1., 1., ["Quadrature=midpoint"]),
            ("multigrid", 1., 1., ["Linear solver=multigrid"])):
        path = column(length, modulus, *more)["path"]
        check(name + " has all steps", len(path) == len(expected))
        for row, (d, opening, taken) in zip(path, expected):
            energy = 2 * modulus * length**2
            close(f"{name}, opening at {d}", row["largest_gap"], opening * length, 1e-10,
                  0.04 * length)
            close(f"{name}, dissipated at {d}", row["dissipated_energy"], taken * energy, 1e-10,
                  0.02 * energy)
            traction = (d - opening) / 0.02
            close(f"{name}, force at {d}", -row["normal_force"], 2 * modulus * length * traction,
                  1e-9, 2 * modulus * length)
            close(f"{name}, balance at {d}", row["elastic_energy"] + row["adhesion_energy"],
                  row["J"], 1e-13, 0.02 * energy)
        close(name + ", J at 0.035", path[2]["J"], 0.01875 * energy, 1e-10)
    # From rest, each by itself, by both methods.
    for method in ("majorise minimise", "energy bundle"):
        for d, opening, J in ((0.02, 1 / 150, 0.0066666666666666667), (0.035, 0.025, 0.01875),
                              (0.05, 0.05, 0.02)):
            result = column(1., 1., "Displacement factors=", "Bonds heal=true",
                            f"Displacement top=free; {d}", "Method=" + method)
            close(f"{method}, J at {d}", result["functional"], 2 * J, 1e-9)
            close(f"{method}, opening at {d}", result["largest_opening"], opening, 1e-5)


def strip(*more):
    return solve("Lengths=40, 2", "Cells=20, 2", "Parts/grip=left: y > 1", "Young modulus=1000",
                 "Poisson ratio=0.3", "Clamped boundaries=right", "Contact boundary=bottom",
                 "Displacement grip=0.2; 1", *FREE, *more)


# Factor: total and dissipated energy, bilinear and exponential.
PATH = {"bilinear": [(0.2, 0.3154258876617, 0.1871095483233), (0.6, 0.8825149347967, 0.38),
                     (1, 1.680100494737, 0.5), (1.5, 3.072030693976, 0.6202187648677),
                     (1, 1.709912955582, 0.6202187648677), (0.5, 0.8926423125464, 0.6202187648677),
                     (0, 0.6202187648677, 0.6202187648677), (2, 4.924806934210, 0.7104452569407)],
        "exponential": [(0.2, 0.3117708209190, 0.1692808895915), (0.6, 0.8785721038235,
                                                                  0.3691348645244),
                        (1, 1.676806740887, 0.4907563379429), (1.5, 3.069020129493,
                                                               0.6114547082725), (1, 1.703706006593,
                                                                                  0.6114547082725),
                        (0.5, 0.8845175328526, 0.6114547082725), (0, 0.6114547082725,
                                                                  0.6114547082725),
                        (2, 4.920527718965, 0.7238151544637)]}


def check_strip():
    for name, expected in PATH.items():
        path = strip(*law(name, 100, 1, 0.02), NO_HEALING, "Displacement factors="
                     + ", ".join(str(row[0]) for row in expected))["path"]
        check(name + " has all steps", len(path) == len(expected))
        for row, (factor, total, dissipated) in zip(path, expected):
            close(f"{name}, total at {factor}", row["J"], total, 1e-8)
            close(f"{name}, dissipated at {factor}", row["dissipated_energy"], dissipated, 1e-6)
        check(name + ", all are minima", all(r["minimum"] == "local minimum" for r in path))
    # Small steps, and bonds between the nodes of a finer mesh.
    factors = "Displacement factors=0.05:0.05:3"
    for name, cells, most in (("bilinear", "20, 2", 4), ("bilinear", "80, 8", 5),
                              ("exponential", "20, 2", 4), ("exponential", "80, 8", 5)):
        path = strip(*law(name, 100, 1, 0.02), NO_HEALING, factors, "Cells=" + cells)["path"]
        mean = sum(row["iterations"] for row in path) / len(path)
        check(f"{name} {cells}: iterations for a factor", len(path) == 60 and mean <= most, mean)
        taken = [row["dissipated_energy"] for row in path]
        check(f"{name} {cells}: what is taken does not fall", taken == sorted(taken))


def check_brittle():
    """With a fracture energy of little more than strength^2 / (2 stiffness)."""
    factors = [NO_HEALING, "Displacement factors=0.2, 0.6, 1, 1.5, 0.5, 2"]
    winkler = strip("Bond stiffness=100", "Bond threshold=0.01", *factors)["path"]
    for part in (1e-3, 1e-6):
        soft = strip(*law("bilinear", 100, 1, 0.005 * (1 + part)), *factors)["path"]
        for row, brittle in zip(soft, winkler):
            close(f"{part}: dissipated", row["dissipated_energy"],
                  brittle["dissipated_energy"] * (1 + part), 1e-9)
            close(f"{part}: J", row["J"] - row["dissipated_energy"],
                  brittle["J"] - brittle["dissipated_energy"], 1e-9, brittle["J"])


def check_snap_back():
    """A cube of E 0.5 whose bonds are rigid up to 1.1 and then soften (SSNP118 of
    code_aster, V6.03.118): the opening p goes with the traction t = 1.1 (1 - p / p_c), p_c =
    1.8 / 1.1, and the top with p + t / 0.5."""
    p_c = 1.8 / 1.1
    for dimension in (2, 3):
        both = dimension == 3
        result = solve(f"Dimension={dimension}", "Lengths=1, 1" + ", 1" * both,
                       "Cells=2, 2" + ", 2" * both, "Young modulus=0.5", "Poisson ratio=0",
                       "Clamped boundaries=", "Roller boundaries=left" + ", front" * both,
                       "Contact boundary=bottom", "Displacement top=free; 1" + "; free" * both,
                       *FREE, "Law=curve", f"Curve=0:1.1, {p_c!r}:0", "Displacement factors=1, 3",
                       "Arc=true")
        arc = result["arc"]
        check(f"{dimension}D: four states", [row["status"] for row in arc] ==
              ["stable", "stable", "unstable", "stable"], arc)
        # Straight between the states.
        first, last = arc[1:3]
        for opening, moved, force in ((0.368848, 2.0729525, 0.852052),
                                      (1.45237, 1.699739, 0.123685)):
            part = opening / last["largest_gap"]
            between = {name: first[name] + part * (last[name] - first[name])
                       for name in ("displacement_factor", "normal_force")}
            traction = 1.1 * (1 - opening / p_c)
            close(f"{dimension}D: displacement", between["displacement_factor"],
                  opening + traction / 0.5, 1e-12)
            close(f"{dimension}D: force", -between["normal_force"], traction, 1e-12)
            close(f"{dimension}D: published", between["displacement_factor"], moved, 1e-6)
            close(f"{dimension}D: published force", -between["normal_force"], force, 1e-5)


def check_proofs():
    """Half of two equal strips: least states by another branch and bound, in Python."""
    for b, J in ((0.1, 0.1068156398590), (0.3, 0.2275626259770), (0.5, 0.3067896265292),
                 (1, 0.4570378093090), (2, 0.6685556957074)):
        result = strip("Poisson ratio=0", *law("bilinear", 200, 1, 0.01),
                       f"Displacement grip=free; {b / 2}", "Prove=true")
        close(f"half of it at {b}", 2 * result["functional"], J, 1e-9)
        check(f"proved at {b}", result["minimum"]["state"] == "global")
        check(f"in few nodes at {b}", result["proof"]["nodes"] <= 81, result["proof"])
    # The arc from rest ends where the path does.
    settings = ["Poisson ratio=0", *law("bilinear", 200, 1, 0.01), "Displacement grip=free; 0.5",
                "Displacement factors=0, 2"]
    result = strip(*settings, "Arc=true")
    check("arc with unstable states", {r["status"] for r in result["arc"]} ==
          {"stable", "unstable"}, len(result["arc"]))
    close("and the end of the path", result["arc"][-1]["J"], result["path"][-1]["J"], 1e-11)
    # A curve is the law of its points, in the scene or in a file.
    (scenes.directory / "law.csv").write_text("opening,traction\n0,0\n0.005,1\n0.02,0\n")
    for entry in ("Curve=0:0, 0.005:1, 0.02:0", "Curve file=law.csv"):
        other = strip("Poisson ratio=0", "Law=curve", entry, *settings[5:])
        close(entry, other["path"][-1]["J"], result["path"][-1]["J"], 1e-12)


def check_double_cantilever():
    """Strong bonds on coarse cells: the crack runs on in snaps."""
    for name in ("bilinear", "exponential"):
        result = solve("Lengths=100, 1.5", "Cells=200, 3",
                       "Hypothesis=plane strain", "Young modulus=126000",
                       "Poisson ratio=0.3", "Clamped boundaries=right",
                       "Contact boundary=bottom",
                       "Displacement left=free; 0.5", *FREE,
                       *law(name, 200000, 57, 0.14), "Traction factor="
                       "if(x < 30 - 1e-9, 0, if(x < 30 + 1e-9, 0.5, 1))",
                       "Displacement factors=0.1:0.1:6", NO_HEALING)
        path = result["path"]
        check(name + " arrives", result["exit_code"] == 0 and len(path) == 60)
        check(name + " snaps, by more than a node", max(b["dissipated_energy"] - a["dissipated_energy"]
                                   for a, b in zip(path, path[1:])) > 0.105)
        check(name + ": at most 40 iterations a factor",
              max(row["iterations"] for row in path) <= 40,
              max(row["iterations"] for row in path))
        check(name + ": damage from 0 to 1", min(r["damage"] for r in result["profile"]) == 0.
              and max(r["damage"] for r in result["profile"]) > 0.99)
        check(name + " has no note on its cells", not any("zone" in n for n in result["notes"]))


def check_edges():
    """What random scenes have shown to be hard."""
    # A pad that only bonds of strength 0.1 hold.
    pad = ["Lengths=0.2, 0.1", "Cells=8, 4", "Clamped boundaries=", "Contact boundary=bottom"]
    for name in ("bilinear", "exponential"):
        for pull in (0.11, 0.2, 1):
            result = solve(*pad, f"Traction top=0; {pull}", *law(name, 100, 0.1, 1e-4))
            check(f"{name} comes off at {pull}", (result["status"], result["exit_code"]) ==
                  ("comes off", 0), result["status"])
        result = solve(*pad, "Traction top=0; 0.05", *law(name, 100, 0.1, 1e-4))
        check(name + " holds", result["status"] == "success")
    # Softening so steep that single nodes have a negative pivot on the arc.
    for scene in (["Displacement right=free; 1", *law("bilinear", 5, 0.1, 0.00105),
                   "Displacement factors=0.02:0.02:0.6"],
                  ["Traction right=0; 0.5", "Law=curve", "Curve=0:1, 0.1:0", "Factors=0.1:0.1:1"]):
        result = solve("Lengths=10, 1", "Cells=6, 1", "Arc=true", "Clamped boundaries=left",
                       "Contact boundary=bottom", *scene)
        check("steep: arc to the end of the interval, without a note",
              result["exit_code"] == 0 and not any("arc" in n for n in result["notes"]) and
              all(row["status"] in ("stable", "unstable") for row in result["arc"]),
              result["notes"])
    # Bonds that are all but brittle.
    beam = ["Lengths=1, 0.5", "Cells=2, 1", "Young modulus=10",
            "Clamped boundaries=left", "Traction right=0; 0.1"]
    brittle = solve(*beam, "Bond stiffness=3", "Bond threshold=0.1")
    for part in (1e-3, 1e-5, 1e-6, 1e-8, 1e-9, 1e-12):
        result = solve(*beam, *law("bilinear", 3, 0.3, repr(0.015 * (1 + part))))
        check(f"brittle to {part}", result["minimum"]["state"] == "global", result["errors"])
        close(f"J of brittle to {part}", result["functional"], brittle["functional"], 20 * part
              + 1e-12)
    # A curve whose second piece is the stiffest.
    result = solve("Lengths=1.6, 1.16", "Cells=4, 2", "Young modulus=8.56", "Poisson ratio=0.02",
                   "Clamped boundaries=left, right", "Contact boundary=bottom",
                   "Traction top=0; 0.66", "Law=curve", "Prove=true",
                   "Curve=0:0, 0.0006:0.15, 0.0007:0.2, 0.0012:0")
    check("bonds that stiffen are proved", result["minimum"]["state"] == "global")
    # Starts from all bonds broken reach the tail of an exponential law.
    states = [solve("Lengths=3.98, 0.34", "Cells=9, 1", "Young modulus=5.52",
                    "Poisson ratio=0.15", "Hypothesis=plane strain",
                    "Clamped boundaries=left",
                    "Contact boundary=bottom",
                    "Traction top=0; 0.0214", "Body force=0; -0.0283",
                    *FREE, *law(name, 72.6, 0.0686, 0.00013))["functional"]
              for name in ("bilinear", "exponential")]
    close("a peeled strip is found with both laws", states[0], states[1], 0.01)


def check_gap():
    """A path begins at rest, where a gap of 0.15 has softened the bonds to the secant of its
    traction 10 (0.2 - 0.15) / 0.19, whichever factors come first."""
    secant = 10 * .05 / .19 / .15
    for factors in "-0.14", "0, -0.14", "-0.14, -0.1, 0", "0, -0.05, -0.149, -0.14":
        path = solve("Lengths=1, 1", "Cells=1, 1", "Young modulus=1e6", "Poisson ratio=0",
                     "Clamped boundaries=", "Contact boundary=bottom", "Displacement top=0; 1",
                     *FREE, *law("bilinear", 1000, 10, 1), "Initial gap=0.15",
                     "Displacement factors=" + factors, NO_HEALING)["path"]
        row = next((row for row in path if row["displacement_factor"] == -.14), {})
        close(f"force on the way {factors}", row.get("unit_displacement_work"),
              .01 * secant / (1 + secant / 1e6), 1e-8)


def check_units():
    """Rings that softening bonds alone hold: J goes with the cube of the unit of length."""
    results = [solve("Symmetry=axis", f"Constants/u={u!r}", "Lengths=6.6*u, 3.9*u", "Cells=2, 3",
                     "Cuts=y = 1.3*u, y = 2.6*u", "Parts/upper=y > 1.3*u", "Young modulus=55",
                     "Poisson ratio=0.4", "Young modulus upper=3.3", "Poisson ratio upper=0.2",
                     "Clamped boundaries=bottom", "Contact boundary=cut_1, cut_2", "Search=none",
                     "Displacement top=free; 0.05*u", "Pressure cut_1=0.0155", *law("bilinear",
                                                                                    "74/u", 0.07,
                                                                                    "1.12e-4*u"),
                     "Tangential displacement=bonded").get("functional", 0.) / u**3
               for u in (1., 1e-3, 1e2, 1e3, 1e4)]
    for value in results[1:]:
        close("J", value, results[0], 1e-9)


scenes.all_of(globals())
