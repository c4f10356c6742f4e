# SPDX-License-Identifier: LGPL-2.1-or-later
"""Random and other scenes beside which the program is tested, as entries and meshes of triangles
or tetrahedra for oracle.py: bodies of many shapes, boxes and frustums around an axis; boxes cut
as the program does it; entries of bodies with many patches for check_search.py; geometries for
check_formats.py. Shares nothing with the program."""

import collections
import itertools
import math
import pathlib
import random
import sys
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from oracle import Body, determinant
from run_scenes import full_entry, sawteeth

SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))
GRID_KINDS = ("L", "step", "notch", "hole")
LARGEST_DOFS = 240


class Draw(random.Random):
    """Random numbers that are the same with every version of Python."""

    def chance(self, probability):
        return self.random() < probability

    def magnitude(self, low, high):
        return 10. ** self.uniform(low, high)

    def below(self, n):
        return min(int(self.random() * n), n - 1)

    def between(self, low, high):
        return low + self.below(high - low + 1)

    def choice(self, values):
        return values[self.below(len(values))]

    def shuffled(self, values):
        rest = list(values)
        return [rest.pop(self.below(len(rest))) for _ in range(len(rest))]


class Field:
    """A number that is linear in x, y and z, and its text for a scene."""

    def __init__(self, constant, slopes=()):
        self.constant, self.slopes = constant, slopes

    def __str__(self):
        return repr(self.constant) + "".join(
            f"+({slope!r})*{x}" for slope, x in zip(self.slopes, "xyz") if slope)

    def times(self, factor):
        return Field(factor * self.constant, [factor * s for s in self.slopes])


# ------------------------------------------------------------------ the bodies


def faces_of_box(low, high):
    """Also the edges of a face of the grid, the ends of an edge."""
    return [tuple(corner[:k] + (end,) + corner[k + 1:] for corner in (low, high))
            for k in range(len(low)) if low[k] < high[k] for end in (low[k], high[k])]


def crossed(low, high):
    """The parts of a box of the grid with its middle and those of its faces."""
    if sum(a < b for a, b in zip(low, high)) == 1:
        return [[low, high]]
    middle = tuple((a + b) // 2 for a, b in zip(low, high))
    return [[middle] + part for face in faces_of_box(low, high) for part in crossed(*face)]


def cut_along_diagonals(first, last):
    """Of a box the simplices along all ways from one corner to the other."""
    parts = []
    for order in itertools.permutations(range(len(first))):
        part = [first]
        for k in order:
            part.append(part[-1][:k] + (last[k],) + part[-1][k + 1:])
        parts.append(part)
    return parts


def corners(low, high):
    """Of a box, a face or an edge of the grid in Gmsh's order."""
    axes = [k for k, (a, b) in enumerate(zip(low, high)) if a < b]
    ways = [[], axes[:1], axes[:2], axes[1:2]][:2 ** len(axes)]
    ways += [way + axes[2:] for way in ways[:4 * (len(axes) == 3)]]
    return [tuple(high[k] if k in way else x for k, x in enumerate(low)) for way in ways]


def volume(points):
    """Twice (six times) that of a triangle (a tetrahedron), with its sign."""
    return determinant([[x - y for x, y in zip(p, points[0])] for p in points[1:]])


class Mesh:
    """A grid of boxes, some left out, under a map, cut in simplices by the script or by
    the program. Corners of the grid have even numbers; those between are middles. The
    sides are those of the grid, and "cut" is what bounds the boxes left out: lists of
    faces."""

    def __init__(self, draw, dim):
        self.dim = dim
        self.kind = draw.choice(["box", "box", "trapezoid", "taper", "sheared",
                                 "arch", "arch", "wavy", *GRID_KINDS])
        self.settings = {"Mesh/Source": "file", "Mesh/File": "shape.msh"}
        self.cells = self.draw_cells(draw)
        lows = self.remove_boxes(draw, list(itertools.product(*map(range, self.cells))))
        boxes = [(tuple(2 * i for i in low), tuple(2 * i + 2 for i in low))
                 for low in draw.shuffled(lows)]
        # Bricks are crossed by the program.
        self.style = "bricks" if self.kind == "box" else draw.choice(
            ["diagonals", "diagonals", "crossed", "bricks"])
        parts = self.cut(draw, boxes)
        keys = draw.shuffled(sorted({key for part in parts for key in part}))
        keys.sort(key=lambda key: any(x % 2 for x in key))
        self.n_corners = sum(not any(x % 2 for x in key) for key in keys)
        place = self.box(draw) if self.kind == "box" else self.map(draw)
        number = self.fill(parts, keys, place)
        if self.style == "bricks":
            self.file_cells = [[number[c] for c in corners(*box)] for box in boxes]
            edges = [self.points[self.file_cells[0][c]] for c in (0, 1, 3, 4)[:dim + 1]]
            if volume(edges) < 0.:
                half = 2 ** (dim - 1)
                self.file_cells = [c[half:] + c[:half] if dim == 3 else c[::-1]
                                   for c in self.file_cells]
            self.file_sides = self.boundary(
                number, [corners(*face) for box in boxes for face in faces_of_box(*box)])
        else:
            self.file_cells = self.simplices
            self.file_sides = self.sides
        self.reverses_faces = draw.chance(0.2)

    def fill(self, parts, keys, place):
        """Points, simplices and sides, from parts that are lists of corners of the grid; the
        corners in their order, and where they are. Returns the numbers of the corners."""
        self.points = [self.point(place, key) for key in keys]
        number = {key: n for n, key in enumerate(keys)}

        def positive(part):
            numbers = [number[key] for key in part]
            turned = volume([self.points[n] for n in numbers]) < 0.
            return numbers[:-2] + numbers[:-3:-1] if turned else numbers

        self.simplices = [positive(part) for part in parts]
        self.sides = self.boundary(
            number, [part[:k] + part[k + 1:] for part in parts for k in range(self.dim + 1)])
        return number

    def draw_cells(self, draw):
        """The numbers of boxes along the axes."""
        if self.kind in GRID_KINDS:
            cells = [draw.between(3, 5 if self.dim == 2 else 3),
                     3 if self.kind == "hole" else draw.between(2, 4 - (self.dim == 3))]
            return cells + [1] * (self.dim - 2)
        if self.dim == 3:
            return draw.shuffled([draw.between(1, 3), draw.between(1, 2), 1])
        return [draw.between(2, 20 if draw.chance(0.2) else 9), draw.between(1, 3)]

    def remove_boxes(self, draw, lows):
        """What is left of all boxes of the grid."""
        nx, ny = self.cells[:2]
        i = draw.between(1, max(nx - 2, 1))
        j = min(draw.between(1, ny), ny - 1)
        left_out = {"L": lambda x, y: x >= i and y >= j, "step": lambda x, y: x < i and y == ny - 1,
                    "notch": lambda x, y: x == i and y == ny - 1, "hole": lambda x, y: x == i
                    and y == 1}.get(self.kind)
        return [low for low in lows if not (left_out and left_out(*low[:2]))]

    def cut(self, draw, boxes):
        """The simplices, as lists of corners of the grid."""
        if self.style != "diagonals":
            return [part for box in boxes for part in crossed(*box)]
        # Diagonals of boxes side by side agree if an axis is turned for all of
        # them, or for each second one along that axis.
        turns = [(draw.below(2), draw.below(2)) for _ in range(self.dim)]
        parts = []
        for box in boxes:
            is_turned = [(turn + every * low // 2) % 2 for low, (turn, every) in zip(box[0], turns)]
            parts += cut_along_diagonals(*(tuple(box[(end + t) % 2][k] for k,
                                                 t in enumerate(is_turned)) for end in (0, 1)))
        return parts

    def boundary(self, number, faces):
        """Those faces that there are once, by the names of their sides."""
        counts = collections.Counter(map(frozenset, faces))
        sides = collections.defaultdict(list)
        for face in faces:
            if counts[frozenset(face)] > 1:
                continue
            names = [SIDES[k][end > 0] for k in range(self.dim) for end in (0, 2 * self.cells[k])
                     if all(corner[k] == end for corner in face)]
            sides[names[0] if names else "cut"].append(tuple(number[c] for c in face))
        return dict(sides)

    def point(self, place, key):
        """Where a corner is, or the mean of the corners about it."""
        around = list(itertools.product(*([x - 1, x + 1] if x % 2 else [x] for x in key)))
        places = [place(*(x // 2 for x in corner)) for corner in around]
        return tuple(sum(x) / len(places) for x in zip(*places))

    def box(self, draw):
        """One of the program's own, up to 1000 times as long as high."""
        self.length = draw.magnitude(-3., 3.)
        lengths = [self.length] + [self.length / draw.magnitude(0., 3. if draw.chance(0.2) else 1.)
                                   for _ in range(self.dim - 1)]
        lengths = draw.shuffled(lengths)
        degrees = draw.choice([0., 0., draw.uniform(-180., 180.)])
        self.settings = {"Mesh/Lengths": ", ".join(map(repr, lengths)),
                         "Mesh/Cells": ", ".join(map(str, self.cells)),
                         "Mesh/Rotation": repr(degrees)}
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

        def place(*key):
            x, y, *z = (length * i / n for length, i, n in zip(lengths, key, self.cells))
            return c * x - s * y, s * x + c * y, *z

        return place

    def map(self, draw):
        """From the numbers of a corner of the grid to its place."""
        self.length = draw.magnitude(-3., 3.)
        height, end = draw.uniform(0.15, 1.), 1.
        if self.kind == "taper":
            height, end = draw.magnitude(-1.7, -0.8), draw.magnitude(-1., -0.3)
        slope = draw.uniform(-0.4, 0.4) * (self.kind == "trapezoid")
        if slope:
            end = draw.uniform(0.3, 3.)
        shear = draw.uniform(-1., 1.) * (self.kind in ("sheared", *GRID_KINDS))
        wave = draw.uniform(0.02, 0.12) * (self.kind in ("wavy", *GRID_KINDS))
        waves = 2. * math.pi / draw.uniform(0.5, 2.)
        angle, inner = draw.uniform(0.5, 3.), draw.uniform(0.3, 0.9)
        grading = draw.choice([1., 1., draw.uniform(0.6, 1.6)])
        depth = draw.uniform(0.3, 1.)
        skew = draw.choice([(0., 0.), (draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3))])
        turns = [draw.choice([0., 0.5 * math.pi, draw.uniform(-math.pi, math.pi)])
                 for _ in range(2 * self.dim - 3)]
        mirror = draw.choice([1., 1., -1.])
        shift = [draw.choice([0., draw.uniform(-1., 1.)]) for _ in range(self.dim)]

        def plane(xi, eta):
            if self.kind == "arch":
                # Mirrored, since angles go from left to right here.
                radius = inner + (1. - inner) * eta
                return -radius * math.cos(angle * xi), radius * math.sin(angle * xi)
            y = slope * xi + height * eta * (1. + (end - 1.) * xi)
            y += wave * math.sin(waves * xi) * (1. if self.kind == "wavy" else eta)
            return xi + shear * y, y

        def place(*key):
            at = list(plane((key[0] / self.cells[0]) ** grading, key[1] / self.cells[1]))
            if self.dim == 3:
                zeta = key[2] / self.cells[2]
                at = [(1. + skew[0] * zeta) * at[0], at[1] + skew[1] * zeta, depth * zeta]
            at[0] *= mirror
            for k, turn in enumerate(turns):
                a, b = k % self.dim, (k + 1) % self.dim
                at[a], at[b] = (math.cos(turn) * at[a] - math.sin(turn) * at[b],
                                math.sin(turn) * at[a] + math.cos(turn) * at[b])
            return tuple(self.length * (x + by) for x, by in zip(at, shift))

        return place

    def is_usable(self):
        """Whether there are few unknowns, and no cells that are flat."""
        for cell in self.simplices:
            points = [self.points[v] for v in cell]
            longest = max(math.dist(p, q) for p, q in itertools.combinations(points, 2))
            if self.kind != "box" and (volume(points) < 10. ** (-self.dim) * longest ** self.dim):
                return False
        return self.dim * len(self.points) <= LARGEST_DOFS

    def vertices(self, sides):
        """Of these sides."""
        return {v for side in sides for face in self.sides[side] for v in face}

    def extent(self, axis):
        """The least and the largest coordinate."""
        values = [point[axis] for point in self.points]
        return min(values), max(values)

    def text(self):
        """A file of version 2.2."""
        n_points = self.n_corners if self.style == "bricks" else len(self.points)
        sides = sorted(self.file_sides)
        return msh.text(
            self.points[:n_points],
            [((group,), face[::-1] if self.reverses_faces else face)
             for group, side in enumerate(sides, 1) for face in self.file_sides[side]],
            [((99,), cell) for cell in self.file_cells],
            {(self.dim - 1, group): side for group, side in enumerate(sides, 1)})


class Box(Mesh):
    """Of which all is given, cut as the program does it."""

    def __init__(self, lengths, cells):
        self.dim, self.length, self.cells = len(cells), max(lengths), cells
        parts = [part for low in itertools.product(*map(range, cells))
                 for part in crossed(tuple(2 * i for i in low), tuple(2 * i + 2 for i in low))]
        self.fill(parts, sorted({key for part in parts for key in part}), lambda *at: tuple(
            length * i / n for length, i, n in zip(lengths, at, cells)))


# ------------------------------------------------------------------ the scenes


class Scene:
    """A mesh, and what the check and the settings of the program both need."""

    def __init__(self, draw, dim):
        mesh = self.mesh = Mesh(draw, dim)
        self.dim = dim
        self.settings = {"Dimension": str(dim), **mesh.settings}
        self.E = draw.magnitude(-6., 12.)
        self.nu = draw.uniform(0.45, 0.499) if draw.chance(0.1) else (draw.uniform(-0.3, 0.45))
        self.is_plane_stress = dim == 2 and draw.chance(0.5)
        self.set("Material/Young modulus", self.E)
        self.set("Material/Poisson ratio", self.nu)
        self.set("Material/Hypothesis", "plane stress" if self.is_plane_stress else "plane strain")
        names = draw.shuffled(sorted(mesh.sides))
        n_contact = 2 if draw.chance(0.25) else 1
        self.contact = names[:n_contact]
        self.add_supports(draw, names[n_contact:])
        self.add_bonds(draw)
        self.add_method(draw)
        self.add_loads(draw)

    def set(self, path, value):
        """What the scene file sets."""
        self.settings[path] = value if isinstance(value, str) else repr(value)

    def field(self, draw, first, last):
        """From one value to another along an axis, or the second one alone."""
        axis = draw.below(self.dim)
        low, high = self.mesh.extent(axis)
        if draw.chance(0.5):
            return Field(last)
        slope = (last - first) / (high - low)
        slopes = [slope * (k == axis) for k in range(self.dim)]
        # Rounding must not make zero negative.
        return Field(first * (1. + 1e-12) - slope * low, slopes)

    def add_supports(self, draw, sides):
        """Clamps, or bonds alone; rollers on flat sides; displacements. What
        supports both hold they must agree on."""
        vertices = self.mesh.vertices
        n_clamped = 0 if draw.chance(0.25) else draw.between(1, 2) if (len(sides) > 2) else 1
        self.clamped, rest = sides[:n_clamped], sides[n_clamped:]
        self.rollers, self.moved = [], []
        for side in rest:
            if draw.chance(0.2) and self.is_flat(side) and not (
                    vertices([side]) & vertices(self.moved)):
                self.rollers.append(side)
            elif draw.chance(0.15) and not (vertices([side]) & vertices(self.clamped + self.moved
                                                                        + self.rollers)):
                self.moved.append(side)
        for entry, names in (("Clamped boundaries", self.clamped),
                             ("Roller boundaries", self.rollers),
                             ("Contact boundary", self.contact)):
            self.set("Boundary conditions/" + entry, ", ".join(names))

    def is_flat(self, side):
        """Whether all its vertices are in the plane of its first face."""
        points = [self.mesh.points[v] for v in sorted(self.mesh.vertices([side]))]
        first = [self.mesh.points[v] for v in self.mesh.sides[side][0]]
        return all(abs(volume(first + [p])) <= 1e-12 * self.mesh.length ** self.dim for p in points)

    def add_bonds(self, draw):
        """Law, quadrature and gap, of all and of sides and parts of their own; steps
        are those of the law relative to stiffness and threshold."""
        a = self.E / self.mesh.length * draw.magnitude(-3., 3.)
        if draw.chance(0.1) and self.clamped:
            a = draw.magnitude(-6., 12.)
        M = self.mesh.length * draw.magnitude(-5., -1.)
        self.a, self.M = a, M
        self.law = draw.choice(["winkler"] * 7 + ["curve"] * 2 + ["none"])
        self.set("Contact law/Law", self.law)
        if self.law == "curve":
            steps = [(1., draw.uniform(0.2, 0.8)), (draw.uniform(0.1, 0.8), 1.)]
            steps = steps[draw.chance(0.3):]
            self.set("Contact law/Curve", sawteeth(
                *([(a, M)[k] * step[k] for step in steps] for k in (0, 1))))
        self.quadrature = "nodal" if draw.chance(0.6) else draw.choice(
            ["midpoint", "gauss 1", "gauss 2", "gauss 3"])
        self.set("Contact law/Quadrature", self.quadrature)
        self.set_bonds(draw, "", 0.2, draw.chance(0.5 if self.clamped else 0.8))
        self.has_own, self.piece = draw.chance(0.3), None
        for side in self.contact if self.has_own else ():
            self.set_bonds(draw, " " + side, 0.5)
        if not self.has_own and draw.chance(0.3) and (
                self.mesh.style != "bricks"):  # which the program cuts
            axis = draw.below(self.dim)
            place = draw.uniform(*self.mesh.extent(axis))
            self.set("Parts/piece", f"{self.contact[0]}: {'xyz'[axis]} > {place!r}")
            self.piece = axis, place
            self.set_bonds(draw, " piece", 0.7)

    def holds_contact(self):
        """Whether a clamped or moved side and a contact side have a vertex in common."""
        return bool(self.mesh.vertices(self.clamped + self.moved)
                    & self.mesh.vertices(self.contact))

    def set_bonds(self, draw, name, probability, is_fixed=None):
        """Gives some of what they have another value, and its entries."""
        a, M = self.a, self.M
        law = "Contact law/"
        if self.law == "winkler":
            changes = [draw.chance(probability), draw.chance(probability)]
            stiffness, threshold = Field(a), Field(M)
            if changes[0]:
                stiffness = self.field(draw, a * draw.uniform(0.1, 1.), a * draw.magnitude(-1., 0.))
            if changes[1]:
                threshold = self.field(draw, M * draw.uniform(0.2, 1.), M * draw.uniform(0.2, 1.))
            if changes[0] or not name:
                self.set(f"{law}Bond stiffness{name}", str(stiffness))
            if changes[1] or not name:
                self.set(f"{law}Bond threshold{name}", str(threshold))
        elif self.law == "curve" and not name and draw.chance(0.4):
            factor = self.field(draw, a * draw.uniform(0.1, 1.), a)
            self.set(f"{law}Traction factor", f"({factor})/{a!r}")
        if draw.chance(0.2):
            # Negative where nothing holds the body in the foundation.
            sign = -1. if draw.chance(0.3) and not self.holds_contact() else 1.
            self.set(f"{law}Initial gap{name}", str(self.field(
                draw, sign * M * draw.uniform(0., 1.5), sign * M * draw.uniform(0., 1.5))))
        if is_fixed is None:
            is_fixed = self.is_fixed("")
            if draw.chance(0.3):
                is_fixed = draw.chance(0.5)
        self.set(f"{law}Tangential displacement{name}", "fixed" if is_fixed else "free")

    def is_fixed(self, name):
        """Whether the tangential displacement is."""
        entry = "Contact law/Tangential displacement"
        return self.settings.get(f"{entry} {name}", self.settings.get(entry)) == "fixed"

    def part_of(self, side, face):
        """The name by which bonds of a face go."""
        axis, place = self.piece or (0, math.inf)
        centre = sum(self.mesh.points[v][axis] for v in face) / len(face)
        return "piece" if side == self.contact[0] and centre > place else side

    def add_method(self, draw):
        """How it is solved."""
        method = draw.choice(["automatic"] * 5 + ["majorise minimise"] * 3 +
                             ["multigrid"] * 2 + (
            ["energy bundle"] * 2 + ["euclidean bundle"] if self.clamped else []))
        is_condensed = self.clamped and method != "euclidean bundle"
        self.set("Solver/Linear solver", "multigrid" if method == "multigrid" else "direct")
        self.set("Solver/Method", "majorise minimise" if method == "multigrid" else method)
        self.set("Solver/Euclidean bundle/Maximum iterations", "3000")
        self.set("Solver/Search", draw.choice(
            ["automatic", "automatic", "full", "none"]) if is_condensed else "automatic")
        is_proved = is_condensed and self.quadrature == "nodal" and draw.chance(0.3)
        self.set("Solver/Prove", "true" if is_proved else "false")
        self.set("Solver/Proof/Maximum time", "10")
        self.set("Solver/Proof/Threads", "1")
        if is_condensed and not is_proved and not method.startswith("energy") and (
                draw.chance(0.2)):
            self.set("Load path/Factors", "0.3, 0.7, 1")
            if self.moved and draw.chance(0.7):
                self.set("Load path/Factors", draw.choice(["1", "0.6, 0.2, 1"]))
                self.set("Load path/Displacement factors", "0.3, 0.7, 1")
            self.set("Load path/Global branch", draw.choice(["search", "prove"]) if (
                self.quadrature == "nodal") else "search")
        self.set("Output/Displacement", "true")
        self.set("Output/Matrices", "true")
        self.set("Output/Contact VTU", "false")
        self.set("Output/Directory", "output")

    def add_loads(self, draw):
        """By their entries, of size 1; scale_loads() sets them. None is a component of
        a displacement that is free."""
        def density(n, by=1.):
            return [self.field(draw, draw.uniform(-1., 1.), draw.uniform(-1., 1.))
                    .times(by) for _ in range(n)]

        self.loads = {"Boundary conditions/Displacement " + side: [
            None if draw.chance(0.3) else
            Field(draw.uniform(-1., 1.) * self.may_move(side, axis))
            for axis in range(self.dim)] for side in self.moved}
        loaded = [side for side in sorted(self.mesh.sides) if side not in self.clamped + self.moved]
        for side in draw.shuffled(loaded)[:draw.between(1, 2)]:
            if draw.chance(0.2):
                self.loads["Loads/Pressure " + side] = density(1)
            else:
                self.loads["Loads/Traction " + side] = density(self.dim)
        if draw.chance(0.25):
            self.loads["Loads/Body force"] = density(self.dim, 1. / self.mesh.length)
        self.expansion = 1e-5
        if draw.chance(0.15):
            self.set("Material/Thermal expansion", self.expansion)
            self.loads["Loads/Temperature change"] = density(1, 1. / (self.expansion * self.E))
        self.scale_loads(1., 1.)

    def may_move(self, side, axis):
        """Whether the faces that hold u_tau at the edges of a side are across the axis,
        so that its displacement along that contradicts nothing."""
        corners, points = self.mesh.vertices([side]), self.mesh.points
        for name, face in ((self.part_of(side, face), face) for side in self.contact
                           for face in self.mesh.sides[side]):
            if self.is_fixed(name) and corners & set(face):
                along = [points[v][axis] for v in face]
                if max(along) - min(along) > 1e-12 * self.mesh.length:
                    return False
        return True

    def scale_loads(self, factor, movement):
        """Multiplies loads and prescribed displacements."""
        for path, components in self.loads.items():
            by = factor if path.startswith("Loads") else movement
            self.loads[path] = [c and c.times(by) for c in components]
            self.set(path, "; ".join("free" if c is None else str(c) for c in self.loads[path]))


def choose_loads(draw, scene, body):
    """Loads that stretch intact bonds to about where they break, so that all,
    some or none of them do; and some of any size. Returns whether there are
    such loads."""

    def largest_opening():
        # Without the gap, which loads do not scale.
        body.set_loads(gap=0)
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
        body = Body(scene.settings, scene.mesh)
        if body.is_usable and choose_loads(draw, scene, body):
            return scene, body


def strip(lengths, cells, E, a, M, clamped, loads, law="winkler", tangential="free", nu=0.33,
          hypothesis="plane stress"):
    """Entries and mesh of a box of which all is given."""
    return {"Dimension": str(len(cells)), "Mesh/Lengths": ", ".join(map(repr, lengths)),
            "Mesh/Cells": ", ".join(map(str, cells)), "Material/Young modulus": str(E),
            "Material/Poisson ratio": str(nu), "Material/Hypothesis": hypothesis,
            "Boundary conditions/Clamped boundaries": clamped,
            "Boundary conditions/Contact boundary": "bottom", "Contact law/Law": law,
            "Contact law/Tangential displacement": tangential, "Contact law/Bond stiffness": str(a),
            "Contact law/Bond threshold": str(M), **loads}, Box(lengths, cells)


# ------------------------------------------------------------------ bodies of revolution


def vector(*values):
    return "; ".join(x if isinstance(x, str) else repr(float(x)) for x in values)


def crossed_grid(n, place):
    """Under a map of the unit square: a mesh, and the text of its file."""
    points, faces, cells = msh.box(n, (1., 1.), crossed=True)
    points, sides = [place(*p) for p in points], {}
    for (group,), face in faces:
        sides.setdefault(msh.SIDES[group - 1], []).append(tuple(face))
    return SimpleNamespace(points=points, simplices=[cell for _, cell in cells], sides=sides,
                           text=msh.text(points, faces, [((7,), cell) for _, cell in cells]))


def body_of(settings, mesh, pairs=()):
    """In doubles."""
    return Body(dict(full_entry(s).split("=", 1) for s in settings), mesh, float, pairs)


def tilted(draw, most):
    """A direction at most so many degrees from downwards."""
    angle = math.radians(draw.uniform(-most, most) - 90.)
    return 3 * math.cos(angle), 3 * math.sin(angle)


def revolved(draw):
    """Entries and mesh of a box or a frustum; None if nothing holds it."""
    n, inner, length = (draw.between(1, 4), draw.between(1, 3)), draw.choice(
        [0., 0., draw.uniform(.1, 2.)]), draw.magnitude(-1., 1.)
    height, shift, wider, tilt = draw.uniform(.3, 1.5), draw.uniform(-1., 1.), draw.choice(
        [0., draw.uniform(-.4, .8)]), draw.choice([0., draw.uniform(-.3, .3)])

    def place(x, y):
        if 0 < x < 1 and 0 < y < 1:
            x, y = x + draw.uniform(-.1, .1) / n[0], y + draw.uniform(-.1, .1) / n[1]
        return length * (inner + x * (1 + wider * y)), length * (shift + height * y + tilt * x)

    def value(size):
        """Linear in x or y, or constant."""
        size *= draw.uniform(.3, 1.)
        slope = draw.uniform(-.1, .1) / length * draw.below(2)
        return f"{size!r}*(1 + {slope!r}*{draw.choice('xy')})"

    mesh = crossed_grid(n, place)
    E, degree = draw.magnitude(-2., 4.), draw.choice([1, 1, 2])
    s = {"Symmetry": "axis", "Degree": str(degree), "Source": "file"}
    if draw.chance(.3):
        for key, low, high in (("Young moduli", E / 2, 2 * E), ("Poisson ratios", -.1, .3),
                               ("Shear moduli", E / 5, E / 2)):
            s["Material/" + key] = ", ".join(repr(draw.uniform(low, high)) for _ in range(3))
        s["Material/Axis angle"], expansion = repr(draw.uniform(-180., 180.)), "1e-3, 2e-3, -5e-4"
    else:
        s["Material/Young modulus"], expansion = repr(E), "1e-3"
        s["Material/Poisson ratio"] = repr(draw.uniform(-.2, .47))
    names = draw.shuffled(["bottom", "top", "right"] + ["left"] * (inner > 0.))
    contact = names[:draw.choice([1, 1, 1, 2])]
    tangential = draw.choice(["fixed", "free"])
    s.update({"Contact boundary": ", ".join(contact),
              "Clamped boundaries": "", "Tangential displacement": tangential})
    # Where sides meet, they agree on what they prescribe.
    size, kinds = E * draw.magnitude(-4., -2.), ["Clamped", "Roller", "Displacement", "", ""]
    for name in names[len(contact):]:
        kind = draw.choice(kinds)
        kinds = ["Roller", ""] if kind in ("Clamped", "Roller") else [""] if kind else kinds
        if kind == "Displacement":
            s[f"Displacement {name}"] = vector(
                draw.choice(["free", "0"]), size / E * length * draw.uniform(.3, 1.))
        elif kind:
            s[f"{kind} boundaries"] = name
        else:
            load = draw.choice(["Traction", "Pressure", "Force"])
            sign = draw.choice([-1., 1.])
            s[f"Loads/{load} {name}"] = vector(value(size), value(sign * size)) if (
                load == "Traction") else value(sign * size) if load == "Pressure" else vector(
                    size * length**2, 2 * sign * size * length**2)
    if draw.chance(.5):
        s[f"Loads/Traction {contact[0]}"] = vector(value(size), value(-size))
    if draw.chance(.3) or not any("Loads" in key for key in s):
        s["Loads/Body force"] = vector(value(size / length), value(-size / length))
    if draw.chance(.3):
        s["Material/Thermal expansion"], s["Loads/Temperature change"] = expansion, value(
            size / E * 1e3)
    if draw.chance(.4):
        for name in contact:
            x, y = tilted(draw, 50.)
            x, y = {"bottom": (x, y), "top": (x, -y), "left": (y, x), "right": (-y, x)}[name]
            s[f"Foundation normal {name}"] = vector(x, f"{y!r}*(1+{.1 / length!r}*x)")
    s["Quadrature"] = draw.choice(["gauss 2", "gauss 3", "gauss 4"] + [
        "nodal", "nodal", "nodal", "midpoint"] * (degree == 1))
    k = E / length * draw.magnitude(-1.5, 1.)
    s["Bond stiffness"], s["Bond threshold"] = value(k), "1e9"
    body = body_of([f"{key}={value}" for key, value in s.items()], mesh)
    s0 = body.is_usable and body.minimise([0] * len(body.bonds))
    if s0 is False or s0 is None:
        return None
    M = (float(np.abs(s0).max(initial=0.)) or size / E * length) * draw.uniform(.3, 1.3)
    s["Law"] = draw.choice(["winkler"] * 4 + ["curve", "bilinear", "none"])
    if s["Law"] == "winkler":
        s["Bond threshold"] = value(M)
    elif s["Law"] == "bilinear":
        s.update({"Bond stiffness": repr(k), "Bond threshold": "", "Bond strength": repr(k * M),
                  "Fracture energy": repr(k * M * M * draw.uniform(.7, 3.))})
    else:
        s.pop("Bond stiffness"), s.pop("Bond threshold")
        if s["Law"] == "curve":
            s["Curve"] = ", ".join(f"{p!r}:{t!r}" for p, t in (
                (0, 0), (M, k * M), (M, k * M / 2), (2 * M, k * M), (2 * M, 0)))
    if draw.chance(.25):
        s["Initial gap"] = value(M)
    # What nothing but bonds holds is not for all methods.
    moduli = np.linalg.eigvalsh(body.S) if body.contact_dofs else [1.]
    s["Method"] = draw.choice(["automatic", "majorise minimise", "energy bundle"])
    if moduli[0] < 1e-9 * moduli[-1]:
        s["Method"] = "majorise minimise"
    elif s["Method"] != "energy bundle":
        s["Search"] = draw.choice(["automatic", "none", "full"])
        s["Linear solver"] = draw.choice(["direct"] * 4 + ["multigrid"])
        s["Prove"] = str(s["Quadrature"] == "nodal" and draw.chance(.4)).lower()
    for name in names:
        s[f"Probes/force_{name}"] = "force " + name
    return [f"{key}={value}" for key, value in s.items()], mesh


# ---------------------------------------- entries of scenes without an oracle


def waves(draw, length):
    """A load along x that changes its sign."""
    n = draw.uniform(0.6, 8.)
    if draw.chance(0.5):
        return (f"{draw.uniform(0.5, 1.5)}*sin({2. * math.pi * n / length}*x"
                f"+{draw.uniform(0., 6.28)})+{draw.uniform(-0.5, 0.8)}")
    load = repr(draw.uniform(-1., 1.5))
    for k in range(int(n) + 2):
        step = (-1.)**k * draw.uniform(0.2, 1.5)
        load = f"if(x<{length * draw.uniform(0., 1.)},{step},{load})"
    return load


def patched_scene(draw):
    """Entries but for the law, and the height: a body with many patches."""
    kind = draw.choice(["bar", "strip", "pad", "plate"])
    length = draw.uniform(1., 3.)
    height = length * draw.magnitude(-1.6, -0.6)
    clamped = {"strip": "left", "pad": "top"}.get(kind, "left, right")
    loaded, load = "bottom" if kind == "pad" else "top", waves(draw, length)
    scene = [f"Poisson ratio={draw.uniform(0., 0.45)}", "Young modulus=1",
             "Clamped boundaries=" + clamped, "Method=automatic",
             "Tangential displacement=" + draw.choice(["fixed", "free"])]
    if kind == "plate":
        return scene + [
            "Dimension=3", f"Lengths={length}, {height}, {length * draw.uniform(0.2, 0.6)}",
            f"Cells={draw.between(8, 14)}, 1, {draw.between(3, 6)}",
            f"Traction {loaded}=0; ({load})*(1+{draw.uniform(-0.8, 0.8)}*z); 0"], height
    return scene + [f"Lengths={length}, {height}", f"Traction {loaded}=0; {load}",
                    f"Cells={draw.between(40, 140)}, {draw.between(1, 4)}"], height


def geometry(dim, draw):
    """A square or a cube for Gmsh, of random sizes at the corners."""
    text = [f"Point({n}) = {{{x}, {y}, 0, {draw.uniform(0.1, 0.4)!r}}};"
            for n, (x, y) in enumerate([(0, 0), (1, 0), (1, 1), (0, 1)], 1)]
    text += ["Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};",
             "Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};"]
    sides, kind, body = (1, 2, 4), "Curve", "Surface(\"body\") = {1};"
    if dim == 3:
        text.append("out[] = Extrude {0, 0, 1} { Surface{1}; };")
        sides, kind = ("out[2]", "out[3]", "out[5]"), "Surface"
        body = "Volume(\"body\") = {out[1]};"
    text += [f'Physical {kind}("{name}") = {{{side}}};'
             for name, side in zip(("bottom", "right", "left"), sides)]
    return "\n".join(text + ["Physical " + body, ""])
