#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_proofs.py DEBOND SCENE_DIRECTORY [n]: scripts/check_proof accepts proofs of random
small problems (of proofs.py), and whatever it accepts is true: bounds of random entries are
below J in their boxes, shifts are positive definite, growth is no more than there is, and
altered and forged files are refused or prove something true. n is the number of altered
files; with 1000 or more, each of a list of mistakes in the checker has to be noticed.
"""
import contextlib
import copy
import io
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import types
import zlib
from fractions import Fraction

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1"))
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import proofs
from proofs import BROKEN, HOLDS, INFINITY
from run_scenes import Scenes

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "check_proof"
TEXT = PROGRAM.read_text(encoding="utf-8")
WIDE = (-1e300, 1e300)
# What may go wrong with a file; other exceptions are mistakes in the checker.
EXPECTED = {"JSONDecodeError", "UnicodeDecodeError", "ValueError", "OverflowError", "RecursionError",
            "FileNotFoundError", "IsADirectoryError"}
folder = tempfile.TemporaryDirectory()
directory = pathlib.Path(folder.name)


class Checker:
    """The program in this process, perhaps with another text."""

    def __init__(self, text=TEXT):
        self.module = types.ModuleType("check_proof")
        exec(compile(text, "check_proof", "exec"), self.module.__dict__)

    def run(self, path=directory):
        """([a, b] or None, what it prints)"""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = self.module.main([str(path)])
        found = re.match(r"proved: J_min in \[(\S+), (\S+)\], ", out.getvalue())
        assert (code == 0) == bool(found) and code in (0, 1), (code, out.getvalue(), err.getvalue())
        return [float(v) for v in found.groups()] if found else None, out.getvalue() + err.getvalue()


def is_expected(said):
    kind = re.match(r"refused: ([A-Z][A-Za-z]*(Error|Exception|Iteration)): ", said)
    return not kind or kind[1] in EXPECTED


def least_energy(model, S, problem, box, rng, states=None, n_starts=6):
    """Of points that are found in a box, exactly."""
    finite = [(max(l, -5.), min(u, 5.)) for l, u in box]
    starts = [[rng.uniform(min(l, u), max(l, u)) for l, u in finite] for _ in range(n_starts)]
    points = [model.descend(start, box, 100, states) for start in starts]
    points += [np.clip(start, *zip(*box)) for start in starts]
    best = min(points, key=lambda s: proofs.exact_energy(S, problem, s, states))
    return proofs.exact_energy(S, problem, best, states)


def brute_force(model, S, problem, rng):
    """J of the best of descents from all patterns of pieces, and of a grid."""
    ends = []
    for pieces, u in zip(model.pieces, model.upper):
        places = sorted({v for piece in pieces for v in piece[:2] if math.isfinite(v)} | {-4., 0., 1.})
        ends.append([min(v, u) for v in places + [(v + w) / 2. for v, w in zip(places, places[1:])]])
    starts = [[rng.choice(places) for places in ends] for _ in range(30)]
    patterns = [{t: int(rng.choice([HOLDS, BROKEN])) for t, v in model.root[1].items() if v == 3}
                for _ in starts]
    # Descents with given states come to where those without them get stuck.
    points = [model.descend(model.descend(start, model.root[0], 60, states), model.root[0], 200)
              for start, states in zip(starts, patterns)]
    return min(proofs.exact_energy(S, problem, s) for s in sorted(points, key=model.energy)[:3])


# Each function yields what is wrong.

def faults_of_proofs(checker, n):
    """Good proofs are accepted, tight, and hold the minimum by brute force."""
    n_loose = 0
    for k in range(n):
        rng = np.random.default_rng([1, k])
        S, problem = proofs.random_problem(rng, int(rng.integers(1, 5)))
        prover = proofs.Prover(S, problem, rng, n_nodes=60)
        proofs.write(directory, S, problem, prover.proof())
        found, said = checker.run()
        if not found:
            yield f"proof {k}: {said}"
            continue
        least = brute_force(prover.model, S, problem, rng)
        if not found[0] <= least or found[1] < proofs.exact_energy(S, problem, prover.state):
            yield f"proof {k}: {float(least)} is not in {found}"
        n_loose += found[1] - found[0] > 3e-6 * max(1., abs(found[1]))
    if n_loose > 0.2 * n:
        yield f"{n_loose} proofs are not tight"


def random_interval(rng, x):
    """Limits about x, some of them infinite, and some with nothing between them."""
    if rng.random() < 0.05:
        return [float(x)] * 2
    return [None if rng.random() < 0.3 else
            float(x + sign * abs(rng.normal()) * rng.choice([0.01, 0.3, 2.])) for sign in (-1., 1.)]


def regions_of(problem, box, states, lower, upper, lost):
    """Boxes with states that a cut has bounds for, in their order, and what is left or None."""
    regions, left, remaining = [], [], dict(states)
    for i, ((l, u), low, high) in enumerate(zip(box, lower, upper)):
        low, high = -INFINITY if low is None else low, INFINITY if high is None else high
        if low > l:
            regions.append((box[:i] + [(l, min(u, low))] + box[i + 1:], states, i))
        if high < u:
            regions.append((box[:i] + [(max(l, high), u)] + box[i + 1:], states, i))
        left.append((max(l, low), min(u, high)))
    if any(l > u for l, u in left):
        return regions, None
    for state, names in zip((BROKEN, HOLDS), lost):
        for t in names:
            term = problem["terms"][t]
            nearest = [Fraction(max(left[i][0], min(left[i][1], 0.))) for i in term["unknowns"]]
            springs = sum(proofs.exact(k) * s ** 2 / 2 for k, s in zip(term["stiffness"], nearest))
            is_free = state == HOLDS and springs >= Fraction(term["energy"])
            if states[t] & state and not is_free:
                regions.append((left, {**states, t: state}, None))
            remaining[t] &= ~state
    return regions, (left, remaining) if all(remaining.values()) else None


def bounds_of(checker, size):
    """What the program finds for the files that are there, as fractions; None if it refuses."""
    kept, tree = [], checker.module.Tree

    class Kept(tree):
        def __init__(self, *arguments):
            kept.append(self)
            super().__init__(*arguments)

    checker.module.Tree = Kept
    try:
        found, said = checker.run()
    finally:
        checker.module.Tree = tree
    if not found:
        return None, said
    return [Fraction(v, 1 << 3 * kept[0].problem.bits + 1) for v in kept[0].bounds], said


def faults_of_bounds(checker, n):
    """Bounds of random entries are below J in the boxes that they are for."""
    n_tight, n_all, n_lost = 0, 0, 0
    for k in range(n):
        rng = np.random.default_rng([2, k])
        size = int(rng.integers(1, 5))
        S, problem = proofs.random_problem(rng, size)
        model = proofs.Model(S, problem)
        x = model.minimise(rng, 2) if rng.random() < 0.6 else rng.normal(size=size)
        D = np.linalg.eigvalsh(S)[0] * rng.choice([0.5, 0.99])
        D = D - (rng.random(size) < 0.3) * rng.uniform(0., 2., size)
        D = D * (rng.random(size) < 0.95)
        data = [{"D": D.tolist(), "x": x.tolist()}]
        if model.pairs:
            data[0]["forces"] = model.forces(x)
        both = [t for t, left in model.root[1].items() if left == HOLDS | BROKEN]
        node, regions, entries = model.root, [], []
        for count in range(2):
            lower, upper = zip(*(random_interval(rng, min(v, u)) for v, u in zip(x, model.upper)))
            if rng.random() < 0.1:
                lower, upper = upper, lower
            lost = [[t for t in both if count and rng.random() < 0.4] for _ in range(2)]
            more, node = regions_of(problem, *node, lower, upper, lost)
            regions, entries = regions + more, entries + [["cut", 0, lower, upper, *lost]]
            n_lost += sum(i is None for _, _, i in more)
            if not node:
                break
        if node:
            grown = int(rng.integers(size)) if rng.random() < 0.5 else None
            entries.append(["leaf", 0] if grown is None else ["grow", 0, grown])
            regions.append((*node, grown))
        state = [min(v, u) for v, u in zip(x, model.upper)]
        proofs.write(directory, S, problem, {"state": list(state), "interval": WIDE, "rounds": data,
                                             "tree": entries})
        bounds, said = bounds_of(checker, size)
        if bounds is None:
            if not ("no bound" in said or "singular" in said):
                yield f"bounds {k}: {said}"
            continue
        if len(bounds) != len(regions):
            yield f"bounds {k}: {len(bounds)}, not {len(regions)}"
            continue
        for place, (bound, (box, states, grown)) in enumerate(zip(bounds, regions)):
            least = least_energy(model, S, problem, box, rng, states, 3)
            expected = proofs.Round(model, D, x, data[0].get("forces", [])).bound(box, states, grown)[0]
            if bound > least:
                yield f"bounds {k}: {place} is {float(bound)}, J has {float(least)}"
            elif math.isfinite(expected) and abs(bound - Fraction(expected)) > 1e-4 * (1. + abs(expected)):
                yield f"bounds {k}: {place} is {float(bound)}, not {expected}"
            n_tight += bound > least - Fraction(1, 10 ** 6)
            n_all += 1
    if n_tight < n // 4 or n_lost < n // 8:
        yield f"of {n_all} bounds {n_tight} are tight and {n_lost} of lost states: too few"


def exact_growth(A, i):
    """1 / (A^-1)_ii, the last pivot if i is the last unknown."""
    order = [j for j in range(len(A)) if j != i] + [i]
    A = [[A[j][k] for k in order] for j in order]
    for k, row in enumerate(A):
        for other in A[k + 1:]:
            factor = other[k] / row[k]
            for j in range(k, len(A)):
                other[j] -= factor * row[j]
    return A[-1][-1]


def faults_of_shifts(checker, n):
    """Of shifts near indefinite ones, and of growth."""
    n_accepted, n_indefinite, n_growths = 0, 0, 0
    for k in range(n):
        rng = np.random.default_rng([3, k])
        size = int(rng.integers(1, 5))
        G = rng.normal(size=(size, size)) * 10. ** rng.uniform(-3., 3., size)[:, None]
        S = G @ G.T + 10. ** rng.uniform(-6., 0.) * np.diag(np.diag(G @ G.T))
        S = (S + S.T) / 2.
        scale = np.sqrt(np.diag(S))
        near = rng.choice([-1e-3, -1e-6, -1e-8, -1e-10, -1e-12, -1e-14, 0., 1e-16, 1e-15, 1e-13, 1e-9, 1e-3])
        # With a scaled least eigenvalue that is nearly zero.
        least = np.linalg.eigvalsh(S / scale[:, None] / scale)[0]
        D = (least + near) * scale ** 2
        problem = {"g": [0.] * size, "c_0": 0., "upper": [None] * size, "terms": [], "friction": []}
        proofs.write(directory, S, problem, {"state": [0.] * size, "interval": WIDE, "tree": [["leaf", 0]],
                                             "rounds": [{"D": D.tolist(), "x": [0.] * size}]})
        found, said = checker.run()
        A = proofs.exact_difference(S, D)
        is_definite = proofs.is_positive_definite(A)
        n_accepted += bool(found)
        n_indefinite += not is_definite
        if found and not is_definite:
            yield f"shift {k} is accepted, but S - D is indefinite"
        if not found and "no bound" not in said and (
                near < -1e-12 or "positive definite" not in said):
            yield f"shift {k}: {said}"
        if not found:
            continue
        try:
            with np.errstate(all="ignore"):
                q = checker.module.Difference(np.array(S), D).growths()
        except checker.module.Refused:
            if near < -2e-11:
                yield f"shift {k} has no growth"
            continue
        for i in range(size):
            exact = exact_growth(A, i)
            n_growths += 1
            if not 0 < Fraction(float(q[i])) <= exact:
                yield f"shift {k}: growth is {q[i]}, at most {float(exact)}"
            if Fraction(float(q[i])) < exact * (1 - Fraction(1, 10 ** (8 if near < -1e-9 else 7))):
                yield f"shift {k}: growth is {q[i]}, and could be {float(exact)}"
    if min(n_accepted, n_indefinite, n_growths) < n // 5:
        yield f"{n_accepted} shifts are accepted, {n_indefinite} are indefinite: too few"


# Good files, and what can be done to them.

class Files:
    """A problem with a proof, as dictionaries, and an interval that holds the minimum."""

    def __init__(self, checker, seed, size, **options):
        rng = np.random.default_rng([4, seed])
        self.S, self.problem = proofs.random_problem(rng, size)
        self.proof = proofs.Prover(self.S, self.problem, rng, **options).proof()
        self.S = self.S.tolist()
        self.write()
        self.interval, self.said = checker.run()

    def write(self):
        proofs.write(directory, self.S, self.problem, self.proof)

    def copy(self):
        return copy.deepcopy(self)


def rewrite(name, content):
    """Of a file that is altered as it is, with the checksums that others have of it."""
    (directory / name).write_bytes(content)
    for other, key, file in (("problem.json", "S", "S.mtx"), ("proof.json", "problem", "problem.json")):
        if file == name or name == "S.mtx":
            old = (directory / other).read_bytes()
            new = re.sub(rb'("%s": {"file": "[^"]*", "crc32": )[0-9]+' % key.encode(),
                         lambda match: match[1] + b"%d" % zlib.crc32((directory / file).read_bytes()), old)
            (directory / other).write_bytes(new)


def some_number(draw, old=0.):
    choices = [0, -1, 1, 0.5, -1e-3, 1e3, 1e150, -1e308, 1e-320, 10 ** 400, 2 ** 53 + 1, math.nan, math.inf,
               True, None, "1", [1], {}, -old, old * 2., old * (1. + 1e-9), old * (1. + 1e-3), old + 1e-6]
    return draw.choice(choices)


def places_of(value):
    """(container, key) of all that is in it."""
    for key, inner in list(value.items() if type(value) is dict else enumerate(value)):
        yield value, key
        if type(inner) in (dict, list):
            yield from places_of(inner)


def alter_value(draw, files):
    part = draw.choice([files.problem, files.proof, files.proof["tree"], files.proof["rounds"]])
    container, key = draw.choice(list(places_of(part)))
    old, kind = container[key], draw.randrange(5)
    if kind == 0 or kind == 1:
        container[key] = some_number(draw, old if type(old) in (int, float) else 0.)
    elif kind == 2:
        del container[key]
    elif kind == 3 and type(container) is list:
        container.insert(draw.randrange(len(container) + 1), copy.deepcopy(old))
    elif kind == 4 and type(container) is list:
        other = draw.randrange(len(container))
        container[key], container[other] = container[other], container[key]
    else:
        container["extra" if type(container) is dict else key] = old


def alter_round(draw, files):
    data = draw.choice(files.proof["rounds"])
    factor = draw.choice([0.5, 0.99, 1.001, 1.1, 2., -1., 1. + 10. ** draw.uniform(-15., -3.)])
    key = draw.choice(["D", "x"])
    data[key] = [v * factor if draw.random() < 0.7 else v for v in data[key]]


def alter_entry(draw, files):
    tree, rounds = files.proof["tree"], len(files.proof["rounds"])
    place = draw.randrange(len(tree))
    entry, n = tree[place], len(files.S)
    if entry[0] in ("leaf", "grow", "cut") and draw.random() < 0.4:
        entry[1] = draw.randrange(rounds)
    elif entry[0] == "leaf":
        tree[place] = ["grow", entry[1], draw.randrange(n)]
    elif entry[0] == "grow":
        entry[2] = draw.randrange(n)
    elif entry[0] == "split":
        entry[draw.choice([1, 2])] = draw.choice([draw.randrange(n), draw.gauss(0., 1.)])
    elif entry[0] == "states":
        entry[1] = draw.randrange(len(files.problem["terms"]))
    elif draw.random() < 0.5:
        limits, i = entry[draw.choice([2, 3])], draw.randrange(n)
        limits[i] = draw.choice([None, draw.gauss(0., 1.), (limits[i] or 0.) + draw.gauss(0., 0.1)])
    else:
        springs = [t for t, term in enumerate(files.problem["terms"]) if "unknowns" in term]
        entry[draw.choice([4, 5])] = [t for t in springs if draw.random() < 0.5]


def alter_tree(draw, files):
    tree = files.proof["tree"]
    a, b, kind = draw.randrange(len(tree)), draw.randrange(len(tree)), draw.randrange(5)
    if kind == 0:
        del tree[a]
    elif kind == 1:
        tree.insert(b, tree[a])
    elif kind == 2:
        tree[a], tree[b] = tree[b], tree[a]
    elif kind == 3:
        del tree[a:]
    else:
        files.proof["tree"] = [tree[a]]


def alter_bytes(draw, files):
    files.write()
    name = draw.choice(["S.mtx", "problem.json", "proof.json"])
    content = bytearray((directory / name).read_bytes())
    digits = [k for k, c in enumerate(content) if chr(c).isdigit()]
    kind = draw.randrange(4)
    if kind <= 1:
        content[draw.choice(digits)] = ord(draw.choice("0123456789"))
    elif kind == 2:
        for _ in range(draw.choice([1, 3])):
            content[draw.randrange(len(content))] = ord(draw.choice('0123456789-.eE,[]{}" \n\xff'))
    else:
        del content[draw.randrange(len(content)):]
    if draw.random() < 0.8:
        rewrite(name, bytes(content))
    else:
        (directory / name).write_bytes(bytes(content))


ALTERATIONS = [alter_value, alter_value, alter_value, alter_round, alter_entry, alter_entry, alter_tree, alter_bytes]


def read_files():
    """(S, problem, proof) of files that the program has accepted."""
    words = [line for line in (directory / "S.mtx").read_text().splitlines() if not line.startswith("%")]
    n, _, *values = " ".join(words).split()
    S, values = np.zeros((int(n), int(n))), iter(values)
    for j in range(int(n)):
        for i in range(j, int(n)):
            S[i, j] = S[j, i] = float(next(values))
    return S, *(json.loads((directory / name).read_text()) for name in ("problem.json", "proof.json"))


def faults_of_altered(checker, n):
    """Altered files are refused, or what they prove is true."""
    goods, n_proved = [Files(checker, seed, 1 + seed % 4, n_nodes=20) for seed in range(12)], 0
    for number, files in enumerate(goods):
        if not files.interval:
            yield f"good files {number}: {files.said}"
            return
    for k in range(n):
        draw = random.Random(k)
        good = draw.choice(goods)
        files, alter = good.copy(), ALTERATIONS[k % len(ALTERATIONS)]
        if draw.random() < 0.7:
            files.proof["interval"] = list(WIDE)
        alter(draw, files)
        if alter is not alter_bytes:
            files.write()
        try:
            found, said = checker.run()
        except Exception as error:
            yield f"altered {k}: {type(error).__name__}: {error}"
            continue
        if not is_expected(said):
            yield f"altered {k}, {alter.__name__}: {said}"
        if not found:
            continue
        n_proved += 1
        S, problem, proof = read_files()
        state = proofs.exact_energy(S, problem, proof["state"])
        is_same = (S.tolist(), {**problem, "format": 0, "S": 0}) == (
            good.S, {**good.problem, "format": 0, "S": 0})
        least = Fraction(good.interval[1]) if is_same else brute_force(
            proofs.Model(S, problem), S, problem, np.random.default_rng(k))
        if found[0] > least or found[1] < state - Fraction(1, 2 ** 190):
            yield f"altered {k}, {alter.__name__}: {found}, but J has {float(least)} and {float(state)}"
        low, high = proof["interval"]
        if not low <= found[0] <= found[1] <= high:
            yield f"altered {k}: what is claimed is not proved"
    if not n // 10 < n_proved < 7 * n // 10:
        yield f"{n_proved} of {n} altered files prove something"


# Files of which each has one mistake in its form: what is altered, and what is said of it.

def base(problem=None, **proof):
    """A small problem with all that there is: two bonds, springs, a free unknown and friction."""
    n = 6
    S = np.diag(np.full(n, 2.)) + np.diag(np.full(n - 1, -0.5), 1) + np.diag(np.full(n - 1, -0.5), -1)
    whole = {"g": [-1., -0.5, 0.3, 0.2, -0.1, 0.4], "c_0": 0.25, "upper": [0., -0.01, None, None, None, None],
             "terms": [{"unknown": 0, "pieces": [[1., 0., -0.3], [0., 0., None]]},
                       {"unknown": 1, "pieces": [[2., 0., -0.2], [-0.5, -0.3, -0.4], [0., 0., None]]},
                       {"unknowns": [2, 3], "stiffness": [1., 2.], "energy": 0.05}],
             "friction": [{"unknowns": [4], "weight": 0.1, "place": [0.01]},
                          {"unknowns": [4, 5], "weight": 0.2, "place": [0., 0.1]}], **(problem or {})}
    pairs = [v for v in whole["friction"] if len(v["unknowns"]) == 2]
    data = {"D": [0.5] * n, "x": [-0.1] * n}
    if pairs:
        data["forces"] = [[0., 0.]] * len(pairs)
    return S.tolist(), whole, {"state": [-0.5] * n, "interval": list(WIDE), "rounds": [data], "tree": [
        ["cut", 0, [-9.] * n, [None] * n, [], []], ["states", 2], ["leaf", 0], ["split", 0, -0.3],
        ["leaf", 0], ["grow", 0, 1]], **proof}


def forms():
    """(what is refused for it, files)"""
    def of(reason, change):
        S, problem, proof = base()
        change(problem, proof, proof["rounds"][0], proof["tree"])
        return reason, (S, problem, proof)

    for value in (math.nan, math.inf, -math.inf, 10 ** 400, True, "1", [1.], {"a": 1.}, None):
        for change in (lambda p, q, r, t: p["g"].__setitem__(2, value),
                       lambda p, q, r, t: p.__setitem__("c_0", value),
                       lambda p, q, r, t: p["terms"][0]["pieces"][0].__setitem__(0, value),
                       lambda p, q, r, t: p["terms"][2]["stiffness"].__setitem__(0, value),
                       lambda p, q, r, t: p["friction"][0].__setitem__("weight", value),
                       lambda p, q, r, t: q["state"].__setitem__(0, value),
                       lambda p, q, r, t: q["interval"].__setitem__(0, value),
                       lambda p, q, r, t: r["D"].__setitem__(0, value),
                       lambda p, q, r, t: r["x"].__setitem__(0, value),
                       lambda p, q, r, t: r["forces"].__setitem__(0, [value, 0.]),
                       lambda p, q, r, t: t[3].__setitem__(2, value)):
            yield of("number|OverflowError", change)
        if value is not None:
            yield of("number|OverflowError", lambda p, q, r, t: p["upper"].__setitem__(2, value))
            yield of("number|OverflowError", lambda p, q, r, t: t[0][2].__setitem__(2, value))
            yield of("number|OverflowError", lambda p, q, r, t: p["terms"][2].__setitem__("energy", value))
    for value in (-1, 6, True, 1., "1", None, [0]):
        for change in (lambda p, q, r, t: p["terms"][0].__setitem__("unknown", value),
                       lambda p, q, r, t: p["terms"][2].__setitem__("unknowns", [2, value]),
                       lambda p, q, r, t: p["friction"][0].__setitem__("unknowns", [value]),
                       lambda p, q, r, t: t[0].__setitem__(1, value), lambda p, q, r, t: t[2].__setitem__(1, value),
                       lambda p, q, r, t: t[1].__setitem__(1, value), lambda p, q, r, t: t[3].__setitem__(1, value),
                       lambda p, q, r, t: t[5].__setitem__(2, value), lambda p, q, r, t: t[0].__setitem__(4, [value]),
                       lambda p, q, r, t: t[0].__setitem__(5, [value])):
            yield of("not one of", change)
    for reason, change in (
            ("keys", lambda p, q, r, t: p.__setitem__("more", 1)), ("keys", lambda p, q, r, t: p.pop("friction")),
            ("keys", lambda p, q, r, t: q.__setitem__("more", 1)), ("keys", lambda p, q, r, t: q.pop("interval")),
            ("keys", lambda p, q, r, t: r.__setitem__("more", 1)), ("keys", lambda p, q, r, t: r.pop("forces")),
            ("keys", lambda p, q, r, t: p["terms"][0].__setitem__("energy", 1.)),
            ("keys", lambda p, q, r, t: p["terms"][2].pop("energy")),
            ("keys", lambda p, q, r, t: p["friction"][0].__setitem__("more", 1)),
            ("keys", lambda p, q, r, t: p["terms"].__setitem__(0, [])),
            ("keys", lambda p, q, r, t: p["terms"].__setitem__(0, 5)),
            ("keys", lambda p, q, r, t: p["friction"].__setitem__(0, None)),
            ("keys", lambda p, q, r, t: q["rounds"].append(7)),
            ("keys", lambda p, q, r, t: p["friction"].pop(1)),
            ("list", lambda p, q, r, t: p["g"].pop()), ("list", lambda p, q, r, t: r["D"].append(0.)),
            ("list", lambda p, q, r, t: q["state"].pop()), ("list", lambda p, q, r, t: t[0][2].pop()),
            ("list", lambda p, q, r, t: r["forces"].append([0., 0.])),
            ("list", lambda p, q, r, t: q["interval"].append(0.)),
            ("list", lambda p, q, r, t: q.__setitem__("tree", {})),
            ("list", lambda p, q, r, t: q.__setitem__("rounds", "0")),
            ("list", lambda p, q, r, t: p.__setitem__("terms", None)),
            ("list", lambda p, q, r, t: t.__setitem__(2, "leaf")),
            ("list", lambda p, q, r, t: p["terms"][2]["stiffness"].pop()),
            ("list", lambda p, q, r, t: p["friction"][1]["place"].pop()),
            ("two terms|twice", lambda p, q, r, t: p["terms"][2].__setitem__("unknowns", [2, 0])),
            ("twice", lambda p, q, r, t: p["terms"][2].__setitem__("unknowns", [2, 2])),
            ("twice", lambda p, q, r, t: p["friction"][1].__setitem__("unknowns", [4, 4])),
            ("twice", lambda p, q, r, t: t[0].__setitem__(4, [2, 2])),
            ("friction is of", lambda p, q, r, t: p["friction"].append(
                {"unknowns": [0, 1, 2], "weight": 1., "place": [0.] * 3})),
            ("friction is of", lambda p, q, r, t: p["friction"].append(
                {"unknowns": [], "weight": 1., "place": []})),
            ("not negative", lambda p, q, r, t: p["friction"][0].__setitem__("weight", -0.1)),
            ("not negative", lambda p, q, r, t: p["friction"][1].__setitem__("weight", -0.1)),
            ("negative", lambda p, q, r, t: p["terms"][2].__setitem__("energy", -0.1)),
            ("negative", lambda p, q, r, t: p["terms"][2]["stiffness"].__setitem__(1, -0.1)),
            ("empty", lambda p, q, r, t: p["terms"].append({"unknowns": [], "stiffness": [], "energy": 1.})),
            ("decays", lambda p, q, r, t: p["terms"][0]["pieces"][1].append(1.)),
            ("decays", lambda p, q, r, t: p["terms"][0]["pieces"][1].append(0)),
            ("list of 3", lambda p, q, r, t: p["terms"][0]["pieces"][0].pop()),
            ("last piece", lambda p, q, r, t: p["terms"][0].__setitem__("pieces", [])),
            ("last piece", lambda p, q, r, t: p["terms"][0]["pieces"].pop()),
            ("do not fall", lambda p, q, r, t: p["terms"][1]["pieces"][1].__setitem__(2, -0.2)),
            ("do not fall", lambda p, q, r, t: p["terms"][1]["pieces"][1].__setitem__(2, None)),
            ("do not fall", lambda p, q, r, t: p["terms"][0]["pieces"][0].__setitem__(2, 0.)),
            ("above 0", lambda p, q, r, t: p["upper"].__setitem__(0, None)),
            ("above 0", lambda p, q, r, t: p["upper"].__setitem__(0, 1e-300)),
            ("above its upper", lambda p, q, r, t: q["state"].__setitem__(0, 5e-324)),
            ("above its weight", lambda p, q, r, t: r["forces"].__setitem__(0, [0.2, 1e-9])),
            ("format", lambda p, q, r, t: p.__setitem__("format", "debond problem 2")),
            ("format", lambda p, q, r, t: q.__setitem__("format", "debond proof 2")),
            ("no such entry", lambda p, q, r, t: t.insert(0, [])),
            ("no such entry", lambda p, q, r, t: t.insert(0, ["add", 0])),
            ("no such entry", lambda p, q, r, t: t.insert(0, [["leaf"], 0])),
            ("no such entry", lambda p, q, r, t: t[2].append(0)),
            ("outside", lambda p, q, r, t: t[3].__setitem__(2, 0.1)),
            ("outside", lambda p, q, r, t: t[3].__setitem__(2, -9.5)),
            ("state is not left", lambda p, q, r, t: t.insert(2, ["states", 2])),
            ("state is not left", lambda p, q, r, t: t[1].__setitem__(1, 0)),
            ("ended before", lambda p, q, r, t: t.append(["leaf", 0])),
            ("not complete", lambda p, q, r, t: t.pop()), ("not complete", lambda p, q, r, t: t.clear()),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": "../a", "crc32": 0})),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": "..", "crc32": 0})),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": "/etc/passwd", "crc32": 0})),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": "", "crc32": 0})),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": 1, "crc32": 0})),
            ("plain name", lambda p, q, r, t: q.__setitem__("problem", {"file": "a\0", "crc32": 0})),
            ("FileNotFound", lambda p, q, r, t: q.__setitem__("problem", {"file": "none", "crc32": 0})),
            ("CRC", lambda p, q, r, t: q.__setitem__("problem", {"file": "problem.json", "crc32": None})),
            ("CRC", lambda p, q, r, t: q.__setitem__("problem", {"file": "problem.json", "crc32": 1})),
            ("CRC", lambda p, q, r, t: p.__setitem__("S", {"file": "S.mtx", "crc32": True})),
            ("keys", lambda p, q, r, t: p.__setitem__("S", {"file": "S.mtx"})),
            ("no bound", lambda p, q, r, t: r["D"].__setitem__(5, 0.)),
            ("no bound", lambda p, q, r, t: (r["D"].__setitem__(5, 0.), p["g"].__setitem__(5, -0.4))),
            ("positive definite", lambda p, q, r, t: r["D"].__setitem__(0, 2.)),
            ("positive definite", lambda p, q, r, t: r["D"].__setitem__(0, 1.99)),
            ("singular", lambda p, q, r, t: r.__setitem__("D", [1.0990311320975809 - 2e-13] * 6))):
        yield of(reason, change)


def faults_of_forms(checker, _):
    """Files of a wrong form are refused for it."""
    proofs.write(directory, *base())
    found, said = checker.run()
    if not found:
        yield f"the files of the right form: {said}"
    for number, (reason, files) in enumerate(forms()):
        proofs.write(directory, *files)
        found, said = checker.run()
        if found or not re.search(reason, said) or not is_expected(said):
            yield f"form {number}: {said.strip()} for {reason}"
    # What proofs.write cannot write.
    proofs.write(directory, *base())
    goods = {name: (directory / name).read_bytes() for name in ("S.mtx", "problem.json", "proof.json")}
    for name, old, new in (
            ("S.mtx", b"2.0", b"nan"), ("S.mtx", b"2.0", b"inf"), ("S.mtx", b"2.0", b"1_0"), ("S.mtx", b"2.0", b"1e999"),
            ("S.mtx", b"2.0\n", b""), ("S.mtx", b"2.0\n", b"2.0\n2.0\n"), ("S.mtx", b"6 6", b"6 7"),
            ("S.mtx", b"6 6", b"0 0"), ("S.mtx", b"6 6", b"6000000 6000000"), ("S.mtx", b"symmetric", b"general"),
            ("S.mtx", b"real", b"complex"), ("S.mtx", b"2.0", b"\xff"), ("S.mtx", goods["S.mtx"], b""),
            ("problem.json", b'"c_0"', b'"g"'), ("problem.json", b'"c_0": 0.25', b'"c_0": 0.25, "c_0": 0.25'),
            ("problem.json", b'0.25', b'1e999'), ("problem.json", b'0.25', b'0.2' * 9), ("problem.json", b'"g"', b'"\xff"'),
            ("problem.json", goods["problem.json"], b"[]"), ("proof.json", goods["proof.json"], b""),
            ("proof.json", goods["proof.json"], b"[" * 100000), ("proof.json", goods["proof.json"], b"{}x"),
            ("proof.json", goods["proof.json"], b'{"a":' * 100000), ("proof.json", b'"tree"', b'"\\ud800"'),
            ("proof.json", b'"tree": [', b'"tree": [' + b"[" * 50000 + b"]" * 50000 + b","),
            ("proof.json", b"-1e+300", b"1" * 5000)):
        proofs.write(directory, *base())
        assert old in goods[name], (name, old)
        rewrite(name, goods[name].replace(old, new, 1))
        found, said = checker.run()
        if found or "CRC" in said or not is_expected(said):
            yield f"{name} with {new[:20]}: {said.strip()}"
    rewrite("proof.json", re.sub(rb'("crc32": [0-9]+)', rb"\1.0", goods["proof.json"]))
    (directory / "problem.json").write_bytes(goods["problem.json"])
    (directory / "S.mtx").write_bytes(goods["S.mtx"])
    if "CRC" not in checker.run()[1]:
        yield "a checksum that is no integer"


# Forgeries: each would prove something wrong if the checker did not look at one thing.

def certificate(model, rng, state):
    """A round for which the state is the least of its bound; mostly S - D is indefinite."""
    D = np.full(model.n, 1e-3)
    for _ in range(60):
        a_round = proofs.Round(model, D, state, model.forces(state))
        place = a_round.bound(*model.root)[1]
        wrong = np.abs(place - state) > 1e-6
        if not wrong.any():
            return a_round
        D = np.where(wrong, 1.5 * D + 0.01, D)
    return None


def forgeries(seed):
    """(what is forged, S, the problem, the proof, a value of J)"""
    rng = np.random.default_rng([5, seed])
    S, problem = proofs.random_problem(rng, int(rng.integers(1, 4)))
    prover = proofs.Prover(S, problem, rng)
    model, s, (box, states) = prover.model, prover.state, prover.model.root
    n, best = len(S), proofs.exact_energy(S, problem, s)
    free = [None] * n

    def forged(name, tree, *rounds, state=s):
        proof = {"state": [float(v) for v in state], "interval": list(WIDE), "tree": tree,
                 "rounds": [a_round.data() for a_round in rounds]}
        return name, S, problem, proof, best

    for start in rng.normal(size=(4, n)) * 3.:
        other = model.descend(start, box, 300)
        if model.energy(other) > float(best) + 1e-3 * abs(float(best)):
            a_round = certificate(model, rng, other)
            if a_round:
                yield forged("a state that is not the least", [["leaf", 0]], a_round, state=other)
    for i in range(n):
        size = float(rng.choice([0.05, 0.3, 1.]))
        for name, k, low, high in (("below", 2, s[i] + size, box[i][1]), ("above", 3, box[i][0], s[i] - size)):
            if low < high:
                limits = [None, None, list(free), list(free)]
                limits[k][i] = float(low if k == 2 else high)
                left = box[:i] + [(low, high)] + box[i + 1:]
                inside = prover.best_round(left, states)[1]
                yield forged("what is cut off " + name, [["cut", 0, *limits[2:], [], []], ["leaf", 0]], inside)
                yield forged("a child that is left out", [["split", i, limits[k][i]], ["leaf", 0]], inside)
                halves = [["split", i, limits[k][i]], ["leaf", 0], ["grow", 0, i]]
                yield forged("half that has grown", halves, inside)
        above = s.copy()
        above[i] += 0.1
        if above[i] > box[i][1]:
            yield forged("a state above its bound", [["leaf", 0]], prover.best_round(box, states)[1], state=above)
        # About a point where the bound alone is good, away from the state.
        x = s.copy()
        x[i] -= rng.uniform(0.1, 2.)
        D = np.full(n, 0.9 * np.linalg.eigvalsh(S)[0])
        yield forged("growth everywhere", [["grow", 0, i]], proofs.Round(model, D, x, model.forces(x)))
    for t, left in states.items():
        if left == HOLDS | BROKEN:
            for name, lost, kept in (("broken is lost", 0, HOLDS), ("holds is lost", 1, BROKEN)):
                inside = prover.best_round(box, {**states, t: kept})[1]
                lists = [[t] if place == lost else [] for place in range(2)]
                yield forged(name, [["cut", 0, free, free, *lists], ["leaf", 0]], inside)
                yield forged(name + " with its sibling", [["states", t], ["leaf", 0]], inside)
            yield forged("both are lost", [["cut", 0, free, free, [t], [t]]], inside)
    if model.pairs:
        a_round = prover.best_round(box, states)[1]
        pair = model.pairs[0]
        v = [s[i] - p for i, p in zip(pair["unknowns"], pair["place"])]
        force = [(pair["weight"] + 0.2) * w / (math.hypot(*v) or 1.) for w in v]
        D = np.full(n, 0.9 * np.linalg.eigvalsh(S)[0])
        yield forged("a force that is too large", [["leaf", 0]], proofs.Round(model, D, s, [force]))


def faults_of_forged(checker, n):
    """Forgeries are refused, or what they prove is true."""
    counts = {}
    for k in range(n):
        for name, S, problem, proof, best in forgeries(k):
            proofs.write(directory, S, problem, proof)
            found, said = checker.run()
            counts[name] = counts.get(name, 0) + 1
            # A proved interval holds every minimum, so none is all above J or all below.
            if found and found[0] > best or not is_expected(said):
                yield f"forgery {k}, {name}: {said.strip()}, but J has {float(best)}"
            if name == "a state above its bound" and found:
                yield f"forgery {k}, {name}: {said.strip()}"
    if n >= 40 and min(counts.values()) < 3 or len(counts) < 11:
        yield f"too few forgeries: {counts}"


# Mistakes that may be made in the checker.
MISTAKES = [
    ('need(self.matrix.has_eigenvalues_above(0.)', 'need(True'),
    ('if not (column[0] > 0. and', 'if not (column[0] != 0. and'),
    ('m + (n + 8) * EPSILON * np.trace(self.A)', 'm'),
    ('need(not nodes and self.bounds', 'need(self.bounds'),
    ('need(all(v <= u for v, u in zip(s, self.upper))', 'need(True'),
    ('need(sum(f * f for f in force) <= weight * weight', 'need(True'),
    ('need(sum(f * f for f in force) <= weight * weight', 'need(max(map(abs, force)) <= weight'),
    ('for half in ((place, upper), (lower, place))', 'for half in ((lower, place), (place, upper))'),
    ('for half in ((place, upper), (lower, place))', 'for half in ((place, upper),)'),
    ('need(lower <= place <= upper', 'need(True'),
    ('for state in (BROKEN, HOLDS)]', 'for state in (HOLDS, BROKEN)]'),
    ('[(l, min(u, low))] * (low > l)', '[]'),
    ('[(l, min(u, low))] * (low > l)', '[(l, min(u, low))] * (l < low < u)'),
    ('[(max(l, high), u)] * (high < u)', '[]'),
    ('(l, min(u, low))', '(l, low)'),
    ('states[t], i)))', 'states[t], 0)))'),
    ('if states[t] & state and not is_free', 'if False'),
    ('if states[t] & state and not is_free', 'if states[t] & state and state == BROKEN'),
    ('is_free = state == HOLDS and', 'is_free ='),
    ('zip(stiffness, nearest)) >= energy', 'zip(stiffness, nearest)) >= energy / 2'),
    ('remaining[t] &= ~state', 'remaining[t] &= state'),
    ('r.part(t, left, state)', 'r.part(t, left, states[t])'),
    ('parts = r.parts(left, states) if lost', 'parts = parts if lost'),
    ('if any(l > u for l, u in left)', 'if any(l >= u for l, u in left)'),
    ('need(None not in parts, "a box has no bound")', 'parts = [v or 0 for v in parts]'),
    ('if None in values:', 'if False:'),
    ('return min(sums)', 'return max(sums)'),
    ('return min(values)', 'return max(values)'),
    ('min(((c * s + 2 * b) * s', 'max(((c * s + 2 * b) * s'),
    ('if c > 0 and (low', 'if c != 0 and (low'),
    ('constant + -b * b // c', 'constant - b * b // c + (1 << self.bits * 2)'),
    ('(c < 0 or c == 0 < b)', 'c < 0'),
    ('(c < 0 or c == 0 > b)', 'c < 0'),
    ('value + q * x * x', 'value + 2 * q * x * x'),
    ('self.slopes[i] - q * x', 'self.slopes[i] + q * x'),
    ('return (1. - 1e-9) / inverse', 'return 4. / inverse'),
    ('return (1. - 1e-9) / inverse', 'return (1. + 1e-6) / inverse'),
    ('+ np.sum((np.abs(R) + error) ** 2, axis=0) / m)', ')'),
    ('(1e-8, 1e-10, 1e-12)', '(1e-8,)'),
    ('low = np.array([math.fsum(v)', 'low = np.array([0. * math.fsum(v)'),
    ('self.constant -= 2 * f * p', 'self.constant += 2 * f * p'),
    ('self.slopes[i] += f', 'self.slopes[i] -= f'),
    ('problem.c_0 - sum(v * (y - d * v)', 'problem.c_0 - sum(v * (y + d * v)'),
    ('y - d * v - g for', 'y - g for'),
    ('c, b - w, k + 2 * w * p', 'c, b - w, k - 2 * w * p'),
    ('c, b + w, k - 2 * w * p', 'c, b, k - 2 * w * p'),
    ('self.pieces[i] = above + below', 'self.pieces[i] = above'),
    ('(result[-1][3] - b)) * begin', '(result[-1][3] + b)) * begin'),
    ('+ extra)', ')'),
    ('math.isqrt(square - 1) + 1 if', '0 if'),
    ('total += min(sum(k * s[i] * s[i] for i, k in zip(unknowns, stiffness)), energy)', 'total += 0'),
    ('(BROKEN, [0] * len(unknowns), energy)', '(BROKEN, stiffness, energy)'),
    ('need(interval[0] <= a <= b <= interval[1]', 'need(a <= b <= interval[1]'),
    ('need(interval[0] <= a <= b <= interval[1]', 'need(interval[0] <= a <= b'),
    ('checksum == zlib.crc32(content)', 'True'),
    ('need(type(checksum) is int and', 'need('),
    ('type(value) in (int, float)', 'isinstance(value, (int, float))'),
    ('need(type(value) is int and 0 <= value < n', 'need(type(value) is int and value < n'),
    ('sorted(k for k, _ in pairs) == sorted(keys)', '{k for k, _ in pairs} == set(keys)'),
    ('sorted(k for k, _ in pairs) == sorted(keys)', '{k for k, _ in pairs} >= set(keys)'),
    ('length in (None, len(value))', 'True'),
    ('need(begin > end', 'need(begin >= end'),
    ('<= 0, "an unknown with pieces', '<= 1e300, "an unknown with pieces'),
    ('and min(*stiffness, energy) >= 0', ''),
    ('need(n in (1, 2) and weight >= 0', 'need(n in (1, 2)'),
    ('        used = indices([i for', '        used = list([i for'),
]


def every_fault(checker, n):
    """With n the size of the tests, about the number of altered files."""
    for faults, count in ((faults_of_forms, 0), (faults_of_forged, n // 8), (faults_of_bounds, n // 2),
                          (faults_of_shifts, n // 2), (faults_of_proofs, n // 8), (faults_of_altered, n)):
        for fault in faults(checker, count):
            yield faults.__name__[10:], fault


def first_fault(text, n):
    """What is noticed of a mistake, or None."""
    try:
        return next(every_fault(Checker(text), n), None)
    except Exception as error:
        return "error", f"{type(error).__name__}: {error}"


def main(debond, _, n=320):
    scenes = Scenes(debond)
    n, faults = int(n), {}
    for kind, fault in every_fault(Checker(), n):
        faults.setdefault(kind, []).append(fault)
    for kind in ("forms", "forged", "bounds", "shifts", "proofs", "altered"):
        scenes.check(kind, kind not in faults, "\n  ".join(faults.get(kind, [])[:5]))
    # As a program.
    proofs.write(directory, *base())
    for arguments, code, words in ((["--help"], 0, "Nothing of a proof is believed"), ([], 2, "usage"),
                                   (["a", "b"], 2, "usage"), ([str(directory)], 0, "proved: J_min in ["),
                                   ([str(directory / "proof.json")], 0, "proved: J_min in ["),
                                   ([str(directory / "none")], 1, "refused: "),
                                   ([str(directory / "S.mtx")], 1, "refused: ")):
        result = subprocess.run([str(PROGRAM), *arguments], capture_output=True, text=True, check=False)
        scenes.check(f"exit code for {arguments}", result.returncode == code, result)
        scenes.check(f"output for {arguments}", words in (result.stderr if code else result.stdout)
                     and not (result.stdout if code else result.stderr), result)
    for old, new in MISTAKES if n >= 1000 else []:
        scenes.check(f"there is no place of the mistake {old}", TEXT.count(old) >= 1)
        scenes.check(f"the mistake is noticed: {old} -> {new}", first_fault(TEXT.replace(old, new, 1), 320))
    scenes.end()


if __name__ == "__main__":
    main(*sys.argv[1:])
