#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_energetic.py DEBOND [COUNT [FIRST]]: energetic paths of bonds that do not heal. Random
scenes, loaded and unloaded, beside incremental global minimisation by trial of all states of all
bonds, from the matrices of the scene: J and what has been taken, step by step; the stability of
each state and the two-sided estimate of the energy. A column in closed form, where the energetic
path breaks before the followed one does; what is not proved."""
import collections
import itertools
import math
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from random_scenes import Draw
from run_scenes import NO_PICTURES, Scenes, sawteeth, scene_text

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
FOR_GOOD = ["Bonds heal=false", "Global branch=prove"]
MOST_STATES = 4096


def read_matrix(file):
    """Of symmetric ones the lower half is there."""
    head, *lines = [line for line in file.read_text().splitlines() if not line.startswith("% ")]
    rows, columns = map(int, lines[0].split())
    values, matrix = list(map(float, lines[1:])), np.zeros((rows, columns))
    if "symmetric" not in head:
        return np.array(values).reshape(columns, rows).T
    matrix.T[np.triu_indices(rows)] = values
    return matrix + np.tril(matrix, -1).T


# ------------------------------------------------------------------ the problem of the bonds


class Bond:
    """The unknowns s with squares that sum up to that of its opening, by the ratios of their
    stiffnesses, and the pieces of its law: (opening at the end, stiffness, slope, constant) of
    j = constant + slope p + stiffness p^2 / 2, p the opening, times the weight."""

    def __init__(self, weight, ratios, pieces):
        self.weight, self.ratios, self.pieces = weight, ratios, pieces

    def opening(self, s):
        return math.sqrt(sum(ratio * s[i]**2 for i, ratio in self.ratios.items()))

    def piece(self, opening):
        return next(k for k, (end, *_) in enumerate(self.pieces) if opening <= end)

    def after(self, reached):
        """The pieces of one that has been at an opening, with what it has taken in J."""
        end, k, slope, constant = self.pieces[self.piece(reached)]
        rest = self.pieces[self.piece(reached):]
        if slope == 0 or not reached:
            return rest
        force = slope + k * reached
        return [(reached, force / reached, 0., constant + slope * reached / 2), *rest]

    def energy(self, opening, reached):
        _, k, slope, constant = next(piece for piece in self.after(reached) if opening <= piece[0])
        return self.weight * (constant + slope * opening + k * opening**2 / 2)

    def taken(self, reached):
        return self.energy(0., reached)


def minimise_all(Q, g, n_bounded):
    """Least s of 1/2 s'Q s - g's, the first n of s <= 0, for all Q of an array."""
    rows, n = Q.shape[:2]
    held, noise = np.zeros((rows, n), bool), 1e-13 * np.abs(g).max()
    left, s = np.arange(rows), np.zeros((rows, n))
    for k in range(300):
        free = ~held[left]
        A = Q[left] * (free[:, :, None] & free[:, None, :]) + np.eye(n) * held[left][:, :, None]
        s[left] = x = np.linalg.solve(A, (g * free)[:, :, None])[:, :, 0]
        force = g - np.einsum("kij,kj->ki", Q[left], x)
        wrong = np.where(free, x > 1e-13 * np.abs(x).max(axis=1, initial=0.)[:, None], force < -noise)
        wrong[:, n_bounded:] = False
        if k > 20:  # the last one alone, which ends
            last = n - 1 - wrong[:, ::-1].argmax(axis=1)
            wrong &= np.arange(n) == last[:, None]
        going = wrong.any(axis=1)
        held[left[going]] ^= wrong[going]
        left = left[going]
        if not len(left):
            return s
    raise ArithmeticError("the active set method does not end")


def minimise_in_box(Q, g, low, high):
    """Least s of 1/2 s'Q s - g's in a box, Q definite."""
    at, noise = np.zeros(len(g), int), 1e-13 * np.abs(g).max()
    for k in range(500):
        free = at == 0
        s = np.where(at > 0, high, np.where(at < 0, low, 0.))
        s[free] = np.linalg.solve(Q[np.ix_(free, free)], (g - Q @ np.where(free, 0., s))[free])
        force = g - Q @ s
        rounding = 1e-13 * np.abs(s).max()
        new = np.where(free, np.where(s > high + rounding, 1, np.where(s < low - rounding, -1, 0)),
                       np.where(at * force < -noise, 0, at))
        wrong = np.flatnonzero(new != at)
        if not len(wrong):
            return np.clip(s, low, high)
        chosen = wrong if k < 20 else wrong[-1:]
        at[chosen] = new[chosen]
    raise ArithmeticError("the active set method does not end")


class Problem:
    """J of contact nodes at any factor, which loads and prescribed displacements have: S, g and
    c_0 as parabolas through those at the factors 1, 2 and 3. A bond of a vertex that is moved by
    so much for each unit of the factor is the last one in lists of what has been reached."""

    def __init__(self, matrices, bonds, held, moves):
        self.S, self.bonds, self.held, self.moves = matrices[0]["S"], bonds, held, moves
        inverse = np.linalg.inv(np.vander([1., 2., 3.], 3))
        self.g_of = inverse @ np.array([m["g"].ravel() for m in matrices])
        self.c_of = inverse @ np.array([m["c_0"].item() - held.energy(moves * f, 0.)
                                        for f, m in zip((1, 2, 3), matrices)])
        self.n_bounded = len(matrices[0]["weights"])
        check("J is quadratic in the factor, g linear",
              np.abs(self.g_of[0]).max() <= 1e-11 * np.abs(self.g_of).max())

    def load(self, factor):
        return np.array([factor**2, factor, 1.]) @ self.g_of

    def J(self, factor, s, reached):
        return np.array([factor**2, factor, 1.]) @ self.c_of + s @ (
            self.S @ s / 2 - self.load(factor)) + sum(
                bond.energy(bond.opening(s), at) for bond, at in zip(self.bonds, reached)
            ) + self.held.energy(self.moves * factor, reached[-1])

    def minima(self, factor, reached):
        """(J, s) of the least points of all choices of pieces, the least first."""
        lists = [bond.after(at) for bond, at in zip(self.bonds, reached)]
        g, found = self.load(factor), []
        if all(piece[2] == 0. for pieces in lists for piece in pieces):
            # Of springs the least piece is the one that holds, whatever the choice.
            choices = list(itertools.product(*lists))
            Q = np.repeat(self.S[None], len(choices), axis=0)
            for b, bond in enumerate(self.bonds):
                k = np.array([choice[b][1] for choice in choices])
                for i, ratio in bond.ratios.items():
                    Q[:, i, i] += bond.weight * ratio * k
            found = list(minimise_all(Q, g, self.n_bounded))
        else:
            # Along normals alone, each in the box of its piece.
            for choice in itertools.product(*map(range, map(len, lists))):
                chosen = [pieces[k] for pieces, k in zip(lists, choice)]
                low = np.array([-piece[0] for piece in chosen])
                high = np.array([0. if k == 0 else -pieces[k - 1][0]
                                 for pieces, k in zip(lists, choice)])
                weights = np.array([bond.weight for bond in self.bonds])
                Q = self.S + np.diag(weights * [piece[1] for piece in chosen])
                found.append(minimise_in_box(
                    Q, g + weights * [piece[2] for piece in chosen], low, high))
        return sorted(((self.J(factor, s, reached), s) for s in found), key=lambda pair: pair[0])

    def states(self, reached):
        return math.prod(len(bond.after(at)) for bond, at in zip(self.bonds, reached))


# ------------------------------------------------------------------ random scenes


def law_of(kind, draw, k, M):
    """Entries, and the pieces of a Bond."""
    if kind == "winkler":
        return [f"Bond stiffness={k!r}", f"Bond threshold={M!r}"], [
            (M, k, 0., 0.), (math.inf, 0., 0., k * M * M / 2)]
    if kind == "bilinear":
        energy = k * M * M * draw.uniform(1.5, 4.)
        end = 2 * energy / (k * M)
        slope = -k * M / (end - M)
        begin = k * M - slope * M
        return ["Law=bilinear", f"Bond stiffness={k!r}", f"Bond strength={k * M!r}",
                f"Fracture energy={energy!r}"], [
                    (M, k, 0., 0.), (end, slope, begin, k * M * M / 2 - begin * M - slope * M * M / 2),
                    (math.inf, 0., 0., energy)]
    stiffnesses, ends, pieces, constant = [k], [M], [], 0.
    for _ in range(draw.between(1, 2)):
        stiffnesses.append(stiffnesses[-1] * draw.uniform(.2, .7))
        ends.append(ends[-1] * draw.uniform(1.1, 2.))
    for stiffness, end, softer in zip(stiffnesses, ends, [*stiffnesses[1:], 0.]):
        pieces.append((end, stiffness, 0., constant))
        constant += (stiffness - softer) * end**2 / 2
    return ["Law=curve", "Curve=" + sawteeth(stiffnesses, ends)], [*pieces,
                                                                   (math.inf, 0., 0., constant)]


def draw_scene(draw):
    """Entries but for the law and the path, and what belongs to them."""
    kind = draw.choice(["winkler", "winkler", "curve", "bilinear", "common", "separate"])
    shears = kind in ("common", "separate")
    body = "pad" if shears else draw.choice(["pad", "strip", "bar", "moved"])
    n = {"winkler": 9, "curve": 5, "bilinear": 4, "common": 9, "separate": 5}[kind] - draw.below(3)
    length = draw.uniform(1., 3.)
    height = length * draw.magnitude(-1.3, -.4)
    scene = [f"Lengths={length!r}, {height!r}", f"Cells={n}, {draw.between(1, 2)}",
             f"Young modulus={draw.magnitude(0., 2.)!r}", f"Poisson ratio={draw.uniform(0., .4)!r}",
             "Contact boundary=bottom", "Clamped boundaries=" + {
                 "pad": "top", "strip": "left", "bar": "left, right", "moved": ""}[body],
             "Quadrature=nodal", "Tangential displacement=" + (
                 "bonded" if shears else draw.choice(["free", "fixed"])), "Constants/f=1"]
    wave = " + ".join(f"{draw.uniform(-1., 1.)!r}*sin({draw.uniform(0., 12.) / length!r}*x + "
                      f"{draw.uniform(0., 6.)!r})" for _ in range(2))
    if body == "moved":
        scene += ["Roller boundaries=left", draw.choice([
            "Displacement right=free; f",
            f"Displacement top=free; f*(1 + {draw.uniform(-.5, .5)!r}*x)"])]
    else:
        loaded = "bottom" if body == "pad" else "top"
        along = f"f*({draw.uniform(-1., 1.)!r}*sin(5*x))" if shears else "0"
        scene.append(f"Traction {loaded}={along}; f*({wave} + {draw.uniform(0., .6)!r})")
    if body in ("pad", "bar") and not shears and draw.chance(.3):
        scene.append(f"Initial gap=GAP*(1 - cos({2 * math.pi / length!r}*x))")
    return scene, kind, length


def run_for_matrices(settings):
    """At three multiples of what is applied."""
    names = [f"matrices-{f}.prm" for f in (1, 2, 3)]
    for f, name in zip((1, 2, 3), names):
        (scenes.directory / name).write_text(scene_text("scene.prm", [
            *NO_PICTURES, *settings, f"Constants/f={f}", "Output/Matrices=true", "Search=none",
            "Output/Directory=out-" + name]))
    log = scenes.run(*names)
    found = []
    for name in names:
        output = scenes.directory / ("out-" + name)
        matrices = {key: read_matrix(output / f"{key}.mtx")
                    for key in ("S", "g", "c_0", "weights", "bounds") if (output / "S.mtx").exists()}
        found.append({**scenes.summary(output.name), **matrices, "errors": log.stderr})
    return found


def scaled(pieces, by):
    return [(end, by * k, by * slope, by * constant) for end, k, slope, constant in pieces]


def bonds_of(matrices, kind, of_shear, pieces, stiffness):
    """All bonds of nodes; `stiffness` is the factor of pieces at a place."""
    rows = [row for row in matrices["profile"] if row["state"] != "held"]
    weights, n = matrices["weights"].ravel(), len(rows)
    bonds, apart = [], []
    for i, (row, weight) in enumerate(zip(rows, weights)):
        by = stiffness(row["x"])
        own = scaled(pieces, by)
        ratios = {i: 1.}
        if kind == "common":
            ratios[n + i] = of_shear[0] / by
        bonds.append(Bond(weight, ratios, own))
        if kind == "separate":
            k, energy = pieces[0][1] * of_shear[0], of_shear[1]
            apart.append(Bond(weight, {n + i: 1.}, [(math.sqrt(2 * energy / k), k, 0., 0.),
                                                    (math.inf, 0., 0., energy)]))
    return bonds + apart


def history(draw, factor):
    """Cycles that grow, with what is between."""
    turns = sorted(draw.uniform(.3, 1.8) for _ in range(draw.between(2, 4)))
    if draw.chance(.3):
        turns = draw.shuffled(turns)
    factors = []
    for turn in turns:
        factors += [factor * turn * part for part in (.6, 1.)]
        factors.append(factor * draw.choice([0., draw.uniform(-.6, .5)]))
    return [*factors, factor * draw.uniform(.5, 2.)]


def check_steps(kind, problem, factors, path, reached, is_moved):
    """Step by step the same state; ends where two states are as good."""
    broken = n_steps = 0
    last = None
    largest = sum(bond.energy(1e100, 0.) for bond in (*problem.bonds, problem.held))
    for factor, row in zip(factors, path):
        if problem.states(reached) > MOST_STATES:
            break
        minima = problem.minima(factor, reached)
        J, s = minima[0]
        size = abs(J) + largest
        close(kind + ", J", row["global_J"], J, 1e-9, size)
        opening = [bond.opening(s) for bond in problem.bonds]
        new = [max(pair) for pair in zip([*opening, problem.moves * factor], reached)]
        # Another state that is as good, but for its bonds.
        others = [[max(bond.opening(t), at) for bond, at in zip(problem.bonds, reached)]
                  for value, t in minima if value < J + 1e-7 * size]
        if any(abs(a - b) > 1e-5 * max(new) for other in others for a, b in zip(new, other)):
            break
        taken = sum(bond.taken(at) for bond, at in zip((*problem.bonds, problem.held), new))
        close("taken", row["global_dissipated_energy"], taken, 1e-9 if all(
            piece[2] == 0. for bond in problem.bonds for piece in bond.pieces) else 1e-7, largest)
        check("word", row["global_minimum"] == "global", row["global_minimum"])
        check("what is taken does not fall", taken >= broken - 1e-12 * largest)
        broken, reached = max(taken, broken), new
        # Estimates from both sides: by what loads do with either state fixed.
        if last is not None and not is_moved:
            step, grown = factor - last[0], row["global_J"] - last[1]["global_J"]
            low, high = sorted(-step * by["global_unit_load_work"] for by in (row, last[1]))
            check("estimates of the energy", low - 1e-9 * size <= grown <= high + 1e-9 * size and
                  grown <= -step * last[1]["global_unit_load_work"] + 1e-9 * size, (grown, low, high))
        last = factor, row
        n_steps += 1
    return n_steps, broken > 0


def check_random(number):
    """Returns the kind, how many steps were compared and whether bonds broke."""
    draw = Draw(number)
    scenes.section(f"scene {number}")
    scene, kind, length = draw_scene(draw)
    # Without bonds and gap first, for their sizes.
    plain = scenes.solve(*[entry for entry in scene if "gap" not in entry and "bonded" not in entry],
                         "Law=none")
    opening = plain.get("largest_opening") or 0.
    if not opening > 0.:
        return kind, 0, False
    M = opening * draw.magnitude(-1.3, -.3)
    pull = max((abs(row["normal_force_density"]) for row in plain["profile"]), default=0.)
    modulus = float(next(e for e in scene if "Young" in e).split("=")[1])
    k = modulus / length * draw.magnitude(-.5, 1.)
    law = "winkler" if kind in ("common", "separate") else kind
    entries, pieces = law_of(law, draw, k, M)
    ratios = draw.uniform(.3, 1.5), k * M * M * draw.uniform(.2, 1.)
    slope = draw.uniform(-.6, .6) / length
    field = f"(1 + ({slope!r})*x)"
    if kind == "separate":
        entries += ["Bond failure=separate", f"Shear fracture energy={ratios[1]!r}"]
    if kind in ("common", "separate"):
        entries.append(f"Bond shear stiffness={k * ratios[0]!r}")
    # Bonds that differ, so that what they take says which have broken.
    varying = [f"Traction factor={field}"] if law == "curve" else [
        e + f"*{field}" for e in entries if e.startswith(("Bond stiffness", "Bond strength",
                                                           "Fracture energy"))]
    gap = repr(M * draw.uniform(.1, .8))
    settings = [entry.replace("GAP", gap) for entry in [*scene, *entries, *varying]]
    matrices = run_for_matrices(settings)
    if not all("S" in m for m in matrices):
        check("matrices", False, [m["errors"] for m in matrices])
        return kind, 0, False
    # A corner that is moved has half a cell.
    moves = float("Displacement right=free; f" in settings)
    problem = Problem(
        matrices, bonds_of(matrices[0], kind, ratios, pieces, lambda x: 1 + slope * x),
        Bond(moves * matrices[0]["weights"].min(), {}, scaled(pieces, 1 + slope * length)), moves)
    if law == "bilinear" and np.linalg.eigvalsh(problem.S + np.diag([
            bond.weight * bond.pieces[1][1] for bond in problem.bonds]))[0] <= 0.:
        return kind, 0, False  # pieces are not convex
    intact = problem.S + np.zeros_like(problem.S)
    for bond in problem.bonds:
        for i, ratio in bond.ratios.items():
            intact[i, i] += bond.weight * ratio * bond.pieces[0][1]
    s = minimise_all(intact[None], problem.load(1.) - problem.g_of[2], problem.n_bounded)[0]
    stretch = max(bond.opening(s) / bond.pieces[0][0] for bond in problem.bonds)
    if stretch < 1e-6:
        return kind, 0, False
    factors = history(draw, 1. / stretch)
    if problem.moves:
        factors = [abs(factor) for factor in factors]  # not into the foundation
    rest = [max(0., float(x)) for x in matrices[0]["bounds"].ravel()]
    reached = [*rest, *[0.] * (len(problem.bonds) - len(rest)), 0.]
    result = scenes.solve(*settings, *FOR_GOOD, "Factors=" + ", ".join(map(repr, factors)))
    path = result["path"]
    check("arrives", result["exit_code"] == 0 and len(path) == len(factors),
          (result["status"], result["errors"], settings, factors))
    if number % 4 == 0:
        # What a search finds of so few bonds is no less, whatever it claims.
        searched = scenes.solve(*settings, *FOR_GOOD, "Global branch=search",
                                "Factors=" + ", ".join(map(repr, factors)))["path"]
        for row, other in zip(path, searched):
            close("J of the search", other["global_J"], row["global_J"], 1e-8)
            check("words of the search", other["global_minimum"] in ("best known", "global"))
    return kind, *check_steps(kind, problem, factors, path, reached,
                              "Clamped boundaries=" in settings)


# ------------------------------------------------------------------ closed forms


# A column of height H, nu = 0, on bonds that break all at once; by area.
E, H, a, M, WIDTH = 10., .2, 150., .01, .3
k = E / H
COLUMN = ["Lengths=0.3, 0.2", "Cells=3, 2", f"Young modulus={E}", "Poisson ratio=0",
          "Contact boundary=bottom", "Tangential displacement=free", f"Bond stiffness={a}",
          f"Bond threshold={M}"]


def check_columns():
    """Moved by d, bonds are springs in series with the body, and let go on the energetic path when
    what both have stored is what they take, d = M sqrt(1 + a/k); on the followed one when the
    opening is M, d = M (1 + a/k). Pulled by t likewise at M sqrt(k (k + a)) and M (k + a)."""
    taken = a * M * M / 2
    for name, early, late, held, off, entries in (
            ("moved", M * math.sqrt(1 + a / k), M * (1 + a / k), k * a / (k + a) / 2, 0., [
                "Displacement top=0; 1", "Clamped boundaries="]),
            ("pulled", M * math.sqrt(k * (k + a)), M * (k + a), -.5 / (k + a), -.5 / k, [
                "Traction bottom=0; 1", "Clamped boundaries=top"])):
        scenes.section("a column that is " + name)
        factors = [0., early / 2, early * (1 - 1e-6), early * (1 + 1e-6), early / 3, 0., early,
                   late * (1 - 1e-6), 0., late * (1 + 1e-6), early / 2]
        path = scenes.solve(*COLUMN, *entries, *FOR_GOOD, "Factors=" + ", ".join(
            map(repr, factors)))["path"]
        check("all steps", len(path) == len(factors))
        are_off = {"": False, "global_": False}
        for row, factor in zip(path, factors):
            for prefix, limit in (("", late), ("global_", early)):
                are_off[prefix] |= factor > limit
                J = taken + off * factor**2 if are_off[prefix] else held * factor**2
                close(f"{prefix}J at {factor}", row[prefix + "J"], WIDTH * J, 1e-9, WIDTH * taken)
                close(f"{prefix}taken at {factor}", row[prefix + "dissipated_energy"],
                      WIDTH * taken * are_off[prefix], 1e-12, WIDTH * taken)
            check(f"words at {factor}", row["global_minimum"] == "global" and
                  row["minimum"] == "local minimum", (row["minimum"], row["global_minimum"]))


def check_what_is_not_proved():
    """With a limit of nodes a step has its gap, and what comes later is not called global."""
    result = scenes.solve(
        "Lengths=1.7, 0.11", "Cells=124, 1", "Young modulus=1", "Poisson ratio=0.1",
        "Clamped boundaries=top", "Traction bottom=0; 0.95*sin(16.8*x + 5.65) + 0.35",
        "Bond stiffness=1400", "Bond threshold=0.007", "Solver/Proof/Maximum nodes=1", *FOR_GOOD,
        "Factors=0, 0.3, 0.9, 0.5, 0")
    scenes.section("what is not proved")
    path = result["path"]
    words = [row["global_minimum"] for row in path]
    check("nothing is called global behind a gap", words == ["global"] * 2 + ["best known"] * 3,
          words)
    check("gaps", path[1]["global_relative_gap"] < 1e-8 < 1e-3 < path[2]["global_relative_gap"])
    check("a note names the step", any("step 3," in note and "not proved" in note
                                       for note in result["notes"]), result["notes"])
    # Unloaded there is nothing left but what was taken.
    close("what is left", path[-1]["global_J"], path[-1]["global_dissipated_energy"], 1e-12)
    check("which is something", path[-1]["global_J"] > 0. == path[-1]["J"])


def main(count=8, first=0):
    steps, broken, number, kinds = 0, 0, 0, collections.Counter()
    while sum(kinds.values()) < count:
        kind, n, breaks = check_random(first + number)
        number += 1
        kinds[kind] += n > 0
        steps, broken = steps + n, broken + breaks
    print(f"scenes up to {first + number}: {dict(kinds)}, {steps} steps, bonds break in {broken}")
    check("steps that were compared", steps >= 3 * count and 2 * broken >= count, (steps, broken))


check_columns()
check_what_is_not_proved()
main(*map(int, sys.argv[2:]))
scenes.end()
