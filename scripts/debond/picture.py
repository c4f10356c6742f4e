# SPDX-License-Identifier: LGPL-2.1-or-later
"""Draws what a run has written in its output directory."""

import argparse
import difflib
import os
import re
import sys

import numpy
from matplotlib import colors
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.lines import Line2D

from . import plots, vtu
from .plots import plt
from .prm import BadInput
from .runs import bodies, read_csv, read_summary

ABOVE = {"loc": "lower center", "bbox_to_anchor": (0.5, 1.), "frameon": False}
# The largest displacement in a picture, relative to the body's size, and what
# colours leave out: stress at corners grows without bound with refinement.
LARGEST_SHOWN = 0.06
CUT = 0.995
# Up to this part of the largest displacement of a load path, openings are rounding.
NEGLIGIBLE = 1e-6
# Beside the other sign, values up to this part have no colours of their own.
SMALL_SIDE = 0.01
PIXELS = 1000.  # about the width of a body
MOST_VECTORS = 20000  # more polygons are an image in SVG files, too
MOST_SPLIT = 8000  # cells are drawn as about so many triangles, if they are fewer
LONGEST = 12.  # what is longer than so many times its height is stretched
FROM_ABOVE, FROM_BELOW = (-65, 25), (-65, -25)  # azimuth and elevation
STATES = {"contact": "tab:blue", "bonded": "tab:green", "kink": "tab:olive",
          "broken": "tab:red", "broken but closed": "tab:orange", "free": "tab:gray",
          "held": "0.8", "slides": "tab:cyan"}
PARTS = "damage", "shear_damage", "mode_mixity"  # fields from 0 to 1
OTHER_STATE = "tab:purple"
FORCES = {("mm", "MPa"): "N", ("mm", "N/mm²"): "N", ("mm", "GPa"): "kN",
          ("m", "Pa"): "N", ("m", "kPa"): "kN", ("m", "MPa"): "MN",
          ("m", "GPa"): "GN", ("µm", "MPa"): "µN"}
# Columns of load_path.csv: names, words for them, and what they measure.
COLUMNS = [
    ("factor", "load factor", ""),
    ("displacement_factor", "factor of the displacements", ""),
    ("(J|(elastic|adhesion|dissipated)_energy)", r"\1", "energy"),
    ("unit_load_work", "work of the loads of factor 1", "energy"),
    ("unit_displacement_work", "work of the supports per factor", "energy"),
    ("(.*)_part", r"\1 part of the contact boundary", ""),
    ("(mean|largest)_gap", r"\1 opening", "length"),
    ("normal_force", "normal force (positive: pressed)", "force"),
    ("contact_reaction_(.)", r"force of the foundation, \1", "force"),
    ("clamped_reaction_(.)", r"force of all supports, \1", "force"),
    ("reaction_(.*)_(.)", r"reaction of \1, \2", "force"),
    ("mean_(.*)_(.)", r"mean displacement of \1, \2", "length"),
    ("probe_(.*)_(.)", r"displacement of probe \1, \2", "length"),
    ("broken_zone", "size of the broken zone", "zone"),
    ("fronts", "position of the front, x", "length"), ("(.*)", r"\1", "")]


def endings(text, is_per_thickness):
    """What follows the words for what is measured, by 'LENGTH, STRESS'. Of plane
    bodies forces and energies are per thickness."""
    length, _, stress = (word.strip() for word in text.partition(","))
    if text and not (length and stress):
        raise BadInput(f"the units '{text}' are not LENGTH, STRESS as in 'mm, MPa'")
    force = FORCES.get((length, stress.replace("^2", "²")),
                       stress and f"{stress} {length}²")
    per = f"/{length}" if is_per_thickness else ""
    units = {"": "", "length": length, "stress": stress,
             "zone": length and length + ("" if is_per_thickness else "²"),
             "force": force and force + per,
             "energy": force and f"{force} {length}{per}"}
    return {what: unit and f", {unit}" for what, unit in units.items()}


def words_for(column, units):
    """The label of an axis with a column of load_path.csv."""
    found, words, what = next(
        (found, words, what) for pattern, words, what in COLUMNS
        if (found := re.fullmatch(pattern, column)))
    return found.expand(words).replace("_", " ") + units[what]


class Run:
    """A directory with results; of a load path those of a step, or the last one."""

    def __init__(self, directory, step, units):
        self.directory, self.title = directory, ""
        self.summary = read_summary(directory)
        if not self.summary:
            raise BadInput(f"{directory} has no summary.json of a run")
        self.units = endings(units, self.summary["dimension"] == 2
                             and self.summary.get("symmetry") != "axis")
        path = self.load_path = read_csv(os.path.join(directory, "load_path.csv"))
        self.factor = max(("factor", "displacement_factor"), key=lambda name: (
            numpy.ptp(path.get(name, 0.)) > 0, numpy.any(path.get(name, 1.) != 1)))
        n = len(path.get("step", []))
        of_peak = ""
        if step == "peak":
            peak = self.summary.get("load_path", {}).get("peak")
            if not peak:
                raise BadInput(f"{directory} has no largest force of a load path")
            # That may be inside of a step: the nearest one of the table.
            step = 1 + int(numpy.argmin(abs(
                path["displacement_factor"] - peak["displacement_factor"])))
            of_peak = f", the largest force is at {peak['displacement_factor']:.4g}"
        self.step = step
        if step is not None and not 1 <= step <= n:
            raise BadInput(f"{directory} has no step {step}, " + (
                f"but 1 to {n}" if n else "as it is no load path"))
        if n:
            words, factor = words_for(self.factor, self.units), path[self.factor]
            shown = step or n
            self.title = f"step {shown} of {n}, {words} {factor[shown - 1]:.4g}{of_peak}\n"
        # What load_path.csv knows of the largest displacement in all steps.
        self.largest = max([0., *(
            numpy.nanmax(abs(values)) for name, values in path.items()
            if re.fullmatch("largest_gap|mean_.*_.", name))])
        files = self.files("contact")
        self.contact = vtu.Contact(files[0], self.summary) if files else None
        if files:
            fields, state = self.contact.mesh.point_data, self.contact.state
            for values in fields["gap"], fields["u_nu"]:
                values[abs(values) < NEGLIGIBLE * self.largest] = 0.
            state[(state == "broken") & (self.contact.at_nodes("gap") == 0)] = (
                "broken but closed")
            if "slides" in fields:
                state[(state == "contact") & (self.contact.at_nodes("slides") > 0)] = (
                    "slides")

    def files(self, name):
        file, entry = name, name.capitalize()
        if self.step:
            file, entry = f"load_path/{name}-{self.step:05d}", f"Load path {name}"
        found = bodies(self.directory, file)
        if not found:
            print(f"picture: {self.directory} has no {file}.vtu: the run needs "
                  f"Output/{entry} VTU = true", file=sys.stderr)
        return found

    def save(self, figure, name):
        plots.save(figure, self.directory, f"{name}-{self.step}" if self.step else name)

    def legend(self, axes, before, **style):
        """What the colours of states mean, with their parts of the boundary."""
        parts = self.contact.parts() if self.contact else {}
        handles = [*before, *(Line2D(
            [], [], color=STATES.get(state, OTHER_STATE), label=state + (
                f" ({part:.1%})" if state != "held" else ""), **style)
            for state, part in parts.items())]
        columns = 4 // axes.get_gridspec().ncols
        axes.legend(handles=handles, ncol=columns, **ABOVE)
        return -(-len(handles) // columns)


def colours_of(states):
    return [colors.to_rgba(STATES.get(state, OTHER_STATE)) for state in states]


def views(body, contact, wanted):
    """Of each picture the directions right, up and to the viewer. In 3D the
    direction away from the contact boundary points up, or at a cut its coordinate;
    what is below the body is seen from below as well."""
    if body.dim == 2:
        return [numpy.eye(3)]
    axis, away, angles = 1, 1., [FROM_ABOVE]
    if contact:
        axis = numpy.argmin(numpy.ptp(contact.nodes, axis=0))
        of_body, of_contact = body.points[:, axis], contact.nodes[:, axis]
        if of_body.max() < of_contact.max() + 1e-6 * body.size:
            away = -1. if of_body.mean() < of_contact.mean() else 1.
        if (away * of_body).min() > (away * of_contact).min() - 1e-6 * body.size:
            angles = [FROM_ABOVE, FROM_BELOW]
    up = away * numpy.eye(3)[axis]
    across = numpy.eye(3)[numpy.argmax(numpy.ptp(body.points, axis=0) * (up == 0))]
    result = []
    for a, e in numpy.radians([wanted] if wanted else angles):
        right = numpy.cos(a) * numpy.cross(up, across) - numpy.sin(a) * across
        back = numpy.cos(e) * numpy.cross(right, up) + numpy.sin(e) * up
        result.append(numpy.array([right, numpy.cross(back, right), back]))
    return result


def is_rounding(values, usual):
    return numpy.nanmax(abs(values), initial=0.) <= vtu.ROUNDING * usual


def colour(axes, values, title, signed="RdBu_r", usual=0., limits=None):
    """A scale of colours for values, which on both sides of 0 has the colours
    `signed`, with a bar that says what it leaves out; one colour for what is the same
    everywhere but for rounding."""
    values = values[numpy.isfinite(values)]
    cut, ticks, size = numpy.zeros((2, 1), bool), None, abs(values).max()
    if limits:
        scale = ScalarMappable(colors.Normalize(*limits))
    elif is_rounding(values, usual) or numpy.ptp(values) <= NEGLIGIBLE * size:
        title += ": 0 to rounding" if is_rounding(values, usual) else (
            f": {values.mean():.4g} everywhere")
        scale = ScalarMappable(colors.Normalize(0., 1.), colors.ListedColormap(["0.8"]))
        ticks = []
    else:
        low, top = (largest if cut <= 0 or largest < 1.2 * cut else cut
                    for sizes in (-values, values)
                    for cut, largest in [(numpy.quantile(sizes, CUT), sizes.max())])
        # A side of hardly any size has no colours of its own, and loses nothing.
        below, above = low > SMALL_SIDE * top, top > SMALL_SIDE * low
        cut = numpy.array([(values < -low) & below, (values > top) & above])
        if cut.any():
            least, most = (0. if is_rounding(end, size) else end
                           for end in (values.min(), values.max()))
            title += (f"\n{cut.sum() / len(values):.1%} cut off, the values are "
                      f"{least:.3g} to {most:.3g}")
        scale = ScalarMappable(colors.Normalize(0., top)) if above else (
            ScalarMappable(colors.Normalize(-low, 0.), "viridis_r"))
        if below and above:
            scale = ScalarMappable(colors.TwoSlopeNorm(0., -low, top), signed)
            ticks = [-low, -low / 2, 0., top / 2, top][
                ::1 if axes[0].get_gridspec().ncols == 1 else 2]
    axes[0].figure.colorbar(
        scale, ax=axes, orientation="horizontal", shrink=0.7, aspect=45, label=title,
        ticks=ticks, format="%.3g" if ticks else None,
        extend=["neither", "min", "max", "both"][cut.any(axis=1) @ [1, 2]])
    return scale


def stretch(axes, width, height):
    """Gives axes one scale for both directions, unless they were a sliver."""
    factor = max(1., float(f"{width / height / LONGEST:.0e}"))
    if factor > 1:
        axes.set_ylabel(f"{axes.get_ylabel()}\nstretched x {factor:g}")
    axes.set_aspect(factor)
    axes.grid(False)
    axes.autoscale_view()


def split(n):
    """A triangle as n² equal ones: of the corners of these their shares in its own."""
    up, down = (numpy.array([[(i, j, m - i - j)] for i in range(m + 1) for j in range(
        m + 1 - i)]).reshape(-1, 1, 3) for m in (n - 1, n - 2))
    return numpy.concatenate([up + numpy.eye(3), down + 1 - numpy.eye(3)]) / n


def draw_body(run, field, wanted, averaged):
    files = run.files("body")
    if not files:
        return
    body = vtu.Body(files)
    u, values = body.at_points("displacement"), body.at_corners(field, averaged)
    largest = numpy.linalg.norm(u, axis=1).max()
    shown = max(largest, run.largest)  # all steps of a path in nearly one scale
    scale = LARGEST_SHOWN * body.size / shown if shown > 1e-12 * body.size else 1.
    scale = float(f"{scale:.0e}")  # one digit, so that it can be said
    panels = views(body, run.contact, wanted)
    width, height, _ = numpy.ptp(numpy.concatenate(
        [body.points, body.points + scale * u]) @ panels[0].T, axis=0)
    figure, all_axes = plt.subplots(len(panels), squeeze=False, figsize=(
        10., min(2.4 + len(panels) * 10. * height / width, 9.)))
    what = {"displacement": "length", "region": ""}.get(field, "stress")
    words = field.replace("_", " ").replace("von mises", "von Mises stress")
    to_rgba = colour([*all_axes.flat], values.ravel(), words + run.units[what] +
                     ", averaged at nodes" * (averaged and what == "stress"),
                     usual=body.usual_stress() if "stress" in words else
                     1e-3 * body.size * (what == "length")).to_rgba
    length, before = run.units["length"], []
    for axes, panel in zip(all_axes.flat, panels):
        draw_panel(axes, run, body, (body.points + scale * u) @ panel.T, values, to_rgba,
                   PIXELS / max(width, len(panels) * height / 0.7))
        if body.dim == 3:
            draw_box(axes, body.points, panel, length[1:])
        else:
            before = [axes.add_collection(LineCollection(
                body.points[body.boundary()[0]][:, :, :2], colors="0.6",
                linewidths=0.8, zorder=0.5, label="at rest"))]
            axes.set(xlabel="x" + length, ylabel="y" + length)
        stretch(axes, width, height if body.dim == 2 else width)
    rows = run.legend(all_axes[0, 0], before, lw=3)
    all_axes[0, 0].set_title(
        f"{run.title}displacement x {scale:g}, the largest is {largest:.3g}"
        f"{length[1:]}", fontsize=9, pad=8 + 14 * rows)
    run.save(figure, "body")


def draw_panel(axes, run, body, moved, values, to_rgba, pixels):
    """The cells in 2D, in 3D the faces that the viewer sees, from behind to the
    front; lines between materials; the contact boundary in the colours of its
    states. Lines of cells fade where these are small, and large ones are split for
    the values between their corners."""
    faces, owners = body.boundary()
    triangles, cells = body.cells, numpy.arange(len(body.cells))
    if body.dim == 3:
        a, b, c = moved[faces].swapaxes(0, 1)
        normal = numpy.cross(b - a, c - a)
        inwards = moved[body.cells[owners].sum(axis=1) - faces.sum(axis=1)] - a
        seen = normal[:, 2] * (normal * inwards).sum(axis=1) < 0
        faces, owners = triangles, cells = faces[seen], owners[seen]
    lines = body.borders(triangles, cells)
    parts, states, of_faces = run.contact.shares(body.points[faces], moved[faces]) \
        if run.contact else (moved[:0, None], [], [])
    of_states = colours_of(states)
    if body.dim == 2:
        lines = numpy.concatenate([lines, faces])
        axes.add_collection(LineCollection(
            parts[:, :, :2], colors=of_states, linewidths=3., capstyle="round"))
        parts = []

    corners = moved[triangles]
    sides = (numpy.roll(corners, 1, axis=1) - corners)[:, :, :2]
    height = pixels * abs(numpy.linalg.det(sides[:, :2])) / (
        numpy.linalg.norm(sides, axis=2).max(axis=1) + 1e-300)
    large = height > 4.
    edges = [(0., 0., 0., min(0.35, 0.06 * (h - 4.))) for h in height[large]]
    n = int(numpy.clip((MOST_SPLIT / (len(corners) or 1))**0.5, 1, 8)) if (
        values != values[:, :1]).any() else 1
    own = (body.cells[cells][:, None] == triangles[:, :, None]).argmax(axis=2)
    colours = to_rgba(numpy.einsum("sck,tk->ts", split(n) / 3, numpy.take_along_axis(
        values[cells], own, axis=1)).ravel())
    small = numpy.einsum("sck,tkd->tscd", split(n), corners).reshape(-1, 3, 3)
    black = [(0., 0., 0., 1.)] * len(lines)
    depth, near = corners[:, :, 2].mean(axis=1), 0.022 * body.size
    drawn = [(polygon[:, :2], fill, edge, width, place)
             for *layer, width in (
                 (small, colours, colours, depth.repeat(n * n), 0.3),
                 (corners[large], numpy.zeros((len(edges), 4)), edges, depth[large], 0.3),
                 (parts, of_states, of_states, depth[of_faces], 0.8),
                 (moved[lines], black, black, near + moved[lines, 2].mean(axis=1), 0.6))
             for polygon, fill, edge, place in zip(*layer)]
    if body.dim == 3:
        drawn.sort(key=lambda one: one[-1])
    polygons, fill, edges, widths, _ = zip(*drawn)
    axes.add_collection(PolyCollection(
        polygons, facecolors=fill, edgecolors=edges, linewidths=widths,
        snap=False, rasterized=len(drawn) > MOST_VECTORS))


def draw_box(axes, points, panel, length):
    """The box around a body in 3D at rest, behind it, with its lengths."""
    ends = [points.min(axis=0), points.max(axis=0)]
    flat = numpy.array([[ends[b >> d & 1][d] for d in range(3)]
                        for b in range(8)]) @ panel[:2].T
    for d, size in enumerate(ends[1] - ends[0]):
        lines = [flat[[b, b | 1 << d]] for b in range(8) if not b >> d & 1]
        axes.add_collection(LineCollection(lines, colors="0.45", linewidths=0.8,
                                           linestyles="--", zorder=0.5))
        # At the lowest edge, or at the leftmost of those that rise.
        x, y = lines[0][1] - lines[0][0]
        rises = abs(y) > abs(x)
        line = min(lines, key=lambda line: line[:, 0 if rises else 1].sum())
        left = rises or x * y < 0
        axes.annotate(f"{'xyz'[d]}: {size:.4g}{length}", line.mean(axis=0), fontsize=8,
                      xytext=(-5 if left else 5, 0 if rises else -10),
                      textcoords="offset points", ha="right" if left else "left")
    axes.axis("off")


def draw_contact(run, wanted):
    """Below each other, or a surface in as many columns as fit it on a page."""
    contact = run.contact
    if not contact or (contact.state == "held").all():
        return
    M = contact.at_nodes("bond_threshold")
    usual = {what: values[numpy.isfinite(values)].max(initial=0.) for what, values in (
        ("length", M), ("stress", M * contact.at_nodes("bond_stiffness")), ("", 0. * M))}
    known = {"u_nu" if contact.dim == 2 else "gap": "length", "normal_traction": "stress",
             "slip": "length", "shear_traction": "stress"}
    extra = {name: "" for name in wanted if name not in known}
    rows = [(name, {"u_nu": "normal displacement", "gap": "opening"}.get(
        name, name.replace("_", " ")) + run.units[what], usual[what])
            for name, what in {**known, **extra}.items()
            if name in contact.mesh.point_data]
    n, columns, height = len(rows), 1, 3.
    if contact.dim == 3:
        low, high = numpy.sort(numpy.ptp(contact.nodes, axis=0))[1:]
        n, height = n + 1, 8.5 * max(low / high, 1. / LONGEST)
        columns = next(c for c in (1, 2, 3) if c == 3 or -(-n // c) * (height / c + 1) < 12)
        height = height / columns + 1.
    figure, all_axes = plt.subplots(
        -(-n // columns), columns, figsize=(9, height * -(-n // columns)),
        sharex=True, sharey=contact.dim == 3, squeeze=False)
    for axes in all_axes.flat[n:]:
        axes.remove()
    (draw_line if contact.dim == 2 else draw_surface)(run, all_axes.flat[:n], rows)
    if run.title:
        figure.suptitle(run.title.strip(), fontsize=9)
    run.save(figure, "contact")


def along(vectors, contact, pieces):
    """Of vectors the part along the boundary, in the direction in which places grow.
    The two shares of a face, from its nodes to its middle, go to and fro."""
    result = numpy.empty(len(vectors))
    for piece, _ in pieces:
        way = numpy.diff(contact.polygons[piece], axis=1)[:, 0]
        way /= numpy.linalg.norm(way, axis=1, keepdims=True)
        way[1::2] *= -1.
        result[piece] = (vectors[piece] * way).sum(axis=1)
    return result


def draw_line(run, all_axes, rows):
    contact = run.contact
    name, pieces = contact.pieces()
    # Where bonds are, which have no stiffness if they are rigid at first.
    M, stiffness = map(contact.at_nodes, ("bond_threshold", "bond_stiffness"))
    for axes, (key, label, usual) in zip(all_axes, rows):
        values = contact.at_nodes(key)
        if values.ndim > 1:
            values = along(values, contact, pieces)
        for piece, x in pieces:
            axes.plot(x, values[piece], color="0.6", lw=1)
            axes.scatter(x, values[piece], s=10., zorder=3,
                         c=colours_of(contact.state[piece]))
            if len(name) > 1 and piece is not pieces[-1][0]:
                axes.axvline(x[-1], color="k", ls=":", lw=0.8)
        axes.axhline(0, color="k", lw=0.6)
        axes.set_ylabel(label)
        if key in PARTS:
            axes.set_ylim(-0.03, 1.03)
        elif is_rounding(values[contact.state != "held"], usual):
            axes.set_ylim(-(usual or 1.), usual or 1.)
            axes.text(0.5, 0.9, "0 to rounding", ha="center", transform=axes.transAxes)
    breaks = numpy.where(
        (M > 0) & ((stiffness > 0) | ~(stiffness > 0).any()) &
        (M < 3 * abs(contact.at_nodes("gap")).max()),
        contact.at_nodes("initial_gap") - M, numpy.nan)
    before = []
    for piece, x in pieces if (breaks < numpy.inf).any() else ():
        before = all_axes[0].plot(
            x, breaks[piece], color="0.4", ls="--", lw=1, drawstyle="steps-mid",
            label="bonds break" + " without slip" * ("slip" in [row[0] for row in rows]))
    run.legend(all_axes[0], before, marker="o", ls="", ms=4)
    all_axes[-1].set_xlabel(name + run.units["length"])
    all_axes[1].set_title("positive: pressed, negative: held", fontsize=8, loc="right")


def draw_surface(run, all_axes, rows):
    """The opening, the other rows and the states, in the plane in which the surface is
    widest, and its longer side from left to right."""
    contact, length = run.contact, run.units["length"]
    size = numpy.ptp(contact.nodes, axis=0)
    wide = numpy.argsort(-size, kind="stable")[:2]
    held, columns = contact.state == "held", all_axes[0].get_gridspec().ncols
    triangles = contact.mesh.cells[0].data[:, [[0, 1, 2], [0, 2, 3]]]
    for axes, (name, title, usual) in zip(all_axes, rows):
        shown = ~held | (name == "gap")
        if name == "normal_traction":
            title += "\n(positive: pressed, negative: held)"
        values = contact.mesh.point_data[name]
        if values.ndim > 1:
            values = numpy.linalg.norm(values, axis=1)
        scale = colour([axes], values[contact.first][shown], title, "RdBu", usual,
                       (0., 1.) if name in PARTS else None)
        axes.tripcolor(*contact.mesh.points[:, wide].T, values,
                       triangles=triangles[shown].reshape(-1, 3), shading="gouraud",
                       cmap=scale.cmap, norm=scale.norm, rasterized=True)
    of_states = [held & False, *[held] * (len(all_axes) - 2), held | True]
    for axes, shown in zip(all_axes, of_states):
        axes.add_collection(PolyCollection(
            contact.polygons[shown][:, :, wide], facecolors=colours_of(
                contact.state[shown]), edgecolors="face", linewidths=0.8,
            rasterized=len(held) > MOST_VECTORS))
        axes.set_ylabel("xyz"[wide[1]] + length)
        stretch(axes, *size[wide])
    for axes in all_axes[-columns:]:
        axes.set_xlabel("xyz"[wide[0]] + length)
        axes.tick_params(labelbottom=True)
    run.legend(all_axes[-1], [], lw=5)


def force_over_displacement(path):
    """The columns of the support that moves, or of the force and the displacement in the
    same direction with the largest product; [] if nothing bears a force."""
    def sizes(pattern):
        found = {name: numpy.nanmax(abs(path[name]), initial=0.) for name in path
                 if re.fullmatch(pattern, name)}
        return {name: size for name, size in found.items()
                if not is_rounding(size, max(found.values()))}

    forces, means = sizes("reaction_.*_.|contact_reaction_."), sizes("mean_.*_.")
    pairs = [(force[8:] == mean[4:], force[0] == "r", forces[force] * means[mean], force,
              mean) for force in forces for mean in means if force[-1] == mean[-1]]
    return [" over ".join(max(pairs)[3:])] if pairs else []


def draw_path(runs, wanted, labels=("",)):
    """Of load paths, with labels if there are several: the wanted 'Y over X', four
    pictures for 'all', or the force over the displacement with what is broken."""
    run, path, factor = runs[0], runs[0].load_path, runs[0].factor
    default = [] if wanted else force_over_displacement(path)
    kinds = default or wanted
    if kinds in ([], ["all"]):
        largest = max((name for name in path if name.startswith("reaction_")),
                      key=lambda name: numpy.ptp([0., *path[name]]), default="normal_force")
        kinds = [f"{largest} over {factor}", f"unit_displacement_work over {factor}"]
        if factor == "factor" and path["unit_load_work"].any():
            kinds = ["normal_force over factor", "factor over unit_load_work"]
        kinds = [f"broken_part over {factor}", f"J over {factor}", *kinds]
    rows = -(-len(kinds) // 2)
    figure, all_axes = plt.subplots(rows, min(len(kinds), 2), squeeze=False, figsize=(
        7 if default else 10, 4.6 if default else 0.6 + 3.4 * rows))
    for axes, kind in zip(all_axes.flat, kinds):
        y, _, x = kind.partition(" over ")
        for one, label in zip(runs, labels):
            draw_curve(axes, one, x, y, label)
        axes.set(xlabel=words_for(x, run.units), ylabel=words_for(y, run.units))
    for axes in all_axes.flat[len(kinds):]:
        axes.remove()
    axes = all_axes[0, 0]
    if default:  # from 0, negative values to the right and up
        axes.axvline(0, color="k", lw=0.6)
        axes.axhline(0, color="k", lw=0.6)
        for name, axis in (x, axes.xaxis), (y, axes.yaxis):
            axis.set_inverted(numpy.nanmax(path[name]) < -numpy.nanmin(path[name]))
        if x[4:] == y[8:]:  # of the support that moves
            axes.set_xlabel(axes.get_xlabel().replace("mean ", ""))
    if default and len(runs) == 1:
        broken = sum(path[name] for name in path if re.fullmatch(
            "(?!global_|contact_|bonded_|free_).*_part", name))
        if broken.any():
            figure.colorbar(axes.scatter(
                path[x], path[y], c=broken, vmin=0., s=25, zorder=3, edgecolors="k",
                linewidths=0.4), label="broken or softening part of the contact boundary")
        end = run.summary.get("load_path", {}).get("comes_off_at")
        if end is not None:
            axes.annotate(f"comes off at factor {end:.4g}", (path[x][-1], path[y][-1]),
                          (-8, 0), ha="right", textcoords="offset points")
    if len(axes.get_legend_handles_labels()[1]) > 1:
        axes.legend()
    return figure


def draw_curve(axes, run, x, y, label):
    """Of a load path Y over X, or with a label only the states that it went through."""
    path = run.load_path
    for name in y, x:
        if name not in path:
            near = ", ".join(difflib.get_close_matches(name, path) or ["step"])
            raise BadInput(f"load_path.csv has no column '{name}', but {near}, "
                           "...; its first line has them all")
        if path[name].dtype.kind != "f" or numpy.isnan(path[name]).all():
            raise BadInput(f"{name} of load_path.csv has no numbers here")
    if label:
        axes.plot(path[x], path[y], ".-", ms=4, label=label)
        return
    if not numpy.isnan(path.get(f"global_{y}", numpy.nan)).all():
        axes.plot(path.get(f"global_{x}", path[x]), path[f"global_{y}"],
                  "--", color="0.5", label="lowest minimum")
    rises = numpy.diff(path[run.factor]) >= 0
    turns = [0, *(numpy.nonzero(numpy.diff(rises))[0] + 1), len(rises)]
    for begin, end in zip(turns, turns[1:]):
        axes.plot(path[x][begin:end + 1], path[y][begin:end + 1], ".-", ms=4, label=(
            "unloading" if begin < end and not rises[begin] else "loading"))
    arc = read_csv(os.path.join(run.directory, "load_path_arc.csv"))
    if arc:
        axes.plot(arc[x], arc[y], ":", color="k", lw=1, label="arc")


def draw_together(directories, file, units, wanted):
    """The curves of several load paths with the names of their directories."""
    runs = [Run(directory, None, units) for directory in directories]
    if not all(run.load_path for run in runs):
        raise BadInput("--together is for load paths")
    names = [os.path.basename(os.path.abspath(directory)) for directory in directories]
    plots.save(draw_path(runs, wanted, names if len(set(names)) == len(runs) else
                         directories), *os.path.split(file))


def draw_history(run):
    """J over the iterations; the gap of a proof over time and nodes."""
    history = read_csv(os.path.join(run.directory, "history.csv"))
    J = history.get("functional", [])
    if len(J) > 2 and J[-1] and J.max() > J[-1]:
        figure, axes = plt.subplots()
        axes.loglog(numpy.arange(1, len(J)), (J[:-1] - J[-1]) / abs(J[-1]),
                    label="J(x_k) - J(x_K)")
        if "v" in history:
            axes.loglog(history["iteration"], -history["v"] / abs(J[-1]),
                        color="0.6", lw=0.8, label="-v_k, predicted descent")
        axes.set(xlabel="iteration k", ylabel="relative to |J(x_K)|")
        axes.legend()
        run.save(figure, "history")
    proof = read_csv(os.path.join(run.directory, "proof.csv"))
    if proof and len(proof["nodes"]) > 2:
        J = proof["functional"]
        figure, both = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True)
        for axes, x in zip(both, ("seconds", "nodes")):
            axes.loglog(proof[x], (J - proof["lower_bound"]) / abs(J), ".-")
            axes.set(xlabel=x, ylabel="gap relative to J")
        run.save(figure, "proof")


def draw(directory, units="", field="von_mises", path=(), view=(), step=None,
         averaged=True):
    """All that a directory has something of, or the body and its contact
    boundary in a step. `units`: 'LENGTH, STRESS'; `view`: degrees."""
    run = Run(directory, step, units)
    if path and (step or not run.load_path):
        raise BadInput("--path is for load paths, and not for a --step of them")
    of_contact = run.contact and field != "displacement" and (
        field in run.contact.mesh.point_data)
    draw_body(run, "von_mises" if of_contact else field, view, averaged)
    draw_contact(run, [field] if of_contact else [])
    if not step:
        if run.load_path:
            run.save(draw_path([run], path), "load_path")
        draw_history(run)


def angles(text):
    """AZIMUTH,ELEVATION in degrees."""
    azimuth, elevation = map(float, text.split(","))
    return azimuth, elevation


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/picture", description="Draws what a run has written, as "
        "PNG and SVG in its directory.")
    parser.add_argument("directories", metavar="DIRECTORY", nargs="+")
    parser.add_argument("--units", default="", help='of length and stress, as in '
                        '"mm, MPa"; those of forces and energies follow')
    parser.add_argument("--field", default="von_mises", help="of body.vtu, or of "
                        "contact.vtu, such as damage")
    parser.add_argument("--cells", action="store_true", help="as each cell has it")
    parser.add_argument("--path", default=[], action="append", help="columns of "
                        'load_path.csv, as in "reaction_left_y over factor"; all: '
                        "four pictures")
    parser.add_argument("--together", metavar="FILE", help="draws the curves of all "
                        "directories in one pair of axes, as FILE.png and FILE.svg")
    parser.add_argument("--step", type=lambda text: text if text == "peak" else int(text),
                        help="draws the body and the contact boundary in this step of "
                        "a load path, a number, or in that next to the largest force: peak")
    parser.add_argument("--view", type=angles, metavar="AZIMUTH,ELEVATION",
                        help="in degrees, where a body in 3D is seen from, as in "
                        "--view=-65,25; the elevation is over the side that is "
                        "glued, which is seen if it is negative")
    options = parser.parse_args()
    try:
        if options.together:
            draw_together(options.directories, options.together, options.units,
                          options.path)
        for directory in [] if options.together else options.directories:
            draw(directory, options.units, options.field, options.path,
                 options.view, options.step, not options.cells)
    except BadInput as error:
        print(f"picture: {error}", file=sys.stderr)
        return 2
    return 0
