# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random small problems of the format of doc/reference/proofs.md, their J, also in fractions, and
random trees with the regions that they need bounds of. It has nothing of scripts/check_proof."""
import json
import math
import zlib
from fractions import Fraction

import numpy as np

INFINITY, HOLDS, BROKEN = math.inf, 1, 2
# Of fractions, at most 2^-209 too large, and not too small.
ROOT = np.vectorize(lambda v: Fraction(math.isqrt(math.ceil(v * 4 ** 210)) + 1, 2 ** 210), [object])
WIDE = (-1e300, 1e300)  # an interval to claim


def exact(number):
    """Numbers of files are doubles, those without a point too."""
    return Fraction(float(number))


def exchanged(values, k, *others):
    return [*values[:k], *others, *values[k + 1:]]


def random_law(rng):
    """Bonds that break at once or soften, a force that ends, and any pieces."""
    M, k, zero = -10. ** rng.uniform(-1., 0.5), 10. ** rng.uniform(-1.5, 1.), [0., 0., None]
    ends = [*np.cumsum(-rng.random(rng.integers(4))).tolist(), None]
    pieces = [[rng.normal() if v else abs(rng.normal()), rng.normal(), v] for v in ends]
    return [[[k, 0., M], zero], [[k, 0., M], [-k, 2. * k * M, 2. * M], zero],
            [[0., k * M, M], zero], pieces][rng.integers(4)]


def random_problem(rng, n):
    """(S, the other entries)"""
    G = rng.normal(size=(n, n)) * 10. ** rng.uniform(-1., 0.5, n)
    S = G @ G.T + 10. ** rng.uniform(-4., 0.) * np.eye(n)
    upper = [v if rng.random() < 0.3 else None for v in rng.normal(size=n).tolist()]
    terms, left = [], rng.permutation(n).tolist()
    while left:
        kind, unknowns = rng.integers(4), [left.pop()]
        if kind <= 1:
            upper[unknowns[0]] = min(0., rng.uniform(-0.5, 2.))
            terms.append({"unknown": unknowns[0], "pieces": random_law(rng)})
        elif kind == 2:
            unknowns += [left.pop() for _ in range(min(len(left), rng.integers(3)))]
            stiffness, *energy = (10. ** rng.uniform(-1., 1., (2, len(unknowns)))).tolist()
            terms.append({"unknowns": unknowns, "stiffness": stiffness,
                          "energy": energy[0][0] / 3. if rng.random() < 0.9 else None})
    friction = [{"unknowns": rng.permutation(n)[:m].tolist(), "weight": rng.random(),
                 "place": rng.normal(size=m).tolist()} for m in (1, 2)[:n] if rng.random() < 0.4]
    return (S + S.T) / 2., {"g": (rng.normal(size=n) * 2.).tolist(), "c_0": rng.normal(),
                            "upper": upper, "terms": terms, "friction": friction}


def write(directory, S, problem, proof, change=lambda name, content: content):
    """With the checksums of what is written, which can be changed before."""
    def put(name, content):
        content = change(name, content.encode())
        (directory / name).write_bytes(content)
        return {"file": name, "crc32": zlib.crc32(content)}

    lines = ["%%MatrixMarket matrix array real symmetric", f"{len(S)} {len(S)}"]
    lines += [repr(float(v)) for j in range(len(S)) for v in S[j:, j]]
    S = put("S.mtx", "\n".join(lines) + "\n")
    problem = put("problem.json", json.dumps({"format": "debond problem 1", "S": S, **problem}))
    put("proof.json", json.dumps({"format": "debond proof 1", "problem": problem, **proof}))


def determinant(A):
    """In fractions, of at most a few rows."""
    return sum((-1) ** j * v * determinant([row[:j] + row[j + 1:] for row in A[1:]])
               for j, v in enumerate(A[0])) if A else 1


class Model:
    """A problem; nodes are boxes with the states that are left of each term."""

    def __init__(self, S, problem):
        self.S, self.n, self.problem = np.array(S, float), len(S), problem
        self.root = ([(-INFINITY, INFINITY if u is None else u) for u in problem["upper"]],
                     [HOLDS | BROKEN * (v.get("energy") is not None) for v in problem["terms"]])

    def energy(self, s, states=None):
        """J of the rows of s, exactly if they are fractions; states of terms can be given."""
        number, root = (exact, ROOT) if s.dtype == object else (float, np.sqrt)
        numbers = np.vectorize(number, otypes=[s.dtype])
        value = number(self.problem["c_0"]) - s @ numbers(self.problem["g"])
        value += ((s @ numbers(self.S)) * s).sum(1) / 2
        for term, left in zip(self.problem["terms"], states or self.root[1]):
            if "unknown" in term:
                v, begin = s[:, term["unknown"]], number(0.)
                for c, b, end in term["pieces"]:
                    end = v if end is None else np.maximum(v, number(end))
                    value += number(c) * (end ** 2 - begin ** 2) / 2 + number(b) * (end - begin)
                    begin = end
            else:
                springs = s[:, term["unknowns"]] ** 2 @ numbers(term["stiffness"]) / 2
                broken = 0 * springs + number(term["energy"]) if left & BROKEN else springs
                value += np.minimum(springs, broken) if left & HOLDS else broken
        for v in self.problem["friction"]:
            way = s[:, v["unknowns"]] - numbers(v["place"])
            value += number(v["weight"]) * root((way ** 2).sum(1))
        return value

    def exact_energy(self, s, states=None):
        assert all(v <= u for v, (_, u) in zip(s, self.root[0]))
        return self.energy(np.array([[exact(v) for v in s]]), states)[0]

    def least(self, rng, box=None, states=None, start=0., n_steps=120):
        """(J exactly, where) of the best point of a box that differential evolution finds."""
        low, high = np.transpose(box or self.root[0])
        s = np.vstack([np.full(self.n, start), rng.standard_cauchy((39, self.n))]).clip(low, high)
        values = self.energy(s, states)
        for _ in range(n_steps):
            a, b, c = (s[rng.permutation(40)] for _ in range(3))
            trial = np.where(rng.random(s.shape) < 0.9, a + 0.6 * (b - c), s).clip(low, high)
            values_of_trial = self.energy(trial, states)
            better = values_of_trial < values
            s[better], values[better] = trial[better], values_of_trial[better]
        best = s[np.argmin(values)]
        return self.exact_energy(best, states), best

    def round(self, D, x, growth=1.):
        """Its forces are those in x, perhaps grown."""
        pairs = [v for v in self.problem["friction"] if len(v["unknowns"]) == 2]
        ways = [(v["weight"] * growth, x[v["unknowns"]] - v["place"]) for v in pairs]
        forces = [(w * (1. - 1e-12) / max(np.hypot(*v), 1e-99) * v).tolist() for w, v in ways]
        return {"D": D.tolist(), "x": x.tolist(), **({"forces": forces} if forces else {})}


def parts_of(model, box, states, entry):
    """The regions (box, states) that an entry needs bounds of, and the children of the node."""
    kind, *rest = entry
    regions, left, remaining = [], [], list(states)
    if kind == "split":
        i, (l, u), place = rest[0], box[rest[0]], rest[1]
        halves = (max(l, place), u), (l, min(u, place))
        return [], [(exchanged(box, i, half), states) for half in halves]
    if kind == "states":
        return [], [(box, exchanged(states, rest[0], state)) for state in (BROKEN, HOLDS)]
    if kind != "cut" or any(l > u for l, u in box):
        return [(box, states)] * all(l <= u for l, u in box), []
    for i, ((l, u), low, high) in enumerate(zip(box, *rest[1:3])):
        low, high = -INFINITY if low is None else low, INFINITY if high is None else high
        slabs = [(l, min(u, low))] * (low > l) + [(max(l, high), u)] * (high < u)
        regions += [(exchanged(box, i, slab), states) for slab in slabs]
        left.append((max(l, low), min(u, high)))
    if any(l > u for l, u in left):
        return regions, []
    for state, t in [(BROKEN, t) for t in rest[3]] + [(HOLDS, t) for t in rest[4]]:
        term = model.problem["terms"][t]
        nearest = [exact(max(left[i][0], min(left[i][1], 0.))) for i in term["unknowns"]]
        springs = sum(exact(k) * s ** 2 / 2 for k, s in zip(term["stiffness"], nearest))
        if states[t] & state and not (state == HOLDS and springs >= term["energy"]):
            regions.append((left, exchanged(states, t, state)))
        remaining[t] &= ~state
    return regions, [(left, remaining)] if all(remaining) else []


def random_proof(model, rng):
    """(a tree of whatever entries with its rounds, the regions that it needs bounds of)"""
    rounds, tree, regions, nodes, n = [], [], [], [model.root], model.n
    state, least = model.least(rng)[1], np.linalg.eigvalsh(model.S)[0]
    while nodes:
        (box, states), r = nodes.pop(), len(tree)
        x = model.least(rng, box, states, n_steps=60)[1]
        x += rng.normal(size=n) * rng.choice([0., 0., 0.1, 1.])
        D = rng.choice([0.5, 0.99]) * least - (rng.random(n) < 0.3) * rng.choice([0., 1.])
        both = [t for t, left in enumerate(states) if left == HOLDS | BROKEN]
        limits = [[float(v + way * rng.choice([-0.1, 0., 0.1, 1.])) if rng.random() < 0.5 else None
                   for v in x] for way in (-1., 1.)]
        cut = ["cut", r, *limits, *([t for t in both if rng.random() < 0.3] for _ in range(2))]
        i, kind = int(rng.integers(n)), rng.integers(7) if r < 5 else 0
        place = float(rng.choice([rng.normal(), x[i], *(v for v in box[i] if abs(v) < INFINITY)]))
        tree.append([["leaf", r], ["grow", r, i], ["split", i, place],
                     ["states", int(rng.choice(both))] if both else cut, cut, cut, cut][kind])
        rounds.append(model.round(D, x))
        more, children = parts_of(model, box, states, tree[-1])
        regions, nodes = regions + more, nodes + children[::-1]
    return {"state": state.tolist(), "interval": WIDE, "rounds": rounds, "tree": tree}, regions
