#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_certificate.py DEBOND: intervals for the least J of the continuous problem,
on a mesh and on one four times as fine, whose displacements are on the sides as the
table of the coarse one says; the branches of a state that is kept, and what has no
certificate. Random scenes are in program/certified_bounds."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile


def run(debond, entries):
    result = subprocess.run(
        [debond, "scene.prm", "--set", "Output/Directory=output"] +
        [word for entry in entries for word in ("--set", entry)],
        capture_output=True, text=True, timeout=600)
    if result.returncode != 0:
        return result, None
    return result, json.loads(
        pathlib.Path("output/summary.json").read_text())


def rows(name):
    with open(name, newline="") as file:
        return list(csv.DictReader(file))


def wrong_sides(sides, profile, threshold):
    """Those of a coarse mesh that the displacement of a finer one, with a J that is
    not above the upper number, is not on; the sides are at the bottom."""
    width = max(float(side[x]) for side in sides for x in ("x0", "x1"))
    displacement = {round(float(row["x"]) / width, 9): float(row["u_nu"])
                    for row in profile}
    wrong = certain = 0
    for side in sides:
        ends = sorted((float(side["x0"]), float(side["x1"])))
        middle, half = sum(ends) / 2., (ends[1] - ends[0]) / 2.
        points = [ends[0] + i * half / 2. for i in range(5)]
        # What is clamped is no contact node.
        values = [displacement.get(round(x / width, 9), 0.) for x in points]
        mean = slope = 0.
        for i in range(4):
            mean += (values[i] + values[i + 1]) / 8.
            xi = [(x - middle) / half for x in points[i:i + 2]]
            slope += 0.5 / 6. * 1.5 * (
                values[i] * xi[0] + values[i + 1] * xi[1] +
                (values[i] + values[i + 1]) * (xi[0] + xi[1]))
        linear = (mean - slope, mean + slope)
        rounding = 1e-9 * max(abs(value) for value in values)
        is_wrong = not (
            float(side["least_mean"]) - rounding <= mean <=
            float(side["largest_mean"]) + rounding and
            float(side["least_linear"]) - rounding <= min(linear) and
            max(linear) <= float(side["largest_linear"]) + rounding)
        if threshold is not None and side["state"] != "uncertain":
            is_wrong |= (min(linear) < -threshold if side["state"] == "bonded"
                         else max(linear) > -threshold)
        certain += side["state"] != "uncertain"
        wrong += is_wrong
    return wrong, certain


def main(debond):
    failures = []
    # All intervals hold for one number: lower ends are below the upper ends of the
    # other mesh, which knows nothing of them.
    for name, entries in {
            "benchmark": ["Loads/Traction top=0; if(x<0.2,0.69,-0.345)"],
            "soft bonds": ["Loads/Traction top=0; if(x<0.2,0.3,0.2)",
                           "Contact law/Bond stiffness=20"],
            "free pad": ["Mesh/Lengths=0.4, 0.1", "Loads/Body force=0; 1",
                         "Boundary conditions/Clamped boundaries=top",
                         "Contact law/Tangential displacement=free",
                         "Loads/Traction right=0; 5*y"]}.items():
        intervals, sides = [], []
        for cells in ("20, 2", "80, 8"):
            summary = run(debond, entries + [
                "Mesh/Cells=" + cells, "Certificate/Kind=global"])[1]
            intervals.append(summary["certificate"])
            sides.append(rows("output/certified_sides.csv"))
            profile = rows("output/contact_profile.csv")
        coarse, fine = intervals
        wrong, certain = wrong_sides(sides[0], profile, 0.002)
        if not (coarse["lower"] <= fine["upper"] <= coarse["upper"] and
                fine["lower"] <= fine["upper"] and wrong == 0 and certain > 0):
            failures.append(f"{name}: {coarse}, {fine}, {wrong} sides are not where "
                            f"they are certain to be, of {certain}")

    # The least J is not above that with some branches kept, and both have the
    # result above them.
    summaries = [run(debond, [f"Certificate/Kind={kind}"])[1]["certificate"]
                 for kind in ("global", "fixed state")]
    if not (summaries[0]["minimum"] == "global" and
            summaries[1]["minimum"] == "fixed state" and
            summaries[0]["lower"] <= summaries[1]["upper"]):
        failures.append(f"kinds: {summaries}")
    without_bonds = run(debond, ["Certificate/Kind=fixed state",
                                 "Contact law/Law=none"])[1]["certificate"]
    if without_bonds["minimum"] != "global":
        failures.append("without bonds a state is all there is")

    # Refined until it is narrow enough, or as far as asked, which is said.
    for degree in ("1", "2"):
        for target in ("2e-2", "1e-4"):
            result, summary = run(debond, [
                "Certificate/Kind=global", f"Certificate/Target={target}",
                f"Mesh/Degree={degree}", "Contact law/Quadrature=gauss 8",
                "Loads/Traction top=0; if(x<0.2,0.69,-0.345)",
                "Accuracy/Maximum unknowns=3000"])
            if summary is None:
                summary = json.loads(
                    pathlib.Path("output/summary.json").read_text())
            interval = summary["certificate"]
            is_met = interval["relative_width"] <= float(target)
            body = pathlib.Path("output/body.vtu").read_bytes()
            contact = pathlib.Path("output/contact.vtu").read_bytes()
            if not (is_met == (target == "2e-2") and
                    result.returncode == (0 if is_met else 3) and
                    interval["minimum"] == "global" and
                    interval["lower"] <= -5.9151e-4 <= interval["upper"] and
                    is_met == ("Certificate/Target is 0.0001" not in
                               result.stderr) and
                    b'"gap_density"' in body and
                    b'"equilibrated_stress_xy"' in body and
                    b'"certain_branch"' in contact):
                failures.append(f"Target {target}, degree {degree}: "
                                f"{interval}, exit code {result.returncode}, "
                                f"{result.stderr!r}")

    # A load that jumps inside a side: on the other mesh at a vertex, so that
    # both intervals are for one number; and each has J in it, whatever the
    # quadrature.
    jump = ["Loads/Traction top=0; if(x<0.4*7/24,0.5,-0.4)",
            "Certificate/Kind=global"]
    fine = run(debond, jump + ["Mesh/Cells=48, 4", "Mesh/Degree=2",
                               "Contact law/Quadrature=gauss 8"])[1]
    if not fine["certificate"]["loads_are_exact"]:
        failures.append(f"jump at a vertex: {fine['certificate']}")
    for degree, quadrature in (("1", "nodal"), ("1", "gauss 8"), ("2", "gauss 8")):
        for cells in ("8, 1", "16, 2", "32, 2"):
            for target in ("", "0.02"):
                result, summary = run(debond, jump + [
                    f"Mesh/Cells={cells}", f"Mesh/Degree={degree}",
                    f"Contact law/Quadrature={quadrature}"] + (
                        [f"Certificate/Target={target}",
                         "Accuracy/Maximum unknowns=9000"] if target else []))
                interval = summary["certificate"] if summary else {
                    "lower": 1., "upper": -1.}
                if not (interval["lower"] <= summary["functional"] <=
                        interval["upper"] and
                        interval["lower"] <= fine["certificate"]["upper"] and
                        fine["certificate"]["lower"] <= interval["upper"]):
                    failures.append(
                        f"jump, {cells} cells, degree {degree}, {quadrature}, "
                        f"{target}: {summary['functional']} in {interval}?")

    # What rounding does not let certify has its result, and the reason.
    flat = ["Mesh/Lengths=0.0002, 0.06", "Mesh/Cells=4, 3",
            "Boundary conditions/Clamped boundaries=top",
            "Loads/Traction top=", "Loads/Traction bottom=0; 0.2",
            "Material/Hypothesis=plane strain",
            "Material/Poisson ratio=0.49999999"]
    alone = run(debond, flat)[1]
    result, summary = run(debond, flat + ["Certificate/Kind=global"])
    if summary is None or not (
            summary["functional"] == alone["functional"] and
            "certificate" not in summary and any(
                note.startswith("There is no certificate: to rounding")
                for note in summary["notes"])):
        failures.append(f"flat cells: exit code {result.returncode}, "
                        f"{result.stderr!r}")
    result, summary = run(debond, flat + [
        "Certificate/Kind=global", "Certificate/Target=0.1"])
    # Rounding decides which matrix it is that is not definite.
    if not (result.returncode == 3 and
            "There is no certificate: " in result.stderr and
            pathlib.Path("output/contact_profile.csv").exists()):
        failures.append(f"flat cells, target: exit code {result.returncode}, "
                        f"{result.stderr!r}")

    # A flap that turns about a soft hinge opens the one contact side in reach
    # from far below the threshold to far above it, while its stresses are those
    # of the element: without the slope's term the bound is 5 % of the bonds'
    # energy too high.
    flap = run(debond, [
        "Mesh/Lengths=0.4, 0.2", "Mesh/Cells=8, 4", "Parts/flap=x > 0.05",
        "Parts/glued=bottom: if(x>0.05,if(x<0.1,1,0),0)",
        "Boundary conditions/Contact boundary=glued",
        "Boundary conditions/Clamped boundaries=left",
        "Material/Young modulus=1", "Material/Young modulus flap=1e5",
        "Material/Poisson ratio=0", "Loads/Traction top=",
        "Loads/Traction right=-0.1*(y-0.1); 0",
        "Contact law/Bond stiffness=8", "Contact law/Bond threshold=2e-4",
        "Contact law/Tangential displacement=free",
        "Certificate/Kind=global", "Accuracy/Maximum unknowns=20000"])[1]
    if not 0. < flap["certificate"]["relative_width"] < 0.1:
        failures.append(f"flap: {flap['certificate']}")

    # Of a solid: the branches of the state, or J if the law has but one.
    solid = ["Dimension=3", "Mesh/Lengths=0.4, 0.1, 0.1", "Mesh/Cells=8, 2, 2",
             "Loads/Traction top=0; if(x<0.2,0.69,-0.345); 0",
             "Certificate/Kind=fixed state"]
    for law, minimum in (("winkler", "fixed state"), ("none", "global")):
        interval = run(debond, solid + [f"Contact law/Law={law}"])[1][
            "certificate"]
        body = pathlib.Path("output/body.vtu").read_bytes()
        if not (interval["minimum"] == minimum and
                0. < interval["relative_width"] < 0.15 and
                b'"gap_density"' in body and
                b'"equilibrated_stress_yz"' in body):
            failures.append(f"solid, {law}: {interval}")
    result, summary = run(debond, solid + [
        "Certificate/Target=0.08", "Accuracy/Maximum unknowns=20000"])
    if summary is None or not summary["certificate"]["relative_width"] <= 0.08:
        failures.append(f"solid, refined: {result.stderr!r}, {summary}")

    def refused(words, added):
        result, _ = run(debond, ["Certificate/Kind=global"] + added)
        if result.returncode != 2 or words not in result.stderr:
            failures.append(f"{added}: expected '{words}', exit code 2: exit "
                            f"code {result.returncode}, {result.stderr!r}")

    refused("is for plane bodies", ["Dimension=3", "Loads/Traction top=0;1;0"])
    refused("is for a single load", ["Load path/Factors=0.5, 1"])
    refused("bonds that vary along a side are not done",
            ["Contact law/Bond stiffness=69*(1+x)"])
    refused("a gap that is not linear on each side",
            ["Contact law/Initial gap=x^2", "Mesh/Degree=2",
             "Contact law/Quadrature=gauss 4"])

    # What is prescribed, where the displacement is linear: J is known, and both
    # numbers are J. A block that is too large for its place, one that is pushed
    # over a gap onto the foundation, and one that bonds hold, of equal stiffness
    # but with two thresholds.
    block = ["Mesh/Lengths=1, 1", "Mesh/Cells=4, 4", "Loads/Traction top=",
             "Material/Young modulus=100", "Material/Poisson ratio=0",
             "Boundary conditions/Clamped boundaries=",
             "Boundary conditions/Roller boundaries=left, right",
             "Contact law/Tangential displacement=free"]
    for name, J, settings in (
            ("press fit", 0.005,
             ["Contact law/Law=none", "Contact law/Initial gap=-0.01",
              "Boundary conditions/Displacement top=free; 0"]),
            ("gap", 0.02,
             ["Contact law/Law=none", "Contact law/Initial gap=0.01",
              "Boundary conditions/Displacement top=free; -0.03"]),
            ("bonds", 2.5e-5,
             ["Boundary conditions/Displacement top=free; 0.001",
              "Contact law/Bond stiffness=100",
              "Contact law/Bond threshold=if(x < 0.5, 1, 2)"])):
        for kind in ("fixed state", "global"):
            interval = run(debond, block + settings + [
                f"Certificate/Kind={kind}"])[1]["certificate"]
            tolerance = 1e-4 if name == "bonds" else 1e-8
            if not all(abs(interval[end] / J - 1.) < tolerance
                       for end in ("lower", "upper")):
                failures.append(f"{name}, {kind}: {interval}, J is {J}")

    # Finer meshes have higher lower numbers and lower upper ones.
    both = ["Boundary conditions/Clamped boundaries=left",
            "Boundary conditions/Displacement right=free; 0.002",
            "Contact law/Initial gap=2e-4*x/0.4",
            "Contact law/Bond stiffness=if(x<0.2,69,30)",
            "Contact law/Bond threshold=if(x<0.3,0.002,0.001)"]
    for kind in ("fixed state", "global"):
        coarse, fine = (run(debond, both + [
            f"Certificate/Kind={kind}", f"Mesh/Cells={cells}"])[1]["certificate"]
            for cells in ("20, 2", "40, 4"))
        if not (coarse["lower"] < fine["lower"] < fine["upper"] <
                coarse["upper"] and
                fine["relative_width"] < 0.4 * coarse["relative_width"]):
            failures.append(f"all at once, {kind}: {coarse}, {fine}")
    check_temperatures(debond, failures)
    for failure in failures:
        print(failure)
    return 1 if failures else 0


def check_temperatures(debond, failures):
    """Temperatures that are constant in each cell but not in the body: intervals of degree 2
    beside those of degree 1 on finer meshes, all for the least J of the same continuous body,
    so that they meet."""
    half = ["Parts/cold=x > 0.5", "Material/Thermal expansion cold=0"]
    shrunk = ["Parts/cold=y > 0.25", "Material/Thermal expansion cold=-1e-3"]
    for dim, kind, cold, cells, fine_cells in (
            (2, "global", half, "4, 2", "16, 8"), (2, "fixed state", half, "4, 2", "16, 8"),
            (2, "global", shrunk, "8, 4", "32, 16"),
            (2, "fixed state", shrunk, "8, 4", "32, 16"),
            (3, "fixed state", half, "2, 1, 1", "8, 4, 4")):
        intervals = []
        for degree, mesh in (("2", cells), ("1", fine_cells)):
            summary = run(debond, cold + [
                f"Dimension={dim}", "Mesh/Lengths=1, 0.5" + ", 0.5" * (dim == 3),
                "Mesh/Degree=" + degree, "Mesh/Cells=" + mesh, "Material/Young modulus=1",
                "Material/Poisson ratio=0.3", "Material/Thermal expansion=1e-3",
                "Boundary conditions/Clamped boundaries=left", "Contact law/Law=none",
                "Contact law/Quadrature=gauss " + ("8" if dim == 2 else "2"),
                "Contact law/Tangential displacement=free", "Loads/Temperature change=10",
                "Certificate/Kind=" + kind])[1]
            interval = summary["certificate"]
            intervals.append(interval)
            # What bounds J is J of the same displacement.
            if not (summary["status"] == "success" and interval["loads_are_exact"] and
                    interval["lower"] <= interval["upper"] and
                    abs(interval["upper"] / summary["functional"] - 1.) < 1e-7):
                failures.append(f"temperature, {kind}, degree {degree}: {interval}")
        two, one = intervals
        if not (two["lower"] <= one["upper"] and one["lower"] <= two["upper"] and
                two["upper"] - two["lower"] <= -0.1 * two["upper"]):
            failures.append(f"temperature, {dim}D, {kind}, {cold[0]}: {intervals}")


with tempfile.TemporaryDirectory() as directory:
    program = str(pathlib.Path(sys.argv[1]).resolve())
    os.chdir(directory)
    pathlib.Path("scene.prm").write_text("""\
subsection Mesh
  set Cells = 20, 2
end
subsection Solver
  set Method = automatic
end
""")
    sys.exit(main(program))
