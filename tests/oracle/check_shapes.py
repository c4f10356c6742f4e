#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_shapes.py DEBOND [COUNT [FIRST [NUMBER]]]: random bodies in 2D and 3D: boxes,
and from Gmsh files trapezoids, tapers, arches, wavy strips, Ls, steps, plates with a
notch or a hole, turned and sheared. Each result is judged by oracle.py, which shares
nothing with the solver. A success must be in equilibrium, satisfy the law and have
the J that is printed; "local minimum" must be one, "global" and "best known" must be
what their words promise, and a body comes off if nothing holds it.

COUNT scenes are tried, from the number FIRST on. The scene NUMBER is printed, and its
files are left in the working directory.
"""

import collections
import csv
import json
import math
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from oracle import EPSILON, EXACT, ZERO, dot, inverse
from random_scenes import Draw, make_scene
from vtu import Piece

SECONDS_FOR_A_SCENE = 30  # of the processor: a busy machine takes longer
PROMISE, BETTER = EXACT("1e-3"), EXACT("1e-8")


class WrongResult(Exception):
    """What is wrong with a result: a class and figures."""


def require(condition, kind, detail):
    """Raises WrongResult unless the condition holds."""
    if not condition:
        raise WrongResult(kind, detail)


def read_frames(body):
    """From frames.mtx, for each of the program's vertices, the rows of its frame."""
    dim = body.dim
    frames = [[[ZERO] * dim for _ in range(dim)] for _ in body.points]
    lines = pathlib.Path("output/frames.mtx").read_text().splitlines()
    for line in lines[2:]:
        row, column, value = line.split()
        (v, i), (w, j) = (divmod(int(x) - 1, dim) for x in (row, column))
        require(v == w, "wrong success: frames.mtx", line)
        frames[v][i][j] = EXACT(value)
    return frames


def read_displacement(body):
    """u in the frames of the body, from displacement.txt, whose order is that in which
    the cells of body.vtu come to their points; what body.vtu has must be the same to
    single precision."""
    dim, points = body.dim, body.mesh.points
    piece = Piece("output/body.vtu")
    first = {}
    for k in range(piece.n_points):
        first.setdefault(piece.points[3 * k:3 * k + dim], k)
    written = [EXACT(line) for line in pathlib.Path("output/displacement.txt").read_text().split()]
    require(len(written) == body.n and len(first) == len(points),
            "wrong success: mesh", f"{len(written)} of {body.n} unknowns")
    u = [None] * body.n
    extent = max(abs(x) for p in points for x in p)
    size = max(abs(x) for x in piece.at_points["displacement"])
    for n, ((place, k), frame) in enumerate(zip(first.items(), read_frames(body))):
        v = min(range(len(points)), key=lambda w: math.dist(place, points[w]))
        require(math.dist(place, points[v]) <= 1e-6 * extent and u[dim * v] is None,
                "wrong success: mesh", f"no vertex at {place}")
        w = written[dim * n:dim * n + dim]
        cartesian = [dot(row, w) + x for row, x in
                     zip(inverse(frame), body.to_cartesian(body.G, v))]
        error = math.dist(map(float, cartesian), piece.at_points["displacement"][3 * k:3 * k + dim])
        require(error <= 1e-6 * size, "wrong success: body.vtu",
                f"differs from displacement.txt by {error:.1e} of {size:.1e}")
        u[dim * v:dim * v + dim] = [dot(row, cartesian) for row in body.rows[v]]
    return np.array(u)


def check_profile(body, s, force, tolerance, of_displacements):
    """contact_profile.csv has each contact node with its u_nu and its force."""
    with open("output/contact_profile.csv", encoding="utf-8") as file:
        rows = [{key: EXACT(value) for key, value in row.items()
                 if key not in ("state", "violation") and not key.startswith("broken")}
                for row in csv.DictReader(file) if row["state"] != "held"]
    require(len(rows) == len(s), "wrong success: contact_profile.csv",
            f"{len(rows)} rows for {len(s)} contact nodes")
    for (v, number), i in body.node_of.items():
        at = [row for row in rows if math.dist([row[x] for x in "xyz"[:body.dim]],
                                               body.points[v]) <= 1e-9 * body.mesh.length]
        gap = body.gaps[v][number]
        # At a corner there are several.
        require(any(abs(row["u_nu"] - s[i] - gap) <= of_displacements
                    and abs(row["normal_force"] - force[i]) <= tolerance[i]
                    and abs(row["initial_gap"] - gap) <= EXACT("1e-12") * abs(gap)
                    for row in at), "wrong success: contact_profile.csv",
                f"no row with u_nu = {s[i] + gap:.6e}, force {force[i]:.6e}, gap "
                f"{gap:.6e}, but {at}")


def check_reactions(body, summary, residual, tolerance):
    """Resultants, from A u - f in Cartesian components. What the bonds pull at
    vertices that are held may be counted as support or foundation: their sum is
    one."""
    dim = body.dim
    supports, contact = [ZERO] * dim, [ZERO] * dim
    for v in body.held | set(body.normals):
        sums = supports if v in body.held else contact
        for k, row in enumerate(body.rows[v]):
            if body.kinds[dim * v + k] != "free":
                sums[:] = [x + e * residual[dim * v + k] for x, e in zip(sums, row)]
    pairs = {"applied_force": [sum(body.applied[k::dim]) for k in range(dim)],
             "clamped_reaction": supports, "contact_reaction": contact}
    printed = {name: summary[name] for name in pairs}
    if any(point.is_held for point in body.bonds) or (body.held & set(body.normals) - body.clamped):
        for of in (pairs, printed):
            of["reactions"] = [sum(map(EXACT, two)) for two in zip(
                of.pop("clamped_reaction"), of.pop("contact_reaction"))]
    for name, own in pairs.items():
        require(all(abs(EXACT(x) - y) <= tolerance for x, y in zip(printed[name], own)),
                f"wrong success: {name}", f"{printed[name]}, not {list(map(float, own))}")


class Result:
    """Of the program, with all that the check finds of it; M is the size of thresholds."""

    def __init__(self, body, summary, M):
        self.body, self.summary, self.M = body, summary, EXACT(M)
        self.word = summary["minimum"]["state"]
        self.is_rough = summary["method"] != "majorise minimise" or (
            summary["linear_solver"] == "multigrid")
        self.u = u = read_displacement(body)
        self.s = np.array(body.traces(u))
        self.residual = [a - f for a, f in zip(body.multiply(u), body.f)]
        self.largest = max(map(abs, self.residual))
        self.size = max(map(abs, u))
        # Results are kept as u - g, which is the gap where that is far larger than
        # displacements: then forces far below the largest one are lost.
        # Gradients are of differences of places, which are rounded where they are.
        self.noise = [100 * (of_u + min(of_G, BETTER * self.largest)) for of_u, of_G in
                      zip(body.rounding(u), body.rounding(body.G))]
        self.force = np.array([-self.residual[d] for d in body.contact_dofs])
        self.of_force = np.array([self.noise[d] for d in body.contact_dofs])
        # The law is relative to what the bonds of a contact node bear.
        self.strength = max(body.strengths)
        largest_contact = max(max(map(abs, self.force)), self.largest / 1000)
        self.scale = min(self.strength or largest_contact, largest_contact)

    def is_rounding(self):
        """Whether forces are, so that nothing can be judged."""
        return not (self.largest > 100 * max(self.noise) and self.scale > 100 * max(self.of_force))

    def check_forces(self):
        """Equilibrium and law."""
        body, s, size, largest = self.body, self.s, self.size, self.largest
        inside = max((abs(self.residual[d]) - self.noise[d] for d in body.free_dofs), default=ZERO)
        lengths = PROMISE * (min(self.M * min(
            1, self.scale / self.strength), size) if self.strength else size)
        # s comes from Cartesian components, which are rounded.
        lengths = max(lengths, 8 * EPSILON * size)
        violation = body.law_violation(s, self.force, lengths, self.of_force)
        # Where the bundle method stops a bond may be within lengths of its threshold.
        tight = ZERO if self.is_rough else body.law_violation(
            s, self.force, EXACT("1e-10") * size, self.of_force)
        # In Cartesian components beside gaps, which are rounded.
        of_gaps = 4 * EPSILON * max(map(abs, body.G))
        fixed = max((abs(self.u[d] - body.G[d]) - of_gaps for d in range(body.n)
                     if body.kinds[d] == "fixed"), default=ZERO)
        for name, value, limit in (
                ("equilibrium", inside / largest, PROMISE if self.is_rough else BETTER),
                ("law", violation / self.scale, PROMISE),
                ("tight law", tight / largest, BETTER),
                ("penetration", max(s) / size, EXACT("1e-12")),
                ("supports", fixed / size, EXACT("1e-10"))):
            require(value <= limit, f"wrong success: {name}", f"{self.word}, {value:.1e}")
        of_G = body.rounding(body.G)
        check_profile(body, s, self.force, [
            BETTER * largest + x + 10 * of_G[d]
            for d, x in zip(body.contact_dofs, self.of_force)],
            EXACT("1e-12") * size + 4 * EPSILON * max(map(abs, body.G)))  # u, G and u - G
        check_reactions(body, self.summary, self.residual, BETTER * largest + max(self.noise) * 10)

    def check_minimum(self, draw):
        """J, and whether it is what the word promises. Returns a class of results and
        figures."""
        body, word = self.body, self.word
        require(not body.is_off(body.from_rest()), "wrong success: comes off", word)
        own = body.descend(body.branches_at(self.s))
        require(not body.is_off(own), "wrong success: not a minimum", "comes off")
        minima, are_all = body.all_minima(draw)
        J_of_own = body.condensed_functional(own)
        least = min([J_of_own] + [body.condensed_functional(s) for s in minima])
        energy = body.condensed_functional(ZERO * self.s) - least
        J, terms = body.functional(self.u)
        printed = EXACT(self.summary["functional"])
        can_change = body.bonds_can_change()
        detail = (f"{word}; J {abs(J - printed) / terms:.1e}, above the own minimum "
                  f"{J - J_of_own:.1e} of {energy:.1e}, above the least one "
                  f"{J - least:.1e} of {can_change:.1e}, terms {terms:.1e}")
        require(abs(J - printed) <= EXACT("1e-11") * terms, "wrong success: J", detail)
        rounding = EXACT("1e-6" if self.summary["method"] == "euclidean bundle"
                         else "1e-11") * terms
        require(J - least >= -rounding or not are_all, "the check's minimum is too high", detail)
        bound = (self.summary.get("proof") or {}).get("lower_bound")
        # Bounds are of J as it is, whatever the precision of the condensed problem.
        require(bound is None or EXACT(bound) <= least + EXACT("1e-15") * terms,
                "wrong success: lower bound", f"{bound!r}; {detail}")
        require(J - J_of_own <= (EXACT("1e-6") if self.is_rough else BETTER) * energy
                + rounding, "wrong success: not a minimum", detail)
        if word != "stationary":
            for point in body.bonds:
                for kink in point.kinks:
                    distance = abs(point.trace(self.s) - kink)
                    require(not point.nodes or distance > EXACT("1e-14") * abs(kink),
                            "wrong word: on a kink", detail)
        is_least = J - least <= BETTER * can_change + rounding
        require(word != "global" or is_least, "wrong word: global", detail)
        if word == "best known":
            for start in (0, -1):
                s = body.descend([start % len(p.branches) for p in body.bonds])
                require(body.is_off(s) or J - body.condensed_functional(s) <= BETTER * can_change
                        + rounding, "wrong word: best known", detail)
        return f"solved, {word}" + ("" if is_least else " above the least"), detail


def check_path(body, draw):
    """Each J of a path is that of a minimum under its loads, and of the global branch the
    least one, where all minima are known."""
    with open("output/load_path.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    require(len(rows) == 3, "wrong success: load_path.csv", f"{len(rows)} rows")
    for row in rows:
        factors = [EXACT(row["factor"]), EXACT(row["displacement_factor"])]
        body.set_loads(*factors)
        minima, are_all = body.all_minima(draw)
        if not are_all or body.pushes_into_foundation():
            continue
        values = sorted(body.condensed_functional(s) for s in minima)
        J, J_global = EXACT(row["J"]), EXACT(row["global_J"])
        gain = values[0] - body.condensed_functional(ZERO * body.g)
        error = BETTER * (abs(gain) + body.bonds_can_change()) + EXACT("1e-11") * (
            abs(J) + abs(body.constant))
        detail = f"factors {factors}, J {J}, global {J_global}, minima {list(map(float, values))}"
        require(any(abs(J - value) <= error for value in values),
                "wrong success: path, not a minimum", detail)
        require(J_global >= values[0] - error and J_global <= J + error
                and (row["global_minimum"] != "global" or J_global <= values[0] + error),
                "wrong success: path, global branch", detail)


def check_success(scene, body, draw):
    """Returns the class of a result that is right and figures; raises
    WrongResult for another one."""
    summary = json.loads(pathlib.Path("output/summary.json").read_text())
    if summary["status"] == "comes off":
        require(body.is_off(body.from_rest()), "wrong success: holds", "")
        return "comes off", ""
    require(summary["status"] == "success", "wrong success: exit code and status",
            summary["status"])
    result = Result(body, summary, scene.M)
    strained = max(abs(a + f) for a, f in zip(result.residual, body.f))
    if strained <= EXACT("1e-12") * result.largest:
        return "solved, nothing moves", result.word
    if result.is_rounding():
        return "not judged: forces are rounding", result.word
    result.check_forces()
    found = result.check_minimum(draw)
    if "Load path/Factors" in scene.settings and not result.is_rough:
        check_path(body, draw)
        return found[0] + ", path", found[1]
    return found


def message_class(text):
    """The first line of a message without what is different in every scene."""
    return re.sub(r"[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?", "#", text.split("\n")[0])[:110]


def try_scene(debond, scene, body, draw):
    """Returns what became of a scene: a class and figures."""
    shutil.rmtree("output", ignore_errors=True)
    pathlib.Path("shape.msh").write_text(scene.mesh.text())
    pathlib.Path("shape.prm").touch()
    limit = SECONDS_FOR_A_SCENE, SECONDS_FOR_A_SCENE + 1
    result = subprocess.run([debond, "shape.prm"] + [f"--set={path}={value}" for path,
                                                     value in scene.settings.items()],
                            capture_output=True, text=True, check=False,
                            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
    if result.returncode in (2, 3):
        return ("rejected" if result.returncode == 2 else "not solved",
                message_class(result.stderr))
    if result.returncode != 0:
        return "error or no end", f"exit code {result.returncode}: {result.stderr}"
    try:
        return check_success(scene, body, draw)
    except WrongResult as wrong:
        return wrong.args


def main(debond, count=30, first=0, listed=None):
    """Tries the scenes and prints what became of them."""
    kinds, missed, failures = collections.Counter(), 0, []
    for number in range(first, first + count):
        draw = Draw(number)
        scene, body = make_scene(draw, 3 if draw.chance(0.4) else 2)
        kind, detail = try_scene(debond, scene, body, draw)
        name = f"{kind}, scene {number} ({scene.mesh.kind}, {scene.dim}D)"
        refused = kind in ("rejected", "not solved")
        kinds[f"{kind}: {detail}" if refused else kind] += 1
        if kind.startswith("solved, best known above the least"):
            missed += scene.settings["Solver/Search"] == "automatic"
            print(name, detail, flush=True)
        is_failure = not refused and not kind.startswith(("solved", "comes off", "not judged"))
        if is_failure:
            failures.append(name)
        if is_failure or number == listed:
            print(f"{name}: {detail}", *map("=".join, scene.settings.items()), sep="\n", flush=True)
        if number == listed:
            for file in ("shape.msh", "output/parameters.prm"):
                shutil.copy(file, WORKING_DIRECTORY)
    for kind, n in sorted(kinds.items()):
        print(f"{n:6} {kind}")
    if 2 * sum(n for kind, n in kinds.items() if kind.startswith("solved")) < count:
        failures.append("fewer than half of the scenes are solved")
    if 50 * kinds["not judged: forces are rounding"] > count + 50:
        failures.append("more than 2 of 100 scenes are not judged")
    if 100 * missed > count + 100:
        failures.append("automatic misses more than 1 minimum of 100 scenes")
    print("\n".join(failures))
    return 1 if failures else 0


WORKING_DIRECTORY = os.getcwd()
if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        program = str(pathlib.Path(sys.argv[1]).resolve())
        os.chdir(directory)
        sys.exit(main(program, *map(int, sys.argv[2:])))
