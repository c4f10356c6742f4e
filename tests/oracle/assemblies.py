# SPDX-License-Identifier: LGPL-2.1-or-later
"""Bodies whose meshes do not match, glued by a dual mortar, in dense matrices and linear elements:
meshes and their files, the rows of an interface, the problem of its jumps and its minima."""
import math
from itertools import count, permutations, product

import numpy as np

import msh
import oracle

numbers_of_meshes = count()
NAMES = {2: ("left", "right", "bottom", "top"),
         3: ("left", "right", "back", "front", "bottom", "top")}
RULES = {n: [(float(w), np.array(l, float)) for w, l in oracle.rule(n)] for n in (2, 3)}


# ------------------------------------------------------------------ meshes


def spaced(length, n, random=None, start=0.):
    steps = np.array([random.uniform(.5, 1.5) if random else 1. for _ in range(n)])
    return start + length * np.concatenate([[0.], np.cumsum(steps) / steps.sum()])


class Body:
    """Simplices of boxes between coordinates; with random numbers vertices are moved where they may
    be, without them rectangles are cut by both diagonals. Sides are lists of (face, the cell's
    other vertex); `tip` is the half of the left side that is away from another body."""

    def __init__(self, name, axes, E, nu, random=None, to=lambda p: p, away=0):
        self.name, self.E, self.nu, self.dim, self.sides = name, E, nu, len(axes), {}
        self.height = np.ptp(axes[-1])
        n, self.points, self.cells = [len(axis) - 1 for axis in axes], [], []
        places = list(product(*(range(m + 1) for m in n)))
        at = {place: v for v, place in enumerate(places)}
        for place in places:
            p = np.array([axis[i] for axis, i in zip(axes, place)])
            for d, i in enumerate(place if random else ()):
                p[d] += random.uniform(-.2, .2) * (0 < i < n[d] and min(
                    np.diff(axes[d])[i - 1:i + 1]))
            self.points.append(to(p))
        for i, j, *k in product(*map(range, n)):
            for order in permutations(range(self.dim)) if random or k else ():
                path = [(i, j, *k)]
                for d in order:
                    path.append(tuple(x + (e == d) for e, x in enumerate(path[-1])))
                self.cells.append([at[place] for place in path])
            if not random and not k:
                square = [at[i, j], at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]]
                self.cells += [[square[m - 1], square[m], len(places)] for m in range(4)]
                self.points.append(sum(self.points[v] for v in square) / 4)
                places.append((-1, -1))
        self.points = np.array(self.points)
        for cell, v in ((cell, v) for cell in self.cells for v in cell):
            face = [w for w in cell if w != v]
            for k, side in enumerate(NAMES[self.dim]):
                if all(places[w][k // 2] == k % 2 * n[k // 2] for w in face):
                    height = sum(places[w][-1] for w in face) / self.dim - n[-1] / 2
                    is_tip = away and side == "left" and away * height >= 0
                    self.sides.setdefault("tip" if is_tip else side, []).append((face, v))


def write(folder, bodies, is_joined=False):
    """Entries of a file in a folder; joined: what is at one place is one vertex."""
    points, faces_of_sides, cells, names, numbers = [], [], [], {}, {}
    for body in bodies:
        at = []
        for p in body.points:
            at.append(numbers.setdefault(tuple(p.round(9)) if is_joined else len(points),
                                         len(points)))
            points += [tuple(p)] * (at[-1] == len(points))
        for d, side, of_side in ((body.dim, "", ((cell, 0) for cell in body.cells)), *(
                (body.dim - 1, "_" + name, faces) for name, faces in body.sides.items())):
            names[d, len(names) + 1] = body.name + side
            (cells if d == body.dim else faces_of_sides).extend(
                ((len(names),), [at[v] for v in face]) for face, _ in of_side)
    file = f"bodies-{next(numbers_of_meshes)}.msh"
    (folder / file).write_text(msh.text(points, faces_of_sides, cells, names))
    return [f"Dimension={body.dim}", "Source=file", "File=" + file, "Clamped boundaries=",
            f"Young modulus={body.E!r}", f"Poisson ratio={body.nu!r}", *(
                entry for b in bodies for entry in (f"Young modulus {b.name}={b.E!r}",
                                                    f"Poisson ratio {b.name}={b.nu!r}"))]


# ------------------------------------------------------------------ mortar


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def area_vector(p, inner):
    """Of a face, away from a point."""
    normal = np.array([p[1][1] - p[0][1], p[0][0] - p[1][0]]) if len(p) == 2 else np.cross(
        p[1] - p[0], p[2] - p[0]) / 2
    return normal if normal @ (p[0] - inner) > 0 else -normal


def common_edge(p, q, normals):
    """Of edges, p with normals at its ends: (weight, shapes on p, shapes on q)."""
    edge, change, other = p[1] - p[0], normals[1] - normals[0], q[1] - q[0]
    ends = []
    for x in q:
        r, y = .5, x - p[0]
        for _ in range(20):
            normal = normals[0] + r * change
            r -= cross(y - r * edge, normal) / (cross(y - r * edge, change) - cross(edge, normal))
        ends.append(min(max(r, 0.), 1.))
    low, high = sorted(ends)
    for weight, l in RULES[2] if high - low > 1e-10 else ():
        r = low + l[1] * (high - low)
        x, normal = p[0] + r * edge, normals[0] + r * change
        t = cross(x - q[0], normal) / cross(other, normal)
        if np.linalg.norm(q[0] + t * other - x) < .3 * max(*map(np.linalg.norm, (edge, other))):
            yield weight * (high - low) * np.linalg.norm(edge), np.array([1 - r, r]), np.array(
                [1 - t, t])


def common_polygon(p, q, vector):
    """Of triangles, along the normal of p."""
    normal, first = vector / np.linalg.norm(vector), p[1] - p[0]
    if min(abs((q - p[0]) @ normal)) > np.linalg.norm(first):
        return
    plane = np.array([first, np.cross(normal, first)]).T / np.linalg.norm(first)
    a, polygon = (p - p[0]) @ plane, list((q - p[0]) @ plane)
    to_a, to_b = (np.linalg.inv(np.vstack([np.transpose(c), np.ones(3)])) for c in (a, polygon))
    for k in range(3):
        heights, cut = [to_a[k] @ (*x, 1.) for x in polygon], []
        for i, (x, of_x) in enumerate(zip(polygon, heights)):
            if of_x * heights[i - 1] < 0:
                cut.append(x + (polygon[i - 1] - x) * of_x / (of_x - heights[i - 1]))
            cut += [x] * (of_x >= 0)
        polygon = cut
    for k in range(1, len(polygon) - 1):
        part = np.array([polygon[0], polygon[k], polygon[k + 1]])
        area = abs(cross(part[1] - part[0], part[2] - part[0])) / 2
        for weight, l in RULES[3] if area > 1e-14 * first @ first else ():
            x = np.array([*(l @ part), 1.])
            yield weight * area, to_a @ x, to_b @ x


def dual_rows(points, slave, master, is_held, around):
    """Of each node of the slave that carries a jump: weight, normal, D, P and -R of its row. What
    is held leaves its function to the nearest of these nodes."""
    vectors, normals = [area_vector(points[face], points[v]) for face, v in slave], {}
    for (face, _), vector in zip(slave, vectors):
        for v in face:
            normals[v] = normals.get(v, 0.) + vector
    sums, parts, D = normals, [], {}
    normals = {v: vector / np.linalg.norm(vector) for v, vector in sums.items()}
    for (face, _), vector in zip(slave, vectors):
        p, bases = points[face], [normals[v] for v in face]
        items = [(w * around(l @ p), l, other, m) for other, _ in master for w, l, m in (
            common_edge(p, points[other], bases) if len(face) == 2 else
            common_polygon(p, points[other], vector))]
        if items:
            d, mass = (sum(w * f(l) for w, l, _, _ in items) for f in (
                np.array, lambda l: np.outer(l, l)))
            parts.append((face, items, np.diag(d) @ np.linalg.inv(mass)))
            D.update({v: D.get(v, 0.) + x for v, x in zip(face, d)})
    rows = {v: [0., 0., 0., {}, {}] for v in D if not is_held(v, normals[v])}
    nearest = {v: v if v in rows else min(rows, key=lambda u: np.linalg.norm(
        points[u] - points[v])) for v in D}
    for v, row in rows.items():
        row[1] = sums[v]
    for face, items, C in parts:
        for w, l, other, m in items:
            for v, psi in zip(face, C @ l):
                rows[nearest[v]][0] += w * psi
                for row, nodes, values in zip(rows[nearest[v]][3:], (other, face), (m, l)):
                    for u, x in zip(nodes, values):
                        row[u] = row.get(u, 0.) + w * psi * x
    for v, row in rows.items():
        row[1], row[2] = row[1] / np.linalg.norm(row[1]), row[4].pop(v)
        row[3:] = ({u: x / row[2] for u, x in of.items()} for of in row[3:])
    return rows


# ------------------------------------------------------------------ the problem


class Law:
    """Energy of an opening, 1/2 k p^2 up to a threshold; with an energy it softens from there."""

    def __init__(self, k=0., threshold=1., ratio=1., energy=None):
        self.k, self.ratio, self.softens, top = k, ratio, bool(energy), k * threshold
        self.polygon = (0., 0.), (threshold, top), (
            2 * energy / top if energy else threshold, 0.)
        self.word = "none" if not k else "bilinear" if energy else "winkler"
        self.numbers = {"Bond stiffness": k, "Bond shear stiffness": ratio * k, **(
            {"Bond strength": top, "Fracture energy": energy} if energy else
            {"Bond threshold": threshold})}


class Problem:
    """Bodies and interfaces (slave, master), sides by name; supports (components or None) and
    tractions of sides."""

    def __init__(self, bodies, joints, supports, tractions, laws, tangential="free", symmetry="",
                 hypothesis="plane stress"):
        self.bodies, self.joints, self.laws, self.tangential = bodies, joints, laws, tangential
        self.supports, self.tractions, self.hypothesis = supports, tractions, hypothesis
        self.dim, self.is_axis = bodies[0].dim, symmetry == "axis"
        self.firsts = np.cumsum([0] + [len(body.points) for body in bodies])
        self.points = np.concatenate([body.points for body in bodies])
        self.sides = {f"{body.name}_{side}": [([v + first for v in face], w + first)
                                              for face, w in faces]
                      for body, first in zip(bodies, self.firsts)
                      for side, faces in body.sides.items()}

    def close_curves(self):
        """Moves what carries jumps, but for its edge, to where the distance is zero in the mean."""
        for slave, master in self.joints:
            edge = {v for name, side in self.sides.items() if name != slave
                    for face, _ in side for v in face}
            for _ in range(5):
                vectors = [(face, area_vector(self.points[face], self.points[v]))
                           for face, v in self.sides[slave]]
                sums = {v: np.zeros(2 + self.dim) for face, _ in vectors for v in face}
                for face, vector in vectors:
                    for v in face:
                        sums[v][2:] += vector
                for face, vector in vectors:
                    p, bases = self.points[face], [sums[v][2:] / np.linalg.norm(sums[v][2:])
                                                   for v in face]
                    for q in (self.points[other] for other, _ in self.sides[master]):
                        for w, l, m in common_edge(p, q, bases) if len(face) == 2 else (
                                common_polygon(p, q, vector)):
                            way = m @ q - l @ p
                            distance = math.copysign(np.linalg.norm(way), way @ vector)
                            for v, psi in zip(face, (self.dim + 1) * l - 1):
                                sums[v][:2] += w * psi, w * psi * distance
                for v in sums.keys() - edge:
                    weight, distance, *normal = sums[v]
                    self.points[v] += distance / weight * (normal / np.linalg.norm(normal))

    def entries(self, folder):
        names = [f"interface_{k + 1}" for k in range(len(self.joints))]
        values = {"Mesh/Interfaces": ", ".join(map(" | ".join, self.joints)),
                  "Contact boundary": ", ".join(names), "Law": self.laws[0].word,
                  "Tangential displacement": self.tangential}
        if self.dim == 2:
            values.update({"Symmetry": "axis"} if self.is_axis else {"Hypothesis": self.hypothesis})
        for name, law in zip(["", *names[1:]], self.laws):
            values.update({f"{entry} {name}".strip(): x for entry, x in law.numbers.items()
                           if law.k and ("shear" not in entry or self.tangential == "bonded")})
        if self.laws[0].softens:
            values["Bond threshold"] = ""
        for kind, sides in (("Displacement ", self.supports), ("Traction ", self.tractions)):
            values.update({kind + side: "; ".join("free" if x is None else repr(float(x))
                                                  for x in u) for side, u in sides.items()})
        return [*write(folder, self.bodies), *(f"{entry}={x}" for entry, x in values.items())]

    def around(self, p):
        return 2 * math.pi * p[0] if self.is_axis else 1.

    def stiffness(self):
        dim, K = self.dim, np.zeros((self.points.size,) * 2)
        shears = ((0, 1), (0, 2), (1, 2))[:1 if dim == 2 else 3]
        for body, first in zip(self.bodies, self.firsts):
            C = np.eye(3 + len(shears)) * body.E / 2 / (1 + body.nu)
            S, C[:3, :3] = (np.eye(3) * (1 + body.nu) - body.nu) / body.E, 0.
            n = 2 if dim == 2 and not self.is_axis and "stress" in self.hypothesis else 3
            C[:n, :n] = np.linalg.inv(S[:n, :n])
            for cell in np.array(body.cells) + first:
                p = self.points[cell]
                whole, middle = np.hstack([np.ones((dim + 1, 1)), p]), p.mean(axis=0)
                G, B = np.linalg.inv(whole)[1:], np.zeros((len(C), p.size))
                for k in range(dim):
                    B[k, k::dim] = G[k]
                if self.is_axis:
                    B[2, ::2] = 1 / 3 / middle[0]
                for k, (i, j) in enumerate(shears, 3):
                    B[k, i::dim], B[k, j::dim] = G[j], G[i]
                dofs = (dim * cell[:, None] + np.arange(dim)).ravel()
                K[np.ix_(dofs, dofs)] += B.T @ C @ B * self.around(middle) * abs(
                    np.linalg.det(whole)) / math.factorial(dim)
        return K

    def condense(self):
        """1/2 x'S x - g'x + c of the normal jumps of all nodes and, if bonded, of the others."""
        n, dim = self.points.size, self.dim
        self.K, self.f, fixed = self.stiffness(), np.zeros(n), {}
        for side, t in self.tractions.items():
            for face, v in self.sides[side]:
                area = np.linalg.norm(area_vector(self.points[face], self.points[v]))
                for w, l in RULES[dim]:
                    for u, x in zip(face, w * area * self.around(l @ self.points[face]) * l):
                        self.f[dim * u:dim * u + dim] += x * np.array(t)
        for side, values in self.supports.items():
            fixed.update({dim * v + d: x for face, _ in self.sides[side] for v in face
                          for d, x in enumerate(values) if x is not None})
        if self.is_axis:
            fixed.update({2 * v: 0. for v, p in enumerate(self.points) if p[0] == 0.})
        self.prescribed, self.bonds, self.T = {d: d for d in fixed}, [], np.eye(n)

        def is_held(v, normal):
            """Nodes that slide keep their jump if what is prescribed is along the side."""
            axes = [abs(normal[d]) for d in range(dim) if dim * v + d in fixed]
            return axes and (self.tangential != "free" or max(axes) > .28)
        normals, tangents, self.frames = [], [], []
        for (slave, master), law in zip(self.joints, self.laws):
            for v, (w, nu, D, P, R) in dual_rows(
                    self.points, self.sides[slave], self.sides[master], is_held,
                    self.around).items():
                rows = range(dim * v, dim * v + dim)
                axes = [d for d in range(dim) if dim * v + d in fixed]
                frame = np.vstack([nu, np.eye(dim)[axes]])
                frame = np.vstack([frame, np.linalg.svd(frame)[2][len(frame):]])
                self.frames.append(frame)
                to, scales = np.linalg.inv(frame), [w / D] + [1. if axes else w / D] * (dim - 1)
                self.T[np.ix_(rows, rows)] = to * scales
                for u, x in (*P.items(), *((u, -x) for u, x in R.items())):
                    self.T[dim * v:dim * v + dim, dim * u:dim * u + dim] += x * (
                        np.outer(to[:, 0], nu) if axes else np.eye(dim))
                values = [fixed.pop(rows[d]) for d in axes]
                for k, (d, value) in enumerate(zip(axes, values), 1):
                    fixed[rows[k]], self.prescribed[rows[d]] = value, rows[k]
                self.bonds.append(oracle.Bond(w, v, law.polygon))
                self.bonds[-1].law = law
                normals.append(rows[0])
                tangents += rows[1:]
        if self.tangential == "fixed":
            fixed.update(dict.fromkeys(tangents, 0.))
        self.keep = normals + tangents * (self.tangential == "bonded")
        A, self.G, keep = self.T.T @ self.K @ self.T, np.zeros(n), self.keep
        self.G[list(fixed)] = list(fixed.values())
        loads = self.T.T @ self.f - A @ self.G
        self.rest = rest = np.setdiff1d(np.arange(n), [*keep, *fixed])
        self.X = np.linalg.solve(A[np.ix_(rest, rest)], np.column_stack([
            -A[np.ix_(rest, keep)], loads[rest]]))
        whole = A[np.ix_(keep, rest)] @ self.X
        self.S, self.g = A[np.ix_(keep, keep)] + whole[:, :-1], loads[keep] - whole[:, -1]
        self.c = self.G @ A @ self.G / 2 - self.T.T @ self.f @ self.G - (
            loads[rest] @ self.X[:, -1] / 2)
        return self

    def reactions(self, x):
        """Sums of the supports' forces on each body."""
        w, held = self.G.copy(), np.zeros(len(self.G))
        w[self.keep] += x
        w[self.rest] += self.X @ (*x, 1.)
        held[list(self.prescribed)] = (self.T.T @ (self.K @ (self.T @ w) - self.f))[
            list(self.prescribed.values())]
        return [held.reshape(-1, self.dim)[a:b].sum(axis=0)
                for a, b in zip(self.firsts, self.firsts[1:])]

    def openings(self, x):
        n = len(self.bonds)
        return [math.sqrt(s * s + bond.law.ratio * (t @ t)) for bond, s, t in zip(
            self.bonds, x, x[n:].reshape(n, -1))]

    def terms(self, x):
        return np.array([self.c, x @ self.S @ x / 2, -self.g @ x, sum(
            bond.energy(-p) for bond, p in zip(self.bonds, self.openings(x)))])

    def J(self, x):
        return self.terms(x).sum()

    def least(self, stiffnesses):
        """Of the convex problem with these for the bonds; None if nothing holds a body."""
        n, Q, g = len(self.bonds), self.S.copy(), self.g
        ratios = np.array([bond.law.ratio for bond in self.bonds])
        Q[np.diag_indices(len(g))] += np.concatenate([stiffnesses, np.repeat(
            stiffnesses * ratios, len(g) // n - 1)])
        if len(g) > n and np.linalg.eigvalsh(Q[n:, n:])[0] < 1e-11 * Q.max():
            return None
        to = np.linalg.solve(Q[n:, n:], np.column_stack([-Q[n:, :n], g[n:]]))
        s = oracle.minimise_convex(Q[:n, :n] + Q[:n, n:] @ to[:, :-1],
                                   g[:n] - Q[:n, n:] @ to[:, -1])
        return None if s is None else np.concatenate([s, to @ (*s, 1.)])

    def descend(self, stiffnesses=None):
        """By majorising the bonds, from rest or from what these would give."""
        last, intact = math.inf, np.array([bond.branches[0][0] for bond in self.bonds])
        x = self.least(intact if stiffnesses is None else stiffnesses)
        while x is not None and last - self.J(x) > 1e-15 * abs(self.terms(x)).sum():
            last = self.J(x)
            x = self.least(np.array([bond.pull(-p) / -p if p > 0. else k for bond, p, k in zip(
                self.bonds, self.openings(x), intact)]))
        return x

    def candidates(self, random):
        """What descents come to, or with few bonds that break at once minima for all states."""
        whole, n = np.array([bond.branches[0][0] for bond in self.bonds]), len(self.bonds)
        if n <= 10 and not self.laws[0].softens:
            found = map(self.least, (whole * state for state in product(
                (0., 1.) if whole.any() else (0.,), repeat=n)))
        else:
            found = (self.descend(whole * [holds ^ (place > k) for k in range(n)])
                     for place, holds in ((random.uniform(0., n), k % 2) for k in range(8)))
        return [x for x in (self.descend(), *found) if x is not None]
