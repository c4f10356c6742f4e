#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_shapes.py DEBOND [COUNT [FIRST [NUMBER]]]: random plane bodies that are
no boxes, from Gmsh files: trapezoids, tapers, arches, wavy strips, Ls, steps,
plates with a notch or a hole, turned and sheared. Each result is judged by a
check that shares nothing with the solver: its own assembly and elimination, in
34 digits, and the true minimum of J, which is the least of the minima with each
bond on each of its branches in turn. A success must be in equilibrium, satisfy
the law and have the J that is printed; "local minimum" must be one, "global" and
"best known" must be what their words promise.

COUNT scenes are tried, from the number FIRST on. Of the scene NUMBER all is
printed, and its files are left in the working directory.
"""

import collections
import csv
import decimal
import itertools
import json
import math
import operator
import os
import pathlib
import random as python_random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

from vtu import Piece

SECONDS_FOR_A_SCENE = 20  # of the processor: a busy machine takes longer
LARGEST_UNKNOWNS = 64
LARGEST_STATES = 512
EPSILON = decimal.Decimal(2) ** -52
ZERO, HALF, ONE = decimal.Decimal(0), decimal.Decimal("0.5"), decimal.Decimal(1)
decimal.getcontext().prec = 34
EXACT = decimal.Decimal


def dot(a, b):
    """The sum of products, in 34 digits."""
    return sum(map(operator.mul, a, b), ZERO)


class Draw:
    """Random numbers that are the same with every version of Python."""

    def __init__(self, number):
        self.source = python_random.Random(number)

    def chance(self, probability):
        return self.source.random() < probability

    def uniform(self, low, high):
        return low + (high - low) * self.source.random()

    def magnitude(self, low, high):
        return 10. ** self.uniform(low, high)

    def below(self, n):
        return min(int(self.source.random() * n), n - 1)

    def between(self, low, high):
        return low + self.below(high - low + 1)

    def choice(self, values):
        return values[self.below(len(values))]

    def shuffled(self, values):
        result = list(values)
        for k in range(len(result) - 1, 0, -1):
            other = self.below(k + 1)
            result[k], result[other] = result[other], result[k]
        return result


class Field:
    """A number that is linear in x and y, and its text for a scene."""

    def __init__(self, constant, along_x=0., along_y=0.):
        self.coefficients = constant, along_x, along_y

    def __call__(self, point):
        constant, along_x, along_y = map(EXACT, self.coefficients)
        return constant + along_x * point[0] + along_y * point[1]

    def __str__(self):
        constant, along_x, along_y = self.coefficients
        text = repr(constant)
        if along_x:
            text += f"+({along_x!r})*x"
        if along_y:
            text += f"+({along_y!r})*y"
        return text


def scaled(components, by):
    """Fields times a number."""
    return [Field(*(by * c for c in f.coefficients)) for f in components]


# ------------------------------------------------------------------ the bodies


class Mesh:
    """A grid of quadrilaterals, some of them left out, under a map; the sides
    are those of the grid, and "cut" is what bounds the cells left out."""

    def __init__(self, draw):
        self.kind = draw.choice(["trapezoid", "taper", "sheared", "arch", "arch",
                                 "wavy", "L", "step", "notch", "hole"])
        grid_is_fine = self.kind in ("L", "step", "notch", "hole")
        if grid_is_fine:
            nx, ny = draw.between(3, 5), draw.between(2, 4)
            if self.kind == "hole":
                ny = 3
        else:
            nx, ny = draw.between(2, 9), draw.between(1, 3)
        cells = {(i, j) for i in range(nx) for j in range(ny)}
        i, j = draw.between(1, nx - 2 if grid_is_fine else 1), draw.between(1, ny)
        if self.kind == "L":
            cells -= {(k, l) for k, l in cells if k >= i and l >= min(j, ny - 1)}
        elif self.kind == "step":
            cells -= {(k, l) for k, l in cells if k < i and l == ny - 1}
        elif self.kind == "notch":
            cells -= {(i, ny - 1)}
        elif self.kind == "hole":
            cells -= {(i, 1)}

        place = self.map(draw, nx, ny)
        grid = {}
        for i, j in cells:
            for corner in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                grid.setdefault(corner, place(*corner))
        self.points = []
        number = {}
        for corner in draw.shuffled(sorted(grid)):
            number[corner] = len(self.points)
            self.points.append(grid[corner])

        # Cells of the file, and the triangles that they are computed with.
        style = draw.choice(["diagonals", "diagonals", "crossed", "quadrilaterals"])
        self.file_cells, self.triangles = [], []
        n_file_points = len(self.points)
        for i, j in draw.shuffled(sorted(cells)):
            corners = [number[c] for c in ((i, j), (i + 1, j), (i + 1, j + 1),
                                           (i, j + 1))]
            start = draw.below(4)
            corners = corners[start:] + corners[:start]
            if style == "diagonals":
                a, b, c, d = corners
                triangles = [[a, b, c], [a, c, d]]
            else:
                centre = len(self.points)
                self.points.append(tuple(
                    sum(self.points[c][k] for c in corners) / 4. for k in (0, 1)))
                triangles = [[corners[k], corners[(k + 1) % 4], centre]
                             for k in range(4)]
            self.triangles += triangles
            self.file_cells += [corners] if style == "quadrilaterals" else triangles
        self.n_file_points = (n_file_points if style == "quadrilaterals"
                              else len(self.points))

        # Each face has its body on the left.
        self.sides = collections.defaultdict(list)
        for i, j in sorted(cells):
            for name, neighbour, is_end, a, b in (
                    ("bottom", (i, j - 1), j == 0, (i, j), (i + 1, j)),
                    ("right", (i + 1, j), i == nx - 1, (i + 1, j), (i + 1, j + 1)),
                    ("top", (i, j + 1), j == ny - 1, (i + 1, j + 1), (i, j + 1)),
                    ("left", (i - 1, j), i == 0, (i, j + 1), (i, j))):
                if neighbour not in cells:
                    self.sides[name if is_end else "cut"].append(
                        (number[a], number[b]))
        self.faces_are_turned = draw.chance(0.2)

    def map(self, draw, nx, ny):
        """From the numbers of a corner of the grid to its place."""
        height = draw.magnitude(-1.7, -0.8) if self.kind == "taper" else (
            draw.uniform(0.15, 1.))
        ends = [draw.uniform(0.3, 1.), draw.uniform(0.3, 1.)]
        if self.kind == "taper":
            ends = [1., draw.magnitude(-1., -0.3)]
        slope = draw.uniform(-0.4, 0.4)
        shear = draw.uniform(-1., 1.) if self.kind in (
            "sheared", "L", "step", "notch", "hole") else 0.
        wave, wave_length = draw.uniform(0.02, 0.12), draw.uniform(0.5, 2.)
        angle = draw.uniform(0.5, 3.)
        inner = draw.uniform(0.3, 0.9)
        grading = draw.choice([1., 1., draw.uniform(0.6, 1.6)])
        turn = draw.choice([0., 0.5 * math.pi, draw.uniform(-math.pi, math.pi)])
        is_mirrored = draw.chance(0.3)
        self.length = draw.magnitude(-3., 3.)
        shift = [draw.choice([0., draw.uniform(-1., 1.)]) for _ in range(2)]

        def place(i, j):
            xi, eta = (i / nx) ** grading, j / ny
            if self.kind == "arch":
                # Mirrored, since angles go from left to right here.
                radius = inner + (1. - inner) * eta
                x = -radius * math.cos(angle * xi)
                y = radius * math.sin(angle * xi)
            else:
                if self.kind in ("trapezoid", "taper"):
                    x = xi
                    y = slope * xi * (self.kind == "trapezoid") + height * eta * (
                        ends[0] + (ends[1] - ends[0]) * xi)
                else:
                    x, y = xi, height * eta
                    if self.kind != "sheared":
                        y += wave * math.sin(2. * math.pi * xi / wave_length) * (
                            self.kind == "wavy" or eta)
                x += shear * y
            if is_mirrored:
                x, y = -y, -x  # turns the sense of the corners as well
            x, y = (math.cos(turn) * x - math.sin(turn) * y,
                    math.sin(turn) * x + math.cos(turn) * y)
            return self.length * (x + shift[0]), self.length * (y + shift[1])

        self.is_mirrored = is_mirrored
        return place

    def orient(self):
        """Makes all triangles and faces go round counterclockwise; returns
        whether none is flat."""
        if self.is_mirrored:
            self.triangles = [t[::-1] for t in self.triangles]
            self.file_cells = [c[::-1] for c in self.file_cells]
            for name, faces in self.sides.items():
                self.sides[name] = [(b, a) for a, b in faces]
        for triangle in self.triangles:
            p, q, r = (self.points[v] for v in triangle)
            area = ((q[0] - p[0]) * (r[1] - p[1])
                    - (r[0] - p[0]) * (q[1] - p[1])) / 2.
            longest = max(math.dist(p, q), math.dist(q, r), math.dist(r, p))
            if area < 0.01 * longest ** 2:
                return False
        return True

    def extent(self, axis):
        """The least and the largest coordinate."""
        values = [point[axis] for point in self.points]
        return min(values), max(values)

    def text(self):
        """A file of version 2.2."""
        names = sorted(self.sides)
        text = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames",
                str(len(names))]
        text += [f'1 {k} "{name}"' for k, name in enumerate(names, 1)]
        text += ["$EndPhysicalNames", "$Nodes", str(self.n_file_points)]
        text += [f"{k} {x!r} {y!r} 0" for k, (x, y) in
                 enumerate(self.points[:self.n_file_points], 1)]
        elements = []
        for k, name in enumerate(names, 1):
            for a, b in self.sides[name]:
                if self.faces_are_turned:
                    a, b = b, a
                elements.append(f"1 2 {k} 1 {a + 1} {b + 1}")
        elements += [f"{len(cell) - 1} 2 99 1 "
                     + " ".join(str(v + 1) for v in cell)
                     for cell in self.file_cells]
        text += ["$EndNodes", "$Elements", str(len(elements))]
        text += [f"{k} {element}" for k, element in enumerate(elements, 1)]
        return "\n".join(text + ["$EndElements", ""])


# ------------------------------------------------------------------ the scenes


class Scene:
    """A mesh, and what the check and the settings of the program both need."""

    def __init__(self, draw):
        self.settings = {}
        mesh = self.mesh = Mesh(draw)
        self.is_usable = mesh.orient()
        self.set("Mesh/Source", "file")
        self.set("Mesh/File", "shape.msh")
        names = draw.shuffled(sorted(mesh.sides))
        n_contact = 2 if draw.chance(0.2) else 1
        n_clamped = draw.between(1, 2) if len(names) - n_contact > 1 else 1
        self.contact = names[:n_contact]
        self.clamped = names[n_contact:n_contact + n_clamped]
        self.moved, self.movement = None, None
        rest = names[n_contact + n_clamped:]
        if rest and draw.chance(0.15):
            # What clamps and another support both hold they must agree on.
            held = {v for side in self.clamped for face in mesh.sides[side]
                    for v in face}
            if not held & {v for face in mesh.sides[rest[0]] for v in face}:
                self.moved = rest[0]
        self.tangential_fixed = draw.chance(0.5)
        self.set("Boundary conditions/Clamped boundaries", ", ".join(self.clamped))
        self.set("Boundary conditions/Contact boundary", ", ".join(self.contact))
        self.set("Contact law/Tangential displacement",
                 "fixed" if self.tangential_fixed else "free")

        E = draw.magnitude(-6., 12.)
        nu = draw.uniform(0.45, 0.499) if draw.chance(0.1) else (
            draw.uniform(-0.3, 0.45))
        hypothesis = draw.choice(["plane stress", "plane strain"])
        self.set("Material/Young modulus", repr(E))
        self.set("Material/Poisson ratio", repr(nu))
        self.set("Material/Hypothesis", hypothesis)
        E, nu = EXACT(E), EXACT(nu)
        self.mu = E / (2 * (1 + nu))
        self.lame = (E * nu / (1 - nu * nu) if hypothesis == "plane stress"
                     else E * nu / ((1 + nu) * (1 - 2 * nu)))

        self.add_bonds(draw, float(E))
        self.set("Solver/Method", draw.choice(
            ["automatic", "automatic", "majorise minimise", "energy bundle"]))
        self.set("Solver/Linear solver", "direct")
        self.set("Solver/Search",
                 draw.choice(["automatic", "automatic", "full", "none"]))
        self.set("Solver/Prove", "true" if self.quadrature == "nodal"
                 and draw.chance(0.3) else "false")
        self.set("Solver/Proof/Maximum time", "10")
        self.set("Solver/Proof/Threads", "1")
        self.set("Output/Displacement", "true")
        self.set("Output/Contact VTU", "false")
        self.set("Output/Directory", "output")
        self.add_loads(draw)

    def set(self, path, value):
        """What the scene file sets."""
        self.settings[path] = value

    def field(self, draw, first, last):
        """From one value to another along an axis, or the second one alone."""
        axis = draw.below(2)
        low, high = self.mesh.extent(axis)
        if draw.chance(0.5):
            return Field(last)
        slope = (last - first) / (high - low)
        slopes = (slope, 0.) if axis == 0 else (0., slope)
        # Rounding must not make zero negative.
        return Field(first * (1. + 1e-12) - slope * low, *slopes)

    def add_bonds(self, draw, E):
        """Law, quadrature and gap; steps are those of the law relative to
        stiffness and threshold."""
        a = E / self.mesh.length * draw.magnitude(-3., 3.)
        if draw.chance(0.1):
            a = draw.magnitude(-6., 12.)
        M = self.mesh.length * draw.magnitude(-5., -1.)
        self.a, self.M = a, M
        law = draw.choice(["winkler"] * 7 + ["stepped"] * 2 + ["none"])
        self.set("Contact law/Law", law)
        self.stiffness, self.threshold = Field(a), Field(M)
        if law == "winkler":
            if draw.chance(0.2):
                self.stiffness = self.field(draw, a * draw.uniform(0.1, 1.), a)
            if draw.chance(0.2):
                self.threshold = self.field(draw, M * draw.uniform(0.2, 1.), M)
            self.steps = [(ONE, ONE)]
        elif law == "stepped":
            # Relative to a and M.
            steps = [(1., draw.uniform(0.2, 0.8)), (draw.uniform(0.1, 0.8), 1.)]
            if draw.chance(0.3):
                steps = steps[1:]
            stiffnesses = [a * k for k, _ in steps]
            thresholds = [M * m for _, m in steps]
            self.set("Contact law/Stepped/Stiffnesses",
                     ", ".join(map(repr, stiffnesses)))
            self.set("Contact law/Stepped/Thresholds",
                     ", ".join(map(repr, thresholds)))
            self.steps = [(EXACT(k) / EXACT(a), EXACT(m) / EXACT(M))
                          for k, m in zip(stiffnesses, thresholds)]
            if draw.chance(0.4):
                self.stiffness = self.field(draw, a * draw.uniform(0.1, 1.), a)
                self.set("Contact law/Stepped/Factor",
                         f"({self.stiffness})/{a!r}")
        else:
            self.steps = []
        if law != "stepped":
            self.set("Contact law/Bond stiffness", str(self.stiffness))
            self.set("Contact law/Bond threshold", str(self.threshold))
        self.quadrature = "nodal" if draw.chance(0.6) else draw.choice(
            ["midpoint", "gauss 1", "gauss 2", "gauss 3"])
        self.set("Contact law/Quadrature", self.quadrature)
        self.gap = None
        if draw.chance(0.2):
            self.gap = self.field(draw, M * draw.uniform(0., 1.5),
                                  M * draw.uniform(0., 1.5))
            self.set("Contact law/Initial gap", str(self.gap))

    def density(self, draw):
        """A load of size 1."""
        components = []
        for _ in range(2):
            first, last = draw.uniform(-1., 1.), draw.uniform(-1., 1.)
            components.append(self.field(draw, first, last))
        return components

    def add_loads(self, draw):
        """Of size 1; scale_loads() sets them."""
        loaded = [side for side in sorted(self.mesh.sides)
                  if side not in self.clamped and side != self.moved]
        self.tractions = {}
        for side in draw.shuffled(loaded)[:draw.between(1, 2)]:
            self.tractions[side] = self.density(draw)
        self.body_force = None
        if draw.chance(0.25):
            self.body_force = scaled(self.density(draw), 1. / self.mesh.length)
        if self.moved:
            self.movement = [Field(draw.uniform(-1., 1.)) for _ in range(2)]

    def scale_loads(self, factor, movement):
        """Multiplies loads and prescribed displacements."""
        def text(components):
            return "; ".join(map(str, components))

        for side in self.tractions:
            self.tractions[side] = scaled(self.tractions[side], factor)
            self.set(f"Loads/Traction {side}", text(self.tractions[side]))
        if self.body_force:
            self.body_force = scaled(self.body_force, factor)
            self.set("Loads/Body force", text(self.body_force))
        if self.moved:
            self.movement = scaled(self.movement, movement)
            self.set(f"Boundary conditions/Displacement {self.moved}",
                     text(self.movement))

    def text(self):
        """The scene file."""
        lines = []
        for path, value in self.settings.items():
            *sections, entry = path.split("/")
            lines += [f"subsection {section}" for section in sections]
            lines += [f"set {entry} = {value}"] + ["end"] * len(sections)
        return "\n".join(lines + [""])


# ------------------------------------------------------------------- the check


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

    def branch(self, trace):
        """The number of the branch that is the least."""
        return min(range(len(self.branches)),
                   key=lambda k: self.energy_of(k, trace))

    def energy_of(self, k, trace):
        """What a branch has at a trace."""
        stiffness, energy = self.branches[k]
        return stiffness * trace * trace / 2 + energy

    def pull(self, trace):
        """j_1' there."""
        return self.branches[self.branch(trace)][0] * trace

    def energy(self, s):
        """Of the least branch."""
        trace = self.trace(s)
        return min(self.energy_of(k, trace) for k in range(len(self.branches)))


class Body:
    """All unknowns in the frames of their nodes: at contact nodes components
    along normals and tangents. Some are fixed, some free, some contact normals;
    u = w + G, w <= 0 at contact normals."""

    def __init__(self, scene):
        self.scene = scene
        self.points = [tuple(map(EXACT, p)) for p in scene.mesh.points]
        self.n = 2 * len(self.points)
        self.make_frames()
        if not self.is_usable:
            return
        self.make_bonds()
        if not self.is_usable:
            return
        self.assemble_stiffness()
        self.set_loads()

    # Frames and kinds of unknowns.

    def make_frames(self):
        """Normals of the vertices, and what is fixed, free or a contact
        normal."""
        scene, mesh = self.scene, self.scene.mesh
        self.is_usable = True
        clamped = {v for side in scene.clamped for face in mesh.sides[side]
                   for v in face}
        moved = ({v for face in mesh.sides[scene.moved] for v in face}
                 if scene.moved else set())
        self.faces = [face for side in scene.contact for face in mesh.sides[side]]
        self.lengths, normals = [], []
        for a, b in self.faces:
            p, q = self.points[a], self.points[b]
            along = q[0] - p[0], q[1] - p[1]
            length = (along[0] ** 2 + along[1] ** 2).sqrt()
            self.lengths.append(length)
            normals.append((along[1] / length, -along[0] / length))

        # The normals of a vertex are those of its faces, or where they differ
        # by less than 31.4 degrees their mean, weighted by their lengths.
        smooth = EXACT(math.cos(math.radians(31.4)))
        at_vertex = collections.defaultdict(list)
        for f, face in enumerate(self.faces):
            for v in face:
                at_vertex[v].append(f)
        self.group_of = {}  # (face, vertex): the number of the normal
        self.normals = {}
        for v, faces in sorted(at_vertex.items()):
            cosine = (dot(normals[faces[0]], normals[faces[-1]]))
            if abs(cosine - smooth) < EXACT("0.01"):
                self.is_usable = False  # rounding would say which it is
            if len(faces) > 2 or (len(faces) == 2 and cosine < EXACT("-0.999")):
                self.is_usable = False
            groups = ([faces] if cosine > smooth else [[f] for f in faces])
            self.normals[v] = []
            for number, group in enumerate(groups):
                mean = [sum((self.lengths[f] * normals[f][k] for f in group), ZERO)
                        for k in (0, 1)]
                size = (mean[0] ** 2 + mean[1] ** 2).sqrt()
                self.normals[v].append((mean[0] / size, mean[1] / size))
                for f in group:
                    self.group_of[f, v] = number

        # Columns of a frame are the Cartesian directions of its unknowns.
        self.frames = [((ONE, ZERO), (ZERO, ONE))] * len(self.points)
        self.kinds = ["free"] * self.n
        self.node_of = {}  # (vertex, number of the normal): contact node
        self.contact_dofs = []
        for v, at in self.normals.items():
            if v in clamped or v in moved:
                continue
            if len(at) == 2 and scene.tangential_fixed:
                self.kinds[2 * v] = self.kinds[2 * v + 1] = "fixed"
                continue
            if len(at) == 2:
                (a, b), (c, d) = at
                determinant = a * d - b * c
                self.frames[v] = ((d / determinant, -c / determinant),
                                  (-b / determinant, a / determinant))
            else:
                a, b = at[0]
                self.frames[v] = (a, b), (-b, a)
                if scene.tangential_fixed:
                    self.kinds[2 * v + 1] = "fixed"
            for number in range(len(at)):
                self.kinds[2 * v + number] = "contact"
                self.node_of[v, number] = len(self.contact_dofs)
                self.contact_dofs.append(2 * v + number)
        for v in clamped | moved:
            self.kinds[2 * v] = self.kinds[2 * v + 1] = "fixed"
        self.clamped, self.moved = clamped, moved
        self.free_dofs = [d for d in range(self.n) if self.kinds[d] == "free"]
        n_unknowns = len(self.free_dofs) + len(self.contact_dofs)
        self.is_usable &= bool(self.contact_dofs) and (
            n_unknowns <= LARGEST_UNKNOWNS)

    def gap_at(self, v):
        """The initial gap at a vertex."""
        return self.scene.gap(self.points[v]) if self.scene.gap else ZERO

    def held_trace(self, v, number):
        """u_nu - g of a vertex whose displacement is prescribed."""
        trace = -self.gap_at(v)
        if v in self.moved:
            trace += dot([component(self.points[v])
                          for component in self.scene.movement],
                         self.normals[v][number])
        return trace

    def pushes_into_foundation(self):
        """Whether a movement does so somewhere."""
        return any(self.held_trace(v, number) > 0 for v in self.moved
                   for number in range(len(self.normals.get(v, []))))

    def make_bonds(self):
        """Points with the same trace and law are one, as their sums would only
        make more states."""
        scene = self.scene
        third = 1 / EXACT(3).sqrt()
        far = EXACT("0.6").sqrt()
        rules = {"nodal": [(HALF, ZERO), (HALF, ONE)],
                 "midpoint": [(ONE, HALF)], "gauss 1": [(ONE, HALF)],
                 "gauss 2": [(HALF, (1 - third) / 2), (HALF, (1 + third) / 2)],
                 "gauss 3": [(EXACT(5) / 18, (1 - far) / 2),
                             (EXACT(8) / 18, HALF),
                             (EXACT(5) / 18, (1 + far) / 2)]}
        parts = {}
        for f, (a, b) in enumerate(self.faces):
            for weight, position in rules[scene.quadrature]:
                place = [(1 - position) * self.points[a][k]
                         + position * self.points[b][k] for k in (0, 1)]
                nodes, constant, is_held = [], ZERO, False
                for v, phi in ((a, 1 - position), (b, position)):
                    number = self.group_of[f, v]
                    node = self.node_of.get((v, number))
                    if not phi:
                        continue
                    if node is None:
                        constant += phi * self.held_trace(v, number)
                        is_held = True
                    else:
                        nodes.append((node, phi))
                key = (tuple(nodes), constant, is_held, scene.stiffness(place),
                       scene.threshold(place))
                parts[key] = parts.get(key, ZERO) + weight * self.lengths[f]
        self.bonds = [] if not scene.steps else [
            BondPoint(weight, *key, scene.steps) for key, weight in parts.items()]
        free = [point for point in self.bonds if point.nodes]
        self.is_usable &= math.prod(len(p.branches) for p in free) <= LARGEST_STATES

    # A and f.

    def gradients(self, triangle):
        """The area, and the gradients of the three basis functions."""
        p, q, r = (self.points[v] for v in triangle)
        double = (q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1])
        return double / 2, [((q[1] - r[1]) / double, (r[0] - q[0]) / double),
                            ((r[1] - p[1]) / double, (p[0] - r[0]) / double),
                            ((p[1] - q[1]) / double, (q[0] - p[0]) / double)]

    def assemble_stiffness(self):
        """A in the frames, a dictionary for each row."""
        lame, mu = self.scene.lame, self.scene.mu
        blocks = collections.defaultdict(lambda: [[ZERO, ZERO], [ZERO, ZERO]])
        for triangle in self.scene.mesh.triangles:
            area, gradients = self.gradients(triangle)
            for v, b in zip(triangle, gradients):
                for w, c in zip(triangle, gradients):
                    block = blocks[v, w]
                    for k in (0, 1):
                        for l in (0, 1):
                            block[k][l] += area * (
                                lame * b[k] * c[l] + mu * b[l] * c[k]
                                + (mu * dot(b, c) if k == l else ZERO))
        self.A = [{} for _ in range(self.n)]
        for (v, w), block in blocks.items():
            for k, e in enumerate(self.frames[v]):
                for l, g in enumerate(self.frames[w]):
                    self.A[2 * v + k][2 * w + l] = sum(
                        (e[i] * block[i][j] * g[j] for i in (0, 1)
                         for j in (0, 1)), ZERO)

    def set_loads(self):
        """f, G, and all that is left of the problem when the free unknowns are
        eliminated: 1/2 s'S s - g's + c for s <= 0."""
        scene, mesh = self.scene, self.scene.mesh
        cartesian = [[ZERO, ZERO] for _ in self.points]
        for side, density in scene.tractions.items():
            for a, b in mesh.sides[side]:
                p, q = self.points[a], self.points[b]
                length = ((q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2).sqrt()
                for k, component in enumerate(density):
                    at_a, at_b = component(p), component(q)
                    cartesian[a][k] += length * (2 * at_a + at_b) / 6
                    cartesian[b][k] += length * (at_a + 2 * at_b) / 6
        if scene.body_force:
            for triangle in mesh.triangles:
                area, _ = self.gradients(triangle)
                for k, component in enumerate(scene.body_force):
                    values = [component(self.points[v]) for v in triangle]
                    for v, value in zip(triangle, values):
                        cartesian[v][k] += area * (sum(values) + value) / 12
        self.cartesian_loads = cartesian
        self.f = [dot(e, cartesian[v]) for v in range(len(self.points))
                  for e in self.frames[v]]
        self.G = [ZERO] * self.n
        for v in self.moved:
            for k in (0, 1):
                self.G[2 * v + k] = scene.movement[k](self.points[v])
        for (v, number) in self.node_of:
            self.G[2 * v + number] = self.gap_at(v)
        of_G = self.multiply(self.G)
        self.constant = dot(self.G, of_G) / 2 - dot(self.f, self.G)
        self.eliminate([f - a for f, a in zip(self.f, of_G)])

    def eliminate(self, load):
        """Condenses onto the contact normals."""
        order = self.free_dofs + self.contact_dofs
        place = {d: k for k, d in enumerate(order)}
        n, n_free = len(order), len(self.free_dofs)
        # The load is a last column.
        rows = [[ZERO] * (n + 1) for _ in range(n)]
        for k, d in enumerate(order):
            for other, value in self.A[d].items():
                if other in place:
                    rows[k][place[other]] = value
            rows[k][n] = load[d]
        self.condensed_constant = ZERO
        for k in range(n_free):
            row, pivot = rows[k], rows[k][k]
            self.condensed_constant -= row[n] * row[n] / pivot / 2
            for i in range(k + 1, n):
                if row[i]:
                    factor = row[i] / pivot
                    rows[i][i:] = [x - factor * y
                                   for x, y in zip(rows[i][i:], row[i:])]
        self.S = [[rows[min(i, j)][max(i, j)] for j in range(n_free, n)]
                  for i in range(n_free, n)]
        self.g = [rows[i][n] for i in range(n_free, n)]

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
        return sum((point.energy(s) for point in self.bonds), ZERO)

    def functional(self, u):
        """J."""
        return (dot(u, self.multiply(u)) / 2 - dot(self.f, u)
                + self.adhesion(self.traces(u)))

    def size_of_terms(self, u):
        """What J is a sum of, for tolerances."""
        return (dot(u, self.multiply(u)) / 2 + abs(dot(self.f, u))
                + self.adhesion(self.traces(u)))

    def condensed_functional(self, s):
        """J where all free unknowns are in equilibrium."""
        return (dot(s, [dot(row, s) for row in self.S]) / 2 - dot(self.g, s)
                + self.constant + self.condensed_constant + self.adhesion(s))

    # Minima.

    def with_branches(self, branches):
        """S and g of the convex problem with each bond on the given branch."""
        Q, g = [list(row) for row in self.S], list(self.g)
        for point, k in zip(self.bonds, branches):
            stiffness = point.branches[k][0]
            if stiffness:
                for i, phi in point.nodes:
                    g[i] -= stiffness * phi * point.constant
                    for j, psi in point.nodes:
                        Q[i][j] += stiffness * phi * psi
        return Q, g

    def branches_at(self, s):
        """Of each bond."""
        return [point.branch(point.trace(s)) for point in self.bonds]

    def descend(self, s):
        """Bonds are put on their branch at s in turn, J falls."""
        branches = self.branches_at(s)
        while True:
            s = minimise_convex(*self.with_branches(branches))
            following = self.branches_at(s)
            if following == branches:
                return s
            branches = following

    def global_minimum(self):
        """The least of J: a minimum of J is that of the convex problem with
        its own branches, and J is nowhere above any of those problems."""
        choices = [range(len(p.branches)) if p.nodes
                   else [p.branch(p.constant)] for p in self.bonds]
        least, held = None, None
        for branches in itertools.product(*choices):
            Q, g = self.with_branches(branches)
            s = minimise_convex(Q, g, held)
            held = [not x for x in s]
            J = self.condensed_functional(s)
            if least is None or J < least:
                least = J
        return least


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
    n = len(g)
    held = list(held) if held else [False] * n
    least, patience = n + 1, 3
    while True:
        loose = [i for i in range(n) if not held[i]]
        values = solve([[Q[i][j] for j in loose] for i in loose],
                       [g[i] for i in loose])
        s = [ZERO] * n
        for i, value in zip(loose, values):
            s[i] = value
        wrong = [i for i in range(n) if
                 (g[i] - dot(Q[i], s) < 0 if held[i] else s[i] > 0)]
        if not wrong:
            return s
        patience = 3 if len(wrong) < least else patience - 1
        least = min(least, len(wrong))
        for i in wrong if patience > 0 else wrong[-1:]:
            held[i] = not held[i]


def choose_loads(draw, scene, body):
    """Loads that stretch intact bonds to about where they break, so that all,
    some or none of them do; and some of any size. Returns whether there are
    such loads."""

    def largest_opening():
        # Without the gap, which loads do not scale.
        gap, scene.gap = scene.gap, None
        body.make_bonds()
        body.set_loads()
        scene.gap = gap
        intact = body.with_branches([0] * len(body.bonds))
        return float(max(map(abs, minimise_convex(*intact))))

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
    if body.pushes_into_foundation():
        scene.scale_loads(1., -1.)
    body.make_bonds()
    body.set_loads()
    return not body.pushes_into_foundation()


def make_scene(number):
    """The first usable scene that is drawn from this number."""
    draw = Draw(number)
    while True:
        scene = Scene(draw)
        if not scene.is_usable:
            continue
        body = Body(scene)
        if body.is_usable and choose_loads(draw, scene, body):
            return scene, body


# ------------------------------------------------------------- results of runs


class WrongResult(Exception):
    """What is wrong with a result: a class and figures."""


def require(condition, kind, detail):
    """Raises WrongResult unless the condition holds."""
    if not condition:
        raise WrongResult(kind, detail)


def read_displacement(body, size_of_file):
    """u in the frames, from displacement.txt, whose order is that in which the
    cells of body.vtu come to their points; what body.vtu has must be the same to single
    precision."""
    piece = Piece("output/body.vtu")
    first = {}
    for k in range(piece.n_points):
        first.setdefault(piece.points[3 * k:3 * k + 2], k)
    written = [EXACT(line) for line in
               pathlib.Path("output/displacement.txt").read_text().split()]
    require(len(written) == body.n and len(first) == len(body.points),
            "wrong success: mesh", f"{len(written)} of {body.n} unknowns")
    u = [None] * body.n
    size = max(abs(x) for x in piece.at_points["displacement"])
    worst = 0.
    for n, (place, k) in enumerate(first.items()):
        v = min(range(len(body.points)),
                key=lambda w: math.dist(place, body.scene.mesh.points[w]))
        require(math.dist(place, body.scene.mesh.points[v])
                <= 1e-6 * size_of_file and u[2 * v] is None,
                "wrong success: mesh", f"no vertex at {place}")
        in_file = piece.at_points["displacement"][3 * k:3 * k + 2]
        pairs = [written[2 * n:2 * n + 2]]
        if body.kinds[2 * v] == body.kinds[2 * v + 1] == "contact":
            # Which of two normals is the first one is not said.
            pairs.append(pairs[0][::-1])
        errors = []
        for pair in pairs:
            values = [w + body.G[2 * v + i] for i, w in enumerate(pair)]
            cartesian = [dot(values, [e[i] for e in body.frames[v]])
                         for i in (0, 1)]
            errors.append((math.dist(map(float, cartesian), in_file), values))
        error, values = min(errors)
        worst = max(worst, error)
        u[2 * v:2 * v + 2] = values
    require(worst <= 1e-6 * size, "wrong success: body.vtu",
            f"differs from displacement.txt by {worst:.1e} of {size:.1e}")
    return u


def check_profile(body, s, force, tolerance, of_displacements):
    """contact_profile.csv has each contact node with its u_nu and its force."""
    with open("output/contact_profile.csv", encoding="utf-8") as file:
        rows = [{key: EXACT(value) for key, value in row.items()
                 if key not in ("state", "violation")}
                for row in csv.DictReader(file) if row["state"] != "held"]
    require(len(rows) == len(s), "wrong success: contact_profile.csv",
            f"{len(rows)} rows for {len(s)} contact nodes")
    for (v, number), i in body.node_of.items():
        at = [row for row in rows if math.dist(
            (row["x"], row["y"]), body.points[v]) <= 1e-9 * body.scene.mesh.length]
        u_nu = s[i] + body.G[2 * v + number]
        # At a corner there are two.
        require(any(abs(row["u_nu"] - u_nu) <= of_displacements
                    and abs(row["normal_force"] - force[i]) <= tolerance[i]
                    and abs(row["initial_gap"] - body.gap_at(v))
                    <= EXACT("1e-12") * body.gap_at(v) for row in at),
                "wrong success: contact_profile.csv",
                f"no row with u_nu = {u_nu:.6e}, force {force[i]:.6e}, gap "
                f"{body.gap_at(v):.6e}, but {at}")


def law_violation(body, s, force, shift, rounding):
    """The largest distance of a force from what bonds and foundation allow at
    displacements within shift of s."""
    lower, upper = [ZERO] * len(s), [ZERO] * len(s)
    for point in body.bonds:
        trace = point.trace(s)
        pulls = []
        for t in (trace - shift, trace, min(trace + shift, ZERO)):
            pulls.append(point.pull(t))
        for i, phi in point.nodes:
            lower[i] += phi * min(pulls)
            upper[i] += phi * max(pulls)
    violation = ZERO
    for i, x in enumerate(s):
        if x < -shift:
            violation = max(violation, force[i] - upper[i] - rounding[i])
        violation = max(violation, lower[i] - force[i] - rounding[i])
    return violation


def check_reactions(body, summary, residual, tolerance):
    """Resultants, from A u - f in Cartesian components. What the bonds pull at
    vertices that are held may be counted as support or foundation: their sum is
    one."""
    contact, supports = [ZERO, ZERO], [ZERO, ZERO]
    held = body.clamped | body.moved
    for v in held | set(body.normals):
        # Along the rows of the inverse of the frame's columns.
        (a, b), (c, d) = body.frames[v]
        determinant = a * d - b * c
        first, second = residual[2 * v:2 * v + 2]
        forces = [(d * first - b * second) / determinant,
                  (a * second - c * first) / determinant]
        sums = supports if v in held else contact
        for k in (0, 1):
            sums[k] += forces[k]
    applied = [sum((load[k] for load in body.cartesian_loads), ZERO)
               for k in (0, 1)]
    has_held_bonds = any(point.is_held for point in body.bonds)
    pairs = [("applied_force", summary["applied_force"], applied)]
    if has_held_bonds:
        pairs.append(("reactions together",
                      [sum(two) for two in zip(summary["clamped_reaction"],
                                               summary["contact_reaction"])],
                      [sum(two) for two in zip(supports, contact)]))
    else:
        pairs += [(name, summary[name], own) for name, own in
                  (("clamped_reaction", supports), ("contact_reaction", contact))]
    for name, printed, own in pairs:
        require(all(abs(EXACT(x) - y) <= tolerance for x, y in zip(printed, own)),
                f"wrong success: {name}",
                f"{printed}, not {list(map(float, own))}")


def check_success(scene, body):
    """Returns the class of a result that is right and figures; raises
    WrongResult for another one."""
    summary = json.loads(pathlib.Path("output/summary.json").read_text())
    require(summary["status"] == "success", "wrong success: exit code and status",
            summary["status"])
    word = summary["minimum"]["state"]
    is_bundle = summary["method"] == "energy bundle"
    largest_place = max(abs(x) for p in scene.mesh.points for x in p)
    u = read_displacement(body, largest_place)
    s = body.traces(u)
    residual = [a - f for a, f in zip(body.multiply(u), body.f)]
    largest = max(map(abs, residual))
    # Results are kept as u - g, which is the gap where that is far larger than
    # displacements: then forces far below the largest one are lost.
    # Gradients are of differences of places, which are rounded where they are.
    noise = [100 * (of_u + min(of_G, EXACT("1e-8") * largest)) for of_u, of_G in
             zip(body.rounding(u), body.rounding(body.G))]
    size = max(map(abs, u))
    if not size:
        return "solved, nothing moves", word
    force = [-residual[d] for d in body.contact_dofs]
    of_force = [noise[d] for d in body.contact_dofs]

    # What the bonds of a contact node bear; the law is relative to it.
    strengths = [ZERO] * len(s)
    for point in body.bonds:
        pull = max((-k * stiffness for k, (stiffness, _) in
                    zip(point.kinks, point.branches)), default=ZERO)
        for i, phi in point.nodes:
            strengths[i] += phi * pull
    strength = max(strengths)
    largest_contact = max(max(map(abs, force)), largest / 1000)
    scale = min(strength, largest_contact) if strength else largest_contact
    if not largest > 100 * max(noise) or not scale > 100 * max(of_force):
        return "not judged: forces are rounding", word

    least = body.global_minimum()
    own = body.condensed_functional(body.descend(s))
    at_zero = body.condensed_functional([ZERO] * len(s))
    energy = at_zero - least
    J, printed = body.functional(u), EXACT(summary["functional"])
    terms = body.size_of_terms(u) + abs(body.constant)
    # What bonds can change in J, the lesser of two energies.
    can_change = sum((point.branches[-1][1] for point in body.bonds), ZERO)
    gain = dot(body.g, solve(body.S, body.g)) / 2
    can_change = min(can_change, gain) if body.bonds else gain

    inside = max((max(abs(residual[d]) - noise[d], ZERO)
                  for d in body.free_dofs), default=ZERO)
    lengths = EXACT("1e-3") * (
        min(EXACT(scene.M) * min(ONE, scale / strength), size) if strength
        else size)
    of_size = EXACT("1e-10") * size
    violation = law_violation(body, s, force, lengths, of_force)
    tight = law_violation(body, s, force, of_size, of_force)
    figures = {"inside": inside / largest, "law": violation / scale,
               "tightly": tight / largest_contact, "penetration": max(s) / size,
               "J": abs(J - printed) / terms,
               "above the own minimum": (J - own) / energy if energy else ZERO,
               "above the global minimum, of what bonds can change":
               (J - least) / can_change}
    detail = f"{word}; " + ", ".join(f"{name} {float(value):.1e}"
                                     for name, value in figures.items())

    promise, better = EXACT("1e-3"), EXACT("1e-8")
    require(inside <= (promise if is_bundle else better) * largest,
            "wrong success: equilibrium", detail)
    require(violation <= promise * scale, "wrong success: law", detail)
    if not is_bundle:
        require(tight <= better * largest_contact, "wrong success: tight law",
                detail)
    require(max(s) <= EXACT("1e-12") * size, "wrong success: penetration", detail)
    require(abs(J - printed) <= EXACT("1e-11") * terms, "wrong success: J", detail)
    check_profile(body, s, force, [better * largest + x for x in of_force],
                  EXACT("1e-12") * size + EPSILON * max(map(abs, body.G)))
    check_reactions(body, summary, residual, better * largest + max(noise) * 10)

    rounding = EXACT("1e-12") * terms
    require(J - least >= -rounding, "the check's minimum is too high", detail)
    bound = (summary.get("proof") or {}).get("lower_bound")
    # Bounds are of J as it is, whatever the precision of the condensed problem.
    require(bound is None or EXACT(bound) <= least + EXACT("1e-15") * terms,
            "wrong success: lower bound",
            f"{bound!r}, but the minimum is {least:.16e}; {detail}")
    of_energy = EXACT("1e-6") if is_bundle else better
    require(J - own <= of_energy * energy + rounding,
            "wrong success: not a minimum", detail)
    if word != "stationary":
        for point in body.bonds:
            for kink in point.kinks:
                distance = abs(point.trace(s) - kink)
                require(not point.nodes or distance > EXACT("1e-14") * abs(kink),
                        "wrong word: on a kink", detail)
    is_global = J - least <= better * can_change + rounding
    require(word != "global" or is_global, "wrong word: global", detail)
    if word == "best known" and not is_global:
        return "solved, best known above the minimum", detail
    if word == "local minimum" and not is_global:
        return "solved, local minimum above the global one", detail
    return f"solved, {word}", detail


def bonds_of_result():
    """What bonds do in a result."""
    states = json.loads(
        pathlib.Path("output/summary.json").read_text())["bond_states"]
    broken = sum(n for name, n in states.items()
                 if name == "broken" or name.startswith("partly"))
    bonded, contact = states["bonded"], states["contact"]
    return ("no bonds" if states["free"] else
            "all press" if not broken + bonded else
            "none is broken" if not broken else
            "some are broken" if bonded + contact else "all are broken")


def message_class(text):
    """A message without what is different in every scene."""
    text = text.strip().splitlines()[0] if text.strip() else "no message"
    return re.sub(r"[-+]?[0-9][0-9.]*(e[-+]?[0-9]+)?", "#", text)[:110]


def limit_time():
    """Ends a process that goes on for too long."""
    resource.setrlimit(resource.RLIMIT_CPU,
                       (SECONDS_FOR_A_SCENE, SECONDS_FOR_A_SCENE + 1))


def try_scene(debond, scene, body):
    """Returns what became of a scene: a class and figures."""
    shutil.rmtree("output", ignore_errors=True)
    pathlib.Path("shape.msh").write_text(scene.mesh.text())
    pathlib.Path("shape.prm").write_text(scene.text())
    try:
        result = subprocess.run([debond, "shape.prm"], capture_output=True,
                                text=True, check=False, preexec_fn=limit_time,
                                timeout=20 * SECONDS_FOR_A_SCENE)
    except subprocess.TimeoutExpired:
        return "hang", "of the clock"
    if result.returncode in (-24, -9):  # SIGXCPU, SIGKILL
        return "hang", f"signal {-result.returncode}"
    if result.returncode == 2:
        return "rejected", message_class(result.stderr)
    if result.returncode == 3:
        return "not solved", message_class(result.stderr)
    if result.returncode != 0:
        return "internal error", f"{result.returncode}: {result.stderr}"
    try:
        return check_success(scene, body)
    except WrongResult as wrong:
        return wrong.args


def main(debond, count=30, first=0, listed=None):
    """Tries the scenes and prints what became of them."""
    kinds, reasons, shapes, bonds = (collections.Counter() for _ in range(4))
    failed = False
    n_missed = 0
    for number in range(first, first + count):
        scene, body = make_scene(number)
        kind, detail = try_scene(debond, scene, body)
        kinds[kind] += 1
        shapes[scene.mesh.kind] += 1
        if kind in ("rejected", "not solved"):
            reasons[f"{kind}: {detail}"] += 1
        elif kind.startswith("solved"):
            bonds[bonds_of_result()] += 1
        is_failure = not kind.startswith(
            ("solved", "not judged", "rejected", "not solved"))
        failed |= is_failure
        if kind == "solved, best known above the minimum":
            search = scene.settings["Solver/Search"]
            n_missed += search == "automatic"
            print(f"{kind}, {search} search, scene {number} ({scene.mesh.kind}): "
                  f"{detail}", flush=True)
        if is_failure or number == listed:
            print(f"{kind}, scene {number} ({scene.mesh.kind}): {detail}\n"
                  f"{scene.text()}", flush=True)
        if number == listed:
            print(scene.mesh.text())
            for file in ("shape.msh", "shape.prm"):
                shutil.copy(file, WORKING_DIRECTORY)
    for counts in (kinds, reasons, shapes, bonds):
        for name, n in sorted(counts.items()):
            print(f"{n:6} {name}")
    n_solved = sum(n for kind, n in kinds.items() if kind.startswith("solved"))
    if 2 * n_solved < count:
        print("fewer than half of the scenes are solved")
        failed = True
    if 50 * kinds["not judged: forces are rounding"] > count + 50:
        print("more than 2 of 100 scenes are not judged")
        failed = True
    if 100 * n_missed > count + 100:
        print("automatic misses more than 1 minimum of 100 scenes")
        failed = True
    return 1 if failed else 0


WORKING_DIRECTORY = os.getcwd()
with tempfile.TemporaryDirectory() as directory:
    program = str(pathlib.Path(sys.argv[1]).resolve())
    os.chdir(directory)
    sys.exit(main(program, *map(int, sys.argv[2:])))
