#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_proof.py DEBOND: what is printed as a bound is one of the result as it is, in the
summary and rounded in the log: of slender strips that are refined in extended precision, with a
gap, lifted and loaded, in other units, and of an interval for the continuous problem. What
limits, threads and interruptions do to a proof is in optimization/global_minimum and
program/interrupt."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
LIFT, NU = "Displacement left=", "Poisson ratio="


def strip(length=1., stress=1.):
    return [f"Lengths={150. * length}, {2. * length}", "Cells=75, 1", NU + "0.3",
            f"Young modulus={7e4 * stress}", "Clamped boundaries=right", "Contact boundary=bottom",
            f"{LIFT}free; {0.4 * length}", "Tangential displacement=free",
            f"Bond stiffness={25. * stress / length}", f"Bond threshold={0.006 * length}",
            "Method=majorise minimise"]


def printed(result, pattern):
    return [float(number) for number in re.search(pattern, result["log"], re.MULTILINE).groups()]


def ascending(name, *numbers):
    scenes.check(name, list(numbers) == sorted(numbers), numbers)


for name, *scene in (
        ("strip", *strip()), ("nu = 0", *strip(), NU + "0"),
        ("other cells", *strip(), "Cells=60, 1"),
        ("gap", *strip(), "Initial gap=0.00002*x"),
        ("m and Pa", *strip(1e-3, 1e6), NU + "0"),
        ("loaded", *strip(), LIFT, "Traction top=0; if(x < 30, 0.02, -0.01)")):
    scenes.section(name)
    result = scenes.solve(*scene, "Prove=true")
    lower, gap = (result["proof"][key] for key in ("lower_bound", "relative_gap"))
    ascending("bound, in the log, in the summary, and J", *printed(result, "J >= (.*)$"), lower,
              result["functional"])
    ascending("bound and J in the log", *printed(result, r"^  J  +(\S+)\n(?:.*\n)*?.* J >= (.*)$")[::-1])
    ascending("gap, in the summary and in the log", gap, *printed(result, r" gap (\S+) of what"))
    for row in result["proof_history"]:
        ascending("bounds on the way", row["lower_bound"], row["functional"])
    scenes.check("some nodes", len(result["proof_history"]) > 1)
scenes.section("Interval")
result = scenes.solve("Traction top=0; if(x < 0.2, 0.69, -0.345)", "Certificate/Kind=global")
interval = result["certificate"]
lower, upper = printed(result, r"^  interval +(\S+) to (\S+)$")
ascending("ends", lower, interval["lower"], interval["upper"], upper)
ascending("width", interval["relative_width"], *printed(result, r"^  certified to +(\S+) of"))
scenes.end()
