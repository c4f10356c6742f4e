# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a scene of random_scenes.py has for a minimum, by code that shares nothing
with the solver: assembly, elimination, law and minima of its own, in 50 digits. J is
the least where each bond is on the branch that gives the least; with few bonds all
choices of branches are tried.
"""

import collections
import decimal
import itertools
import math
import operator

from random_scenes import Scene, determinant, volume

LARGEST_STATES = 1024
decimal.getcontext().prec = 50
EXACT = decimal.Decimal
ZERO, ONE = EXACT(0), EXACT(1)
EPSILON = EXACT(2) ** -52
ROUNDING = EXACT("1e-25")


def dot(a, b):
    """The sum of products."""
    return sum(map(operator.mul, a, b), ZERO)


def solve(Q, g):
    """Symmetric and definite."""
    rows = [list(row) + [value] for row, value in zip(Q, g)]
    n = len(rows)
    for k in range(n):
        for i in range(k + 1, n):
            factor = rows[k][i] / rows[k][k]
            if factor:
                rows[i][i:] = [x - factor * y
                               for x, y in zip(rows[i][i:], rows[k][i:])]
    x = [ZERO] * n
    for k in reversed(range(n)):
        x[k] = (rows[k][n] - dot(rows[k][k + 1:n], x[k + 1:])) / rows[k][k]
    return x


def minimise_convex(Q, g, held=None):
    """min 1/2 s'Q s - g's for s <= 0: all that is wrong is exchanged while fewer
    and fewer are wrong, else the last one alone, which ends."""
    n, noise = len(g), ROUNDING * max(map(abs, g), default=ZERO)
    held = list(held) if held else [False] * n
    least, patience = n + 1, 3
    for _ in range(1000):
        loose = [i for i in range(n) if not held[i]]
        values = solve([[Q[i][j] for j in loose] for i in loose],
                       [g[i] for i in loose])
        s = [ZERO] * n
        for i, value in zip(loose, values):
            s[i] = value
        beyond = ROUNDING * max(map(abs, s))
        wrong = [i for i in range(n) if
                 (g[i] - dot(Q[i], s) < -noise if held[i] else s[i] > beyond)]
        if not wrong:
            return [min(x, ZERO) for x in s]
        patience = 3 if len(wrong) < least else patience - 1
        least = min(least, len(wrong))
        for i in wrong if patience > 0 else wrong[-1:]:
            held[i] = not held[i]
    raise ArithmeticError("the active set method does not end")


def unit(n):
    """Rows of the unit matrix."""
    return [[ONE if i == j else ZERO for j in range(n)] for i in range(n)]


def inverse(rows):
    """Of a small matrix, by Cramer's rule."""
    n, whole = len(rows), determinant(rows)
    return [[determinant(rows[:j] + [e] + rows[j + 1:]) / whole for j in range(n)]
            for e in unit(n)]


def normalised(vector):
    """Of length 1."""
    length = dot(vector, vector).sqrt()
    return [x / length for x in vector]


def without(vector, directions):
    """What is left of a vector across orthonormal directions."""
    for direction in directions:
        part = dot(vector, direction)
        vector = [x - part * d for x, d in zip(vector, direction)]
    return vector


def is_long(vector):
    """Of a vector that is a part of a unit vector, whether it is no rounding."""
    return dot(vector, vector) > EXACT("1e-14")


def symmetric_rule(*orbits):
    """Weights and barycentric coordinates of (weight, two of three coordinates)."""
    return [(w, [a if j != k else 1 - 2 * a for j in range(3)])
            for w, a in orbits for k in range(3)]


def rules(dim):
    """Of the quadratures of a face: weights and barycentric coordinates."""
    middle = [(ONE, [ONE / dim] * dim)]
    two, three = ONE / EXACT(3).sqrt(), EXACT("0.6").sqrt()
    if dim == 2:
        gauss_2 = [(ONE / 2, [(1 - x) / 2, (1 + x) / 2]) for x in (-two, two)]
        gauss_3 = [(EXACT(w) / 18, [(1 - x) / 2, (1 + x) / 2])
                   for w, x in ((5, -three), (8, ZERO), (5, three))]
    else:
        # Of degree 4 and 5 (Dunavant; Radon).
        root, fifteen = EXACT(10).sqrt(), EXACT(15).sqrt()
        a, w = ((38 - 44 * EXACT("0.4").sqrt()).sqrt(),
                (213125 - 53320 * root).sqrt())
        gauss_2 = symmetric_rule(*(((620 + k * w) / 3720, (8 - root + k * a) / 18)
                                   for k in (1, -1)))
        gauss_3 = [(EXACT(9) / 40, middle[0][1])] + symmetric_rule(
            *(((155 + k * fifteen) / 1200, (6 + k * fifteen) / 21) for k in (1, -1)))
    return {"nodal": [(ONE / dim, phi) for phi in unit(dim)], "midpoint": middle,
            "gauss 1": middle, "gauss 2": gauss_2, "gauss 3": gauss_3}


class BondPoint:
    """A quadrature point: its share of the boundary, how the trace depends on
    the contact nodes, whether on vertices that are held as well, and
    (stiffness, energy) of each branch of its law."""

    def __init__(self, weight, nodes, constant, is_held, stiffness, threshold,
                 steps):
        self.nodes, self.constant, self.is_held = nodes, constant, is_held
        self.branches, self.kinks = [], []
        energy = ZERO
        following = [k for k, _ in steps[1:]] + [ZERO]
        for (k, m), after in zip(steps, following):
            k, after, m = k * stiffness, after * stiffness, m * threshold
            self.branches.append((weight * k, weight * energy))
            self.kinks.append(-m)
            energy += (k - after) * m * m / 2
        self.branches.append((ZERO, weight * energy))

    def trace(self, s):
        """u_nu - g there."""
        return self.constant + sum((phi * s[i] for i, phi in self.nodes), ZERO)

    def energies(self, trace):
        """Of all branches at a trace."""
        return [k * trace * trace / 2 + energy for k, energy in self.branches]

    def branch(self, trace):
        """The number of the branch that is the least."""
        energies = self.energies(trace)
        return energies.index(min(energies))

    def pull(self, trace):
        """j_1' there."""
        return self.branches[self.branch(trace)][0] * trace


class Face:
    """Of the boundary: its vertices, measure and outward normal."""

    def __init__(self, points, face, opposite):
        self.vertices = face
        at = [points[v] for v in face]
        edges = [[x - y for x, y in zip(p, at[0])] for p in at[1:]]
        dim = len(at)
        normal = [(-1) ** k * determinant(
            [edge[:k] + edge[k + 1:] for edge in edges])
            if dim == 3 else (edges[0][1], -edges[0][0])[k] for k in range(dim)]
        size = dot(normal, normal).sqrt()
        self.measure = size / (dim - 1)
        if dot(normal, points[opposite]) > dot(normal, at[0]):
            size = -size
        self.normal = [x / size for x in normal]


class Body:
    """All unknowns in the frames of their vertices: along the normals of contact,
    what supports prescribe, and the rest. Some are fixed, some free, some contact
    normals; u = w + G, w <= 0 at contact normals."""

    def __init__(self, scene):
        self.scene, self.dim = scene, scene.dim
        self.is_usable = True
        self.points = [tuple(map(EXACT, p)) for p in scene.mesh.points]
        self.n = self.dim * len(self.points)
        self.faces = {side: [Face(self.points, *face) for face in faces]
                      for side, faces in scene.mesh.sides.items()}
        self.contact_faces = [(name, Face(self.points, *face))
                              for name, *face in scene.contact_faces]
        E, nu = EXACT(scene.E), EXACT(scene.nu)
        self.mu = E / (2 * (1 + nu))
        self.lame = (E * nu / (1 - nu * nu) if scene.is_plane_stress
                     else E * nu / ((1 + nu) * (1 - 2 * nu)))
        self.make_normals()
        self.make_frames()
        # The program refuses a part without faces.
        self.is_usable &= bool(self.contact_dofs) and (
            {name for name, _ in self.contact_faces} >= set(scene.bonds))
        if not self.is_usable:
            return
        self.assemble_stiffness()
        self.eliminate()
        if self.is_usable:
            self.set_loads()

    # Frames and kinds of unknowns.

    def make_normals(self):
        """Of the vertices of the contact boundary: those of their faces, which are
        joined where they differ by less than 31.4 degrees, and so is all that such
        pairs connect, to their mean weighted by measures."""
        at_vertex = collections.defaultdict(list)
        for f, (_, face) in enumerate(self.contact_faces):
            for v in face.vertices:
                at_vertex[v].append(f)
        smooth = EXACT(math.cos(math.radians(31.4)))
        self.group_of, self.normals, self.gaps = {}, {}, {}
        for v, faces in sorted(at_vertex.items()):
            groups = [[f] for f in faces]
            for f, g in itertools.combinations(faces, 2):
                cosine = dot(self.contact_faces[f][1].normal,
                             self.contact_faces[g][1].normal)
                if abs(cosine - smooth) < EXACT("0.01"):
                    self.is_usable = False  # rounding would say which it is
                one, = (group for group in groups if f in group)
                other, = (group for group in groups if g in group)
                if cosine > smooth and one is not other:
                    groups.remove(other)
                    one += other
            self.normals[v], self.gaps[v] = [], []
            for number, group in enumerate(groups):
                at = [self.contact_faces[f] for f in group]
                mean = normalised([sum((face.measure * face.normal[k]
                                        for _, face in at), ZERO)
                                   for k in range(self.dim)])
                if any(dot(mean, face.normal) < EXACT("0.2") for _, face in at):
                    self.is_usable = False
                self.normals[v].append(mean)
                self.gaps[v].append(min(self.scene.bonds[name].gap(self.points[v])
                                        for name, _ in at))
                for f in group:
                    self.group_of[f, v] = number

    def prescribed_rows(self, v):
        """Orthonormal directions at a vertex in which supports hold it, with the load
        and the component that are prescribed if they need not be zero."""
        scene, axes, rows = self.scene, unit(self.dim), []
        if v in self.clamped:
            return [(e, None) for e in axes]
        for side in scene.moved:
            path = "Boundary conditions/Displacement " + side
            if v in self.vertices[side]:
                rows += [(axes[k], (path, k))
                         for k, c in enumerate(scene.loads[path]) if c]
        for side in scene.rollers:
            if v in self.vertices[side]:
                rest = without(self.faces[side][0].normal, [row for row, _ in rows])
                if is_long(rest):
                    rows.append((normalised(rest), None))
        return rows

    def make_frames(self):
        """What is fixed, free or a contact normal; the rows of the inverse of a frame
        are the directions along which its unknowns are displacements."""
        scene, dim = self.scene, self.dim
        self.vertices = {side: scene.mesh.vertices([side]) for side in scene.mesh.sides}
        self.clamped = scene.mesh.vertices(scene.clamped)
        fixing = {v for name, face in self.contact_faces for v in face.vertices
                  if scene.bonds[name].is_tangential_fixed}
        self.rows, self.columns, self.kinds, self.prescribed = [], [], [], {}
        self.node_of, self.contact_dofs = {}, []
        self.held = set()
        for v in range(len(self.points)):
            prescribed = self.prescribed_rows(v)
            rows = [row for row, _ in prescribed]
            for k, (_, component) in enumerate(prescribed):
                if component:
                    self.prescribed[dim * v + k] = component
            if rows:
                self.held.add(v)
            normals = self.normals.get(v, [])
            unknown = [k for k, normal in enumerate(normals)
                       if is_long(without(normal, rows))]
            kinds = ["fixed"] * len(rows)
            rest = "fixed" if v in fixing else "free"
            if v in fixing and len(normals) > 1:
                unknown = []
            for k in unknown:
                self.node_of[v, k] = len(self.contact_dofs)
                self.contact_dofs.append(dim * v + len(rows))
                rows.append(normals[k])
                kinds.append("contact")
            self.add_frame(rows, kinds, rest)
        self.free_dofs = [d for d in range(self.n) if self.kinds[d] == "free"]

    def add_frame(self, rows, kinds, rest):
        """Completes the directions of a vertex by those across all of them."""
        orthonormal = []
        for row in rows:
            left = without(row, orthonormal)
            if len(orthonormal) == self.dim or not is_long(left):
                self.is_usable = False  # too much is prescribed
                rows, kinds = [], []
                break
            orthonormal.append(normalised(left))
        while len(rows) < self.dim:
            row = normalised(max((without(e, orthonormal) for e in unit(self.dim)),
                                 key=lambda e: dot(e, e)))
            orthonormal.append(row)
            rows, kinds = rows + [row], kinds + [rest]
        self.rows.append(rows)
        self.columns.append(list(zip(*inverse(rows))))
        self.kinds += kinds

    # Bonds.

    def to_cartesian(self, u, v):
        """The displacement of a vertex."""
        of_v = u[self.dim * v:self.dim * (v + 1)]
        return [dot(of_v, components) for components in zip(*self.columns[v])]

    def held_trace(self, v, number):
        """u_nu - g of a vertex where supports prescribe u_nu."""
        return dot(self.to_cartesian(self.G, v),
                   self.normals[v][number]) - self.gaps[v][number]

    def pushes_into_foundation(self):
        """Whether a movement does so somewhere."""
        return any(self.held_trace(v, number) > 0 for v, normals in self.normals.items()
                   for number in range(len(normals))
                   if (v, number) not in self.node_of)

    def make_bonds(self):
        """Points with the same trace and law are one, as their sums would only make
        more states. Those of a node are one as well, with the mean stiffness and
        fracture energy."""
        scene, sums = self.scene, {}
        for f, (name, face) in enumerate(self.contact_faces):
            for weight, phis in rules(self.dim)[scene.quadrature]:
                place = [dot(phis, [self.points[v][k] for v in face.vertices])
                         for k in range(self.dim)]
                a = scene.bonds[name].stiffness(place)
                M = scene.bonds[name].threshold(place)
                at = tuple(sorted(((v, self.group_of[f, v]), phi)
                                  for v, phi in zip(face.vertices, phis) if phi))
                sum_of = sums.setdefault((at, (a, M)[:2 * (len(at) > 1)]), [ZERO] * 3)
                for k, value in enumerate((ONE, a, a * M * M)):
                    sum_of[k] += weight * face.measure * value
        steps = [tuple(map(EXACT, step)) for step in scene.steps]
        self.bonds = []
        for (at, _), (weight, a, energy) in sums.items() if steps else ():
            held = [phi * self.held_trace(*where) for where, phi in at
                    if where not in self.node_of]
            nodes = [(self.node_of[where], phi) for where, phi in at
                     if where in self.node_of]
            self.bonds.append(BondPoint(weight, nodes, sum(held, ZERO), bool(held),
                                        a / weight, (energy / a).sqrt(), steps))
        # What the bonds of a contact node can bear.
        self.strengths = [ZERO] * len(self.contact_dofs)
        for point in self.bonds:
            pull = max(-k * stiffness for k, (stiffness, _) in
                       zip(point.kinks, point.branches))
            for i, phi in point.nodes:
                self.strengths[i] += phi * pull

    # A and f.

    def gradients(self, simplex):
        """The volume, and the gradients of the basis functions."""
        at = [self.points[v] for v in simplex]
        edges = [[x - y for x, y in zip(p, at[0])] for p in at[1:]]
        others = list(zip(*inverse(edges)))
        first = [-sum(components) for components in zip(*others)]
        return volume(at) / math.factorial(self.dim), [first] + others

    def assemble_stiffness(self):
        """A in the frames, a dictionary for each row."""
        lame, mu, axes = self.lame, self.mu, range(self.dim)
        blocks = collections.defaultdict(lambda: [[ZERO for _ in axes] for _ in axes])
        self.cells = [(simplex, *self.gradients(simplex))
                      for simplex in self.scene.mesh.simplices]
        for simplex, size, gradients in self.cells:
            for v, b in zip(simplex, gradients):
                for w, c in zip(simplex, gradients):
                    block, product = blocks[v, w], mu * dot(b, c)
                    for k in axes:
                        for l in axes:
                            block[k][l] += size * (
                                lame * b[k] * c[l] + mu * b[l] * c[k]
                                + (product if k == l else ZERO))
        self.A = [{} for _ in range(self.n)]
        for (v, w), block in blocks.items():
            half = [[dot(row, g) for row in block] for g in self.columns[w]]
            for k, e in enumerate(self.columns[v]):
                for l, g in enumerate(half):
                    value = dot(e, g)
                    if value:
                        self.A[self.dim * v + k][self.dim * w + l] = value

    def eliminate(self):
        """Condenses A onto the contact normals: of each free unknown its pivot and
        the others in its row. Those of one end of the body come first."""
        order = sorted(self.free_dofs,
                       key=lambda d: self.scene.mesh.along[d // self.dim])
        self.order = order + self.contact_dofs
        place = {d: k for k, d in enumerate(self.order)}
        rows = [{place[j]: a for j, a in self.A[d].items()
                 if place.get(j, -1) >= place[d]} for d in self.order]
        n = len(order)
        self.eliminated = []
        for k in range(n):
            row = rows[k]
            pivot = row.pop(k)
            if not self.clamped and (
                    pivot < EXACT("1e-12") * self.A[order[k]][order[k]]):
                self.is_usable = False  # nothing holds the body
                return
            self.eliminated.append((pivot, row))
            items = sorted(row.items())
            for at, (i, value) in enumerate(items):
                factor, target = value / pivot, rows[i]
                for j, other in items[at:]:
                    target[j] = target.get(j, ZERO) - factor * other
        self.S = [[rows[min(i, j)].get(max(i, j), ZERO)
                   for j in range(n, len(rows))] for i in range(n, len(rows))]
        # Rigid motions that are free have the stiffness of what rounding did to places.
        self.weak = ZERO if self.clamped else EXACT("1e-14") * max(
            self.A[d][d] for d in self.contact_dofs)

    def cartesian_loads(self):
        """Tractions, pressures and body forces: all are linear on their face or
        simplex, and so integrated exactly; and what temperatures do, whose sum is
        zero."""
        scene, dim = self.scene, self.dim
        loads = [[ZERO] * dim for _ in self.points]
        body_force = scene.loads.get("Loads/Body force")
        temperature = scene.loads.get("Loads/Temperature change")

        def add(vertices, measure, values):
            n = len(vertices)
            for k in range(dim):
                total = sum(value[k] for value in values)
                for v, value in zip(vertices, values):
                    loads[v][k] += measure * (total + value[k]) / (n * (n + 1))

        for side, faces in self.faces.items():
            traction = scene.loads.get("Loads/Traction " + side)
            pressure = scene.loads.get("Loads/Pressure " + side)
            for face in faces if traction or pressure else ():
                at = [self.points[v] for v in face.vertices]
                add(face.vertices, face.measure,
                    [[c(p) for c in traction] for p in at] if traction else
                    [[-pressure[0](p) * x for x in face.normal] for p in at])
        for simplex, size, gradients in self.cells:
            at = [self.points[v] for v in simplex]
            if body_force:
                add(simplex, size, [[c(p) for c in body_force] for p in at])
            if temperature:
                mean = sum(temperature[0](p) for p in at) / len(at)
                stress = size * mean * EXACT(scene.expansion) * (
                    (2 if scene.is_plane_stress else 3) * self.lame + 2 * self.mu)
                for v, gradient in zip(simplex, gradients):
                    loads[v] = [x + stress * b for x, b in zip(loads[v], gradient)]
        return loads

    def set_loads(self):
        """f, G, and what is left of the problem when the free unknowns are
        eliminated: 1/2 s'S s - g's + c for s <= 0."""
        self.applied = self.cartesian_loads()
        self.f = [dot(e, load) for columns, load in zip(self.columns, self.applied)
                  for e in columns]
        self.G = [ZERO] * self.n
        for d, (path, k) in self.prescribed.items():
            self.G[d] = self.scene.loads[path][k](self.points[d // self.dim])
        for (v, number), i in self.node_of.items():
            self.G[self.contact_dofs[i]] = self.gaps[v][number]
        self.make_bonds()
        of_G = self.multiply(self.G)
        load = [self.f[d] - of_G[d] for d in self.order]
        self.constant = dot(self.G, of_G) / 2 - dot(self.f, self.G)
        self.condensed_constant = ZERO
        for k, (pivot, row) in enumerate(self.eliminated):
            factor = load[k] / pivot
            self.condensed_constant -= load[k] * factor / 2
            for j, value in row.items():
                load[j] -= factor * value
        self.g = load[len(self.eliminated):]

    # Values at points.

    def multiply(self, u):
        """A u."""
        return [sum((a * u[j] for j, a in row.items()), ZERO) for row in self.A]

    def rounding(self, u):
        """What displacements that are rounded to double leave of A u."""
        return [EPSILON * sum((abs(a * u[j]) for j, a in row.items()), ZERO)
                for row in self.A]

    def traces(self, u):
        """w at the contact normals."""
        return [u[d] - self.G[d] for d in self.contact_dofs]

    def adhesion(self, s):
        """The energy of all bonds."""
        return sum((min(point.energies(point.trace(s))) for point in self.bonds), ZERO)

    def functional(self, u):
        """J, and the size of what it is a sum of."""
        strain = dot(u, self.multiply(u)) / 2
        work, bonds = dot(self.f, u), self.adhesion(self.traces(u))
        return strain - work + bonds, strain + abs(work) + bonds + abs(self.constant)

    def condensed_functional(self, s):
        """J where all free unknowns are in equilibrium."""
        return (dot(s, [dot(row, s) for row in self.S]) / 2 - dot(self.g, s)
                + self.constant + self.condensed_constant + self.adhesion(s))

    # Minima.

    def held_weakly(self):
        """S with weak springs, which hold what nothing else holds, far away."""
        return [[a + self.weak if i == j else a for j, a in enumerate(row)]
                for i, row in enumerate(self.S)]

    def minimise(self, branches, held=None):
        """The minimum of the convex problem with each bond on the given branch."""
        Q, g = self.held_weakly(), list(self.g)
        for point, k in zip(self.bonds, branches):
            stiffness = point.branches[k][0]
            if stiffness:
                for i, phi in point.nodes:
                    g[i] -= stiffness * phi * point.constant
                    for j, psi in point.nodes:
                        Q[i][j] += stiffness * phi * psi
        return minimise_convex(Q, g, held)

    def bonds_can_change(self):
        """Of J, the lesser of two energies: of all bonds, and of what is gained
        without foundation and bonds."""
        gain = dot(self.g, solve(self.held_weakly(), self.g)) / 2
        return min([gain] + ([sum(point.branches[-1][1] for point in self.bonds)]
                             if self.bonds else []))

    def is_off(self, s):
        """Whether nothing but weak springs holds the body."""
        return self.weak * max(map(abs, s)) > EXACT("1e-5") * max(map(abs, self.g))

    def branches_at(self, s):
        """Of each bond."""
        return [point.branch(point.trace(s)) for point in self.bonds]

    def descend(self, branches):
        """Bonds are put on their branch in turn, J falls."""
        while True:
            s = self.minimise(branches)
            following = self.branches_at(s)
            if following == branches or self.is_off(s):
                return s
            branches = following

    def from_rest(self):
        """What the body at rest comes to: there gaps are open."""
        return self.descend(self.branches_at(
            [-self.G[d] for d in self.contact_dofs]))

    def all_minima(self, draw):
        """Minima of J. Each is that of the convex problem with its own branches, so
        with few bonds the least is among these, and true is returned with them; else
        they are what descents come to."""
        choices = [range(len(p.branches)) if p.nodes
                   else [p.branch(p.constant)] for p in self.bonds]
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
            held = [not x for x in s]
            if self.branches_at(s) == list(branches) and not self.is_off(s):
                minima.append(s)
        return minima, True


def choose_loads(draw, scene, body):
    """Loads that stretch intact bonds to about where they break, so that all,
    some or none of them do; and some of any size. Returns whether there are
    such loads."""

    def largest_opening():
        # Without the gap, which loads do not scale.
        gaps = body.gaps
        body.gaps = {v: [ZERO] * len(at) for v, at in gaps.items()}
        body.set_loads()
        body.gaps = gaps
        s = body.minimise([0] * len(body.bonds))
        opening = 0. if body.is_off(s) else float(max(map(abs, s)))
        return opening if opening > 1e-20 * scene.mesh.length / scene.E else 0.

    opening = largest_opening()
    if not opening and draw.chance(0.8):
        # They press, and pull in the other direction.
        scene.scale_loads(-1., 1.)
        opening = largest_opening()
    if draw.chance(0.8) and opening > 0.:
        # Movements, which are of size one as well, were applied together.
        factor = scene.M / opening * draw.magnitude(-0.3, 0.9)
        scene.scale_loads(factor, factor)
    else:
        scene.scale_loads(scene.a * scene.M * draw.magnitude(-2., 2.),
                          scene.M * draw.magnitude(-1., 1.))
    body.set_loads()
    if body.pushes_into_foundation():
        scene.scale_loads(1., -1.)
        body.set_loads()
    return not body.pushes_into_foundation()


def make_scene(draw, dim):
    """The first usable scene that is drawn."""
    while True:
        scene = Scene(draw, dim)
        if not scene.mesh.is_usable():
            continue
        body = Body(scene)
        if body.is_usable and choose_loads(draw, scene, body):
            return scene, body
