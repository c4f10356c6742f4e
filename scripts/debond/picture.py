# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what a run has written in its output directory."""

import argparse
import os
import sys

import meshio
import numpy
from matplotlib.collections import LineCollection, PolyCollection

from . import plots
from .plots import plt
from .prm import BadInput
from .runs import bodies, read_csv

ABOVE = {"ncol": 7, "loc": "lower center", "bbox_to_anchor": (0.5, 1.),
         "frameon": False}
# The largest displacement in a picture, relative to the body's size, and what
# colours leave out: stress at corners grows without bound with refinement.
LARGEST_SHOWN = 0.06
CUT = 0.995
MOST_CELLS_WITH_EDGES = 3000
STATES = {"contact": "tab:blue", "bonded": "tab:green", "kink": "tab:olive",
          "broken": "tab:red", "broken but closed": "tab:orange", "free": "tab:gray", "held": "k"}


class Grid:
    """The cells of .vtu files by their corners, with their fields."""

    def __init__(self, files):
        self.meshes = [meshio.read(file) for file in files]
        self.points = numpy.concatenate([m.points for m in self.meshes])
        cells, n = [], 0
        for mesh in self.meshes:
            (block,) = mesh.cells
            corners = {"li": 2, "tr": 3, "te": 4, "qu": 4}[block.type[:2]]
            cells.append(block.data[:, :corners] + n)
            n += len(mesh.points)
        self.cells = numpy.concatenate(cells)
        extent = numpy.ptp(self.points, axis=0)
        self.dim, self.size = 3 if extent[2] > 0 else 2, extent.max()

    def at_points(self, name):
        return numpy.concatenate([m.point_data[name] for m in self.meshes])

    def in_cells(self, name):
        """Of each cell, the mean if the field is at points."""
        if name in self.meshes[0].cell_data:
            return numpy.concatenate([mesh.cell_data[name][0].ravel()
                                      for mesh in self.meshes])
        if name not in self.meshes[0].point_data:
            raise BadInput(f"there is no field {name}")
        corners = self.at_points(name)[self.cells]
        return corners.reshape(len(self.cells), -1).mean(axis=1)

    def boundary(self):
        """The faces (2D: edges) that belong to one cell, and the cells. Files
        of ranks have points of their own: those at one place are one. In a
        single file these are of bodies that are glued to each other."""
        vertex = numpy.arange(len(self.points))
        if len(self.meshes) > 1:
            vertex = numpy.unique(
                numpy.round(self.points / self.size * 1e6).astype(int), axis=0,
                return_inverse=True)[1].ravel()
        faces = numpy.concatenate([numpy.delete(self.cells, k, axis=1)
                                   for k in range(self.dim + 1)])
        _, first, count = numpy.unique(
            numpy.sort(vertex[faces], axis=1), axis=0, return_index=True,
            return_counts=True)
        first = first[count == 1]
        return faces[first], first % len(self.cells)


def projection(points, grid, azimuth=-65., elevation=25.):
    """Coordinates on the picture and the depth, without perspective; y, the
    direction away from most foundations, points up."""
    if grid.dim == 2:
        return points[:, :2], points[:, 2]
    a, e = numpy.radians((azimuth, elevation))
    right = numpy.array([-numpy.sin(a), 0, -numpy.cos(a)])
    back = numpy.array([numpy.cos(a) * numpy.cos(e), numpy.sin(e),
                        -numpy.sin(a) * numpy.cos(e)])
    return points @ numpy.array([right, numpy.cross(back, right)]).T, \
        points @ back


def colour(axes, drawn, values, title):
    """Gives the cells colours, with a bar that says what they leave out."""
    top, largest = numpy.quantile(values, CUT), values.max()
    if top <= 0 or largest < 1.2 * top:
        top = largest
    drawn.set(array=values, cmap="viridis",
              clim=(min(0., values.min()), top or 1.))
    cut = (values > top).sum()
    if cut:
        title += (f"; {cut} cells above {top:.3g} cut off, the largest is "
                  f"{largest:.3g}")
    axes.figure.colorbar(drawn, ax=axes, orientation="horizontal", shrink=0.7,
                         aspect=45, label=title,
                         extend="max" if cut else "neither")


def show_nodes(axes, profile, place, size):
    """The contact nodes in the colours of their states."""
    for state in dict.fromkeys(profile["state"]):
        of = numpy.array(profile["state"]) == state
        axes.scatter(*place[of].T, s=size, color=STATES.get(state, "tab:purple"),
                     label=f"{state} ({of.sum()})", zorder=3)


def draw_body(directory, length, stress, field):
    files = bodies(directory)
    if not files:
        return
    grid = Grid(files)
    u, values = grid.at_points("displacement"), grid.in_cells(field)
    largest = numpy.linalg.norm(u, axis=1).max()
    scale = LARGEST_SHOWN * grid.size / largest if largest else 1.
    scale = float(f"{scale:.0e}")  # one digit, so that it can be said
    faces, owners = grid.boundary()
    moved, depth = projection(grid.points + scale * u, grid)
    rest, _ = projection(grid.points, grid)
    shown = grid.cells
    if grid.dim == 3:  # from behind to the front
        order = numpy.argsort(depth[faces].mean(axis=1))
        shown, values = faces[order], values[owners[order]]
    extent = numpy.ptp(numpy.concatenate([moved, rest]), axis=0)
    figure, axes = plt.subplots(
        figsize=(10., min(2.4 + 10. * extent[1] / extent[0], 9.)))
    axes.set_aspect("equal")
    axes.grid(False)
    edges = len(grid.cells) < MOST_CELLS_WITH_EDGES
    cells = axes.add_collection(PolyCollection(
        moved[shown], edgecolors=(0, 0, 0, 0.35) if edges else "face",
        linewidths=0.3))
    colour(axes, cells, values, "von Mises stress" + stress
           if field == "von_mises" else field)
    profile = read_csv(os.path.join(directory, "contact_profile.csv"))
    if grid.dim == 3:
        draw_box(axes, grid, length)
    else:
        axes.add_collection(LineCollection(rest[faces], colors="0.45",
                                           linestyles="--", label="at rest"))
        axes.set(xlabel="x" + length, ylabel="y" + length)
    if grid.dim == 2 and profile:
        # With displacements between the two nearest points of the boundary; of
        # bodies that are glued to each other in the middle between both.
        nodes = numpy.array([profile["x"], profile["y"]]).T
        own = numpy.unique(faces)
        _, first, place = numpy.unique((rest[own] / grid.size).round(6), axis=0,
                                       return_index=True, return_inverse=True)
        means = numpy.zeros((len(first), 2))
        numpy.add.at(means, place, u[own, :2])
        means /= numpy.bincount(place)[:, None]
        own = own[first]
        for k, node in enumerate(nodes.copy()):
            distance = numpy.linalg.norm(rest[own] - node, axis=1)
            i, j = numpy.argsort(distance)[:2]
            nodes[k] += scale * numpy.average(
                means[[i, j]], 0, [distance[j], distance[i]])
        show_nodes(axes, profile, nodes, max(4., min(20., 2000. / len(nodes))))
    if grid.dim == 2:
        axes.legend(**ABOVE)
    axes.autoscale_view()
    axes.set_title(f"displacement x {scale:g}, the largest is {largest:.3g}"
                   f"{length.replace(',', '')}", fontsize=9, pad=22)
    plots.save(figure, directory, "body")


def draw_box(axes, grid, length):
    """The box around a body in 3D at rest, with its lengths."""
    low, high = grid.points.min(axis=0), grid.points.max(axis=0)
    corners = numpy.array([[(low, high)[b >> d & 1][d] for d in range(3)]
                           for b in range(8)])
    flat, _ = projection(corners, grid)
    # Lengths along edges that are not in front of the body.
    for d, side, to, at in ((0, 1, (0, -12), "center"),
                            (1, 0, (-5, 0), "right"), (2, 1, (5, -8), "left")):
        lines = [flat[[b, b | 1 << d]] for b in range(8) if not b >> d & 1]
        axes.add_collection(LineCollection(lines, colors="0.45",
                                           linewidths=0.8, linestyles="--"))
        axes.annotate(f"{'xyz'[d]}: {high[d] - low[d]:.4g}{length[1:]}",
                      min(lines, key=lambda line: line[:, side].sum()).mean(0),
                      fontsize=8, xytext=to, textcoords="offset points", ha=at)
    axes.axis("off")


def draw_contact(directory, length, stress):
    profile = read_csv(os.path.join(directory, "contact_profile.csv"))
    if not profile:
        return
    figure, both = plt.subplots(2, 1, figsize=(9, 6), sharex=True)
    if "z" in profile:
        draw_surface(directory, profile, both, length)
    else:
        draw_line(profile, both, length, stress)
    both[int("z" in profile)].legend(**ABOVE)
    plots.save(figure, directory, "contact")


def draw_line(profile, both, length, stress):
    name, x, _ = plots.position(profile)
    order = numpy.argsort(x)
    for axes, key, label in (
            (both[0], "u_nu", "normal displacement" + length),
            (both[1], "normal_force_density", "normal force density" + stress)):
        axes.plot(x[order], profile[key][order], color="0.6", lw=1)
        show_nodes(axes, profile, numpy.array([x, profile[key]]).T, 10.)
        axes.axhline(0, color="k", lw=0.6)
        axes.set_ylabel(label)
    M = numpy.unique(profile["bond_threshold"])
    if len(M) == 1 and M[0] < 3 * abs(profile["u_nu"]).max():
        both[0].axhline(-M[0], color="0.4", ls="--", lw=1, label="bonds break")
    both[1].set_xlabel(name + length)
    both[1].set_title("positive: pressed, negative: held", fontsize=8,
                      loc="right")


def draw_surface(directory, profile, both, length):
    """Opening and states, in the plane in which the surface is widest."""
    x = numpy.array([profile[axis] for axis in "xyz"]).T
    wide = sorted(numpy.argsort(numpy.ptp(x, axis=0))[1:])
    file = os.path.join(directory, "contact.vtu")
    if os.path.exists(file):
        grid = Grid([file])
        cells = both[0].add_collection(PolyCollection(
            grid.points[grid.cells][:, :, wide], edgecolors="face"))
        colour(both[0], cells, grid.in_cells("gap"), "opening" + length)
    show_nodes(both[1], profile, x[:, wide], max(3., min(20., 8000. / len(x))))
    for axes in both:
        axes.grid(False)
        axes.set(aspect="equal", ylabel="xyz"[wide[1]] + length)
        axes.autoscale_view()
    both[1].set_xlabel("xyz"[wide[0]] + length)


def draw_path(directory, wanted):
    """A load path: four pictures of it, or the wanted 'Y over X'."""
    path = read_csv(os.path.join(directory, "load_path.csv"))
    if not path:
        return
    arc = read_csv(os.path.join(directory, "load_path_arc.csv"))
    loads = numpy.ptp(path["factor"]) > 0
    factor = "factor" if loads else "displacement_factor"
    kinds = wanted or [f"{y} over {factor}" for y in (
        "broken_part", "J", "normal_force")] + [
            "factor over unit_load_work" if loads else
            "unit_displacement_work over displacement_factor"]
    figure, all_axes = plt.subplots(
        -(-len(kinds) // 2), min(len(kinds), 2), squeeze=False,
        figsize=(10, 0.6 + 3.4 * -(-len(kinds) // 2)))
    rises = numpy.diff(path[factor]) >= 0
    turns = [0, *(numpy.nonzero(numpy.diff(rises))[0] + 1), len(rises)]
    for axes, kind in zip(all_axes.flat, kinds):
        y, _, x = kind.partition(" over ")
        if not {x, y} <= set(path):
            raise BadInput(f"load_path.csv has no '{kind}', but the columns "
                           + ", ".join(path))
        if not numpy.isnan(path.get(f"global_{y}", numpy.nan)).all():
            axes.plot(path.get(f"global_{x}", path[x]), path[f"global_{y}"],
                      "--", color="0.5", label="lowest minimum")
        for begin, end in zip(turns, turns[1:]):
            axes.plot(path[x][begin:end + 1], path[y][begin:end + 1], ".-", ms=4,
                      label="loading" if rises[begin] else "unloading")
        if arc:
            axes.plot(arc[x], arc[y], ":", color="k", lw=1, label="arc")
        axes.set(xlabel=x, ylabel=y)
    for axes in all_axes.flat[len(kinds):]:
        axes.remove()
    all_axes[0, 0].legend()
    plots.save(figure, directory, "load_path")


def draw_history(directory):
    """J over the iterations; the gap of a proof over time and nodes."""
    history = read_csv(os.path.join(directory, "history.csv"))
    J = history.get("functional", [])
    if len(J) > 2 and J[-1]:
        figure, axes = plt.subplots()
        axes.loglog(numpy.arange(1, len(J)), (J[:-1] - J[-1]) / abs(J[-1]),
                    label="J(x_k) - J(x_K)")
        if "v" in history:
            axes.loglog(history["iteration"], -history["v"] / abs(J[-1]),
                        color="0.6", lw=0.8, label="-v_k, predicted descent")
        axes.set(xlabel="iteration k", ylabel="relative to |J(x_K)|")
        axes.legend()
        plots.save(figure, directory, "history")
    proof = read_csv(os.path.join(directory, "proof.csv"))
    if proof and len(proof["nodes"]) > 2:
        J = proof["functional"]
        figure, both = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True)
        for axes, x in zip(both, ("seconds", "nodes")):
            axes.loglog(proof[x], (J - proof["lower_bound"]) / abs(J), ".-")
            axes.set(xlabel=x, ylabel="gap relative to J")
        plots.save(figure, directory, "proof")


def draw(directory, units="", field="von_mises", path=()):
    """All that a directory has something of. `units`: 'LENGTH, STRESS'."""
    if not os.path.exists(os.path.join(directory, "summary.json")):
        raise BadInput(f"{directory} has no summary.json of a run")
    units = [f", {unit.strip()}" if unit else ""
             for unit in (units.split(",") + [""])[:2]]
    draw_body(directory, *units, field)
    draw_contact(directory, *units)
    draw_path(directory, path)
    draw_history(directory)


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/picture", description="Draws what a run has written, as "
        "PNG and SVG in its directory.")
    parser.add_argument("directories", metavar="DIRECTORY", nargs="+")
    parser.add_argument("--units", default="", help='as in "mm, MPa"')
    parser.add_argument("--field", default="von_mises", help="of body.vtu")
    parser.add_argument("--path", default=[], action="append", help="columns of "
                        'load_path.csv, as in "reaction_left_y over factor"')
    options = parser.parse_args()
    try:
        for directory in options.directories:
            draw(directory, options.units, options.field, options.path)
    except BadInput as error:
        print(f"picture: {error}", file=sys.stderr)
        return 2
    return 0
