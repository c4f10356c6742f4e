#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_certificate_proof.py DEBOND: scripts/check_certificate computes the intervals that
Debond writes. What is altered in a file is refused, or the interval is wider but still
holds the least J, which is known from finer meshes."""
import copy
import json
import random
import subprocess

from common import DEBOND, SOURCE, near

# Of the benchmark by its bonds: an interval of a refined mesh with quadratic displacements.
LEAST = {69.: (-5.91916e-4, -5.91478e-4), 690.: (-2.5767e-4, -2.4734e-4)}
random.seed(1)


def check(path):
    """The interval, or why there is none."""
    done = subprocess.run([SOURCE / "scripts" / "check_certificate", path], capture_output=True, text=True)
    assert done.returncode in (0, 1) and not (done.returncode and "refused" not in done.stderr), done.stderr
    if done.returncode:
        return done.stderr
    return [float(v) for v in done.stdout.split("[")[1].split("]")[0].split(",")]


def places(value, path=()):
    """All numbers and lists of what is proved, not of the problem."""
    if isinstance(value, (dict, list)):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            yield from places(item, path + (key,))
        if isinstance(value, list):
            yield path
    elif isinstance(value, (int, float)):
        yield path


def altered(data, path):
    result = copy.deepcopy(data)
    inside = result
    for key in path[:-1]:
        inside = inside[key]
    value = inside[path[-1]]
    if isinstance(value, list):
        del inside[path[-1]][-1:]
    elif isinstance(value, bool):
        inside[path[-1]] = not value
    elif isinstance(value, int):
        inside[path[-1]] += random.choice((-1, 1))
    else:
        inside[path[-1]] = value * random.choice((0., -1., 0.5, 1.001, 3.)) + random.choice((0., 1e-6))
    return result


def written(name, *entries):
    """Where Debond has written the file of a scene."""
    subprocess.run([DEBOND, SOURCE / "prm" / "benchmark-40x4.prm", *(word for entry in (
        "Solver/Method=automatic", "Mesh/Cells=20, 2", "Certificate/Kind=global", "Output/Proof=true",
        f"Output/Directory=out-{name}", *entries) for word in ("--set", entry))],
        check=True, stdout=subprocess.DEVNULL)
    return f"out-{name}/certificate_proof.json"


at_rest = check(written("rest", "Loads/Traction top="))
assert -1e-300 < at_rest[0] <= 0. <= at_rest[1] < 1e-300, at_rest
for stiffness, (least, largest) in LEAST.items():
    path = written(stiffness, f"Contact law/Bond stiffness={stiffness}")
    with open(path) as file:
        data = json.load(file)
    found = check(path)
    # What is claimed has J of the result in it, by the scene's quadrature.
    near(found[0], data["interval"][0], 1e-5)
    assert least <= found[1] <= data["interval"][1] * (1. - 1e-9), found
    outcomes = [0, 0]
    proved = list(places(data["stages"], ("stages",))) + [("contact", i, "trace_constant") for i in range(20)] + [
        ("points", i, "u", d) for i in range(40) for d in (0, 1)]
    for _ in range(6):
        with open("altered.json", "w") as file:
            json.dump(altered(data, random.choice(proved)), file)
        a = check("altered.json")
        outcomes[isinstance(a, list)] += 1
        assert isinstance(a, str) or a[0] <= largest and a[1] >= least and a[0] <= a[1], a
    # Those of the problem that are not allowed.
    for key, value in (("cells", data["cells"] + data["cells"][:1]), ("contact", data["contact"] * 2),
                       ("format", "another"), ("sides", data["sides"][:1] * 2)):
        with open("altered.json", "w") as file:
            json.dump(data | {key: value}, file)
        assert isinstance(check("altered.json"), str), key
    too_large = copy.deepcopy(data)
    for side in too_large["contact"]:
        side["trace_constant"] *= 1.001
    with open("altered.json", "w") as file:
        json.dump(too_large, file)
    assert "trace constant" in check("altered.json")
    print(stiffness, found, outcomes)
