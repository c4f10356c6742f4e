#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_friction_of_solids.py DEBOND: friction in the plane of a face of a solid, beside finite
elements and a coordinate descent over nodes of its own: single loads, paths of both laws, proofs;
turned, mirrored and in other units; a block that slides in a circle."""
import math
import os
import pathlib
import sys
from itertools import count, permutations, product
from random import Random

# Threads take longer than products of such a size.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
numbers_of_blocks = count()
PATH = ["Global branch=none", "Bonds heal=false"]


class Block:
    """Tetrahedra, six to a box, on the foundation y = 0; written to a file."""

    def __init__(self, lengths, cells, E, nu, turn=np.eye(3)):
        self.name = f"block-{next(numbers_of_blocks)}.msh"
        numbers = {place: k for k, place in enumerate(product(*(range(n + 1) for n in cells)))}
        self.points = np.array([[L * i / n for L, i, n in zip(lengths, place, cells)]
                                for place in numbers])
        tets = []
        for place in product(*map(range, cells)):
            for axes in permutations(range(3)):
                corner, tet = list(place), [numbers[place]]
                for axis in axes:
                    corner[axis] += 1
                    tet.append(numbers[tuple(corner)])
                p = self.points[tet]
                tets.append(tet if np.linalg.det(p[1:] - p[0]) > 0 else
                            [tet[1], tet[0], *tet[2:]])
        faces = {}
        for tet in tets:
            for leave in range(4):
                face = tuple(v for k, v in enumerate(tet) if k != leave)
                faces.setdefault(tuple(sorted(face)), []).append(face)
        sides = []
        for key, (face, *other) in faces.items():
            if not other:
                y = self.points[list(key)][:, 1]
                group = 1 if (y == 0.).all() else 2 if (y == lengths[1]).all() else 3
                sides.append(((group,), face))
        turned = [tuple(turn @ p) for p in self.points]
        (scenes.directory / self.name).write_text(msh.text(
            turned, sides, [((7,), tet) for tet in tets],
            {(2, 1): "low", (2, 2): "high", (2, 3): "round", (3, 7): "all"}))

        self.K = np.zeros((3 * len(self.points),) * 2)
        C = np.zeros((6, 6))
        C[:3, :3] = nu
        C[range(3), range(3)] = 1 - nu
        C[range(3, 6), range(3, 6)] = (1 - 2 * nu) / 2
        C *= E / (1 + nu) / (1 - 2 * nu)
        for tet in tets:
            inverse = np.linalg.inv(np.hstack([np.ones((4, 1)), self.points[tet]]))
            B = np.zeros((6, 12))
            for v, (x, y, z) in enumerate(inverse[1:].T):
                B[:, 3 * v:3 * v + 3] = [[x, 0, 0], [0, y, 0], [0, 0, z], [y, x, 0], [0, z, y],
                                         [z, 0, x]]
            dofs = [3 * v + d for v in tet for d in range(3)]
            volume = np.linalg.det(self.points[tet][1:] - self.points[tet][0]) / 6
            self.K[np.ix_(dofs, dofs)] += B.T @ C @ B * volume
        self.low = [v for v, p in enumerate(self.points) if p[1] == 0.]
        self.high = [v for v, p in enumerate(self.points) if p[1] == lengths[1]]
        self.weights = np.zeros(len(self.low))
        for (group,), face in sides:
            if group == 1:
                p = self.points[list(face)]
                area = np.linalg.norm(np.cross(p[1] - p[0], p[2] - p[0])) / 2
                for v in face:
                    self.weights[self.low.index(v)] += area / 3

    def condensed(self):
        """(S, R, T): on (normal, x, z) of each node below, for u = given above."""
        kept = [3 * v + d for v in self.low for d in (1, 0, 2)]
        high = [3 * v + d for v in self.high for d in range(3)]
        rest = sorted(set(range(len(self.K))) - set(kept) - set(high))
        sign = np.tile([-1., 1., 1.], len(self.low))
        inner = np.linalg.solve(self.K[np.ix_(rest, rest)], self.K[np.ix_(rest, kept + high)])
        whole = (self.K[np.ix_(kept + high, kept + high)]
                 - self.K[np.ix_(kept + high, rest)] @ inner)
        n = len(kept)
        return sign[:, None] * whole[:n, :n] * sign, sign[:, None] * whole[:n, n:], whole[n:, n:]


def least_in_plane(A, f, w):
    """The least 1/2 v'A v - f'v + w |v|: v / |v| (w + ...) by bisection of the length."""
    if math.hypot(*f) <= w:
        return np.zeros(2)
    low, high = 0., math.hypot(*f) / np.linalg.eigvalsh(A)[0]
    for _ in range(200):
        length = (low + high) / 2
        if length in (low, high):
            break
        # (A + w / length) v = f.
        v = np.linalg.solve(length * A + w * np.eye(2), length * f)
        low, high = (length, high) if math.hypot(*v) > length else (low, length)
    return np.linalg.solve(high * A + w * np.eye(2), high * f)


def descend(S, g, phi, place, stiffness, x):
    """Over nodes: 1/2 x'S x - g'x + 1/2 sum stiffness x_n^2 + sum phi |x_t - place|, x_n <= 0."""
    S = S.copy()
    S[range(0, len(g), 3), range(0, len(g), 3)] += stiffness
    pull = g - S @ x
    for _ in range(100000):
        largest = 0.
        for i in range(len(phi)):
            n, t = 3 * i, slice(3 * i + 1, 3 * i + 3)
            new = min(x[n] + pull[n] / S[n, n], 0.)
            if new != x[n]:
                largest = max(largest, abs(new - x[n]))
                pull -= S[:, n] * (new - x[n])
                x[n] = new
            A, before = S[t, t], x[t].copy()
            x[t] = place[i] + (least_in_plane(A, pull[t] + A @ (before - place[i]), phi[i])
                               if phi[i] > 0. else
                               np.linalg.solve(A, pull[t] + A @ (before - place[i])))
            pull -= S[:, t] @ (x[t] - before)
            largest = max(largest, abs(x[t] - before).max())
        if largest <= 1e-13 * abs(x).max():
            return x
    raise ArithmeticError("coordinate descent does not end")


def own_path(block, ways, phi, k, M, coefficient=0.):
    """As that of check_friction.py: J, energy lost, forces above and x for each displacement."""
    S, R, T = block.condensed()
    n, w = len(block.weights), block.weights
    place, x, lost = np.zeros((n, 2)), np.zeros(3 * n), 0.
    holds, bound, rows = np.ones(n, bool), w * phi, []
    for d in ways:
        g = -R @ d
        for _ in range(1000):
            while True:
                x = descend(S, g, bound, place, w * k * holds, x)
                still = holds & (x[0::3] >= -M)
                if (still == holds).all():
                    break
                holds = still
            new = w * phi + coefficient * np.maximum((g - S @ x)[0::3] * (x[0::3] == 0.), 0.)
            if abs(new - bound).max() <= 1e-12 * max(abs(new).max(), 1e-300):
                break
            bound = new
        else:
            raise ArithmeticError("friction does not settle")
        t = x.reshape(n, 3)[:, 1:]
        lost += bound @ np.hypot(*(t - place).T)
        place = t.copy()
        broken = (w * k)[~holds].sum() * M**2 / 2
        elastic = x @ S @ x / 2 + d @ R.T @ x + d @ T @ d / 2
        rows.append((elastic + (w * k * holds) @ x[0::3]**2 / 2 + broken + lost, lost + broken,
                     (R.T @ x + T @ d).reshape(-1, 3).sum(0), x.copy()))
    return rows


def scene_of(random, bonded, coefficient=None, cells=None):
    """Entries, the block with the displacement above, its law, E and the displacement's size."""
    lengths = [random.uniform(1, 3), random.uniform(0.5, 1.5), random.uniform(1, 3)]
    cells = cells or [random.randint(1, 3), random.randint(1, 2), random.randint(1, 3)]
    E, nu = 10**random.uniform(-1, 4), random.uniform(0, 0.45)
    size = 10**random.uniform(-5, -2)
    block = Block(lengths, cells, E, nu)
    # Pressed and tilted, pushed along the face, and turned about the normal.
    press, tilt_x, tilt_z = random.uniform(-1, 0.3), random.uniform(-1, 1), random.uniform(-1, 1)
    angle, push, twist = random.uniform(0, 7), random.uniform(0, 1), random.uniform(-1, 1)
    push_x, push_z = push * math.cos(angle), push * math.sin(angle)
    phi = E * size * 10**random.uniform(-2, 0.3)
    k = E * 10**random.uniform(-1, 1.5) if bonded else 0.
    M = size * 10**random.uniform(-1.5, 0.5)

    def given(x, z):
        return [size * (push_x + twist * z), size * (press + tilt_x * x + tilt_z * z),
                size * (push_z - twist * x)]
    moved = np.concatenate([given(block.points[v][0], block.points[v][2]) for v in block.high])
    entries = ["Dimension=3", "Mesh/Source=file", "Mesh/File=" + block.name, f"Young modulus={E!r}",
               f"Poisson ratio={nu!r}", "Clamped boundaries=", "Contact boundary=low",
               f"Contact law/Friction bound={phi!r}" if coefficient is None else
               f"Contact law/Friction coefficient={coefficient!r}",
               f"Displacement high={size!r} * ({push_x!r} + {twist!r} * z); {size!r} * ({press!r}"
               f" + {tilt_x!r} * x + {tilt_z!r} * z); {size!r} * ({push_z!r} - {twist!r} * x)"]
    entries += [f"Bond stiffness={k!r}", f"Bond threshold={M!r}"] if bonded else ["Law=none"]
    return entries, block, moved, (phi if coefficient is None else 0., k, M), (E, size)


def check_single_loads():
    random = Random(1)
    for case in range(14):
        entries, block, moved, law, (E, size) = scene_of(random, case % 2)
        scenes.section(f"block {case}")
        result = solve(*entries, "Search=none")
        J, _, _, x = own_path(block, [moved], *law)[0]
        close("J", result["functional"], J, 1e-9, max(abs(J), 1e-5 * E * size**2))
        at = {tuple(block.points[v][[0, 2]].round(9)): x[3 * i:3 * i + 3]
              for i, v in enumerate(block.low)}
        for row in result["profile"]:
            u = at[round(row["x"], 9), round(row["z"], 9)]
            for name, value in zip(("u_nu", "slip_x", "slip_z"), u):
                close(name, row[name], value, 1e-7, abs(x).max())
            check("slides", row["slides"] == (math.hypot(*u[1:]) > 1e-9 * abs(x).max()), row)
        check("word", result["minimum"]["state"] in ("global", "local minimum", "best known"))


def check_paths():
    """Pulled, let go and pushed, with what friction and bonds have taken."""
    random = Random(2)
    factors = (0.4, 1., 0.7, -0.6, 0.3)
    for case in range(16):
        coefficient = random.uniform(0.02, 0.4) if case >= 8 else None
        entries, block, moved, law, (E, size) = scene_of(random, case % 2, coefficient)
        scenes.section(f"path {case}")
        result = solve(*entries, *PATH, "Displacement factors=" + ", ".join(map(str, factors)))
        check("exit code", result["exit_code"] == 0, result["errors"])
        own = own_path(block, [f * moved for f in factors], *law, *filter(None, [coefficient]))
        for row, (J, lost, force, _) in zip(result["path"], own, strict=True):
            energy = max(abs(J), 1e-5 * E * size**2)
            close("J", row["J"], J, 1e-8, energy)
            close("lost", row["dissipated_energy"], lost, 1e-7, energy)
            for axis, component in zip("xyz", force):
                close("force " + axis, row["reaction_high_" + axis], component, 1e-7,
                      max(*map(abs, force), 1e-5 * E * size))


def check_large_coefficients():
    """With these the pressures of one problem after the other need not settle by themselves. The
    state is one of Coulomb's by forces from own elements."""
    random = Random(5)
    for case in range(16):
        mu = random.uniform(1., 4.)
        entries, block, moved, _, (E, size) = scene_of(random, False, mu)
        scenes.section(f"coefficient {mu:.3g}")
        result = solve(*entries, *PATH, "Displacement factors=1")
        check("exit code", result["exit_code"] == 0, result["errors"])
        S, R, _ = block.condensed()
        at = {tuple(block.points[v][[0, 2]].round(9)): i for i, v in enumerate(block.low)}
        x = np.zeros((len(at), 3))
        for row in result["profile"]:
            x[at[round(row["x"], 9), round(row["z"], 9)]] = [row[name] for name in (
                "u_nu", "slip_x", "slip_z")]
        forces = (-R @ moved - S @ x.ravel()).reshape(-1, 3)
        scale = max(abs(R @ moved).max(), 1e-300)
        for (u, *t), (p, *f) in zip(x, forces):
            length = math.hypot(*t)
            close("pressure", p, max(p, 0.) if u == 0. else 0., 1e-8, scale)
            if length > 1e-9 * abs(x).max():
                for component, way in zip(f, t):
                    close("slides", component, mu * max(p, 0.) * way / length, 1e-7, scale)
            else:
                check("sticks", math.hypot(*f) <= mu * max(p, 0.) + 1e-7 * scale, (f, p))


def check_proofs():
    """The least J over all choices of which of six bonds hold, by search and by proof."""
    random, n_global = Random(3), 0
    for case in range(6):
        entries, block, moved, (phi, k, M), (E, size) = scene_of(random, True, cells=[1, 1, 2])
        scenes.section(f"proof {case}")
        S, R, T = block.condensed()
        n, w, g, values = len(block.weights), block.weights, -R @ moved, []
        for holds in product((False, True), repeat=n):
            holds = np.array(holds)
            x = descend(S, g, w * phi, np.zeros((n, 2)), w * k * holds, np.zeros(3 * n))
            values.append(x @ S @ x / 2 - g @ x + (w * k * holds) @ x[0::3]**2 / 2
                          + (w * k)[~holds].sum() * M**2 / 2
                          + w * phi @ np.hypot(x[1::3], x[2::3]))
        J = min(values) + moved @ T @ moved / 2
        for more in ([], ["Prove=true"]):
            result = solve(*entries, *more)
            close("J", result["functional"], J, 1e-9, max(abs(J), 1e-5 * E * size**2))
            word = result["minimum"]["state"]
            check("word", word == "global" or not more and word == "best known", word)
            n_global += word == "global"
            if word == "global":
                check("bound", result["proof"]["lower_bound"] <= J + 1e-9 * E * size**2)
    check("proofs", n_global > 6, n_global)


def check_invariances():
    """A block that is pressed and pushed there and back, with bonds: turned, mirrored, and in
    other units of length and stress."""
    def path(friction, turn=np.eye(3), L=1., E=1.):
        block = Block((2 * L, L, 1.5 * L), (4, 2, 3), E, 0.3, turn)
        u = turn @ (0.01 * L, -0.004 * L, 0.006 * L)
        rows = solve("Dimension=3", "Mesh/Source=file", "Mesh/File=" + block.name, f"Young modulus={100 * E!r}",
                     "Poisson ratio=0.3", "Clamped boundaries=", "Contact boundary=low",
                     f"Bond stiffness={20 * E / L!r}", f"Bond threshold={0.001 * L!r}",
                     "Displacement high=" + "; ".join(map(repr, map(float, u))),
                     f"Contact law/Friction {friction}", *PATH,
                     "Displacement factors=0.3, 1, 0.4, -0.5")["path"]
        return [(row["J"] / (E * L**3), row["dissipated_energy"] / (E * L**3), row["stick_part"],
                 row["broken_part"]) for row in rows]
    turn = np.linalg.qr(np.array([[1., 2., 0.5], [-1., 0.3, 1.], [0.2, -1., 2.]]))[0]
    mirror = np.diag([-1., 1., 1.])
    for name in ("bound=", "coefficient="):
        scenes.section("invariance, " + name)
        wanted = path(name + "0.3")
        check("it slides", len(wanted) == 4 and 0. < wanted[1][1] < wanted[3][1], wanted)
        for changes in ({"turn": turn}, {"turn": mirror}, {"turn": turn @ mirror},
                        {"L": 1e-3, "E": 1e6}, {"L": 1e4, "E": 1e-3}):
            rows = path(name + repr(0.3 * (changes.get("E", 1.) if name == "bound=" else 1.)),
                        **changes)
            for row, other in zip(rows, wanted, strict=True):
                for value, expected in zip(row, other):
                    close(f"{changes}", value, expected, 1e-8, max(abs(expected), 1e-3))


scenes.all_of(globals())
