# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random small problems of the format of doc/reference/proofs.md, and a plain branch and bound
in floating point that writes proofs of their minima, with all kinds of entries. It has
nothing of Debond and nothing of scripts/check_proof."""
import json
import math
import zlib
from fractions import Fraction

import numpy as np

INFINITY = math.inf
HOLDS, BROKEN = 1, 2


# Problems.

def random_law(rng):
    """Pieces of any curvature; the last one does not fall to minus infinity."""
    kind, threshold = rng.integers(5), float(10. ** rng.uniform(-1., 0.5))
    stiffness = float(10. ** rng.uniform(-1.5, 1.))
    if kind == 0:  # a bond that breaks
        return [[stiffness, 0., -threshold], [0., 0., None]]
    if kind == 1:  # of sawteeth
        return [[stiffness, 0., -threshold], [stiffness / 3., 0., -2. * threshold], [0., 0., None]]
    if kind == 2:  # softening, which is concave
        return [[stiffness, 0., -threshold], [-stiffness, -2. * stiffness * threshold, -2. * threshold],
                [0., 0., None]]
    if kind == 3:  # a force that does not change, and ends
        return [[0., -stiffness * threshold, -threshold], [0., 0., None]]
    ends = sorted(-rng.uniform(0.05, 3., rng.integers(0, 4)))[::-1]
    return [[float(rng.normal()), float(rng.normal()), float(end)] for end in ends] + [
        [float(rng.choice([0., abs(rng.normal())])), float(rng.normal()), None]]


def random_problem(rng, n):
    """(S, the other entries)"""
    G = rng.normal(size=(n, n)) * 10. ** rng.uniform(-1., 0.5, n)
    S = G @ G.T + float(10. ** rng.uniform(-4., 0.)) * np.eye(n)
    S = (S + S.T) / 2.
    upper = [float(v) if rng.random() < 0.3 else None for v in rng.normal(size=n)]
    terms, friction, left = [], [], [int(i) for i in rng.permutation(n)]
    while left:
        kind, i = rng.integers(4), left.pop()
        if kind <= 1:
            upper[i] = 0. if rng.random() < 0.8 else -float(rng.uniform(0., 0.5))
            terms.append({"unknown": i, "pieces": random_law(rng)})
        if kind == 2:
            unknowns = [i] + [left.pop() for _ in range(min(len(left), rng.integers(3)))]
            terms.append({"unknowns": unknowns, "energy": float(10. ** rng.uniform(-2., 0.5)),
                          "stiffness": [float(10. ** rng.uniform(-1., 1.)) for _ in unknowns]})
            if rng.random() < 0.1:
                terms[-1]["energy"] = None
    if rng.random() < 0.4:
        friction.append({"unknowns": [int(rng.integers(n))], "weight": float(rng.uniform(0., 1.)),
                         "place": [float(rng.normal())]})
    if n > 1 and rng.random() < 0.4:
        friction.append({"unknowns": [int(i) for i in rng.permutation(n)[:2]],
                         "weight": float(rng.uniform(0., 1.)), "place": rng.normal(size=2).tolist()})
    return S, {"g": (rng.normal(size=n) * 2.).tolist(), "c_0": float(rng.normal()), "upper": upper,
               "terms": terms, "friction": friction}


def write(directory, S, problem, proof):
    """With the checksums of what is written."""
    n = len(S)
    lines = ["%%MatrixMarket matrix array real symmetric", f"{n} {n}"]
    lines += [repr(float(S[i][j])) for j in range(n) for i in range(j, n)]
    content = ("\n".join(lines) + "\n").encode()
    (directory / "S.mtx").write_bytes(content)
    problem = {"format": "debond problem 1", "S": {"file": "S.mtx", "crc32": zlib.crc32(content)},
               **problem}
    content = json.dumps(problem).encode()
    (directory / "problem.json").write_bytes(content)
    proof = {"format": "debond proof 1",
             "problem": {"file": "problem.json", "crc32": zlib.crc32(content)}, **proof}
    (directory / "proof.json").write_text(json.dumps(proof))


# Exactly, in fractions.

def exact(number):
    """Numbers of files are doubles, those without a point too."""
    return number if type(number) is Fraction else Fraction(float(number))


def exact_law(pieces, s):
    """Integrated from 0."""
    value, begin = Fraction(0), Fraction(0)
    for curvature, slope, end in pieces:
        end = s if end is None else max(s, exact(end))
        value += exact(curvature) * (end ** 2 - begin ** 2) / 2 + exact(slope) * (end - begin)
        begin = end
    return value


def exact_energy(S, problem, s, states=None):
    """J(s), at most 2^-200 too large; of some terms the state can be given."""
    s, upper = [exact(v) for v in s], problem["upper"]
    assert all(u is None or v <= exact(u) for v, u in zip(s, upper))
    value = exact(problem["c_0"])
    for i, row in enumerate(S):
        value += s[i] * (sum(exact(a) * v for a, v in zip(row, s)) / 2
                         - exact(problem["g"][i]))
    for t, term in enumerate(problem["terms"]):
        if "unknown" in term:
            value += exact_law(term["pieces"], s[term["unknown"]])
        else:
            springs = sum(exact(k) * s[i] ** 2 / 2
                          for i, k in zip(term["unknowns"], term["stiffness"]))
            left = (states or {}).get(t, HOLDS | (BROKEN if term["energy"] is not None else 0))
            value += min([springs] * (left & HOLDS > 0) + (
                [exact(term["energy"])] if left & BROKEN else []))
    for entry in problem["friction"]:
        square = exact(entry["weight"]) ** 2 * sum(
            (s[i] - exact(p)) ** 2 for i, p in zip(entry["unknowns"], entry["place"]))
        value += Fraction(math.isqrt(math.ceil(square * 4 ** 210)) + 1, 2 ** 210)
    return value


def is_positive_definite(A):
    """Of a matrix of fractions, by all its pivots."""
    A = [list(row) for row in A]
    for k, row in enumerate(A):
        if row[k] <= 0:
            return False
        for other in A[k + 1:]:
            factor = other[k] / row[k]
            for j in range(k, len(A)):
                other[j] -= factor * row[j]
    return True


def exact_difference(S, D):
    return [[Fraction(float(v)) - (Fraction(D[i]) if i == j else 0) for j, v in enumerate(row)]
            for i, row in enumerate(S)]


# In floating point.

def pieces_of(problem, i):
    """(upper end, lower end, curvature, slope, constant) of what there is of an unknown alone."""
    pieces = [(INFINITY, -INFINITY, 0., 0., 0.)]
    for term in problem["terms"]:
        if term.get("unknown") == i:
            pieces, begin = [], INFINITY
            for c, b, end in term["pieces"]:
                k = 0.
                if pieces:
                    k = pieces[-1][4] + (pieces[-1][2] - c) * begin ** 2 / 2. + (pieces[-1][3] - b) * begin
                pieces.append((begin, -INFINITY if end is None else end, c, b, k))
                begin = end
    for entry in problem["friction"]:
        if entry["unknowns"] == [i]:
            w, p = entry["weight"], entry["place"][0]
            pieces = [(min(u, e), max(l, f), c, b + sign * w, k - sign * w * p)
                      for u, l, c, b, k in pieces
                      for e, f, sign in ((INFINITY, p, 1.), (p, -INFINITY, -1.))
                      if min(u, e) > max(l, f)]
    return pieces


def least_of(pieces, curvature, slope, lower, upper):
    """(least, where)"""
    best = INFINITY, None
    for u, l, c, b, k in pieces:
        u, l, c, b = min(u, upper), max(l, lower), c + curvature, b + slope
        if u < l:
            continue
        places = [v for v in (l, u) if math.isfinite(v)]
        if c > 0.:
            places.append(min(max(-b / c, l), u))
        elif l == -INFINITY and (c < 0. or b > 0.) or u == INFINITY and (c < 0. or b < 0.):
            return -INFINITY, 0.
        for s in places or [0.]:
            best = min(best, ((c * s / 2. + b) * s + k, s))
    return best


class Model:
    """A problem for floating point."""

    def __init__(self, S, problem):
        self.S, self.n, self.g = np.array(S), len(S), np.array(problem["g"])
        self.c_0, self.problem = problem["c_0"], problem
        self.upper = [INFINITY if u is None else u for u in problem["upper"]]
        self.pieces = [pieces_of(problem, i) for i in range(self.n)]
        self.springs = {t: (v["unknowns"], v["stiffness"],
                            INFINITY if v["energy"] is None else v["energy"])
                        for t, v in enumerate(problem["terms"]) if "unknowns" in v}
        self.term_of = {i: t for t, v in self.springs.items() for i in v[0]}
        self.pairs = [v for v in problem["friction"] if len(v["unknowns"]) == 2]
        self.root = [(-INFINITY, u) for u in self.upper], {
            t: HOLDS | BROKEN if v[2] < INFINITY else HOLDS for t, v in self.springs.items()}

    def energy(self, s):
        value = self.c_0 + s @ (self.S @ s / 2. - self.g)
        value += sum(least_of(self.pieces[i], 0., 0., v, v)[0] for i, v in enumerate(s))
        for unknowns, stiffness, energy in self.springs.values():
            value += min(sum(k * s[i] ** 2 / 2. for i, k in zip(unknowns, stiffness)), energy)
        for pair in self.pairs:
            (i, j), (p, q) = pair["unknowns"], pair["place"]
            value += pair["weight"] * math.hypot(s[i] - p, s[j] - q)
        return value

    def descend(self, s, box, n_sweeps=60, states=None):
        """Coordinate by coordinate, in a box; of some terms the state can be given."""
        s = np.array([min(max(v, l), u) for v, (l, u) in zip(s, box)])
        for _ in range(n_sweeps):
            before = s.copy()
            for i in range(self.n):
                c, b = self.S[i, i], self.S[i] @ s - self.S[i, i] * s[i] - self.g[i]
                for pair in self.pairs:
                    if i in pair["unknowns"]:
                        v = [s[k] - p for k, p in zip(pair["unknowns"], pair["place"])]
                        w = pair["weight"] / max(math.hypot(*v), 1e-9)
                        c, b = c + w, b - w * pair["place"][pair["unknowns"].index(i)]
                values = [least_of(self.pieces[i], c, b, *box[i])]
                if i in self.term_of:
                    unknowns, stiffness, energy = self.springs[self.term_of[i]]
                    others = sum(k * s[j] ** 2 / 2. for j, k in zip(unknowns, stiffness) if j != i)
                    k = stiffness[unknowns.index(i)]
                    value, place = least_of(self.pieces[i], c + k, b, *box[i])
                    left = (states or {}).get(self.term_of[i], HOLDS | BROKEN)
                    values = [(value + others, place)] * (left & HOLDS > 0) + [
                        (values[0][0] + energy, values[0][1])] * (left & BROKEN > 0)
                s[i] = min(values)[1]
            if np.max(np.abs(s - before)) < 1e-14:
                break
        return s

    def minimise(self, rng, n_starts=8):
        """The best of some descents."""
        box = self.root[0]
        starts = [np.zeros(self.n)] + [rng.normal(size=self.n) * 3. for _ in range(n_starts)]
        return min((self.descend(start, box, 300) for start in starts), key=self.energy)

    def forces(self, x):
        result = []
        for pair in self.pairs:
            v = np.array([x[i] - p for i, p in zip(pair["unknowns"], pair["place"])])
            if np.hypot(*v) < 1e-6:
                v = (self.g - self.S @ x)[pair["unknowns"]]
                v = v / max(np.hypot(*v), pair["weight"], 1e-300)
            else:
                v = v / np.hypot(*v)
            result.append((v * pair["weight"] * (1. - 1e-12)).tolist())
        return result


class Round:
    """Its bounds, in floating point."""

    def __init__(self, model, D, x, forces):
        self.model, self.D, self.x, self.forces = model, D, x, forces
        self.A = model.S - np.diag(D)
        self.r = self.A @ x - model.g
        self.constant = model.c_0 - x @ self.A @ x / 2.
        for pair, force in zip(model.pairs, forces):
            self.r[pair["unknowns"]] += force
            self.constant -= np.dot(force, pair["place"])
        self.q = 1. / np.diag(np.linalg.inv(self.A)) * (1. - 1e-6)

    def data(self):
        data = {"D": self.D.tolist(), "x": self.x.tolist()}
        return {**data, "forces": self.forces} if self.model.pairs else data

    def of_unknown(self, i, interval, stiffness=0., grown=None):
        q, x = (self.q[i], self.x[i]) if i == grown else (0., 0.)
        value, place = least_of(self.model.pieces[i], self.D[i] + stiffness + q,
                                self.r[i] - q * x, *interval)
        return value + q * x * x / 2., place

    def of_term(self, t, box, states, grown=None):
        unknowns, stiffness, energy = self.model.springs[t]
        values = []
        for state, factor, extra in ((HOLDS, 1., 0.), (BROKEN, 0., energy)):
            if states & state:
                parts = [self.of_unknown(i, box[i], k * factor, grown)
                         for i, k in zip(unknowns, stiffness)]
                values.append((sum(v for v, _ in parts) + extra, [s for _, s in parts]))
        return min(values)

    def bound(self, box, states, grown=None):
        """(bound, where each function is least)"""
        place, total = np.zeros(self.model.n), self.constant
        for t, left in states.items():
            value, places = self.of_term(t, box, left, grown)
            place[self.model.springs[t][0]] = places
            total += value
        for i in range(self.model.n):
            if i not in self.model.term_of:
                value, place[i] = self.of_unknown(i, box[i], 0., grown)
                total += value
        return total, place


class Prover:
    """Writes the tree as it goes."""

    def __init__(self, S, problem, rng, tolerance=1e-6, n_nodes=200):
        self.model, self.rng, self.n_nodes = Model(S, problem), rng, n_nodes
        self.state = self.model.minimise(rng)
        self.energy = self.model.energy(self.state)
        self.target = self.energy - tolerance * max(1., abs(self.energy))
        self.rounds, self.places, self.tree, self.least = [], {}, [], INFINITY

    def shift(self, box, states):
        """As much as S has to give, and the curvature of what is decided or not needed."""
        model = self.model
        D = np.zeros(model.n)
        for i, (l, u) in enumerate(box):
            c = min(c for e, f, c, _, _ in model.pieces[i] if min(e, u) >= max(f, l))
            if i in model.term_of and states[model.term_of[i]] == HOLDS:
                unknowns, stiffness, _ = model.springs[model.term_of[i]]
                c += stiffness[unknowns.index(i)]
            if self.rng.random() < 0.5:
                D[i] = -c * (1. - 1e-9) if c > 0. else 0.
        smallest = np.linalg.eigvalsh(model.S - np.diag(D))[0]
        while smallest < 1e-6:
            D -= 1e-6 + abs(smallest)
            smallest = np.linalg.eigvalsh(model.S - np.diag(D))[0]
        return D + self.rng.choice([0.5, 0.9, 0.99]) * smallest

    def best_round(self, box, states):
        """Frank and Wolfe's method for the envelope, from a point where J is least."""
        best, x = None, self.model.descend(self.state, box, 30)
        D = self.shift(box, states)
        for step in range(25):
            a_round = Round(self.model, D, x, self.model.forces(x))
            value, place = a_round.bound(box, states)
            if best is None or value > best[0]:
                best = value, a_round
            if value >= self.target or not math.isfinite(value):
                break
            x = x + 2. / (step + 3.) * (place - x)
        return best

    def number(self, a_round):
        if a_round not in self.places:
            self.places[a_round] = len(self.rounds)
            self.rounds.append(a_round.data())
        return self.places[a_round]

    def slab(self, a_round, box, states, i, interval):
        """Its bound, with growth."""
        return a_round.bound(box[:i] + [interval] + box[i + 1:], states, i)[0]

    def closed(self, box, states, a_round):
        """Up to where growth closes what is below of each unknown, and what is above."""
        lower, upper = [None] * self.model.n, [None] * self.model.n
        for i, (l, u) in enumerate(box):
            size = 1e-3 * (1. + abs(a_round.x[i]))
            places = [a_round.x[i] + sign * size * 2. ** k for sign in (-1, 1) for k in range(16)]
            places += [end for piece in self.model.pieces[i] for end in piece[:2]]
            places = [float(v) for v in places if l < v < u]
            lower[i] = max((v for v in places if self.slab(a_round, box, states, i, (l, v))
                            >= self.target), default=None)
            upper[i] = min((v for v in places if self.slab(a_round, box, states, i, (v, u))
                            >= self.target), default=None)
        return lower, upper

    def chain(self, box, states, a_round, lower, upper):
        """One slab closes as a child of a split."""
        i = int(self.rng.choice([i for i in range(len(box)) if (lower[i], upper[i]) != (None, None)]))
        (l, u), place = box[i], upper[i] if lower[i] is None else lower[i]
        self.tree.append(["split", i, place])
        for half, is_closed in (((place, u), lower[i] is None), ((l, place), lower[i] is not None)):
            child = box[:i] + [half] + box[i + 1:]
            if is_closed:
                self.close(["grow", self.number(a_round), i], a_round.bound(child, states, i)[0])
            else:
                self.node(child, states)

    def cut(self, box, states, a_round, lower, upper):
        """The entry and what is left, or None."""
        model, found = self.model, []
        for i, (l, u) in enumerate(box):
            found += [] if lower[i] is None else [self.slab(a_round, box, states, i, (l, lower[i]))]
            found += [] if upper[i] is None else [self.slab(a_round, box, states, i, (upper[i], u))]
        left = [(max(l, -INFINITY if v is None else v), min(u, INFINITY if w is None else w))
                for (l, u), v, w in zip(box, lower, upper)]
        remaining, lists = dict(states), ([], [])
        if all(l <= u for l, u in left):
            for t, both in states.items():
                for lost, names in ((BROKEN, lists[0]), (HOLDS, lists[1])):
                    value = a_round.bound(left, {**states, t: lost})[0] if both & lost else INFINITY
                    unknowns, stiffness, energy = model.springs[t]
                    nearest = [max(left[i][0], min(left[i][1], 0.)) for i in unknowns]
                    least = sum(k * v * v / 2. for k, v in zip(stiffness, nearest))
                    is_free = lost == HOLDS and least > energy * (1. + 1e-9)
                    if both == HOLDS | BROKEN and (value >= self.target or is_free):
                        names.append(t)
                        remaining[t] &= ~lost
                        found += [] if is_free else [value]
        if not found and not any(lists):
            return None
        self.least = min(self.least, *found, INFINITY)
        self.tree.append(["cut", self.number(a_round), lower, upper, *lists])
        is_over = any(l > u for l, u in left) or not all(remaining.values())
        return None if is_over else left, remaining

    def close(self, entry, value):
        self.tree.append(entry)
        self.least = min(self.least, value)

    def node(self, box, states, n_cuts=0):
        self.n_nodes -= 1
        value, a_round = self.best_round(box, states)
        if value >= self.target or self.n_nodes < 0:
            self.close(["leaf", self.number(a_round)], value)
            return
        grown = [(a_round.bound(box, states, i)[0], i) for i in range(self.model.n)]
        if max(grown)[0] >= self.target:
            self.close(["grow", self.number(a_round), max(grown)[1]], max(grown)[0])
            return
        cut = None
        if n_cuts < 3 and self.rng.random() < 0.8:
            lower, upper = self.closed(box, states, a_round)
            if self.rng.random() < 0.3 and any(v is not None for v in lower + upper):
                self.chain(box, states, a_round, lower, upper)
                return
            cut = self.cut(box, states, a_round, lower, upper)
        if cut:
            if cut[0]:
                self.node(*cut, n_cuts + 1)
            return
        self.branch(box, states, a_round)

    def branch(self, box, states, a_round):
        """Where the bound is furthest below the functions in x."""
        gaps, x = [], a_round.x
        for t, left in states.items():
            if left == HOLDS | BROKEN:
                gaps.append((a_round.of_term(t, [(v, v) for v in x], left)[0]
                             - a_round.of_term(t, box, left)[0], "states", t))
        for i, (l, u) in enumerate(box):
            v = min(max(x[i], l), u)
            gaps.append((a_round.of_unknown(i, (v, v))[0] - a_round.of_unknown(i, box[i])[0],
                         "split", i))
        both = [gap for gap in gaps if gap[1] == "states"]
        gaps = both if both and self.rng.random() < 0.4 else [
            gap for gap in gaps if gap[0] >= 0.5 * max(gaps)[0]]
        _, kind, k = gaps[self.rng.integers(len(gaps))]
        self.tree.append([kind, k])
        if kind == "states":
            children = [(box, {**states, k: state}) for state in (BROKEN, HOLDS)]
        else:
            (l, u), other = box[k], a_round.of_unknown(k, box[k])[1]
            places = [end for piece in self.model.pieces[k] for end in piece[:2] if l < end < u]
            middle = (max(l, min(u, x[k])) + other) / 2.
            place = min(places, key=lambda v: abs(v - middle)) if places else middle
            self.tree[-1].append(float(place))
            children = [(box[:k] + [half] + box[k + 1:], states) for half in ((place, u), (l, place))]
        for child in children:
            self.node(*child)

    def proof(self):
        self.node(*self.model.root)
        margin = 1e-9 * max(1., abs(self.energy), abs(self.least))
        return {"state": self.state.tolist(), "interval": [float(self.least - margin),
                                                          float(self.energy + margin)],
                "rounds": self.rounds, "tree": self.tree}
