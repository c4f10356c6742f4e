#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_friction.py DEBOND: friction. A bar on a rough table, pulled and let go, in closed form;
blocks beside finite elements and a coordinate descent of its own, with bonds that break and with
several steps; turned, mirrored and in other units; what falls, and what is proved; triangles of
which Coulomb's friction has one state or three."""
import math
import os
import pathlib
import sys
from random import Random

# Threads take longer than products of such a size.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from run_scenes import NO_PICTURES, Scenes, full_entry

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
BLOCK = ["Law=none", "Clamped boundaries=", "Contact boundary=bottom"]
PATH = ["Global branch=none", "Bonds heal=false"]


# ------------------------------------------------------------------ closed forms


def bar(force, cells=20):
    """A bar of unit length, height and modulus that cannot shear or bend, on a table with the
    bound 1, pulled at its right end by these forces, one after the other, in the ends of its
    sliding part: (displacement of the end, energy lost) of each. In between its elements the
    tension falls by the bound of a node."""
    h = 1. / cells
    bound = np.full(cells + 1, h)
    bound[0] = bound[-1] = 0.5 * h
    u, lost, rows = np.zeros(cells + 1), 0., []
    for F in force:
        # Coordinate descent on 1/2 sum (u_i+1 - u_i)^2 / h - F u_n + sum bound |u_i - before_i|.
        before = u.copy()
        while True:
            old = u.copy()
            for i in [*range(cells, -1, -1), *range(cells + 1)]:
                k, pull = 0., F if i == cells else 0.
                for j in (i - 1, i + 1):
                    if 0 <= j <= cells:
                        k, pull = k + 1. / h, pull + u[j] / h
                free = (pull - k * before[i])
                u[i] = before[i] + math.copysign(max(abs(free) - bound[i], 0.), free) / k
            if abs(u - old).max() <= 1e-15 * abs(u).max():
                break
        lost += bound @ abs(u - before)
        rows.append((u[-1], lost))
    return rows


def check_bar():
    """Pulled by F < 1 it slides on the length F, and its end by F^2/2; turned to -F, the same
    part slides back on the length of half the change: Cattaneo's and Mindlin's load cycle."""
    forces = (0.3, 0.8, 0.2, -0.8, 0.8)
    scene = [*BLOCK, "Material/Young moduli=1, 1e7, 1e7", "Shear moduli=1e7, 1e7, 1e7",
             "Poisson ratio=0", "Lengths=1, 1", "Cells=20, 1", "Roller boundaries=top",
             "Traction right=1; 0", "Contact law/Friction bound=1",
             "Factors=" + ", ".join(map(str, forces)), *PATH]
    scenes.section("A bar that is pulled and pushed, quadratic displacements")
    quadratic = solve(*scene, "Mesh/Degree=2", "Contact law/Quadrature=gauss 3")["path"]
    close("F^2/2", quadratic[1]["mean_right_x"], 0.32, 1e-3)
    close("back", quadratic[3]["mean_right_x"], -0.32, 1e-3)
    close("F^3/6", quadratic[1]["dissipated_energy"], 0.8**3 / 6., 1e-3)
    scenes.section("A bar that is pulled and pushed")
    result = solve(*scene)
    for row, (end, lost) in zip(result["path"], bar(forces)):
        close("displacement", row["mean_right_x"], end, 1e-5)
        close("energy lost", row["dissipated_energy"], lost, 1e-4)
    # Of the continuous bar, to the order h^2.
    close("F^2/2", result["path"][1]["mean_right_x"], 0.32, 0.01)
    close("back", result["path"][3]["mean_right_x"], -0.32, 0.01)
    close("parts", result["path"][1]["stick_part"], 0.2, 0.15)


def check_bar_with_bonds():
    """The same bar on bonds that break in shear, and rub from the next step on: pulled by its
    end, and pushed back, beside nodes and springs."""
    n, k, M, bound = 20, 25., 0.02, 0.4
    h = 1. / n
    w = np.full(n + 1, h)
    w[[0, -1]] /= 2.
    K = np.zeros((n + 1, n + 1))
    for i in range(n):
        K[i:i + 2, i:i + 2] += np.array([[1., -1.], [-1., 1.]]) / h
    steps = [0.01 * j for j in range(1, 16)] + [0.1, 0.05, 0., -0.05]
    for acts in ("everywhere", "where bonds are damaged"):
        scenes.section("A bar with bonds, friction " + acts)
        result = solve("Lengths=1, 1", "Cells=20, 1", "Material/Young moduli=1, 1e7, 1e7",
                       "Shear moduli=1e7, 1e7, 1e7", "Poisson ratio=0", "Roller boundaries=top",
                       "Clamped boundaries=", "Contact boundary=bottom",
                       "Tangential displacement=bonded", f"Bond stiffness={k}",
                       f"Bond threshold={M}", f"Contact law/Friction bound={bound}",
                       "Contact law/Friction acts=" + acts, "Displacement right=1; free", *PATH,
                       "Load path/Resolve=0", "Displacement factors=" + ", ".join(map(str, steps)))
        u, holds, lost = np.zeros(n + 1), np.ones(n + 1, bool), 0.
        for d, row in zip(steps, result["path"], strict=True):
            before = u.copy()
            phi = w * bound * (1. if acts == "everywhere" else ~holds)
            bonds = holds.copy()
            while True:
                u[n] = d
                for _ in range(20000):
                    old = u.copy()
                    for i in (*range(n), *reversed(range(n))):
                        size = K[i, i] + w[i] * k * bonds[i]
                        free = u[i] - (K[i] @ u + w[i] * k * bonds[i] * u[i]) / size - before[i]
                        u[i] = before[i] + math.copysign(max(abs(free) - phi[i] / size, 0.), free)
                    if abs(u - old).max() <= 1e-14 * abs(u).max():
                        break
                still = bonds & (abs(u) <= M)
                if (still == bonds).all():
                    break
                bonds = still
            lost += phi[:n] @ abs(u - before)[:n] + (w * k)[holds & ~bonds].sum() * M**2 / 2.
            holds = bonds
            close("force", row["reaction_right_x"], K[n] @ u + w[n] * k * holds[n] * d, 1e-4, 0.1)
            close("lost", row["dissipated_energy"], lost, 1e-3)
        check("broke", 0 < holds.sum() < n, holds)


# ------------------------------------------------------------------ own finite elements


class Block:
    """Crossed triangles on a box, the bottom in contact, degrees of freedom x and y of each."""

    def __init__(self, lengths, cells, E, nu):
        (L, H), (n, m) = lengths, cells
        grid = [(L * i / n, H * j / m) for j in range(m + 1) for i in range(n + 1)]
        middle = [(L * (i + 0.5) / n, H * (j + 0.5) / m) for j in range(m) for i in range(n)]
        self.points = np.array(grid + middle)
        self.K = np.zeros((2 * len(self.points),) * 2)
        C = E / (1 - nu**2) * np.array([[1, nu, 0], [nu, 1, 0], [0, 0, (1 - nu) / 2]])
        for j in range(m):
            for i in range(n):
                corners = [j * (n + 1) + i, j * (n + 1) + i + 1,
                           (j + 1) * (n + 1) + i + 1, (j + 1) * (n + 1) + i]
                for k in range(4):
                    nodes = [corners[k], corners[(k + 1) % 4], len(grid) + j * n + i]
                    (x0, y0), (x1, y1), (x2, y2) = self.points[nodes]
                    twice = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
                    B = np.zeros((3, 6))
                    for v, (b, c) in enumerate(((y1 - y2, x2 - x1), (y2 - y0, x0 - x2),
                                                (y0 - y1, x1 - x0))):
                        B[:, 2 * v:2 * v + 2] = np.array([[b, 0], [0, c], [c, b]]) / twice
                    dofs = [2 * v + d for v in nodes for d in (0, 1)]
                    self.K[np.ix_(dofs, dofs)] += B.T @ C @ B * twice / 2
        self.bottom = list(range(n + 1))
        self.top = list(range(m * (n + 1), (m + 1) * (n + 1)))
        self.weights = np.full(n + 1, L / n)
        self.weights[[0, -1]] /= 2

    def condensed(self):
        """(S, R): on normals (downwards) and tangents of the bottom, for u = given at the top."""
        normals = [2 * v + 1 for v in self.bottom]
        tangents = [2 * v for v in self.bottom]
        kept = normals + tangents
        top = [2 * v + d for v in self.top for d in (0, 1)]
        rest = [i for i in range(len(self.K)) if i not in kept and i not in top]
        sign = np.array([-1.] * len(normals) + [1.] * len(tangents))
        inner = np.linalg.solve(self.K[np.ix_(rest, rest)], self.K[np.ix_(rest, kept + top)])
        all_ = self.K[np.ix_(kept + top, kept + top)] - self.K[np.ix_(kept + top, rest)] @ inner
        n = len(kept)
        S = sign[:, None] * all_[:n, :n] * sign
        return S, sign[:, None] * all_[:n, n:], all_[n:, n:]


def descend(S, g, phi, place, stiffness, x):
    """Coordinate descent on 1/2 x'S x - g'x + 1/2 sum stiffness x_n^2 + sum phi |x_t - place|
    for x_n <= 0; the first half of x are normals."""
    n = len(g) // 2
    diagonal = np.diag(S).copy()
    diagonal[:n] += stiffness
    pull = g - S @ x
    pull[:n] -= stiffness * x[:n]
    for _ in range(100000):
        largest = 0.
        for i in range(2 * n):
            free = x[i] + pull[i] / diagonal[i]
            if i < n:
                new = min(free, 0.)
            else:
                way = free - place[i - n]
                new = place[i - n] + math.copysign(max(abs(way) - phi[i - n] / diagonal[i], 0.),
                                                   way)
            if new != x[i]:
                change = new - x[i]
                pull -= S[:, i] * change
                if i < n:
                    pull[i] -= stiffness[i] * change
                largest = max(largest, abs(change))
                x[i] = new
        if largest <= 1e-14 * abs(x).max():
            return x
    raise ArithmeticError("coordinate descent does not end")


def own_path(block, moved, factors, phi, k, M, coefficient=0.):
    """Of bonds that do not heal: J, energy lost, the force on the top and x at each factor. With
    a coefficient friction has the bound phi + coefficient times the pressure, by iteration."""
    S, R, T = block.condensed()
    n, w = len(block.weights), block.weights
    place, x, lost = np.zeros(n), np.zeros(2 * n), 0.
    holds, bound = np.ones(n, bool), w * phi
    rows = []
    for factor in factors:
        d = factor * moved
        g = -R @ d
        for _ in range(1000):
            # Majorants from the state before: bonds that are within M hold.
            while True:
                x = descend(S, g, bound, place, w * k * holds, x)
                still = holds & (x[:n] >= -M)
                if (still == holds).all():
                    break
                holds = still
            new = w * phi + coefficient * np.maximum((g - S @ x)[:n] * (x[:n] == 0.), 0.)
            if abs(new - bound).max() <= 1e-13 * max(abs(new).max(), 1e-300):
                break
            bound = new
        else:
            raise ArithmeticError("friction does not settle")
        lost += bound @ abs(x[n:] - place)
        place = x[n:].copy()
        broken = (w * k)[~holds].sum() * M**2 / 2
        elastic = x @ S @ x / 2 + d @ R.T @ x + d @ T @ d / 2
        force = R.T @ x + T @ d
        rows.append((elastic + (w * k * holds) @ x[:n]**2 / 2 + broken + lost, lost + broken,
                     (force[0::2].sum(), force[1::2].sum()), x.copy()))
    return rows


def scene_of(random, bonded, coefficient=None):
    """Entries, and what own_path() takes. With a coefficient friction is Coulomb's."""
    lengths = (random.uniform(1, 4), random.uniform(0.5, 2))
    cells = (random.randint(2, 7), random.randint(1, 3))
    E, nu = 10**random.uniform(-1, 4), random.uniform(0, 0.45)
    size = 10**random.uniform(-5, -2)
    tilt, shift, press = random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0.3)
    phi, slope = E * size * 10**random.uniform(-2, 0.5), random.uniform(-0.9, 0.9)
    k = E * 10**random.uniform(-1, 1.5) if bonded else 0.
    M = size * 10**random.uniform(-1.5, 0.5)
    block = Block(lengths, cells, E, nu)
    moved = np.array([c for v in block.top for c in (
        size * shift, size * (press + tilt * block.points[v][0] / lengths[0]))])
    x = block.points[block.bottom][:, 0] / lengths[0]
    entries = [f"Lengths={lengths[0]!r}, {lengths[1]!r}", f"Cells={cells[0]}, {cells[1]}",
               f"Young modulus={E!r}", f"Poisson ratio={nu!r}", "Clamped boundaries=",
               "Contact boundary=bottom", f"Contact law/Friction bound={phi!r} * (1 + {slope!r} * "
               f"x / {lengths[0]!r})",
               f"Displacement top={size * shift!r}; {size!r} * ({press!r} + {tilt!r} * x / "
               f"{lengths[0]!r})"]
    if coefficient is not None:
        entries[6:7] = [f"Contact law/Friction coefficient={coefficient!r}"]
        phi = 0.
    entries += ([f"Bond stiffness={k!r}", f"Bond threshold={M!r}"] if bonded else ["Law=none"])
    return entries, (block, moved), (phi * (1 + slope * x), k, M), (E, size)


def check_blocks():
    """From rest in one step: J and the displacements of all nodes."""
    random = Random(1)
    for case in range(24):
        entries, body, law, (E, size) = scene_of(random, case % 2)
        scenes.section(f"block {case}")
        result = solve(*entries, "Search=none")
        J, _, _, x = own_path(*body, [1.], *law)[0]
        close("J", result["functional"], J, 1e-9, max(abs(J), 1e-5 * E * size**2))
        n, scale = len(x) // 2, abs(x).max()
        for i, row in enumerate(result["profile"]):
            close("u_nu", row["u_nu"], x[i], 1e-7, scale)
            close("slip", row["slip_x"], x[n + i], 1e-7, scale)
            check("slides", row["slides"] == (abs(x[n + i]) > 1e-9 * scale), row)
        check("word", result["minimum"]["state"] in ("global", "local minimum", "best known"))


def check_block_paths():
    """Pulled, let go and pushed, with what friction and bonds have taken; with a bound and with
    a coefficient."""
    random = Random(2)
    factors = (0.4, 1., 0.7, 0., -0.6, 0.3)
    for case in range(32):
        coefficient = random.uniform(0.02, 0.4) if case >= 16 else None
        entries, body, law, (E, size) = scene_of(random, case % 2, coefficient)
        scenes.section(f"path {case}")
        result = solve(*entries, *PATH, "Displacement factors=" + ", ".join(map(str, factors)))
        check("exit code", result["exit_code"] == 0, result["errors"])
        if coefficient:
            law += (coefficient,)
            check("word", {row["minimum"] for row in result["path"]} == {"stationary"})
        for row, (J, lost, force, _) in zip(result["path"],
                                            own_path(*body, factors, *law)):
            energy = max(abs(J), 1e-5 * E * size**2)
            close("J", row["J"], J, 1e-8, energy)
            close("lost", row["dissipated_energy"], lost, 1e-7, energy)
            for axis, component in zip("xy", force):
                close("force " + axis, row["reaction_top_" + axis], component, 1e-7,
                      max(*map(abs, force), 1e-5 * E * size))


def least(block, moved, phi, k, M):
    """J over all choices of which bonds hold, each as if its branch went on for ever."""
    S, R, T = block.condensed()
    n, w, g, values = len(block.weights), block.weights, -R @ moved, []
    for choice in range(2**n):
        holds = np.array([choice >> i & 1 for i in range(n)], bool)
        x = descend(S, g, w * phi, np.zeros(n), w * k * holds, np.zeros(2 * n))
        values.append(x @ S @ x / 2 - g @ x + (w * k * holds) @ x[:n]**2 / 2
                      + (w * k)[~holds].sum() * M**2 / 2 + w * phi @ abs(x[n:]))
    return min(values) + moved @ T @ moved / 2


def check_proofs():
    """The least J of blocks with few bonds, by search and by proof."""
    random, n_global = Random(3), 0
    for case in range(24):
        entries, body, law, (E, size) = scene_of(random, True)
        if int(entries[1].split("=")[1].split(",")[0]) > 4:
            continue
        scenes.section(f"proof {case}")
        J = least(*body, *law)
        for more in ([], ["Prove=true"]):
            result = solve(*entries, *more)
            close("J", result["functional"], J, 1e-9, max(abs(J), 1e-5 * E * size**2))
            word = result["minimum"]["state"]
            check("word", word == "global" or not more and word == "best known", word)
            n_global += word == "global"
            if word == "global":
                check("bound", result["proof"]["lower_bound"] <= J + 1e-9 * E * size**2,
                      result["minimum"])
    check("proofs", n_global > 10, n_global)


def check_held_by_bonds_and_friction():
    """A seat that bonds and friction hold together, by 0.5 and 0.8 of what presses: whether the
    load comes at once or not, no bond breaks."""
    scene = ["Lengths=2, 0.5", "Cells=8, 2", "Parts/arm=x < 1", "Parts/seat=bottom: x > 1",
             "Parts/lid=top: x > 1", "Young modulus=1000", "Material/Young modulus arm=0.1",
             "Poisson ratio=0", "Clamped boundaries=left", "Contact boundary=seat",
             "Loads/Traction lid=1; -1", "Bond stiffness=100", "Bond threshold=0.005",
             "Tangential displacement=bonded", "Contact law/Friction coefficient=0.8"]
    for factors in ("1", "0.1, 1", "0.5, 1", "0.25:0.25:1"):
        scenes.section("bonds and friction, factors " + factors)
        result = solve(*scene, *PATH, "Factors=" + factors)
        close("broken", result["path"][-1]["broken_part"], 0., 1e-12, 1.)
        # No more than springs of 100 on half of the load would let it move.
        check("moved", 0. < result["path"][-1]["mean_lid_x"] < 0.01, result["path"][-1])


def check_fall():
    """Blocks on friction alone that slide, or do not."""
    scene = ["Lengths=1.68, 0.76", "Young modulus=57", "Poisson ratio=0.4", "Law=none",
             "Clamped boundaries=", "Contact boundary=top", "Traction left=1.1; 0.7",
             "Traction right=-0.9; 1.7", "Traction bottom=-0.65; -1.65"]
    for cells in ("8, 2", "12, 3"):
        for bound in (0.1, 1., 1.2, 1.4, 1.7, 5.):
            scenes.section(f"falls with {bound}")
            result = solve(*scene, f"Cells={cells}", f"Contact law/Friction bound={bound}")
            check("status", result["status"] == "comes off", result["status"])
    for load, status in ((0.0599, "success"), (0.0601, "comes off")):
        scenes.section(f"pushed by {load}")
        result = solve("Lengths=2, 0.5", "Cells=8, 2", *BLOCK, "Traction top=0; -0.1",
                       f"Traction bottom={load / 2!r}; 0", "Contact law/Friction coefficient=0.3",
                       "Factors=0.5, 1", *PATH)
        check("status", result["status"] == status, result["status"])


def check_invariances():
    """A block that is pressed and pushed there and back, with bonds: turned, mirrored, and in
    other units of length and stress."""
    def path(friction, L=1., E=1., degrees=0., side=1.):
        u, v = side * 0.01 * L, -0.004 * L
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        rows = solve(f"Lengths={2 * L!r}, {L!r}", "Cells=8, 4", f"Young modulus={100 * E!r}",
                     "Poisson ratio=0.3", "Clamped boundaries=", "Contact boundary=bottom",
                     f"Bond stiffness={20 * E / L!r}", f"Bond threshold={0.001 * L!r}",
                     f"Mesh/Rotation={degrees!r}", f"Displacement top={c * u - s * v!r}; "
                     f"{s * u + c * v!r}", f"Contact law/Friction {friction}", *PATH,
                     "Displacement factors=0.3, 1, 0.4, -0.5")["path"]
        return [(row["J"] / (E * L**2), row["dissipated_energy"] / (E * L**2), row["stick_part"],
                 row["broken_part"]) for row in rows]
    for name in ("bound=", "coefficient="):
        scenes.section("invariance, " + name)
        wanted = path(name + "0.3")
        check("it slides", len(wanted) == 4 and 0. < wanted[1][1] < wanted[3][1], wanted)
        for changes in ({"degrees": 33.}, {"degrees": -90.}, {"side": -1.},
                        {"L": 1e-3, "E": 1e6}, {"L": 1e4, "E": 1e-3}):
            rows = path(name + repr(0.3 * (changes.get("E", 1.) if name == "bound=" else 1.)),
                        **changes)
            for row, other in zip(rows, wanted, strict=True):
                for value, expected in zip(row, other):
                    close(f"{changes}", value, expected, 1e-9, max(abs(expected), 1e-3))


def check_parameters_again():
    """The scene with all parameters that a run has written can be run, and is the same."""
    first = scenes.run("scene.prm", *("--set=" + full_entry(entry) for entry in (
        *NO_PICTURES, "Lengths=2, 0.5", "Cells=8, 2", *BLOCK, "Traction top=0; -0.1",
        "Traction bottom=0.02; 0", "Contact law/Friction coefficient=0.3", "Factors=0.5, 1",
        *PATH, "Output/Directory=written")))
    again = scenes.run("written/parameters.prm", "--set=Output/Directory=again")
    results = [scenes.summary(name) for name in ("written", "again")]
    scenes.section("parameters.prm once more")
    check("exit codes", first.returncode == again.returncode == 0, first.stderr + again.stderr)
    check("J", results[0].get("functional") is not None
          and results[0]["functional"] == results[1].get("functional"), results)


def check_proof_of_three_bonds():
    """By enumeration the least J is the local minimum; 5 of 112 such proofs failed once."""
    for bound in (0.03, 0.05, 0.07, 0.1, 1.):
        scenes.section(f"proof with the bound {bound}")
        result = solve("Lengths=1, 0.3", "Cells=3, 1", "Young modulus=10", "Poisson ratio=0.3",
                       "Clamped boundaries=left", "Contact boundary=bottom",
                       "Traction top=0.02; 0.05", "Bond stiffness=10", "Bond threshold=0.01",
                       f"Contact law/Friction bound={bound}", "Prove=true")
        check("word", result["minimum"]["state"] == "global", result["minimum"])


def states_of_node(S, g, mu):
    """All (u_n, u_t) after one step from rest of a node with the stiffness S and the load g, along
    the normal into the foundation and the tangent: where it sticks, slides either way, is off."""
    (a, b), (_, c) = S
    (n, t), states = g, []
    if n >= 0. and abs(t) <= mu * n:
        states.append((0., 0.))
    for side in (1., -1.):
        u = (t - side * mu * n) / (c - side * mu * b)
        if u * side > 0. and n >= b * u:
            states.append((0., u))
    u = np.linalg.solve(S, g)
    if u[0] < 0.:
        states.append(tuple(u))
    return states


def check_triangles():
    """One triangle with one node that is free, in contact and loaded. With mu beyond the ratio
    k = c / |b| of its stiffnesses three states exist where the load along the tangent, on the side
    of b, is between k and mu times that along the normal: the node sticks, slides or is off.
    Elsewhere, and with smaller mu, there is one. A note says so, and what sticks is taken, in one
    step and in four, with which the state is the same. All are unloaded, where the pressures fall
    to nothing; next to k and beyond it pressures do not settle by themselves."""
    random, n_states = Random(4), []
    for case in range(36):
        scenes.section(f"triangle {case}")
        E, nu = 10**random.uniform(-1, 4), random.uniform(0.1, 0.45)
        size = 10**random.uniform(-4, 1)
        L, top = random.uniform(0.5, 2), (random.uniform(-1, 0.6), random.uniform(0.4, 1.5))
        # The gradient of the basis function, and the stiffness in plane strain.
        x, y = -1 / L, -(L - top[0]) / (L * top[1])
        A = E / ((1 + nu) * (1 - 2 * nu)) * L * top[1] / 2
        S = A * np.array([[(1 - nu) * y * y + (0.5 - nu) * x * x, -0.5 * x * y],
                          [-0.5 * x * y, (1 - nu) * x * x + (0.5 - nu) * y * y]])
        k, side = S[1, 1] / abs(S[0, 1]), math.copysign(1., S[0, 1])
        mu = k * (0.3, 0.8, 0.995, 1.05, 1.3, 3.)[case % 6]
        g = E * size * np.array([1., side * random.uniform(-0.3, 1.3) * max(k, mu)])
        states = states_of_node(S, g, mu)
        n_states.append(len(states))
        file = f"triangle-{case}.msh"
        (scenes.directory / file).write_text(msh.text(
            [(0., 0.), (L, 0.), top], [((1,), (0, 1)), ((2,), (1, 2)), ((3,), (2, 0))],
            [((4,), (0, 1, 2))],
            {(1, 1): "bottom", (1, 2): "right", (1, 3): "left", (2, 4): "all"}))
        # Half of a force on a side is at each of its ends.
        for factors in ("1", "0.25:0.25:1", "1, 0"):
            result = solve("Source=file", "File=" + file, f"Young modulus={E!r}",
                           f"Poisson ratio={nu!r}", "Hypothesis=plane strain",
                           "Clamped boundaries=right", "Contact boundary=bottom", "Law=none",
                           f"Force left={2 * g[1]!r}; {-2 * g[0]!r}", "Factors=" + factors,
                           f"Contact law/Friction coefficient={mu!r}", *PATH)
            check("word", result["minimum"]["state"] == "stationary", result["errors"])
            check("note", any("several states" in note for note in result["notes"])
                  == (len(states) > 1), (states, result["notes"]))
            row = result["profile"][0]
            if factors != "1, 0":
                for name, value, expected in zip(("u_nu", "slip"), (row["u_nu"], row["slip_x"]),
                                                 states[0]):
                    close(name, value, expected, 1e-8, size)
    check("some have three states, most have one", set(n_states) == {1, 3}
          and 4 <= n_states.count(3) <= 16, n_states)


scenes.all_of(globals())
