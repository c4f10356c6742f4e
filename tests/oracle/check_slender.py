#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_slender.py DEBOND [LENGTH...]: slender bodies, and J of the benchmark, beside the
minimum of the same discrete problem with the same bonds in 50 digits (oracle.py). Lengths
over height: strips of these alone, with the figures of all."""
import itertools
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from check_shapes import Result, WrongResult
from oracle import EXACT, Body
from random_scenes import Field
from random_scenes import strip as box


def strip(aspect, cells, clamped="left", law="winkler", tangential="free", unit=1., stress=1.):
    """Of height 1 mm, lifted off at its end, or at the top if both ends are clamped; without
    bonds, which break at 0.01 mm, the end would be lifted by 0.04 mm."""
    dim, q = len(cells), 8e3 / aspect**3 * stress
    side, q = ("right", q) if clamped == "left" else ("top", 16. * q / aspect)
    return box((aspect * unit, unit, unit)[:dim], cells, 2e5 * stress,
               8e5 / aspect**4 * stress / unit, 0.01 * unit, clamped,
               {"Loads/Traction " + side: "; ".join(["0", repr(q), "0"][:dim])}, law, tangential)


def bar(cells, lengths=(0.4, 0.04), a=69., load=0.69, **others):
    """The benchmark under a load that is linear along the top."""
    return box(lengths, cells, 69., a, 0.002, "left, right", {
        "Loads/Traction top": f"0; {Field(load, [-3.75 * load])}"}, **others)


def compare(debond, name, settings, mesh, *method):
    """Returns the largest errors of J and displacement; raises what is wrong."""
    pathlib.Path("scene.prm").touch()
    result = subprocess.run([debond, "scene.prm", "--set=Output/Displacement=true",
                             "--set=Output/Matrices=true", "--set=Output/Directory=output",
                             *(f"--set={path}={value}" for path, value in settings.items()),
                             *("--set=Solver/" + entry for entry in method)], capture_output=True,
                            text=True, check=False)
    if result.returncode != 0:
        raise WrongResult("no success", result.stderr)
    body = Body(settings, mesh)
    found = Result(body, json.loads(pathlib.Path("output/summary.json").read_text()),
                   settings["Contact law/Bond threshold"])
    found.is_rough = False
    found.check_forces()
    own = body.minimise(body.branches_at(found.s))
    J, printed = body.condensed_functional(own), EXACT(found.summary["functional"])
    errors = (abs(printed / J - 1), abs(body.functional(found.u)[0] / J - 1),
              max(abs(x - y) for x, y in zip(found.s, own)) / max(map(abs, own)))
    print(f"{name}: J {errors[0]:.1e}, J of u {errors[1]:.1e}, displacement {errors[2]:.1e}",
          flush=True)
    if max(errors[:2]) > 1e-12 or errors[2] > 1e-9:
        raise WrongResult("errors", errors)


def cases(aspects):
    """Names, scenes and methods."""
    multigrid = ("Method=majorise minimise", "Linear solver=multigrid",
                 "Majorise minimise/Stop tolerance=1e-12")
    methods = {"automatic": ("Method=automatic",), "energy": ("Method=energy bundle",),
               "multigrid": multigrid}
    for aspect in aspects:
        for cells, clamped, tangential, law, method in itertools.product(
                ((100, 1), (100, 4), (20, 1, 1)), ("left", "left, right"), ("free", "fixed"),
                ("none", "winkler"), methods):
            yield (f"{aspect}, {cells}, {clamped}, {tangential}, {law}, {method}",
                   *strip(aspect, cells, clamped, law, tangential), *methods[method])
    if aspects:
        return
    for name, scene in (
            ("20x2", bar((20, 2))), ("40x4", bar((40, 4))),
            ("nu = 0.4999", bar((20, 2), nu=0.4999, hypothesis="plane strain")),
            ("slender", bar((80, 2), (0.4, 0.01))), ("very slender", bar((200, 1), (0.4, 0.002))),
            ("load 10", bar((20, 2), load=6.9)), ("a = 690", bar((20, 2), a=690.))):
        yield (name, *scene, "Method=majorise minimise")
    for arguments, method in (
            ((100., (100, 1), "left", "none"), "automatic"),
            ((1e3, (150, 1)), "automatic"),
            ((1e3, (100, 1), "left", "winkler", "free", 1e-3, 1e6), "automatic"),
            ((1e4, (150, 1), "left", "winkler", "fixed"), "automatic"),
            ((1e4, (150, 1)), "energy"),
            ((1e4, (60, 3), "left, right"), "automatic"),
            ((1e3, (100, 2)), "multigrid"),
            # Where linear solvers in double precision do not get through.
            ((1e4, (100, 4), "left", "none"), "multigrid"),
            ((1e4, (60, 4), "left", "winkler", "free", 1e-3, 1e6), "multigrid"),
            ((1e4, (40, 1, 1)), "automatic"),
            ((1e4, (10, 2, 2), "left", "none", "fixed"), "automatic")):
        yield (f"{arguments}, {method}", *strip(*arguments), *methods[method])


def main(debond, *aspects):
    failures = 0
    for name, *scene in cases(list(map(float, aspects))):
        try:
            compare(debond, name, *scene)
        except WrongResult as wrong:
            failures += 1
            print(f"FAILED {name}:", *wrong.args, flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        program = str(pathlib.Path(sys.argv[1]).resolve())
        os.chdir(directory)
        sys.exit(main(program, *sys.argv[2:]))
