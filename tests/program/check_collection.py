#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_collection.py DEBOND: what doc/collection/load.py says of the problems in doc/collection/
is J in exact arithmetic, and its derivatives are those of J; scripts/collection makes problems
again as they are; no optimiser is below the least J that is known."""
import csv
import fractions
import json
import math
import pathlib
import subprocess
import sys

import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(SOURCE / "tests"), str(SOURCE / "doc" / "collection")]
import load  # noqa: E402
import peers  # noqa: E402
from run_scenes import Scenes  # noqa: E402

scenes = Scenes(sys.argv[1])
exact = fractions.Fraction


def of_curve(pieces, s):
    """A term of one unknown, but for tails in double precision."""
    total = begin = exact(0)
    for c, m, end, *decay in pieces:
        stop = s if end is None else max(s, exact(end))
        if decay:
            total += exact(m * math.expm1(decay[0] * float(stop - begin)) / decay[0])
        else:
            total += exact(c) / 2 * (stop**2 - begin**2) + exact(m) * (stop - begin)
        if stop == s:
            return total
        begin = stop


def exact_J(folder, state):
    """As doc/reference/proofs.md says it."""
    data, S = json.loads((folder / "problem.json").read_text()), load.Problem(folder).S
    s = [exact(x) for x in state]
    total = exact(data["c_0"]) + sum(x * (sum(exact(a) * y for a, y in zip(row, s)) / 2 - exact(b))
                                     for x, row, b in zip(s, S.tolist(), data["g"]))
    for term in data["terms"]:
        if "pieces" in term:
            total += of_curve(term["pieces"], s[term["unknown"]])
        else:
            stored = sum(exact(k) * s[j]**2 / 2 for j, k in zip(
                term["unknowns"], term["stiffness"]))
            total += stored if term["energy"] is None else min(stored, exact(term["energy"]))
    return total + sum(exact(rub["weight"] * math.hypot(*(
        float(s[i] - exact(p)) for i, p in zip(rub["unknowns"], rub["place"]))))
                       for rub in data["friction"])


def check_loader(folder):
    problem, result = load.Problem(folder), json.loads((folder / "result.json").read_text())
    J, s = exact_J(folder, result["state"]), np.array(result["state"])
    # Of slender bodies parts of J are far larger than J, and bring their rounding.
    rounding = 1e-12 * abs(float(J)) + 1e-15 * (np.abs(s) @ np.abs(problem.S) @ np.abs(s))
    scenes.close("J of the loader", problem.value(s), float(J), rounding, 1.)
    scenes.close("J that is stored", result["J"], float(J), rounding, 1.)
    scenes.check("bounds", np.all(s <= problem.upper))
    # Derivatives at a random point, along a random way.
    random, scale = np.random.default_rng(1), np.max(np.abs(s))
    s = np.minimum(problem.upper, 0.) - scale * random.random(len(s))
    way = 1e-6 * scale * random.standard_normal(len(s))
    for name, function, derivative in (
            ("gradient", problem.value, problem.gradient(s) @ way),
            ("curvature", lambda s: problem.gradient(s) @ way, way @ problem.curvature(s) @ way)):
        scenes.close(name, (function(s + way) - function(s - way)) / 2., derivative, 1e-4)


with open(SOURCE / "doc" / "collection" / "problems.csv", encoding="utf-8") as file:
    rows = list(csv.DictReader(file))
for row in rows:
    if row["small"] == "yes":
        scenes.section(row["name"])
        check_loader(SOURCE / "doc" / "collection" / row["name"])

again = ["benchmark-20", "exponential-40"]
done = subprocess.run([SOURCE / "scripts" / "collection", *again, "--debond", sys.argv[1], "--into",
                       scenes.directory], capture_output=True, text=True, check=False)
scenes.check("scripts/collection", done.returncode == 0, done.stderr)
for name in again:
    made, stored = (json.loads((folder / name / "result.json").read_text()) for folder in (
        scenes.directory, SOURCE / "doc" / "collection"))
    scenes.section(name)
    scenes.close("J again", made["J"], stored["J"], 1e-9)
    scenes.check("the word again", made["minimum"] == stored["minimum"], made["minimum"])

# The last one is ours, and finds the least J of these.
for name in "patches-12", "benchmark-40-690", "shear-common":
    scenes.section(name + ", others")
    folder = SOURCE / "doc" / "collection" / name
    least = json.loads((folder / "result.json").read_text())["J"]
    for peer in peers.compare(load.Problem(folder)):
        scenes.check(peer.name, peer.best >= least - 1e-9 * abs(least), peer.best)
    scenes.close(peer.name, peer.best, least, 1e-9)
scenes.end()
