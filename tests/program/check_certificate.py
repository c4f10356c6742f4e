#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_certificate.py DEBOND [N [FIRST]]: intervals for the least J of the
continuous problem on N random scenes (bars, strips and pads with clamps of all
kinds, three laws, both tangential conditions, three systems of units), each on a
mesh and on one four times as fine. All of them hold for one number, so the lower
ends have to be below the upper ends of the other mesh, which knows nothing of
them; and finer meshes have narrower intervals. Then the branches of a state that
is kept, and what has no certificate."""
import csv
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

UNITS = ((1., 1.), (1e3, 1e3), (1., 1e9))  # of length and of stress


def run(debond, entries):
    result = subprocess.run(
        [debond, "scene.prm", "--set", "Output/Directory=output"] +
        [word for entry in entries for word in ("--set", entry)],
        capture_output=True, text=True, timeout=600)
    if result.returncode != 0:
        return result, None
    return result, json.loads(
        pathlib.Path("output/summary.json").read_text())


def draw(generator):
    length, stress = generator.choice(UNITS)
    height = generator.choice((0.03, 0.1, 0.4)) * length
    width = generator.choice((1., 3.)) * 0.4 * length
    nu = generator.uniform(0., 0.48)
    clamps = generator.choice(("left", "right", "left, right", "top"))
    side = "top" if clamps != "top" else "right"
    jump = generator.choice((0.25, 0.5)) * width
    load = [generator.uniform(-1., 1.) * stress * height / length
            for _ in range(2)]
    a = 10.**generator.uniform(0., 3.) * stress / length
    entries = [
        f"Mesh/Lengths={width!r}, {height!r}",
        f"Material/Young modulus={69. * stress!r}",
        f"Material/Poisson ratio={nu!r}",
        "Material/Hypothesis=" +
        generator.choice(("plane stress", "plane strain")),
        f"Boundary conditions/Clamped boundaries={clamps}",
        "Contact law/Tangential displacement=" +
        generator.choice(("fixed", "free")),
        "Loads/Traction top=",
        f"Loads/Traction {side}=0; " +
        (f"if(x<{jump!r},{load[0]!r},{load[1]!r})" if side == "top" else
         f"{load[0]!r}*y/{height!r}"),
        f"Loads/Body force=0; {generator.uniform(-1., 1.) * stress / length!r}"]
    law = generator.choice(("winkler", "winkler", "stepped", "none"))
    entries.append("Contact law/Law=" + law)
    threshold = 10.**generator.uniform(-4., -2.) * length
    if law == "stepped":
        entries += [f"Contact law/Stepped/Stiffnesses={a!r}, {a / 3.!r}",
                    f"Contact law/Stepped/Thresholds={threshold!r}, "
                    f"{2. * threshold!r}"]
    elif law == "winkler":
        entries += [f"Contact law/Bond stiffness={a!r}",
                    f"Contact law/Bond threshold={threshold!r}"]
    return entries, [4 * generator.randint(2, 5), generator.randint(1, 3)]


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


def main(debond, n, first):
    failures, widths = [], []
    solved = unsolved = proofs_ended = n_sides = n_certain = 0
    for number in range(first, first + n):
        entries, cells = draw(random.Random(number))
        intervals, sides = [], []
        for factor in (1, 4):
            result, summary = run(
                debond, entries +
                [f"Mesh/Cells={factor * cells[0]}, {factor * cells[1]}",
                 "Solver/Proof/Maximum nodes=200", "Certificate/Kind=global"])
            if summary is None or "certificate" not in summary:
                break
            intervals.append(summary["certificate"])
            if pathlib.Path("output/certified_sides.csv").exists():
                sides.append(rows("output/certified_sides.csv"))
            profile = rows("output/contact_profile.csv")
        if len(intervals) < 2:
            unsolved += 1
            if summary is None and result.returncode not in (2, 3):
                failures.append(f"{number}: exit code {result.returncode}, "
                                f"{result.stderr}")
            continue
        solved += 1
        coarse, fine = intervals
        proofs_ended += all(interval["proof_status"] == "proved"
                            for interval in intervals)
        widths.append(fine["relative_width"])
        if sides and fine["upper"] <= coarse["upper"]:
            thresholds = [float(entry.split("=")[1]) for entry in entries
                          if entry.startswith("Contact law/Bond threshold")]
            wrong, certain = wrong_sides(sides[0], profile,
                                         (thresholds or [None])[0])
            n_sides += len(sides[0])
            n_certain += certain
            if wrong > 0:
                failures.append(f"{number}: {wrong} sides are not where they "
                                f"are certain to be, {entries}")
        if not (coarse["lower"] <= fine["upper"] and
                fine["lower"] <= coarse["upper"] and
                fine["lower"] <= fine["upper"]):
            failures.append(f"{number}: {coarse}, {fine}, {entries}")
    if n > 20:
        widths.sort()
        print(f"{solved} scenes with intervals, {unsolved} without, in "
              f"{proofs_ended} all proofs ended; relative width on the finer "
              f"mesh {widths[len(widths) // 2]:.1e} in the median, "
              f"{widths[-1]:.1e} at most; {n_certain} of {n_sides} sides of "
              f"the coarse mesh are certain")
    elif solved < n // 2:
        failures.append(f"{unsolved} of {n} scenes have no certificate")

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
    if not (result.returncode == 3 and
            "There is no certificate: to rounding" in result.stderr and
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
    refused("an initial gap is not done", ["Contact law/Initial gap=1e-3"])
    refused("bonds that vary are not done",
            ["Contact law/Bond stiffness=69*(1+x)"])
    refused("a prescribed displacement that is not zero is not done",
            ["Boundary conditions/Clamped boundaries=left",
             "Boundary conditions/Displacement right=0; 1e-4"])
    for failure in failures:
        print(failure)
    return 1 if failures else 0


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
    sys.exit(main(program,
                  int(sys.argv[2]) if len(sys.argv) > 2 else 12,
                  int(sys.argv[3]) if len(sys.argv) > 3 else 0))
