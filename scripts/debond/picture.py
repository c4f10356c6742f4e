# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what a run has written in its output directory."""

import argparse
import glob
import os
import sys

import meshio
import numpy

from . import cases, plots
from .plots import plt
from matplotlib.collections import LineCollection, PolyCollection

# The largest displacement in a picture, relative to the body's size, and what
# colours leave out: stress at corners grows without bound with refinement.
LARGEST_SHOWN = 0.06
CUT = 0.995
MOST_CELLS_WITH_EDGES = 3000
STATES = {"contact": "tab:blue", "bonded": "tab:green", "kink": "tab:olive",
          "broken": "tab:red", "free": "tab:gray", "held": "k"}


class Grid:
    """The cells of .vtu files by their corners, with their fields."""

    def __init__(self, files):
        points, cells, blocks = [], [], []
        for file in files:
            mesh = meshio.read(file)
            n = sum(map(len, points))
            for block in mesh.cells:
                corners = {"li": 2, "tr": 3, "te": 4, "qu": 4}[
                    block.type.replace("VTK_LAGRANGE_", "").lower()[:2]]
                cells.append(block.data[:, :corners] + n)
            points.append(mesh.points)
            blocks.append(mesh)
        self.points = numpy.concatenate(points)
        self.cells = numpy.concatenate(cells)
        self.meshes = blocks
        self.dim = 3 if numpy.ptp(self.points[:, 2]) > 0 else 2
        self.size = numpy.ptp(self.points, axis=0).max()
        # Cells may have points of their own: those at one place are one.
        self.vertex = numpy.unique(
            numpy.round(self.points / self.size * 1e6).astype(numpy.int64),
            axis=0, return_inverse=True)[1].ravel()

    def at_points(self, name):
        return numpy.concatenate([mesh.point_data[name]
                                  for mesh in self.meshes])

    def in_cells(self, name):
        """Of each cell, the mean if the field is at points; None if there is no
        such field."""
        if all(name in mesh.cell_data for mesh in self.meshes):
            return numpy.concatenate([data.ravel() for mesh in self.meshes
                                      for data in mesh.cell_data[name]])
        if all(name in mesh.point_data for mesh in self.meshes):
            corners = self.at_points(name)[self.cells]
            return corners.reshape(len(self.cells), -1).mean(axis=1)
        return None

    def boundary(self):
        """The faces (2D: edges) that belong to one cell, and the cells."""
        faces, owners = [], []
        for k in range(self.dim + 1):
            faces.append(numpy.delete(self.cells, k, axis=1))
            owners.append(numpy.arange(len(self.cells)))
        faces, owners = map(numpy.concatenate, (faces, owners))
        key = numpy.sort(self.vertex[faces], axis=1)
        _, first, count = numpy.unique(key, axis=0, return_index=True,
                                       return_counts=True)
        first = first[count == 1]
        return faces[first], owners[first]


def one_digit(value):
    return float(f"{value:.0e}") if value < 1 else float(f"{value:.1g}")


def projection(points, grid, azimuth=-65., elevation=25.):
    """Coordinates on the picture and the depth, without perspective; y, which
    is what the foundation is below, points up."""
    if grid.dim == 2:
        return points[:, :2], None
    a, e = numpy.radians((azimuth, elevation))
    right = numpy.array([-numpy.sin(a), 0, -numpy.cos(a)])
    back = numpy.array([numpy.cos(a) * numpy.cos(e), numpy.sin(e),
                        -numpy.sin(a) * numpy.cos(e)])
    up = numpy.cross(back, right)
    return points @ numpy.array([right, up]).T, points @ back


def colour_bar(figure, axes, drawn, values, title, unit):
    """Says what its colours leave out."""
    drawn.set(array=values, cmap="viridis")
    top, largest = numpy.quantile(values, CUT), values.max()
    if top <= 0 or largest < 1.2 * top:
        top = largest
    drawn.set_clim(min(0., values.min()), top or 1.)
    cut = (values > top).sum()
    words = title + (f", {unit}" if unit else "")
    if cut:
        words += f"; {cut} cells above {top:.3g} cut off, the largest is " \
                 f"{largest:.3g}"
    figure.colorbar(drawn, ax=axes, orientation="horizontal", shrink=0.7,
                    aspect=45, label=words, extend="max" if cut else "neither")


def figure_of(extent, more=0.):
    """As wide as pages are, as high as the body asks for."""
    height = 10. * extent[1] / max(extent[0], 1e-12) + 1.8 + more
    figure, axes = plt.subplots(figsize=(10., min(max(height, 2.8), 9.)))
    axes.set_aspect("equal")
    axes.grid(False)
    return figure, axes


def save(figure, directory, name):
    path = os.path.join(directory, name)
    for ending in ("png", "svg"):
        figure.savefig(f"{path}.{ending}", dpi=120, bbox_inches="tight",
                       metadata={"Date": None} if ending == "svg" else None)
    plt.close(figure)
    print(f"{path}.png")


def show_nodes(axes, profile, place, size):
    """The contact nodes in the colours of their states."""
    states = numpy.array(profile["state"])
    for state in dict.fromkeys(states):
        of = states == state
        axes.scatter(*place[of].T, s=size, color=STATES.get(state, "tab:purple"),
                     label=f"{state} ({of.sum()})", zorder=3)
    return len(set(states))


def draw_body(directory, units, field):
    files = (glob.glob(os.path.join(directory, "body.vtu")) or
             sorted(glob.glob(os.path.join(directory, "body.rank*.vtu"))))
    if not files:
        return
    grid = Grid(files)
    u = grid.at_points("displacement")
    largest = numpy.linalg.norm(u, axis=1).max()
    scale = one_digit(LARGEST_SHOWN * grid.size / largest) if largest else 1.
    faces, owners = grid.boundary()
    moved, depth = projection(grid.points + scale * u, grid)
    rest, _ = projection(grid.points, grid)
    values = grid.in_cells(field)
    if values is None:
        raise cases.prm.BadInput(f"{files[0]} has no field {field}")
    if grid.dim == 2:
        shown, colours = moved[grid.cells], values
    else:
        order = numpy.argsort(depth[faces].mean(axis=1))
        shown, colours = moved[faces[order]], values[owners[order]]
    both = numpy.concatenate([moved, rest])
    figure, axes = figure_of(numpy.ptp(both, axis=0), 0.6)
    edges = len(grid.cells) < MOST_CELLS_WITH_EDGES
    drawn = axes.add_collection(PolyCollection(
        shown, edgecolors=(0, 0, 0, 0.35) if edges else "face", linewidths=0.3))
    title = {"von_mises": "von Mises stress"}.get(field, field)
    colour_bar(figure, axes, drawn, colours, title,
               units[1] if field == "von_mises" else "")
    length = f", {units[0]}" if units[0] else ""
    if grid.dim == 2:
        axes.add_collection(LineCollection(rest[faces], colors="0.45",
                                           linewidths=1., linestyles="--",
                                           label="at rest"))
        axes.set(xlabel="x" + length, ylabel="y" + length)
    else:
        box(axes, grid, length)
        axes.axis("off")
    profile = cases.read_csv(os.path.join(directory, "contact_profile.csv"))
    if profile and grid.dim == 2:
        # Displacements of the nearest points of the boundary.
        own = numpy.unique(faces)
        nodes = numpy.array([profile["x"], profile["y"]]).T
        nearest = own[[numpy.argmin(((grid.points[own, :2] - node)**2).sum(1))
                       for node in nodes]]
        show_nodes(axes, profile, nodes + scale * u[nearest, :2],
                   max(4., min(20., 2000. / len(nodes))))
    if grid.dim == 2:
        axes.legend(ncol=7, loc="lower center", bbox_to_anchor=(0.5, 1.),
                    frameon=False)
    axes.autoscale_view()
    axes.set_title(f"displacement x {scale:g}, the largest is {largest:.3g}"
                   f"{length.replace(',', '')}", fontsize=9,
                   pad=22 if grid.dim == 2 else 6)
    save(figure, directory, "body")


def box(axes, grid, length):
    """The box around a body in 3D at rest, with its lengths."""
    low, high = grid.points.min(axis=0), grid.points.max(axis=0)
    corners = numpy.array([[(low, high)[b >> d & 1][d] for d in range(3)]
                           for b in range(8)])
    flat, depth = projection(corners, grid)
    lines = [(b, b | 1 << d) for b in range(8) for d in range(3)
             if not b >> d & 1]
    axes.add_collection(LineCollection([flat[list(line)] for line in lines],
                                       colors="0.45", linewidths=0.8,
                                       linestyles="--"))
    # Along edges that are not in front of the body: low ones, the left one.
    for d, side, to, at in ((0, 1, (0, -12), "center"), (1, 0, (-5, 0), "right"),
                            (2, 1, (5, -8), "left")):
        line = min((line for line in lines if line[1] ^ line[0] == 1 << d),
                   key=lambda line: flat[list(line), side].sum())
        axes.annotate(f"{'xyz'[d]}: {high[d] - low[d]:.4g}{length[1:]}",
                      flat[list(line)].mean(axis=0), fontsize=8, xytext=to,
                      textcoords="offset points", ha=at)


def draw_contact(directory, units):
    profile = cases.read_csv(os.path.join(directory, "contact_profile.csv"))
    if not profile:
        return
    length = f", {units[0]}" if units[0] else ""
    force = f", {units[1]}" if units[1] else ""
    if "z" in profile:
        draw_contact_3d(directory, profile, length)
        return
    name, x, _ = plots.position(profile)
    order = numpy.argsort(x)
    figure, both = plt.subplots(2, 1, figsize=(9, 6), sharex=True)
    for axes, key, label in ((both[0], "u_nu", "normal displacement" + length),
                             (both[1], "normal_force_density",
                              "normal force density" + force)):
        axes.plot(x[order], profile[key][order], color="0.6", lw=1)
        show_nodes(axes, profile, numpy.array([x, profile[key]]).T, 10.)
        axes.axhline(0, color="k", lw=0.6)
        axes.set_ylabel(label)
    thresholds = numpy.unique(profile["bond_threshold"])
    if len(thresholds) == 1 and thresholds[0] < 3 * abs(profile["u_nu"]).max():
        both[0].axhline(-thresholds[0], color="0.4", ls="--", lw=1,
                        label="bonds break")
    both[0].legend(ncol=7, loc="lower center", bbox_to_anchor=(0.5, 1.),
                   frameon=False)
    both[1].set_xlabel(name + length)
    both[1].set_title("positive: pressed, negative: held", fontsize=8,
                      loc="right")
    save(figure, directory, "contact")


def draw_contact_3d(directory, profile, length):
    """Opening and states of a surface, in the plane in which it is widest."""
    x = numpy.array([profile[axis] for axis in "xyz"]).T
    wide = sorted(numpy.argsort(numpy.ptp(x, axis=0))[1:])
    file = os.path.join(directory, "contact.vtu")
    figure, both = plt.subplots(2, 1, figsize=(9, 7), sharex=True)
    if os.path.exists(file):
        grid = Grid([file])
        gaps = grid.in_cells("gap")
        drawn = both[0].add_collection(PolyCollection(
            grid.points[grid.cells][:, :, wide], edgecolors="face"))
        colour_bar(figure, both[0], drawn, gaps, "opening", length[2:])
    show_nodes(both[1], profile, x[:, wide], max(3., min(20., 8000. / len(x))))
    both[1].legend(ncol=7, loc="lower center", bbox_to_anchor=(0.5, 1.),
                   frameon=False)
    for axes in both:
        axes.grid(False)
        axes.set_aspect("equal")
        axes.autoscale_view()
        axes.set(ylabel="xyz"[wide[1]] + length)
    both[1].set_xlabel("xyz"[wide[0]] + length)
    save(figure, directory, "contact")


def runs_of(direction):
    """Where a path turns: pairs of first and one past the last step."""
    turns = [0] + [k + 1 for k in range(1, len(direction))
                   if direction[k] * direction[k - 1] < 0] + [len(direction) + 1]
    return [(begin, end + (end <= len(direction)))
            for begin, end in zip(turns, turns[1:])]


def draw_path(directory, wanted):
    """A load path: four pictures of it, or the wanted 'Y over X'."""
    path = cases.read_csv(os.path.join(directory, "load_path.csv"))
    if not path:
        return
    arc = cases.read_csv(os.path.join(directory, "load_path_arc.csv"))
    factor = ("factor" if numpy.ptp(path["factor"]) > 0 else
              "displacement_factor")
    kinds = wanted or [f"broken_part over {factor}", f"J over {factor}",
                       f"normal_force over {factor}",
                       "factor over unit_load_work" if factor == "factor" else
                       "unit_displacement_work over displacement_factor"]
    n = len(kinds)
    figure, all_axes = plt.subplots(-(-n // 2), min(n, 2), squeeze=False,
                                    figsize=(10, 0.6 + 3.4 * -(-n // 2)))
    for axes, kind in zip(all_axes.flat, kinds):
        y, _, x = kind.partition(" over ")
        for name in (x, y):
            if name not in path:
                raise cases.prm.BadInput(f"load_path.csv has no column '{name}'; "
                                         f"it has {', '.join(path)}")
        other = [path.get("global_" + name, path[name]) for name in (x, y)]
        if not all(a is path[b] for a, b in zip(other, (x, y))):
            axes.plot(*other, "--", color="0.5", label="lowest minimum")
        for begin, end in runs_of(numpy.diff(path[factor])):
            rises = path[factor][min(end, len(path[factor])) - 1] > \
                path[factor][begin]
            axes.plot(path[x][begin:end], path[y][begin:end], ".-", ms=4,
                      label="loading" if rises else "unloading")
        if arc and x in arc and y in arc:
            axes.plot(arc[x], arc[y], ":", color="k", lw=1, label="arc")
        axes.set(xlabel=x, ylabel=y)
    for axes in all_axes.flat[n:]:
        axes.remove()
    all_axes[0, 0].legend()
    save(figure, directory, "load_path")


def draw_history(directory):
    history = cases.read_csv(os.path.join(directory, "history.csv"))
    J = history.get("functional", numpy.array([]))
    if len(J) > 2 and J[-1]:
        plot = plots.Plot("history", "", "iteration k", "relative to |J(x_K)|",
                          "xy")
        plot.add("J(x_k) - J(x_K)", numpy.arange(1, len(J) + 1),
                 (J - J[-1]) / abs(J[-1]))
        if "v" in history:
            plot.add("-v_k, the predicted descent", history["iteration"],
                     -history["v"] / abs(J[-1]), color="0.6", lw=0.8)
        plot.save(directory)
        print(os.path.join(directory, "history.png"))
    proof = cases.read_csv(os.path.join(directory, "proof.csv"))
    if proof and len(proof["nodes"]) > 2:
        gap = (proof["functional"] - proof["lower_bound"]) / \
            abs(proof["functional"])
        figure, both = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True)
        for axes, x in zip(both, ("seconds", "nodes")):
            axes.loglog(proof[x], gap, ".-")
            axes.set(xlabel=x, ylabel="gap relative to J")
        save(figure, directory, "proof")


def draw(directory, units="", field="von_mises", path=()):
    """All that a directory has something of. Throws BadInput."""
    if not os.path.exists(os.path.join(directory, "summary.json")):
        raise cases.prm.BadInput(f"{directory} has no summary.json of a run")
    units = [*(word.strip() for word in units.split(",")), "", ""]
    draw_body(directory, units, field)
    draw_contact(directory, units)
    draw_path(directory, path)
    draw_history(directory)


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/picture", description="Draws the results of a run: body, "
        "contact boundary, load path, history and proof, as PNG and SVG in its "
        "directory, as far as it has them.")
    parser.add_argument("directories", metavar="DIRECTORY", nargs="+")
    parser.add_argument("--units", default="", metavar='"LENGTH, STRESS"',
                        help='of the scene, as in "mm, MPa"')
    parser.add_argument("--field", default="von_mises",
                        help="of body.vtu, for the colours of the body")
    parser.add_argument("--path", default=[], action="append",
                        metavar='"Y over X"', help="columns of load_path.csv")
    options = parser.parse_args()
    try:
        for directory in options.directories:
            draw(directory, options.units, options.field, options.path)
    except cases.prm.BadInput as error:
        print(f"picture: {error}", file=sys.stderr)
        return 2
    return 0
