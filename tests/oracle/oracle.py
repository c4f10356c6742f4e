# SPDX-License-Identifier: LGPL-2.1-or-later
"""Finite elements of a body and its bonds that share nothing with the program: from the entries
of a scene and a mesh of simplices to K and f, frames and supports, the problem of the contact
nodes and its minima. In 2D, in 3D and of revolution (x is the radius then), of degree 1 or, in
2D, 2; in 50 digits or in doubles. J is the least where each bond is on the branch that gives the
least; with few bonds all choices of branches are tried."""

import collections
import decimal
import functools
import itertools
import math
import re

import numpy as np

LARGEST_STATES = 1024
decimal.getcontext().prec = 50
EXACT = decimal.Decimal
ZERO, ONE = EXACT(0), EXACT(1)
EPSILON = EXACT(2) ** -52
SUPPORTS, LAW = "Boundary conditions/", "Contact law/"
EDGES = ((0, 1), (1, 2), (2, 0))


# ------------------------------------------------------------------ algebra


def dot(a, b):
    """The sum of products."""
    return sum((x * y for x, y in zip(a, b)), 0 * a[0] if len(a) else 0)


def is_exact(array):
    return array.dtype == object


def solve(Q, g):
    """Symmetric and definite, for one or for several right sides."""
    if not is_exact(Q):
        return np.linalg.solve(Q, g)
    n, rows = len(Q), np.column_stack([Q, g])
    for k in range(n):
        for i in range(k + 1, n):
            if rows[i, k]:
                rows[i, k:] = rows[i, k:] - rows[i, k] / rows[k, k] * rows[k, k:]
    for k in reversed(range(n)):
        rows[k, n:] = (rows[k, n:] - rows[k, k + 1:n] @ rows[k + 1:, n:]) / rows[k, k]
    return rows[:, n:].reshape(np.shape(g))


def minimise_convex(Q, g, held=None):
    """min 1/2 s'Q s - g's for s <= 0: all that is wrong is exchanged while fewer and fewer are
    wrong, else the last one alone, which ends. None in doubles if there is none."""
    n, rounding = len(g), EXACT("1e-25") if is_exact(Q) else 1e-13
    noise = rounding * max(map(abs, g), default=0)
    held = np.array(held if held else [False] * n, bool)
    least, patience = n + 1, 3
    for _ in range(1000):
        loose, s = np.flatnonzero(~held), 0 * g
        A = Q[np.ix_(loose, loose)]
        if not is_exact(Q) and len(loose) and (np.linalg.eigvalsh(A)[0] < 1e-11 * np.diag(Q).max()):
            return None
        s[loose] = solve(A, g[loose])
        beyond, force = rounding * max(map(abs, s), default=0), g - Q @ s
        wrong = [i for i in range(n) if (force[i] < -noise if held[i] else s[i] > beyond)]
        if not wrong:
            return np.minimum(s, 0 * s)
        patience = 3 if len(wrong) < least else patience - 1
        least = min(least, len(wrong))
        held[wrong if patience > 0 else wrong[-1:]] ^= True
    raise ArithmeticError("the active set method does not end")


def determinant(rows):
    """Of two or three."""
    if len(rows) == 2:
        return rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    return sum(rows[0][k] * (rows[1][k - 2] * rows[2][k - 1]
                             - rows[1][k - 1] * rows[2][k - 2]) for k in range(3))


def inverse(rows):
    """Of a small matrix."""
    n, whole = len(rows), determinant(rows)
    unit = [[int(i == j) for j in range(n)] for i in range(n)]
    return np.array([[determinant([*rows[:j], e, *rows[j + 1:]]) / whole for j in range(n)]
                     for e in unit])


def root(x):
    return x.sqrt() if isinstance(x, EXACT) else math.sqrt(x)


def normalised(vector):
    return vector / root(dot(vector, vector))


def without(vector, directions):
    """What is left of a vector across orthonormal directions."""
    for direction in directions:
        vector = vector - dot(vector, direction) * direction
    return vector


def is_long(vector):
    """Of a vector that is a part of a unit vector, whether it is no rounding."""
    return dot(vector, vector) > 1e-14


# ------------------------------------------------------------------ quadrature


@functools.lru_cache
def gauss(n):
    """Weights and barycentric coordinates on an edge, by Newton's method."""
    rule = []
    for k in range(n):
        x = EXACT(-math.cos(math.pi * (k + .75) / (n + .5)))
        for _ in range(8):
            before, p = ONE, x
            for m in range(2, n + 1):
                before, p = p, ((2 * m - 1) * x * p - (m - 1) * before) / m
            slope = n * (x * p - before) / (x * x - 1) if n > 1 else ONE
            x -= p / slope
        rule.append((1 / ((1 - x * x) * slope * slope), [(1 - x) / 2, (1 + x) / 2]))
    return rule


def symmetric_rule(n, *orbits):
    """Weights and barycentric coordinates of (weight, all but one of n coordinates)."""
    return [(w, [a if j != k else 1 - (n - 1) * a for j in range(n)])
            for w, a in orbits for k in range(n)]


@functools.lru_cache
def rule(n, name="gauss 3"):
    """Of a simplex of n vertices; the default is exact to degree 5, in tetrahedra 2."""
    if name in ("midpoint", "gauss 1"):
        return [(ONE, [ONE / n] * n)]
    if n == 2:
        return gauss(int(name.split()[1]))
    if n == 4:
        return symmetric_rule(4, (ONE / 4, (5 - EXACT(5).sqrt()) / 20))
    # Of degree 4 and 5 (Dunavant; Radon).
    root, fifteen = EXACT(10).sqrt(), EXACT(15).sqrt()
    a, w = (38 - 44 * EXACT("0.4").sqrt()).sqrt(), (213125 - 53320 * root).sqrt()
    if name == "gauss 2":
        return symmetric_rule(3, *(((620 + k * w) / 3720, (8 - root + k * a) / 18)
                                   for k in (1, -1)))
    return [(EXACT(9) / 40, [ONE / 3] * 3)] + symmetric_rule(
        3, *(((155 + k * fifteen) / 1200, (6 + k * fifteen) / 21) for k in (1, -1)))


def shapes(degree, l):
    """The basis functions of a simplex, and their derivatives by barycentric coordinates."""
    n, unit = len(l), np.eye(len(l), dtype=int)
    if degree == 1:
        return l, unit
    pairs = EDGES if n == 3 else EDGES[:1]
    return (np.array([*(l * (2 * l - 1)), *(4 * l[i] * l[j] for i, j in pairs)]),
            np.array([*((4 * l - 1)[:, None] * unit),
                      *(4 * (l[i] * unit[j] + l[j] * unit[i]) for i, j in pairs)]))


def on_contact(degree, l):
    """The functions of contact, which are not negative."""
    return l if degree == 1 else np.array([l[0]**2, l[1]**2, 2 * l[0] * l[1]])


# ------------------------------------------------------------------ bodies


class Bond:
    """Of a point of the quadrature: its share of the boundary; how the trace u_nu - g depends on
    the contact nodes, and whether on vertices that are held as well; its law, a polygon of
    tractions over the opening, by pieces, and for laws of springs (stiffness, energy) of each."""

    def __init__(self, weight, where, polygon):
        self.weight, self.where, self.threshold = weight, where, polygon[-1][0]
        self.nodes, self.constant, self.is_held = [], 0, False
        self.pieces, self.branches, self.kinks, energy = [], [], [], 0 * weight
        for (a, t), (b, w) in zip(polygon, polygon[1:]):
            if b > a:
                slope = (w - t) / (b - a)
                self.pieces.append((a, b, t, slope, energy))
                self.branches.append((weight * slope, weight * (energy - slope * a * a / 2)))
                self.kinks.append(-b)
                energy += (t + w) / 2 * (b - a)
        self.branches.append((0 * weight, weight * energy))

    def trace(self, s):
        return self.constant + sum(phi * s[i] for i, phi in self.nodes)

    def branch(self, trace):
        """The number of the piece at a trace."""
        return next((k for k, (_, b, *_) in enumerate(self.pieces) if -trace <= b),
                    len(self.pieces))

    def energy(self, trace):
        opening, k = max(-trace, 0), self.branch(trace)
        if k == len(self.pieces):
            return self.branches[-1][1]
        a, _, t, slope, energy = self.pieces[k]
        return self.weight * (energy + (opening - a) * (t + slope * (opening - a) / 2))

    def pull(self, trace):
        """Of the bond on the body, along the normal: not positive."""
        opening, k = max(-trace, 0), self.branch(trace)
        if k == len(self.pieces) or not opening:
            return 0 * self.weight
        a, _, t, slope, _ = self.pieces[k]
        return -self.weight * (t + slope * (opening - a))


class Face:
    """Of the boundary: its nodes, measure, middle and outward normal."""

    def __init__(self, points, vertices, nodes, opposite):
        self.nodes, at = nodes, [points[v] for v in vertices]
        edges, dim = [p - at[0] for p in at[1:]], len(at)
        normal = np.array([edges[0][1], -edges[0][0]]) if dim == 2 else np.array(
            [edges[0][k - 2] * edges[1][k - 1] - edges[0][k - 1] * edges[1][k - 2]
             for k in range(3)])
        self.measure = root(dot(normal, normal)) / (dim - 1)
        outward = -1 if dot(normal, points[opposite] - at[0]) > 0 else 1
        self.normal, self.middle = outward * normalised(normal), sum(at) / dim
        self.vertices = vertices


class Body:
    """All unknowns in the frames of their nodes: along what supports prescribe, the normals of
    contact, and the rest. Some are fixed, some free, some contact normals; u = T (w + G), w <= 0 at
    contact normals. Pairs are vertices above and below a cut, whose jumps are unknowns."""

    def __init__(self, settings, mesh, number=EXACT, pairs=()):
        self.of, self.mesh, self.number, self.pairs = settings, mesh, number, dict(pairs)
        self.dtype = object if number is EXACT else float
        self.points = [self.array([number(x) for x in p]) for p in mesh.points]
        self.dim, self.is_axis = len(self.points[0]), settings.get("Symmetry") == "axis"
        self.degree, self.is_usable = int(settings.get("Mesh/Degree", 1)), True
        self.axes = [self.array([number(int(i == j)) for j in range(self.dim)])
                     for i in range(self.dim)]
        self.add_middles()
        self.n = self.dim * len(self.points)
        opposite = {frozenset(cell[:k] + cell[k + 1:]): v for cell in mesh.simplices
                    for cell in [list(cell)] for k, v in enumerate(cell)}
        self.sides = {side: [Face(self.points, face, [*face, *(
            [self.middle[frozenset(face)]] if self.degree == 2 else [])],
                                  opposite[frozenset(face)]) for face in faces]
                      for side, faces in mesh.sides.items()}
        self.vertices = {side: {v for face in faces for v in face.nodes}
                         for side, faces in self.sides.items()}
        self.contact_faces = [(self.part_of(side, face), face) for side in self.names(
            "Contact boundary") for face in self.sides[side]]
        self.make_normals()
        self.make_frames()
        # The program refuses a part without faces.
        self.is_usable &= {*self.names("Contact boundary"), *(
            ["piece"] if "Parts/piece" in self.of else [])} <= {f for f, _ in self.contact_faces}
        if not self.is_usable:
            return
        self.make_unknowns()
        self.assemble()
        self.eliminate()
        if self.is_usable:
            self.set_loads()

    # Entries.

    def array(self, values):
        return np.array(values, self.dtype)

    def names(self, entry):
        return [x.strip() for x in self.of.get(SUPPORTS + entry, "").split(",") if x.strip()]

    def entry(self, path, name="", default="0"):
        """Of a side, or of all."""
        return self.of.get(f"{path} {name}") or self.of.get(path) or default

    def value(self, text, point):
        return eval(compiled(text), {"N": lambda x: self.number(float(x))}, dict(zip("xyz", point)))

    def values(self, text, point):
        """Of the components of a vector."""
        return self.array([self.value(part, point) for part in text.split(";")])

    def is_fixed(self, name):
        return self.entry(LAW + "Tangential displacement", name, "fixed") == "fixed"

    def part_of(self, side, face):
        """The name by which bonds of a face go."""
        of, _, condition = self.of.get("Parts/piece", "").partition(":")
        return "piece" if of == side and self.value(condition, face.middle) else side

    # Nodes and frames.

    def add_middles(self):
        self.middle, self.cells = {}, []
        for cell in self.mesh.simplices:
            edges = [frozenset((cell[i], cell[j])) for i, j in EDGES[:3 * (self.degree - 1)]]
            for edge in edges:
                if edge not in self.middle:
                    self.middle[edge] = len(self.points)
                    self.points.append(sum(self.points[v] for v in edge) / 2)
            self.cells.append([*cell, *(self.middle[edge] for edge in edges)])
        for edge, v in list(self.middle.items()):
            low = frozenset(self.pairs.get(w) for w in edge)
            if low in self.middle:
                self.pairs[v] = self.middle[low]

    def foundation_normal(self, name, face, v):
        text = self.entry(SUPPORTS + "Foundation normal", name, "")
        normal = self.values(text, face.middle) if text else face.normal
        if self.is_axis and self.points[v][0] == 0:
            normal = normal * self.array([0, 1])
        return normalised(normal)

    def make_normals(self):
        """Of the nodes of the contact boundary: those of their faces, which are joined where they
        differ by less than 31.4 degrees, and so is all that such pairs connect, to their mean
        weighted by measures."""
        at_node = collections.defaultdict(list)
        for f, (name, face) in enumerate(self.contact_faces):
            for v in face.nodes:
                at_node[v].append((f, name, face.measure, self.foundation_normal(name, face, v)))
        smooth = self.number(math.cos(math.radians(31.4)))
        self.group_of, self.normals, self.gaps = {}, {}, {}
        for v, faces in sorted(at_node.items()):
            groups = [[face] for face in faces]
            for a, b in itertools.combinations(faces, 2):
                cosine = dot(a[3], b[3])
                if abs(cosine - smooth) < .01:
                    self.is_usable = False  # rounding would say which it is
                one, other = (next(group for group in groups if any(
                    face is member for member in group)) for face in (a, b))
                if cosine > smooth and one is not other:
                    groups = [group for group in groups if group is not other]
                    one += other
            self.normals[v], self.gaps[v] = [], []
            for number, group in enumerate(groups):
                mean = normalised(sum(measure * normal for _, _, measure, normal in group))
                self.is_usable &= all(dot(mean, face[3]) >= .2 for face in group)
                self.normals[v].append(mean)
                self.gaps[v].append(min(self.value(self.entry(
                    LAW + "Initial gap", name), self.points[v]) for _, name, *_ in group))
                for f, *_ in group:
                    self.group_of[f, v] = number

    def prescribed_rows(self, v):
        """Directions at a node in which the axis or supports hold it, with the load and the
        component that are prescribed if they need not be zero."""
        if v in self.clamped:
            return [(e, None) for e in self.axes]
        rows = [(self.axes[0], None)] if self.is_axis and self.points[v][0] == 0 else []
        for side in (side for side in self.sides if v in self.vertices[side]):
            path = f"{SUPPORTS}Displacement {side}"
            rows += [(self.axes[k], (path, k)) for k, text in enumerate(
                self.of.get(path, "free").split(";")) if text.strip() != "free"]
        for side in self.names("Roller boundaries"):
            rows += [(face.normal, None) for face in self.sides[side] if v in face.nodes][:1]
        return rows

    def prescribed_value(self, component, v):
        if not component:
            return self.number(0)
        path, k = component
        return self.value(self.of[path].split(";")[k], self.points[v])

    def make_frames(self):
        """What is fixed, free or a contact normal; the rows of the inverse of a frame are the
        directions along which its unknowns are displacements."""
        dim = self.dim
        self.clamped = {v for side in self.names("Clamped boundaries") for v in self.vertices[side]}
        fixing = {v for name, face in self.contact_faces for v in face.nodes if self.is_fixed(name)}
        self.rows, self.columns, self.kinds, self.prescribed = [], [], [], {}
        self.node_of, self.contact_dofs, self.held = {}, [], set()
        for v in range(len(self.points)):
            prescribed, normals = self.prescribed_rows(v), self.normals.get(v, [])
            # u_tau = 0 and a support that is inclined to the normal leave nothing; up to 16
            # degrees from the boundary, as on polygons, it counts as along it.
            if v in fixing and len(normals) == 1 and any(
                    abs(dot(normals[0], row)) > .28 and not self.prescribed_value(component, v)
                    for row, component in prescribed):
                prescribed += [(e, None) for e in self.axes]
            if prescribed:
                self.held.add(v)
            rows, kinds, orthonormal = [], [], []

            def add(row, kind):
                left = without(row, orthonormal)
                if len(rows) == dim or not is_long(left):
                    return False
                rows.append(row)
                kinds.append(kind)
                orthonormal.append(normalised(left))
                return True

            for row, component in prescribed:
                if add(row, "fixed"):
                    if component:
                        self.prescribed[dim * v + len(rows) - 1] = component
                elif self.prescribed_value(component, v) and self.number is EXACT:
                    self.is_usable = False  # which need not be what is prescribed already
            is_held = [not is_long(without(normal, orthonormal)) for normal in normals]
            for k, normal in enumerate(normals):
                if is_held[k] or v in fixing and len(normals) > 1:
                    continue
                if not add(normal, "contact"):
                    self.is_usable = False  # too much is prescribed
                    continue
                self.node_of[v, k] = len(self.contact_dofs)
                self.contact_dofs.append(dim * v + len(rows) - 1)
            while len(rows) < dim:
                add(max((without(e, orthonormal) for e in self.axes), key=lambda e: dot(e, e)),
                    "fixed" if v in fixing else "free")
                rows[-1] = orthonormal[-1]
            self.rows.append(rows)
            self.columns.append(inverse(rows).T)
            self.kinds += kinds
        self.free_dofs = [d for d in range(self.n) if self.kinds[d] == "free"]
        self.is_usable &= bool(self.contact_dofs) or self.number is not EXACT

    def make_unknowns(self):
        """How each Cartesian component depends on the unknowns; on contact edges of degree 2 they
        are coefficients of functions that are not negative."""
        self.ends = {}
        for _, face in self.contact_faces if self.degree == 2 else ():
            a, b, v = face.nodes
            for nodes in ((v, a, b), tuple(self.pairs.get(w) for w in (v, a, b))):
                if None not in nodes:
                    self.ends[nodes[0]] = nodes[1:]

        def coefficient(v, k):
            row = {self.dim * v + i: column[k] for i, column in enumerate(self.columns[v])
                   if column[k]}
            return {**row, **coefficient(self.pairs[v], k)} if v in self.pairs else row

        self.T = []
        for v, k in itertools.product(range(len(self.points)), range(self.dim)):
            row = coefficient(v, k)
            if v in self.ends:
                row = {d: x / 2 for d, x in row.items()}
                for d, x in (item for end in self.ends[v] for item in coefficient(end, k).items()):
                    row[d] = row.get(d, 0) + x / 4
            self.T.append(row)

    # K and f.

    def material(self):
        """C on the strains xx, yy, zz (around the axis), 2 xy, 2 xz, 2 yz as far as there are
        such, and the stresses that a change of temperature by 1 would take away."""
        number, pairs = self.number, ((0, 1), (0, 2), (1, 2))[:3 if self.dim == 3 else 1]
        if "Material/Young modulus" in self.of:
            E, nu = (number(float(self.of["Material/" + x]))
                     for x in ("Young modulus", "Poisson ratio"))
            E, nu, G = [E] * 3, [nu] * 3, [E / (2 + 2 * nu)] * 3
        else:
            E, nu, G = ([number(float(x)) for x in self.of["Material/" + name].split(",")]
                        for name in ("Young moduli", "Poisson ratios", "Shear moduli"))
        expansion = [number(float(x)) for x in self.of.get(
            "Material/Thermal expansion", "0").split(",")]
        expansion = self.array((3 * expansion)[:3] + [number(0)] * len(pairs))
        S = self.array(np.diag(E + G[:len(pairs)]) * 0)
        for k, modulus in enumerate(E + G[:len(pairs)]):
            S[k, k] = 1 / modulus
        for (i, j), ratio in zip(((0, 1), (0, 2), (1, 2)), nu):
            S[i, j] = S[j, i] = -ratio / E[i]
        kept = list(range(len(S)) if self.dim == 3 or self.is_axis else (0, 1, 3))
        if self.dim == 2 and not self.is_axis and self.of.get(
                "Material/Hypothesis", "plane stress") == "plane stress":
            S, expansion, kept = S[np.ix_(kept, kept)], expansion[kept], [0, 1, 2]
        C = solve(S, self.array(np.eye(len(S), dtype=int)))
        angle = math.radians(float(self.of.get("Material/Axis angle", 0)))
        if angle:
            # To strains along the material's axes.
            c, s = math.cos(angle), math.sin(angle)
            R = np.array([[c * c, s * s, 0, c * s], [s * s, c * c, 0, -c * s], [0, 0, 1, 0],
                          [-2 * c * s, 2 * c * s, 0, c * c - s * s]])
            C, expansion = R.T @ C @ R, np.linalg.solve(R, expansion)
        return C[np.ix_(kept, kept)], (C @ expansion)[kept]

    def around(self, point):
        """The way around the axis."""
        return 2 * math.pi * point[0] if self.is_axis else 1

    def rule(self, *name):
        return [(self.number(w), self.array([self.number(x) for x in l])) for w, l in rule(*name)]

    def in_cell(self, cell, l):
        """Strains by the unknowns of a cell, its basis functions, the place, and volume times the
        way around."""
        dim, at = self.dim, self.array([self.points[v] for v in cell[:self.dim + 1]])
        phi, d = shapes(self.degree, l)
        rest = inverse(at[1:] - at[0]).T
        g, p = d @ np.vstack([-rest.sum(axis=0), rest]), l @ at
        shears = ((0, 1), (0, 2), (1, 2))[:3 if dim == 3 else 1]
        B = self.array(np.zeros((3 + len(shears), dim * len(phi)), int))
        for k in range(dim):
            B[k, k::dim] = g[:, k]
        if self.is_axis:
            B[2, ::2] = phi / p[0]
        for k, (i, j) in enumerate(shears, 3):
            B[k, i::dim], B[k, j::dim] = g[:, j], g[:, i]
        size = abs(determinant(at[1:] - at[0])) / math.factorial(dim)
        return B if dim == 3 or self.is_axis else B[[0, 1, 3]], phi, p, size * self.around(p)

    def strains(self, cell):
        """With exact weights for strains of degree 1, of which the energy is integrated."""
        third = self.number(1) / 3
        if self.degree == 1:
            return [(1, self.in_cell(cell, self.array([1 / self.number(self.dim + 1)]
                                                      * (self.dim + 1))))]
        return [(third, self.in_cell(cell, self.array(
            [third / 2 if j != k else 2 * third for j in range(3)]))) for k in range(3)]

    def dofs(self, nodes):
        return [self.dim * v + k for v in nodes for k in range(self.dim)]

    def assemble(self):
        """K in Cartesian components and A in the frames, dictionaries for rows."""
        C, _ = self.material()
        self.K = [{} for _ in range(self.n)]
        for cell in self.cells:
            dofs, matrix = self.dofs(cell), 0
            for weight, (B, _, _, size) in self.strains(cell):
                matrix = matrix + weight * size * (B.T @ C @ B)
            for d, row in zip(dofs, matrix):
                of_d = self.K[d]
                for e, x in zip(dofs, row):
                    of_d[e] = of_d.get(e, 0) + x
        self.A = [{} for _ in range(self.n)]
        for of_d, row in zip(self.T, self.K):
            half = collections.defaultdict(int)
            for e, x in row.items():
                for j, t in self.T[e].items():
                    half[j] += x * t
            for i, t in of_d.items():
                of_i = self.A[i]
                for j, x in half.items():
                    of_i[j] = of_i.get(j, 0) + t * x

    def on(self, face):
        """Points of a face: functions, weight, place."""
        at = self.array([self.points[v] for v in face.vertices])
        for w, l in self.rule(self.dim):
            p = l @ at
            yield shapes(self.degree, l)[0], w * face.measure * self.around(p), p

    def area(self, name):
        return sum(w for face in self.sides[name] for _, w, _ in self.on(face))

    def cartesian_loads(self):
        """Tractions, pressures, total forces and body forces, and what temperatures do, whose sum
        is zero."""
        loads, (_, heat) = self.array(np.zeros(self.n, int)), self.material()
        for name in self.sides:
            traction, pressure, force = (self.of.get(f"Loads/{kind} {name}") for kind in (
                "Traction", "Pressure", "Force"))
            for face in self.sides[name] if traction or pressure or force else ():
                dofs = self.dofs(face.nodes)
                for phi, weight, p in self.on(face):
                    t = (self.values(traction, p) if traction else
                         -self.value(pressure, p) * face.normal if pressure else
                         self.values(force, p) / self.area(name))
                    loads[dofs] += weight * np.kron(phi, t)
        force, change = self.of.get("Loads/Body force"), self.of.get("Loads/Temperature change")
        for cell in self.cells if force or change else ():
            dofs = self.dofs(cell)
            for weight, l in self.rule(self.dim + 1) if force else ():
                _, phi, p, size = self.in_cell(cell, l)
                loads[dofs] += weight * size * np.kron(phi, self.values(force, p))
            for weight, (B, _, p, size) in self.strains(cell) if change else ():
                loads[dofs] += weight * size * self.value(change, p) * (B.T @ heat)
        return loads

    # The problem of the contact nodes.

    def eliminate(self):
        """Condenses A onto the contact normals: of each free unknown its pivot and the others in
        its row. Those of one end of the body come first."""
        places = np.array(self.points, float)
        axis = int(np.argmax(np.ptp(places, axis=0)))
        order = sorted(self.free_dofs, key=lambda d: places[d // self.dim, axis])
        self.order = order + self.contact_dofs
        place = {d: k for k, d in enumerate(self.order)}
        rows = [{place[j]: a for j, a in self.A[d].items() if place.get(j, -1) >= place[d]}
                for d in self.order]
        self.eliminated, n = [], len(order)
        for k in range(n):
            row = rows[k]
            pivot = row.pop(k)
            if not self.clamped and pivot < self.number(1e-12) * self.A[order[k]][order[k]]:
                self.is_usable = False  # nothing holds the body
                return
            self.eliminated.append((pivot, row))
            items = sorted(row.items())
            for at, (i, value) in enumerate(items):
                factor, target = value / pivot, rows[i]
                for j, other in items[at:]:
                    target[j] = target.get(j, 0) - factor * other
        self.S = self.array([[rows[min(i, j)].get(max(i, j), self.number(0))
                              for j in range(n, len(rows))] for i in range(n, len(rows))])
        self.S = self.S.reshape((len(self.contact_dofs),) * 2)
        # Rigid motions that are free have the stiffness of what rounding did to places.
        self.weak = ZERO if self.clamped or self.number is not EXACT else EXACT("1e-14") * max(
            self.A[d][d] for d in self.contact_dofs)

    def set_loads(self, factor=1, displacement_factor=None, gap=1):
        """f, G, and what is left of the problem when the free unknowns are eliminated:
        1/2 s'S s - g's + c for s <= 0."""
        moved = factor if displacement_factor is None else displacement_factor
        self.unit_loads = self.cartesian_loads()
        self.applied = factor * self.unit_loads
        self.f = self.array(np.zeros(self.n, int))
        for row, x in zip(self.T, self.applied):
            for d, t in row.items():
                self.f[d] += t * x
        self.G = self.array(np.zeros(self.n, int))
        for d, component in self.prescribed.items():
            self.G[d] = moved * self.prescribed_value(component, d // self.dim)
        for (v, number), i in self.node_of.items():
            self.G[self.contact_dofs[i]] = gap * self.gaps[v][number]
        self.make_bonds(gap)
        of_G = self.multiply(self.G)
        self.load = [self.f[d] - of_G[d] for d in self.order]
        self.constant = self.G @ of_G / 2 - self.f @ self.G
        self.condensed_constant = self.number(0)
        for k, (pivot, row) in enumerate(self.eliminated):
            by_pivot = self.load[k] / pivot
            self.condensed_constant -= self.load[k] * by_pivot / 2
            for j, value in row.items():
                self.load[j] -= by_pivot * value
        self.g = self.array(self.load[len(self.eliminated):])

    def to_cartesian(self, u, v):
        """The displacement of a node, of unknowns that are displacements."""
        return self.array([sum((t * u[d] for d, t in self.T[self.dim * v + k].items()),
                               self.number(0)) for k in range(self.dim)])

    def held_trace(self, v, number, gap=1):
        """u_nu - g of a node where supports prescribe u_nu."""
        at = self.G[self.dim * v:self.dim * (v + 1)]
        return dot(at @ self.columns[v], self.normals[v][number]) - gap * self.gaps[v][number]

    def pushes_into_foundation(self):
        """Whether a movement does so somewhere."""
        return any(self.held_trace(v, number) > 0 for v, normals in self.normals.items()
                   for number in range(len(normals)) if (v, number) not in self.node_of)

    def polygon(self, name, place):
        """Of the law at a place."""
        a, M, t, energy = (self.value(self.entry(LAW + entry, name), place) for entry in (
            "Bond stiffness", "Bond threshold", "Bond strength", "Fracture energy"))
        kind = self.of.get(LAW + "Law", "winkler")
        if kind == "winkler":
            return (0 * a, 0 * a), (M, a * M), (M, 0 * a)
        if kind == "bilinear":
            return (0 * a, 0 * a), (t / a, t), (2 * energy / t, 0 * a)
        factor = self.value(self.of.get(LAW + "Traction factor", "1"), place)
        return tuple((p, factor * t) for p, t in ([self.number(float(x)) for x in point.split(":")]
                                                  for point in self.of[LAW + "Curve"].split(",")))

    def make_bonds(self, gap=1):
        """Points with the same trace and law are one, as their sums would only make more states.
        Those of a node are one as well, of springs with the mean stiffness and energy."""
        sums, name = {}, self.of.get(LAW + "Quadrature", "nodal")
        law = self.of.get(LAW + "Law", "winkler")
        for f, (side, face) in enumerate(self.contact_faces if law != "none" else ()):
            at = self.array([self.points[v] for v in face.vertices])
            if name == "nodal":
                points = [(sum(w * l[k] * self.around(l @ at) for w, l in self.rule(self.dim)),
                           [int(k == i) for i in range(self.dim)], at[k]) for k in range(self.dim)]
            else:
                points = [(w * self.around(l @ at), on_contact(self.degree, l), l @ at)
                          for w, l in self.rule(self.dim, name)]
            for weight, phis, place in points:
                where = tuple(sorted(((v, self.group_of[f, v]), phi)
                                     for v, phi in zip(face.nodes, phis) if phi))
                polygon = self.polygon(side, place)
                mean = len(where) == 1 and law == "winkler"
                sum_of = sums.setdefault((where, None if mean else polygon), [0, 0, 0, polygon])
                for k, value in enumerate((1, polygon[1][1] / polygon[1][0],
                                           polygon[1][1] * polygon[1][0])
                                          if law == "winkler" else (1,)):
                    sum_of[k] += weight * face.measure * value
        self.bonds = []
        for (where, of), (weight, a, energy, polygon) in sums.items():
            if of is None:
                M = root(energy / a)
                polygon = (0 * a, 0 * a), (M, a / weight * M), (M, 0 * a)
            bond = Bond(weight, where, polygon)
            bond.nodes = [(self.node_of[at], phi) for at, phi in where if at in self.node_of]
            held = [phi * self.held_trace(*at, gap) for at, phi in where if at not in self.node_of]
            bond.constant, bond.is_held = sum(held, self.number(0)), bool(held)
            self.bonds.append(bond)
        # What the bonds of a contact node can bear.
        self.strengths = [self.number(0)] * len(self.contact_dofs)
        for bond in self.bonds:
            pull = max(-bond.pull(kink) for kink in bond.kinks)
            for i, phi in bond.nodes:
                self.strengths[i] += phi * pull

    # Values at points.

    def multiply(self, u):
        """A u."""
        return self.array([sum((a * u[j] for j, a in row.items()), self.number(0))
                           for row in self.A])

    def rounding(self, u):
        """What displacements that are rounded to double leave of A u."""
        return [EPSILON * sum((abs(a * u[j]) for j, a in row.items()), ZERO) for row in self.A]

    def strain_forces(self, u):
        """K u."""
        return self.array([sum(x * u[e] for e, x in row.items()) for row in self.K])

    def traces(self, u):
        """w at the contact normals."""
        return [u[d] - self.G[d] for d in self.contact_dofs]

    def adhesion(self, s):
        """The energy of all bonds."""
        return sum((bond.energy(bond.trace(s)) for bond in self.bonds), self.number(0))

    def functional(self, u):
        """J, and the size of what it is a sum of."""
        strain, work = u @ self.multiply(u) / 2, self.f @ u
        bonds = self.adhesion(self.traces(u))
        return strain - work + bonds, strain + abs(work) + bonds + abs(self.constant)

    def condensed_functional(self, s):
        """J where all free unknowns are in equilibrium."""
        return s @ self.S @ s / 2 - self.g @ s + (
            self.constant + self.condensed_constant) + self.adhesion(s)

    def size(self, s):
        """Of what that is a sum of."""
        return abs(self.constant + self.condensed_constant) + s @ self.S @ s / 2 + abs(
            self.g @ s) + self.adhesion(s)

    def displacement(self, s):
        """Where all free unknowns are in equilibrium, in Cartesian components."""
        w, at = self.G.copy(), dict(enumerate(s, len(self.eliminated)))
        w[self.contact_dofs] += s
        for k in reversed(range(len(self.eliminated))):
            pivot, row = self.eliminated[k]
            at[k] = (self.load[k] - sum(x * at[j] for j, x in row.items())) / pivot
            w[self.order[k]] = at[k]
        return np.concatenate([self.to_cartesian(w, v) for v in range(len(self.points))])

    def law_violation(self, s, force, shift, rounding):
        """The largest distance of a force from what bonds and foundation allow at displacements
        within shift of s."""
        lower, upper = (self.array(np.zeros(len(s), int)) for _ in range(2))
        for bond in self.bonds:
            trace = bond.trace(s)
            pulls = [bond.pull(t) for t in (trace - shift, trace, min(trace + shift, 0))]
            for i, phi in bond.nodes:
                lower[i] += phi * min(pulls)
                upper[i] += phi * max(pulls)
        return max([self.number(0), *(lower - force - rounding),
                    *(force[i] - upper[i] - rounding[i] for i, x in enumerate(s) if x < -shift)])

    # Minima.

    def held_weakly(self):
        """S with weak springs, which hold what nothing else holds, far away."""
        S = self.S.copy()
        if self.weak:
            S[np.diag_indices(len(S))] += self.weak
        return S

    def minimise(self, branches, held=None):
        """The minimum of the convex problem with each bond on the given branch."""
        Q, g = self.held_weakly(), self.g.copy()
        for bond, k in zip(self.bonds, branches):
            stiffness = bond.branches[k][0]
            for i, phi in bond.nodes if stiffness else ():
                g[i] -= stiffness * phi * bond.constant
                for j, psi in bond.nodes:
                    Q[i, j] += stiffness * phi * psi
        return minimise_convex(Q, g, held)

    def bonds_can_change(self):
        """Of J, the lesser of two energies: of all bonds, and of what is gained without
        foundation and bonds."""
        gain = self.g @ solve(self.held_weakly(), self.g) / 2
        return min([gain] + ([sum(bond.branches[-1][1] for bond in self.bonds)]
                             if self.bonds else []))

    def is_off(self, s):
        """Whether nothing but weak springs holds the body."""
        return s is None or bool(self.weak) and (
            self.weak * max(map(abs, s)) > EXACT("1e-5") * max(map(abs, self.g)))

    def branches_at(self, s):
        """Of each bond."""
        return [bond.branch(bond.trace(s)) for bond in self.bonds]

    def descend(self, branches):
        """Bonds are put on their branch in turn, J falls."""
        while True:
            s = self.minimise(branches)
            if self.is_off(s) or self.branches_at(s) == branches:
                return s
            branches = self.branches_at(s)

    def from_rest(self):
        """What the body at rest comes to: there gaps are open."""
        return self.descend(self.branches_at([-self.G[d] for d in self.contact_dofs]))

    def all_minima(self, draw):
        """Minima of J. Each is that of the convex problem with its own branches, so with few
        bonds the least is among these, and true is returned with them; else they are what
        descents come to."""
        choices = [range(len(bond.branches)) if bond.nodes else [bond.branch(bond.constant)]
                   for bond in self.bonds]
        if math.prod(map(len, choices)) > LARGEST_STATES:
            starts = [[c[-1] for c in choices], [c[0] for c in choices]]
            for k in range(12):
                broken, starts = False, starts + [[]]
                for choice in choices:
                    broken ^= draw.chance(0.2 if k < 8 else 0.5)
                    starts[-1].append(choice[-1 if broken else 0])
            return [s for s in map(self.descend, starts) if not self.is_off(s)], False
        minima, held = [], None
        for branches in itertools.product(*choices):
            s = self.minimise(branches, held)
            if self.is_off(s):
                continue
            held = [not x for x in s]
            if self.branches_at(s) == list(branches):
                minima.append(s)
        return minima, True


@functools.lru_cache(None)
def compiled(text):
    """An expression of x, y and z, in numbers of any type."""
    numbers = re.sub(r"(?<![\w.])(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+)", r"N(\1)",
                     text.strip().replace("^", "**"))
    return compile(numbers, text, "eval")
