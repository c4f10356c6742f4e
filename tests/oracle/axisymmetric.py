# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finite elements of bodies of revolution for check_axis.py, which share nothing with the
program: from the entries of a scene and a mesh to K and f, what supports hold, the problem of
the contact nodes and its minima. x is the radius r, y the coordinate z along the axis."""
import itertools

import numpy as np

X, W = np.polynomial.legendre.leggauss(6)
X, W = (X + 1) / 2, W / 2
# Weights and barycentric coordinates of a rule of a triangle that is exact to degree 10.
FINE = [(2 * a * b * (1 - x), np.array([x, y * (1 - x), (1 - x) * (1 - y)]))
        for x, a in zip(X, W) for y, b in zip(X, W)]
# Those of the strain energy, by degree.
STRAIN = {1: [(1., np.full(3, 1 / 3))],
          2: [(1 / 3, np.where(np.arange(3) == k, 2 / 3, 1 / 6)) for k in range(3)]}
EDGES = ((0, 1), (1, 2), (2, 0))
SUPPORTS, LAW = "Boundary conditions/", "Contact law/"


def field(text):
    """A function of a place."""
    code = compile(text.strip(), text, "eval")
    return lambda p: float(eval(code, {"x": p[0], "y": p[1]}))


def shapes(degree, l):
    """The basis functions of a triangle, and their derivatives by barycentric coordinates."""
    if degree == 1:
        return l, np.eye(3)
    d = np.vstack([np.diag(4 * l - 1), np.zeros((3, 3))])
    for k, (i, j) in enumerate(EDGES, 3):
        d[k, i], d[k, j] = 4 * l[j], 4 * l[i]
    return np.array([*(l * (2 * l - 1)), *(4 * l[i] * l[j] for i, j in EDGES)]), d


def on_edge(degree, x, is_bernstein=False):
    """The functions of an edge, or those of contact, which are not negative."""
    if degree == 1:
        return np.array([1 - x, x])
    if is_bernstein:
        return np.array([(1 - x)**2, x * x, 2 * x * (1 - x)])
    return np.array([(1 - x) * (1 - 2 * x), x * (2 * x - 1), 4 * x * (1 - x)])


class Law:
    """A polygon of tractions over the opening."""

    def __init__(self, points):
        self.points = points
        self.threshold = max(p for p, _ in points)

    def energy(self, p):
        total = 0.
        for (a, t), (b, w) in zip(self.points, self.points[1:]):
            q = min(p, b) - a
            if q > 0:
                total += q * t + q * q * (w - t) / (b - a) / 2
        return total

    def traction(self, p):
        for (a, t), (b, w) in zip(self.points, self.points[1:]):
            if a <= p < b:
                return t + (p - a) * (w - t) / (b - a)
        return 0.


class Bond:
    """Of a point of the quadrature: its weight, its law, the stiffness of the first piece of that,
    and u_nu - gap as row.s + held."""

    def __init__(self, weight, law, stiffness, where):
        self.weight, self.law, self.stiffness, self.where = weight, law, stiffness, where
        self.row, self.held = None, 0.

    def opening(self, s):
        return -(self.row @ s + self.held)

    def energy(self, s):
        return self.weight * self.law.energy(self.opening(s))


class Body:
    """Of the entries of a scene; points, vertices of triangles and names of sides are those of
    the mesh; pairs are vertices above and below a cut."""

    def __init__(self, settings, points, triangles, sides, pairs=()):
        self.of = dict(s.split("=", 1) for s in settings)
        self.points, self.pairs = [np.array(p, float) for p in points], dict(pairs)
        self.degree, middle, self.cells = int(self.of.get("Mesh/Degree", 1)), {}, []
        for t in triangles:
            edges = [frozenset((t[i], t[j])) for i, j in EDGES[:3 * (self.degree - 1)]]
            for edge in edges:
                if edge not in middle:
                    middle[edge] = len(self.points)
                    self.points.append(sum(self.points[v] for v in edge) / 2)
            self.cells.append([*t, *(middle[edge] for edge in edges)])
        for edge, v in list(middle.items()):
            low = frozenset(self.pairs.get(w) for w in edge)
            if low in middle:
                self.pairs[v] = middle[low]
        self.n = 2 * len(self.points)
        third = {frozenset((t[i], t[j])): t[3 - i - j] for t in triangles for i, j in EDGES}
        self.sides = {}
        for name, faces in sides.items():
            self.sides[name] = []
            for a, b in faces:
                d, edge = self.points[b] - self.points[a], frozenset((a, b))
                normal = np.array([d[1], -d[0]]) / np.hypot(*d)
                normal *= -np.sign(normal @ (self.points[third[edge]] - self.points[a]))
                self.sides[name].append(
                    ([v for v in (a, b, middle.get(edge)) if v is not None], np.hypot(*d), normal))
        self.assemble()
        self.make_unknowns()
        self.make_bonds()
        self.condense()

    # ------------------------------------------------------------------ K and f

    def material(self):
        """C on the strains rr, zz, tt, 2 rz, and what a change of temperature by 1 strains."""
        if "Material/Young modulus" in self.of:
            E, nu = (float(self.of["Material/" + x]) for x in ("Young modulus", "Poisson ratio"))
            numbers = [[E] * 3, [nu] * 3, [E / (2 + 2 * nu)]]
        else:
            numbers = [[float(x) for x in self.of["Material/" + name].split(",")]
                       for name in ("Young moduli", "Poisson ratios", "Shear moduli")]
        alpha = [float(a) for a in self.of.get("Material/Thermal expansion", "0").split(",")]
        angle = np.radians(float(self.of.get("Material/Axis angle", 0)))
        S, c, s = np.zeros((4, 4)), np.cos(angle), np.sin(angle)
        S[3, 3] = 1 / numbers[2][0]
        for i in range(3):
            S[i, i] = 1 / numbers[0][i]
        for (i, j), nu in zip(((0, 1), (0, 2), (1, 2)), numbers[1]):
            S[i, j] = S[j, i] = -nu / numbers[0][i]
        # To strains along the material's axes.
        R = np.array([[c * c, s * s, 0, c * s], [s * s, c * c, 0, -c * s], [0, 0, 1, 0],
                      [-2 * c * s, 2 * c * s, 0, c * c - s * s]])
        return R.T @ np.linalg.inv(S) @ R, np.linalg.solve(R, [*(3 * alpha)[:3], 0.])

    def at_point(self, cell, l):
        """Strains by the unknowns of a cell, its basis functions, the place, and area times the
        way around."""
        at = np.array([self.points[v] for v in cell[:3]])
        phi, d = shapes(self.degree, l)
        g = d @ np.linalg.inv(np.vstack([at.T, np.ones(3)]))[:, :2]
        p, B = l @ at, np.zeros((4, 2 * len(phi)))
        B[0, ::2], B[1, 1::2], B[3, ::2], B[3, 1::2] = g[:, 0], g[:, 1], g[:, 1], g[:, 0]
        B[2, ::2] = phi / p[0]
        (a, b), (c, e) = at[1] - at[0], at[2] - at[0]
        return B, phi, p, abs(a * e - b * c) * np.pi * p[0]

    def assemble(self):
        C, expansion = self.material()
        heat = field(self.of.get("Loads/Temperature change", "0"))
        force = [field(t) for t in self.of.get("Loads/Body force", "0;0").split(";")]
        self.K, self.f = np.zeros((self.n, self.n)), np.zeros(self.n)
        for cell in self.cells:
            dofs = [2 * v + k for v in cell for k in (0, 1)]
            for weight, l in STRAIN[self.degree]:
                B, _, p, area = self.at_point(cell, l)
                self.K[np.ix_(dofs, dofs)] += weight * area * B.T @ C @ B
                self.f[dofs] += weight * area * B.T @ C @ expansion * heat(p)
            for weight, l in FINE if "Loads/Body force" in self.of else ():
                _, phi, p, area = self.at_point(cell, l)
                self.f[dofs] += weight * area * np.kron(phi, [c(p) for c in force])
        for name, path in itertools.product(self.sides, ("Traction", "Pressure", "Force")):
            load = [field(c) for c in self.of.get(f"Loads/{path} {name}", "").split(";") if c]
            for nodes, phi, weight, p, normal in self.on(name) if load else ():
                t = np.array([c(p) for c in load])
                t = {"Traction": t, "Pressure": -t[0] * normal, "Force": t / self.area(name)}[path]
                self.f[[2 * v + k for v in nodes for k in (0, 1)]] += weight * np.kron(phi, t)

    def on(self, name):
        """Points of a side: nodes, their functions, weight, place, normal."""
        for nodes, length, normal in self.sides[name]:
            for x, w in zip(X, W):
                p = (1 - x) * self.points[nodes[0]] + x * self.points[nodes[1]]
                yield (nodes, on_edge(self.degree, x), w * length * 2 * np.pi * p[0], p, normal)

    def area(self, name):
        return sum(w for _, _, w, _, _ in self.on(name))

    # ------------------------------------------------------------------ unknowns

    def names(self, entry):
        return [x.strip() for x in self.of.get(SUPPORTS + entry, "").split(",") if x.strip()]

    def prescribed(self):
        """Of each node the directions along which supports or the axis hold it, and how far."""
        rows = [[((1., 0.), 0.)] * int(p[0] == 0.) for p in self.points]
        for name, faces in self.sides.items():
            moved = self.of.get(f"{SUPPORTS}Displacement {name}", "free; free").split(";")
            if name in self.names("Clamped boundaries"):
                moved = ["0", "0"]
            for nodes, _, normal in faces:
                for v in nodes:
                    rows[v] += [(e, field(c)(self.points[v])) for e, c in zip(
                        ((1., 0.), (0., 1.)), moved) if c.strip() != "free"]
                    if name in self.names("Roller boundaries"):
                        rows[v].append((tuple(normal), 0.))
        return rows

    def directions(self):
        """Of each node on contact faces the directions of u_nu and the gaps along them: those of
        its faces, joined if they are near to each other. slot says which one a face has."""
        self.faces = [(name, face) for name in self.names("Contact boundary")
                      for face in self.sides[name]]
        self.slot, normals, self.gap = {}, {}, {}
        for f, (name, (nodes, size, normal)) in enumerate(self.faces):
            given = self.of.get(f"{SUPPORTS}Foundation normal {name}",
                                self.of.get(SUPPORTS + "Foundation normal"))
            if given:
                middle = (self.points[nodes[0]] + self.points[nodes[1]]) / 2
                normal = np.array([field(c)(middle) for c in given.split(";")])
            gap = field(self.of.get(LAW + "Initial gap", "0"))
            for v in nodes:
                d = np.array([0., normal[1]]) if self.points[v][0] == 0. else normal
                d, here = d / np.hypot(*d), normals.setdefault(v, [])
                n = next((n for n, mean in enumerate(here) if mean @ d > np.cos(
                    np.radians(31.4)) * np.hypot(*mean)), len(here))
                here[n:n + 1] = [size * d + sum(here[n:n + 1])]
                self.slot[f, v] = v, n
                self.gap[v, n] = gap(self.points[v])
        return {v: [d / np.hypot(*d) for d in here] for v, here in normals.items()}

    def make_unknowns(self):
        """u = T w: w are coefficients of functions that are not negative on contact edges, jumps
        above cuts, and along what is held or touches the foundation. Of each slot there is the
        unknown, or the direction of what is prescribed."""
        T, J, F = np.eye(self.n), np.eye(self.n), np.eye(self.n)
        rows, normals = self.prescribed(), self.directions()
        edges = [face[0] for _, face in self.faces] if self.degree == 2 else []
        for nodes in edges + [[self.pairs[v] for v in e] for e in edges if e[0] in self.pairs]:
            for k in (0, 1):
                i, *ends = (2 * v + k for v in (nodes[2], *nodes[:2]))
                T[i, i], T[i, ends] = .5, .25
        for up, low in self.pairs.items():
            J[2 * up, 2 * low] = J[2 * up + 1, 2 * low + 1] = 1.
        self.coefficients = T
        is_fixed = self.of.get(LAW + "Tangential displacement", "fixed") == "fixed"
        self.fixed, self.free, self.contact, self.slots = {}, [], [], {}
        for v in range(len(self.points)):
            here, frame = normals.get(v, []), []
            # u_tau = 0 and a support that is inclined to the normal leave nothing; up to 16
            # degrees from the boundary, as on polygons, it counts as along it.
            if is_fixed and len(here) == 1 and any(
                    value == 0. and abs(here[0] @ row) > .28 for row, value in rows[v]):
                rows[v] = rows[v] + [((1., 0.), 0.), ((0., 1.), 0.)]
            wanted = rows[v] + [(d, k) for k, d in enumerate(here)
                                if len(here) == 1 or not is_fixed] + [((1., 0.), None),
                                                                      ((0., 1.), None)]
            if len(here) == 1:
                wanted[-2:] = [((-here[0][1], here[0][0]), None)] + wanted[-2:]
            for n, (row, of) in enumerate(wanted):
                if len(frame) == 2 or frame and abs(
                        frame[0][0] * row[1] - frame[0][1] * row[0]) < 1e-7:
                    continue
                if of is None and frame:
                    row = (-frame[0][1], frame[0][0])
                dof = 2 * v + len(frame)
                frame.append(row)
                if n < len(rows[v]):
                    self.fixed[dof] = of
                elif of is not None:
                    self.contact.append(dof)
                    self.slots[v, of] = dof
                elif here and is_fixed:
                    self.fixed[dof] = 0.
                else:
                    self.free.append(dof)
            for k, d in enumerate(here):
                self.slots.setdefault((v, k), d)
            F[2 * v:2 * v + 2, 2 * v:2 * v + 2] = np.linalg.inv(frame)
        self.T = T @ J @ F

    def make_bonds(self):
        """Those of a node are one."""
        kind, rule = self.of.get(LAW + "Law", "winkler"), self.of.get(LAW + "Quadrature", "nodal")
        sums = {}
        for f, (_, (nodes, length, _)) in enumerate(self.faces):
            a, b = (self.points[v] for v in nodes[:2])
            if rule == "nodal":
                points = [(length * np.pi * (2 * p[0] + q[0]) / 3, phi, p) for p, q, phi in (
                    (a, b, (1., 0.)), (b, a, (0., 1.)))]
            else:
                n = 1 if rule == "midpoint" else int(rule.split()[1])
                points = [(w * length * np.pi * (a + x * (b - a))[0],
                           on_edge(self.degree, x, True), a + x * (b - a)) for x, w in zip(
                               *(t + k for t, k in zip(np.polynomial.legendre.leggauss(n), (1, 0))))
                          for x in [x / 2]]
            for weight, phi, p in points:
                where = tuple((self.slot[f, v], x) for v, x in zip(nodes, phi) if x)
                k, M, t, G = (field(self.of.get(LAW + name) or "0")(p) for name in (
                    "Bond stiffness", "Bond threshold", "Bond strength", "Fracture energy"))
                polygon = {"winkler": lambda: [(0, 0), (M, k * M), (M, 0)],
                           "bilinear": lambda: [(0, 0), (t / k, t), (2 * G / t, 0)],
                           "curve": lambda: [tuple(map(float, x.split(":"))) for x in self.of[
                               LAW + "Curve"].split(",")]}
                if kind != "none":
                    bond = sums.setdefault((where, k, M), [0., Law(polygon[kind]()), k, where])
                    bond[0] += weight
        self.bonds = [Bond(*terms) for terms in sums.values()]

    def condense(self, factor=1.):
        """J = c + 1/2 s'S s - g's + bonds, where all else is in equilibrium, under a multiple of
        loads and prescribed displacements."""
        K, f, w = self.T.T @ self.K @ self.T, factor * self.T.T @ self.f, np.zeros(self.n)
        w[list(self.fixed)] = factor * np.array(list(self.fixed.values()))
        for slot, dof in self.slots.items():
            if not isinstance(dof, np.ndarray):
                w[dof] = self.gap[slot]
        r, i, c = f - K @ w, self.free, self.contact
        X = np.linalg.solve(K[np.ix_(i, i)], np.column_stack([K[np.ix_(i, c)], r[i]]))
        self.S = K[np.ix_(c, c)] - K[np.ix_(c, i)] @ X[:, :-1]
        self.g = r[c] - K[np.ix_(c, i)] @ X[:, -1]
        self.constant = w @ K @ w / 2 - f @ w - r[i] @ X[:, -1] / 2
        self.factor, self.offset, self.X = factor, w, X
        for bond in self.bonds:
            bond.row, bond.held = np.zeros(len(c)), 0.
            for slot, phi in bond.where:
                dof = self.slots[slot]
                if isinstance(dof, np.ndarray):
                    v = slot[0]
                    bond.held += phi * (dof @ self.T[2 * v:2 * v + 2] @ w - self.gap[slot])
                else:
                    bond.row[c.index(dof)] += phi

    # ------------------------------------------------------------------ states

    def displacement(self, s):
        """In Cartesian components of the nodes."""
        w = self.offset.copy()
        w[self.contact] += s
        w[self.free] = self.X[:, -1] - self.X[:, :-1] @ s
        return self.T @ w

    def J(self, s):
        return self.constant + s @ self.S @ s / 2 - self.g @ s + sum(
            b.energy(s) for b in self.bonds)

    def size(self, s):
        """Of what J is a sum of."""
        return (abs(self.constant) + s @ self.S @ s / 2 + abs(self.g @ s)
                + sum(b.energy(s) for b in self.bonds))

    def forces(self, u):
        """Of all that holds the body on its nodes, on contact edges on the coefficients."""
        return (self.coefficients.T @ (self.K @ u - self.factor * self.f)).reshape(-1, 2)

    def violation(self, s, shift):
        """How far forces on contact nodes are from what bonds and foundation allow at openings
        within a shift, over the largest force."""
        force, low, high = self.g - self.S @ s, np.zeros(len(s)), np.zeros(len(s))
        for b in self.bonds:
            pulls = [b.weight * b.law.traction(q) if q > 0 else 0. for q in (
                b.opening(s) + k * shift for k in (-1, 0, 1))]
            low, high = low - b.row * max(pulls), high - b.row * min(pulls)
        high[s >= -shift] = np.inf
        return max(0., (force - high).max(), (low - force).max(), s.max() * np.abs(
            self.S).max()) / np.abs([self.g, force]).max()

    def minimise(self, holds):
        """The minimum with each bond on the first or on the last piece of its law."""
        Q, g = self.S.copy(), self.g.copy()
        for is_whole, b in zip(holds, self.bonds):
            if is_whole:
                Q += b.weight * b.stiffness * np.outer(b.row, b.row)
                g -= b.weight * b.stiffness * b.held * b.row
        return quadratic(Q, g)

    def descend(self, holds):
        while True:
            s = self.minimise(holds)
            if s is None:
                return s
            after = [b.opening(s) <= b.law.threshold for b in self.bonds]
            if after == holds:
                return s
            holds = after

    def minima(self, random, most=8):
        """The least J of all choices of broken bonds if these are few, or what descents come to."""
        n = len(self.bonds)
        if n <= most:
            found = map(self.minimise, itertools.product((True, False), repeat=n))
        else:
            found = map(self.descend, [[random.random() >= q for _ in range(n)]
                                       for q in (0., 1., .2, .4, .6, .8) for _ in range(3)])
        return [s for s in found if s is not None]

    def largest_von_mises(self, u):
        """Of the mean stresses of cells."""
        (C, expansion), largest = self.material(), 0.
        heat = field(self.of.get("Loads/Temperature change", "0"))
        for cell in self.cells:
            of_cell, stress = u.reshape(-1, 2)[cell].ravel(), np.zeros(4)
            for weight, l in STRAIN[self.degree]:
                B, _, p, _ = self.at_point(cell, l)
                stress += weight * C @ (B @ of_cell - expansion * heat(p))
            rest = stress[:3] - stress[:3].mean()
            largest = max(largest, np.sqrt(1.5 * (rest @ rest + 2 * stress[3]**2)))
        return largest

    def mean(self, u, name):
        return sum(w * phi @ u.reshape(-1, 2)[nodes] for nodes, phi, w, _, _ in self.on(
            name)) / self.area(name)


def quadratic(Q, g):
    """min 1/2 s'Q s - g's for s <= 0 by active sets; None if there is none."""
    held, noise = np.zeros(len(g), bool), 1e-13 * np.abs(g).max(initial=0.)
    for k in range(60 + 4 * len(g)):
        loose, s = np.flatnonzero(~held), np.zeros(len(g))
        A = Q[np.ix_(loose, loose)]
        if len(loose) and np.linalg.eigvalsh(A)[0] < 1e-11 * np.diag(Q).max():
            return None
        s[loose] = np.linalg.solve(A, g[loose])
        wrong = np.flatnonzero(np.where(held, g - Q @ s < -noise,
                                        s > 1e-13 * np.abs(s).max(initial=0.)))
        if not len(wrong):
            return np.minimum(s, 0.)
        held[wrong if k < 30 else wrong[-1:]] ^= True
    return None
