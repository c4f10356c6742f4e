#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_proofs.py DEBOND PRM_DIRECTORY [n [scenes]]: scripts/check_proof accepts the proofs of
random scenes, and whatever it accepts of trees by lot, shifts near indefinite ones, and altered
and forged files is true. n is the number of altered files; with 1000 or more there are more
scenes, and each of a list of mistakes in the checker has to be noticed.
"""
import contextlib
import copy
import functools
import io
import json
import math
import operator
import os
import pathlib
import random
import re
import subprocess
import sys
import types
from fractions import Fraction

os.environ.update(dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1"))
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import proofs
from proofs import WIDE, Model, determinant, exchanged, random_problem, random_proof
from run_scenes import NO_PICTURES, Scenes, scene_text

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "check_proof"
TEXT = PROGRAM.read_text(encoding="utf-8")
# Exceptions that no file may raise, since reading it raises others.
WRONG = "refused: (?!JSON|Unicode|Value|Overflow|Recursion|FileNotFound)[A-Za-z]+Error: "
scenes = Scenes(sys.argv[1])
directory = scenes.directory


class Checker:
    """The program in this process, perhaps with another text."""

    def __init__(self, text=TEXT):
        self.module, self.tree = types.ModuleType("check_proof"), None
        exec(compile(text, "check_proof", "exec"), vars(self.module))
        tree = self.module.Tree
        self.module.Tree = lambda *parts: setattr(self, "tree", tree(*parts)) or self.tree

    def run(self, path=directory):
        """([a, b] or None, what it prints)"""
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            code = self.module.main([str(path)])
        said = out.getvalue().strip()
        found = re.match(r"proved: J_min in \[(\S+), (\S+)\], ", said)
        assert code == (not found) and not re.match(WRONG, said), said
        return [float(v) for v in found.groups()] if found else None, said


def faults_of_bounds(checker, n):
    """Of trees of whatever entries: each bound is below J in its region, by brute force."""
    n_tight = n_refused = 0
    for k in range(n):
        rng = np.random.default_rng([1, k])
        model = Model(*random_problem(rng, int(rng.integers(1, 5))))
        proof, regions = random_proof(model, rng)
        proofs.write(directory, model.S, model.problem, proof)
        found, said = checker.run()
        if not found:
            n_refused += 1
            if not re.search("no bound|singular", said):
                yield f"{k}: {said}"
            continue
        unit, state = 1 << 3 * checker.tree.problem.bits + 1, model.exact_energy(proof["state"])
        bounds = [Fraction(v, unit) for v in checker.tree.bounds]
        if not found[0] <= state <= found[1] or len(bounds) != len(regions):
            yield f"{k}: {float(state)} is not in {found}, or {len(bounds)} is not {len(regions)}"
        for bound, (box, states) in zip(bounds, regions):
            least = model.least(rng, box, states)[0]
            n_tight += bound > least - Fraction(1, 10 ** 6)
            if bound > least:
                yield f"{k}: {float(bound)}, but J has {float(least)} in {box}, {states}"
    if n_tight < n / 4 or n_refused > n / 2:
        yield f"{n_tight} bounds are tight, {n_refused} trees refused"


def faults_of_shifts(checker, n):
    """Of shifts near indefinite ones, and of growth, beside exact elimination."""
    counts = np.zeros(3)
    for k in range(n):
        rng = np.random.default_rng([3, k])
        size = int(rng.integers(1, 5))
        G = rng.normal(size=(size, size)) * 10. ** rng.uniform(-3., 3., size)[:, None]
        S = G @ G.T + 10. ** rng.uniform(-6., 0.) * np.diag(np.diag(G @ G.T))
        S, scale = (S + S.T) / 2., np.sqrt(np.diag(S))
        near = rng.choice([*(-10. ** np.arange(-14, -1, 2)), 0., 1e-16, 1e-15, 1e-13, 1e-9, 1e-3])
        # With a scaled least eigenvalue that is nearly zero.
        D = (np.linalg.eigvalsh(S / scale[:, None] / scale)[0] + near) * scale ** 2
        A = [[Fraction(v) - (Fraction(D[i]) if i == j else 0) for j, v in enumerate(row)]
             for i, row in enumerate(S.tolist())]
        is_accepted, q = False, []
        is_definite = all(determinant([row[:j] for row in A[:j]]) > 0 for j in range(1, size + 1))
        with contextlib.suppress(checker.module.Refused), np.errstate(all="ignore"):
            matrix = checker.module.Difference(S, D)
            is_accepted = matrix.has_eigenvalues_above(0.)
            q = matrix.growths().tolist() if is_accepted else []
        if is_accepted > is_definite or is_accepted < (near < -1e-12) or not q and near < -2e-11:
            yield f"{k}, {near}: accepted {is_accepted}, definite {is_definite}, growths {q}"
        for i, v in enumerate(q):
            most = determinant(A) / determinant([exchanged(row, i) for row in exchanged(A, i)])
            if not 0 < v <= most or v < most * (1 - Fraction(1, 10 ** (8 if near < -1e-9 else 7))):
                yield f"{k}: growth is {v}, and could be {float(most)}"
        counts += is_accepted, not is_definite, len(q)
    if min(counts) < n // 5:
        yield f"{counts} shifts are accepted, indefinite and have growth: too few"


def alter(draw, part):
    """Something anywhere in a part of the files."""
    key = draw.choice(list(part) if type(part) is dict else range(len(part)))
    old, kind = part[key], draw.randrange(8)
    size = old if type(old) in (int, float) else 0.
    if type(old) is list and kind > 4 and old and all(type(v) is float for v in old):
        factor = draw.choice([0.5, 0.99, 1.1, 2., -1., 1. + 10. ** draw.uniform(-15., -3.)])
        part[key] = [v * factor if draw.random() < 0.7 else v for v in old]
    elif type(old) in (dict, list) and old and kind > 1:
        alter(draw, old)
    elif kind == 0:
        del part[key]
    elif kind <= 2 and type(part) is list:
        part.insert(draw.randrange(len(part)), copy.deepcopy(old))
    else:
        part[key] = draw.choice([
            *range(4), draw.gauss(0., 1.), -size, 2. * size, size * (1. + 1e-9), size + 1e-6,
            size + draw.gauss(0., 0.1), 1e3, 1e-320, 10 ** 400, math.nan, True, None, "1", [1], {}])


def read(path):
    """(S, problem, proof), without what write adds"""
    files = [json.loads((path / name).read_text()) for name in ("problem.json", "proof.json")]
    S = np.zeros([len(files[0]["g"])] * 2)
    S.T[np.triu_indices(len(S))] = [float(v) for v in (path / "S.mtx").read_text().split()[7:]]
    return S + np.tril(S, -1).T, *({key: value for key, value in data.items() if key not in (
        "format", "S", "problem")} for data in files)


def faults_of_altered(checker, n):
    """Altered files, of Debond too, are refused, or what they prove is true."""
    goods = [read(path.parent) for path in sorted(directory.glob("proof-?/proof.json"))]
    for seed in range(12):
        rng = np.random.default_rng([4, seed])
        model = Model(*random_problem(rng, 1 + seed % 4))
        goods.append((model.S, model.problem, random_proof(model, rng)[0]))
    n_proved = 0
    for k in range(n):
        draw = random.Random(k)
        S, *files = copy.deepcopy(draw.choice(goods))
        start, place = files[1]["state"], draw.random()
        name = draw.choice(["S.mtx", "problem.json", "proof.json"]) if k % 6 == 0 else None
        files[1]["interval"] = WIDE if draw.random() < 0.7 else files[1]["interval"]
        if not name:
            alter(draw, draw.choice([*files, files[1]["rounds"], *[files[1]["tree"]] * 2]))
        byte = draw.choice('0123456789-.eE,[]{}" \xff').encode()
        proofs.write(directory, S, *files, lambda file, content: content if file != name else
                     content.replace(content[int(place * len(content)):][:1], byte, 1))
        found, said = checker.run()
        if found:
            S, problem, proof = read(directory)
            model, n_proved = Model(S, problem), n_proved + 1
            least = model.least(np.random.default_rng(k), start=start)[0]
            state, (low, high) = model.exact_energy(proof["state"]), proof["interval"]
            if found[0] > min(state, least) or found[1] < state - Fraction(1, 2 ** 190) or not (
                    low <= found[0] <= found[1] <= high):
                yield f"{k}: {found} of {proof['interval']}, J has {float(least)}, {float(state)}"
    if not n // 10 < n_proved < 7 * n // 10:
        yield f"{n_proved} of {n} altered files prove something"


def faults_of_forged(checker, n):
    """Entries that leave something out, with rounds that are good for what is left."""
    for k in range(n):
        rng = np.random.default_rng([5, k])
        model = Model(*random_problem(rng, int(rng.integers(1, 4))))
        (J, s), none, leaf = model.least(rng), [None] * model.n, ["leaf", 0]
        entries, cut = [["split", 0, s[0] + 9.]], ["cut", 0, none, none, [], []]
        for i, side in [(i, side) for i in range(model.n) for side in (2, 3)]:
            place = s[i] + (5 - 2 * side) * float(rng.choice([0.05, 0.3, 1.]))
            entries += [exchanged(cut, side, exchanged(none, i, place)), ["split", i, place]]
        for t in [t for t, left in enumerate(model.root[1]) if left == 3]:
            entries += [["states", t], exchanged(cut, 4, [t]), exchanged(cut, 5, [t])]
        # Also S - D that is indefinite, another state being the least of the bound then.
        D = np.full(model.n, 0.9 * np.linalg.eigvalsh(model.S)[0])
        other = model.least(rng, n_steps=2)[1]
        tries = [([leaf], model.round(D, s, 1.2), s), ([leaf], model.round(1e3 + D, other), other)]
        tries += [([entry, leaf], model.round(D, model.least(rng, *child, n_steps=60)[1]), s)
                  for entry in entries for child in proofs.parts_of(model, *model.root, entry)[1]]
        for tree, a_round, state in tries:
            proofs.write(directory, model.S, model.problem, {
                "state": state.tolist(), "interval": WIDE, "tree": tree, "rounds": [a_round]})
            found, said = checker.run()
            if found and found[0] > J:
                yield f"{k}, {tree}: {said}, but J has {float(J)}"


def base():
    """A small problem with all that there is: two bonds, springs, a free unknown and friction."""
    laws = [[1., 0., -0.3], [0., 0., None]], [[2., 0., -0.2], [-0.5, -0.3, -0.4], [0., 0., None]]
    terms = [{"unknown": i, "pieces": list(law)} for i, law in enumerate(laws)]
    problem = {"g": [-1., -0.5, 0.3, 0.2, -0.1, 0.4], "upper": [0., -0.01, None, None, None, None],
               "terms": [*terms, {"unknowns": [2, 3], "stiffness": [1., 2.], "energy": 0.05}],
               "friction": [{"unknowns": [4], "weight": 0.1, "place": [0.01]},
                            {"unknowns": [4, 5], "weight": 0.2, "place": [0., 0.1]}], "c_0": 0.25}
    tree = [["cut", 0, [-9.] * 6, [None] * 6, [], []], ["states", 2], ["leaf", 0],
            ["split", 0, -0.3], ["leaf", 0], ["grow", 0, 1]]
    a_round = {"D": [0.5] * 6, "x": [-0.1] * 6, "forces": [[0., 0.]]}
    return 2. * np.eye(6) - 0.5 * np.eye(6, k=1) - 0.5 * np.eye(6, k=-1), problem, {
        "state": [-0.5] * 6, "interval": list(WIDE), "rounds": [a_round], "tree": tree}


# What is said if in places of the problem p or the proof q of base there are values, or NONE.
NONE, LEAF, OUTSIDE = object(), ("leaf", 0), ("split", 0, 9.)
FORMS = [
    ("number|OverflowError", [math.nan, -math.inf, 10 ** 400, True, "1", None],
     "p g 2, p c_0, p terms 0 pieces 0 0, p terms 2 stiffness 0, p friction 0 weight, q state 0, "
     "q interval 0, q rounds 0 D 0, q rounds 0 forces 0 0, q tree 3 2"),
    ("not one of", [-1, 6, True, 1., None],
     "p terms 0 unknown, p terms 2 unknowns 1, p friction 0 unknowns 0, q tree 0 1, q tree 2 1, "
     "q tree 1 1, q tree 3 1, q tree 5 2, q tree 0 4 0, q tree 0 5 0"),
    ("keys", [1], "p more, q more, q rounds 0 more, p terms 0 more, p terms 2 more, p terms 0"),
    ("keys", [NONE], "p friction, q interval, q rounds 0 forces, p terms 2 energy"),
    ("list", [NONE], "p g 5, q rounds 0 D 0, q tree 0 2 0, p terms 2 stiffness 0"),
    ("list", ["0"], "q tree, q rounds, p terms, q tree 2, p upper, q rounds 0 forces"),
    ("number", [math.inf], "p upper 2, q tree 0 2 2"), ("twice", [0, 2], "p terms 2 unknowns 1"),
    ("twice", [[2, 2]], "q tree 0 4"), ("twice", [4], "p friction 1 unknowns 1"),
    ("is of one", [{"unknowns": [0, 1, 2], "weight": 1., "place": [0.] * 3}], "p friction 0"),
    ("negative", [-0.1], "p friction 0 weight, p terms 2 energy, p terms 2 stiffness 1"),
    ("empty", [{"unknowns": [], "stiffness": [], "energy": 1.}], "p terms 3"),
    ("last piece", [[], [[1., 0., -1.]]], "p terms 0 pieces"), ("above 0", [1e-300], "p upper 0"),
    ("do not fall", [-0.2, 0., None], "p terms 1 pieces 1 2"), ("above its", [5e-324], "q state 0"),
    ("above its weight", [[0.2, 1e-9]], "q rounds 0 forces 0"), ("format", ["debond"], "q format"),
    ("decays", [0], "p terms 0 pieces 1 3"), ("no such entry", [[], ["leaf"]], "q tree 0"),
    ("state is not left", [["states", 2], ["states", 0]], "q tree 2"),
    ("ended before", [LEAF], "q tree 6"), ("not complete", [NONE], "q tree 5"),
    # Outside of the box one half is empty, and the other one still has to be proved.
    ("not complete", [[], [OUTSIDE, LEAF], [OUTSIDE, OUTSIDE, LEAF, LEAF]], "q tree"),
    ("^proved", [[OUTSIDE, LEAF, LEAF]], "q tree"), ("safely", [[1.5] * 6], "q rounds 0 D"),
    ("name", [{"file": name, "crc32": 0} for name in ("../a", "..", "/etc/passwd", "", 1)], "p S"),
    ("CRC", [{"file": "S.mtx", "crc32": value} for value in (1, None)], "p S"),
    ("no bound", [{"D": [0.5] * 5 + [0.], "x": [-0.1] * 5 + [x], "forces": [[0., 0.]]}
                  for x in (-0.1, 0.5)], "q rounds 0"),
    # Bytes of a file in place of others, with the right checksum.
    ("refused", [b"nan", b"1_0", b"1e999", b"", b"2.0\n2.0", b"\xff"], "S.mtx 2.0"),
    ("refused", [b"6 7", b"0 0"], "S.mtx 6 6"), ("refused", [b"general"], "S.mtx symmetric"),
    ("refused", [b"1e999", b'0.25, "c_0": 0.25'], "problem.json 0.25"),
    ("refused", [b"[" * 100000], "proof.json {"), ("refused", [b"1" * 5000], "proof.json -1e+300")]


def faults_of_forms(checker, _):
    """Files of a wrong form are refused for it."""
    for reason, place, value in [(reason, place, value) for reason, values, places in FORMS
                                 for place in places.split(", ") for value in values]:
        (S, *files), (name, _, old) = base(), place.partition(" ")
        if type(value) is not bytes:
            *keys, last = [int(word) if word.isdigit() else word for word in old.split()]
            inner = functools.reduce(operator.getitem, keys, files["pq".index(name)])
            if value is NONE:
                del inner[last]
            elif type(inner) is list:
                inner[last:last + 1] = [value]
            else:
                inner[last] = value
        proofs.write(directory, S, *files, lambda file, content: content if file != name else
              content.replace(old.encode(), value, 1))
        said = checker.run()[1]
        if not re.search(reason, said) or reason == "refused" and "CRC" in said:
            yield f"{place}, {value!r:.40}: {said} for {reason}"


# Mistakes that may be made in the checker: what is there, and what may be in its place.
MISTAKES = [
    ("need(self.matrix.has_eigenvalues_above(0.)", "need(True"),
    ("m + (n + 8) * EPSILON * np.trace(self.A)", "m"),
    ("need(not nodes and self.bounds", "need(self.bounds"),
    ("need(all(v <= u for v, u in zip(s, self.upper))", "need(True"),
    ("sum(f * f for f in force) <= weight * weight", "True", "max(map(abs, force)) <= weight"),
    ("(max(lower, place), upper), (lower, min(place, upper))",
     "(lower, min(place, upper)), (max(lower, place), upper)"),
    ("for half in halves]", "for half in halves if half[0] <= half[1]]"),
    ("or all(l <= u for l, u in box)", "or all(l < u for l, u in box)", "or True"),
    ("for state in (BROKEN, HOLDS)]", "for state in (HOLDS, BROKEN)]"),
    ("[(l, min(u, low))] * (low > l)", "[]", "[(l, min(u, low))] * (l < low < u)"),
    ("[(max(l, high), u)] * (high < u)", "[]"), ("return min(sums)", "return max(sums)"),
    ("states[t] & state and not is_free", "False", "states[t] & state and state == BROKEN"),
    ("if any(l > u for l, u in left)", "if any(l >= u for l, u in left)"),
    ('need(None not in parts, "a box has no bound")', "parts = [v or 0 for v in parts]"),
    ("math.isqrt(square - 1) + 1 if", "0 if"), ("if c > 0 and (low", "if c != 0 and (low"),
    ("(c < 0 or c == 0 < b)", "c < 0"), ("(c < 0 or c == 0 > b)", "c < 0"),
    ("value + q * x * x", "value + 2 * q * x * x"), ("slopes[i] - q * x", "slopes[i] + q * x"),
    ("(1. - 1e-9) / inverse", "(1. + 1e-6) / inverse"), ("(1e-8, 1e-10, 1e-12)", "(1e-8,)"),
    ("+ np.sum((np.abs(R) + error) ** 2, axis=0) / m)", ")"),
    ("low = np.array([math.fsum(v)", "low = np.array([0. * math.fsum(v)"),
    ("constant -= 2 * f * p", "constant += 2 * f * p"), ("y - d * v - g for", "y - g for"),
    ("c, b - w, k + 2 * w * p", "c, b - w, k - 2 * w * p"), ("begin > end", "begin >= end"),
    ("(result[-1][3] - b)) * begin", "(result[-1][3] + b)) * begin"),
    ("interval[0] <= a <= b <= interval[1]", "a <= b <= interval[1]", "interval[0] <= a <= b"),
    ("checksum == zlib.crc32(content)", "True"), ("<= value < n", "<= abs(value) < n"),
    ("and min(*stiffness, energy) >= 0", ""), ("used = indices([i for", "used = list([i for")]


def every_fault(checker, n):
    """All that is wrong; n is the number of altered files."""
    for faults, count in ((faults_of_forms, 0), (faults_of_shifts, n // 2), (faults_of_altered, n),
                          (faults_of_bounds, n // 2), (faults_of_forged, n // 8)):
        try:
            yield from (f"{faults.__name__[10:]}: {fault}" for fault in faults(checker, count))
        except Exception as error:
            yield f"{faults.__name__[10:]}: {type(error).__name__}: {error}"


def random_scene(k):
    """Entries of a bar with bonds of all kinds or friction, in 2D or 3D."""
    draw = random.Random(k)
    T, a, M = (10. ** draw.uniform(*v) for v in ((-2., 0.3), (0., 3.), (-3.6, -2.)))
    top = [f"{T * draw.uniform(-1., 1.)}", f"if(x < {draw.uniform(0.05, 0.35)}, {T}, "
           f"{T * draw.uniform(-1., 0.5)})", f"{T * draw.uniform(-0.5, 0.5)}"]
    bar = [f"Cells={draw.randint(4, 14)}, 2", "Traction top=" + "; ".join(top[:2]),
           f"Rotation={draw.choice([0., 0., draw.uniform(0., 90.)])}"]
    if draw.random() < 0.35:
        bar = ["Dimension=3", "Lengths=0.4, 0.04, 0.04", f"Cells={draw.randint(2, 4)}, 1, 2",
               "Traction top=" + "; ".join(top)]
    bonds = [f"Bond stiffness={a}", f"Bond threshold={M}"]
    free, bonded = (f"Tangential displacement={word}" for word in ("free", "bonded"))
    bound = [free, f"Contact law/Friction bound={T * draw.uniform(0.05, 1.)}"]
    shear = [*bonds, bonded, f"Bond shear stiffness={a * draw.uniform(0.1, 2.)}"]
    return [*bar, f"Poisson ratio={draw.choice([0., 0.3, 0.45])}", *[
        bonds, [*bonds, free, f"Initial gap={M * draw.uniform(0.1, 2.)} * x"],
        ["Law=bilinear", bonds[0], f"Bond strength={a * M}",
         f"Fracture energy={a * M * M * draw.uniform(0.6, 3.)}"],
        ["Law=none", *bound], [*bonds, *bound], shear, [*shear, "Bond failure=separate", (
            f"Shear fracture energy={a * M * M * draw.uniform(0.1, 1.5)}")]][k % 7]]


# Proofs of the first two take several nodes.
OWN = {"split": ["Cells=80, 8", "Bond stiffness=690"],
       "states": ["Cells=20, 4", "Bond stiffness=2000", "Tangential displacement=bonded",
                  "Bond shear stiffness=2000"],
       "rest": ["Traction top="]}


def check_scenes(base_scene, n):
    """Proofs of random scenes, of two that are divided and of a body at rest hold J."""
    entries = {**OWN, **{str(k): random_scene(k) for k in range(n)}}
    for name, own in entries.items():
        (directory / f"{name}.prm").write_text(scene_text(base_scene, [
            *NO_PICTURES, *own, "Method=automatic", "Prove=true", "Output/Proof=true",
            "Solver/Proof/Maximum time=20", f"Output/Directory=proof-{name}"]))
    result = scenes.run(*(f"{name}.prm" for name in entries))
    scenes.check("scenes run", result.returncode == 0, result.stderr)
    for kind in ("split", "states"):
        tree = json.loads((directory / f"proof-{kind}" / "proof.json").read_text())["tree"]
        scenes.check(f"the tree has {kind}", any(entry[0] == kind for entry in tree))
    proved = [path.parent for path in directory.glob("proof-*/proof.json")]
    for output in proved:
        found, said = Checker().run(output)
        J = json.loads((output / "summary.json").read_text())["functional"]
        scenes.check(output.name, found and max(found[0] - J, J - found[1]) <= 1e-9 * abs(J), said)
    scenes.check("most scenes are proved", len(proved) >= 0.8 * n + len(OWN), len(proved))
    scenes.check("no proof without Solver/Prove", "no effect of Output/Proof" in scenes.solve(
        "Output/Proof=true", scene=base_scene)["log"])


def main(_, parameters, n=320, n_scenes=0):
    base_scene = str(pathlib.Path(parameters).resolve() / "benchmark-40x4.prm")
    check_scenes(base_scene, int(n_scenes) or (100 if int(n) >= 1000 else 14))
    faults = list(every_fault(Checker(), int(n)))
    scenes.check("the checker is right", not faults, "\n".join(faults[:20]))
    proofs.write(directory, *base())
    for arguments, code in ((["--help"], 0), ([], 2), ([directory], 0), (["none"], 1)):
        result = subprocess.run([PROGRAM, *arguments], capture_output=True, check=False)
        scenes.check(f"exit code of {arguments}", result.returncode == code, result)
    mistakes = [(old, new) for old, *news in MISTAKES for new in news]
    for old, new in mistakes if int(n) >= 1000 else []:
        fault = next(every_fault(Checker(TEXT.replace(old, new, 1)), 320), None)
        scenes.check(f"the mistake is noticed: {old} -> {new}", old in TEXT and fault)
    scenes.end()


if __name__ == "__main__":
    main(*sys.argv[1:])
