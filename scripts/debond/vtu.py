# SPDX-License-Identifier: LGPL-2.1-or-later
"""The body and the contact boundary, as .vtu files have them."""

import re

import meshio
import numpy

from .prm import BadInput

ROUNDING = 1e-9  # relative to what is usual


class Body:
    """The cells by their corners, with their fields; a file of each rank."""

    def __init__(self, files):
        self.meshes = [meshio.read(file) for file in files]
        self.points = numpy.concatenate([m.points for m in self.meshes])
        cells, n = [], 0
        for mesh in self.meshes:
            (block,) = mesh.cells
            self.dim = 3 if block.type.startswith("tetra") else 2
            cells.append(block.data[:, :self.dim + 1] + n)
            n += len(mesh.points)
        self.cells = numpy.concatenate(cells)
        self.size = numpy.ptp(self.points, axis=0).max()
        self.region = self.in_cells("region").astype(int) if (
            "region" in self.meshes[0].cell_data) else numpy.zeros(len(self.cells), int)
        # Files of ranks have points of their own: those at one place are one.
        # In a single file these are of bodies that are glued to each other.
        self.vertex = numpy.arange(n) if len(files) == 1 else numpy.unique(
            self.points, axis=0, return_inverse=True)[1].ravel()

    def at_points(self, name):
        return numpy.concatenate([m.point_data[name] for m in self.meshes])

    def in_cells(self, name):
        return numpy.concatenate([m.cell_data[name][0].ravel() for m in self.meshes])

    def at_corners(self, name, averaged):
        """At the corners of each cell: the sizes of vectors, or what the cell has;
        averaged over those around a point of the file (bodies that are glued to each
        other have points of their own) that are of the same material."""
        if name in self.meshes[0].point_data:
            return numpy.linalg.norm(self.at_points(name), axis=1)[self.cells]
        if name not in self.meshes[0].cell_data:
            raise BadInput(f"there is no field {name}, but displacement, " +
                           ", ".join(self.meshes[0].cell_data))
        values = self.in_cells(name)[:, None].repeat(self.dim + 1, axis=1)
        if averaged and name != "region":
            group = numpy.unique(self.cells + len(self.points) * self.region[:, None],
                                 return_inverse=True)[1].ravel()
            mean = numpy.bincount(group, values.ravel()) / numpy.bincount(group)
            values = mean[group].reshape(values.shape)
        return values

    def usual_stress(self):
        """The largest one, or that of a strain u / size in a material as stiff as the
        energy says if this is larger: then stress is rounding."""
        u = numpy.linalg.norm(self.at_points("displacement"), axis=1).max()
        stress, energy = (max(
            abs(self.in_cells(field)).max().item() for field in self.meshes[0].cell_data
            if re.match(names, field)) for names in ("stress_|von_mises", "strain_energy"))
        return stress * max(1., stress * u / self.size / (energy or 1e-300))

    def boundary(self):
        """The faces (2D: edges) that belong to one cell, and the cells."""
        faces = numpy.concatenate([numpy.delete(self.cells, k, axis=1)
                                   for k in range(self.dim + 1)])
        _, first, count = numpy.unique(
            numpy.sort(self.vertex[faces], axis=1), axis=0, return_index=True,
            return_counts=True)
        first = first[count == 1]
        return faces[first], first % len(self.cells)

    def borders(self, triangles, cells):
        """The edges of triangles at which the material region changes."""
        edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        ends = numpy.sort(self.vertex[edges], axis=1)
        _, first = numpy.unique(
            numpy.column_stack([ends, self.region[cells].repeat(3)]),
            axis=0, return_index=True)
        _, again, count = numpy.unique(ends[first], axis=0, return_index=True,
                                       return_counts=True)
        return edges[first[again[count > 1]]]


class Contact:
    """The shares that nodes have of faces of the contact boundary: their
    polygons, the `nodes` that they belong to, and the `state` in words."""

    def __init__(self, file, summary):
        self.mesh = meshio.read(file)
        self.dim, self.degree = summary["dimension"], summary["degree"]
        self.first = self.mesh.cells[0].data[:, 0]
        self.nodes = self.mesh.points[self.first]
        self.polygons = self.mesh.points[self.mesh.cells[0].data]
        names = list(summary["bond_states"])
        zero = names.index("contact")  # the number of which is 0
        names.insert(zero + 5, "held")
        numbers = self.mesh.cell_data["bond_state"][0].astype(int).ravel()
        self.state = numpy.array(names)[zero + numbers]

    def at_nodes(self, name):
        return self.mesh.point_data[name][self.first]

    def parts(self):
        """The states, with their parts of the boundary that is not held."""
        p = self.polygons
        size = numpy.linalg.norm(p[:, 1] - p[:, 0] if self.dim == 2 else numpy.cross(
            p[:, 2] - p[:, 0], p[:, 3] - p[:, 1]), axis=1) * (self.state != "held")
        if self.degree == 2:  # the nodes of a face have equal parts of it
            size.reshape(-1, {2: 4, 3: 12}[self.dim])[:, ::self.dim + 1] *= self.dim
        return {state: size[self.state == state].sum() / (size.sum() or 1.)
                for state in numpy.unique(self.state)}

    def shares(self, places, moved):
        """(polygons, states, faces) of the shares of faces with corners at these
        places, where they have moved."""
        step, shares = ((1, self.dim) if self.degree == 1 else
                        (self.dim + 1, self.dim * 2**(self.dim - 1)))
        corners, states = (
            of.reshape(-1, shares, *of.shape[1:])[:, :step * self.dim:step].tolist()
            for of in (self.nodes, self.state))
        known = {frozenset(map(tuple, face)): dict(zip(map(tuple, face), state))
                 for face, state in zip(corners, states)}
        found = [known.get(frozenset(map(tuple, face)), {}) for face in places.tolist()]
        state = numpy.array([of.get(tuple(corner), "") for face, of in zip(
            places.tolist(), found) for corner in face])
        after, before = (numpy.roll(moved, k, axis=1) for k in (-1, 1))
        parts = [moved, (moved + after) / 2]
        if self.dim == 3:
            parts += [0 * moved + moved.mean(axis=1, keepdims=True),
                      (moved + before) / 2]
        polygons = numpy.stack(parts, axis=2).reshape(-1, len(parts), 3)
        (shown,) = numpy.nonzero(state != "")
        return polygons[shown], state[shown], shown // self.dim

    def pieces(self):
        """(name, [(shares, places)]) of the connected pieces of a boundary in
        2D: the coordinate to which all are parallel, or the length along them,
        one after the other. In 3D all shares over the longest coordinate."""
        if self.dim == 3:
            axis = numpy.argmax(numpy.ptp(self.nodes, axis=0))
            return "xyz"[axis], [(range(len(self.nodes)), self.nodes[:, axis])]
        place = numpy.unique(self.nodes, axis=0, return_inverse=True)[1].ravel()
        at = [[] for _ in place]
        for share, k in enumerate(place):
            at[k].append(share)
        pieces, left = [], set(range(len(place)))
        for start in sorted(left, key=lambda i: (len(at[place[i]]) > 1, place[i])):
            piece = []  # from an end; the other share of a face is beside it
            while start in left:
                piece += [start, start ^ 1]
                left -= {start, start ^ 1}
                start = next((i for i in at[place[start ^ 1]] if i in left), None)
            pieces += [piece] if piece else []
        x = [self.nodes[piece] for piece in pieces]
        for axis in 0, 1:
            if max(numpy.ptp(y[:, 1 - axis]) for y in x) < 1e-6 * numpy.ptp(self.nodes):
                return "xy"[axis], [*zip(pieces, (y[:, axis] for y in x))]
        steps = [numpy.linalg.norm(numpy.diff(y, axis=0, prepend=y[:1]), axis=1)
                 for y in x]
        ends = numpy.cumsum([len(y) for y in x])[:-1]
        lengths = numpy.split(numpy.cumsum(numpy.concatenate(steps)), ends)
        return "length along the contact boundary", [*zip(pieces, lengths)]
