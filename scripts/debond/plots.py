# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plots of studies, as PNG and SVG."""

import os
import re

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib import ticker

from . import prm, vtu
from . import study as studies
from .runs import read_csv

# More curves than these have the colours of a scale, in their order.
MOST_COLOURS = 10
# Logarithmic axes of at most so many decades have labels at these multiples of the
# powers of ten, or like a linear one.
MULTIPLES = ((0.9, None), (1.5, (1, 2, 3, 5, 7)), (4.2, (1, 2, 5)))
MOST_LABELS = 25

plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.color": "0.85",
                     "lines.linewidth": 1.4, "svg.hashsalt": "debond",
                     "figure.constrained_layout.use": True})


class Plot:
    """Curves in one pair of axes; `log` names those that are logarithmic."""

    def __init__(self, name, caption, x, y, log=""):
        self.name, self.caption, self.log = name, caption, log
        self.figure, self.axes = plt.subplots(figsize=(8, 4.5))
        self.axes.set(xlabel=x, ylabel=y)
        for axis in log:
            getattr(self.axes, f"set_{axis}scale")("log")
        self.curves = []  # label, x, y, style, options

    def add(self, label, x, y, style="-", **options):
        """Adds what has values; with belongs=True in the colour of the curve
        before."""
        x, y = (numpy.array([numpy.nan if v is None else v for v in values],
                            dtype=float) for values in (x, y))
        shown = numpy.isfinite(x) & numpy.isfinite(y)
        shown &= ((x > 0) | ("x" not in self.log)) & (
            (y > 0) | ("y" not in self.log))
        if shown.any():
            self.curves.append((label, x[shown], y[shown], style, options))

    def save(self, directory):
        own = sum(not c[4].get("belongs") for c in self.curves)
        few = own <= MOST_COLOURS
        every = -(-own // MOST_LABELS)
        index = -1
        for label, x, y, style, options in self.curves:
            belongs = options.pop("belongs", False)
            index += not belongs
            colour = (plt.get_cmap("tab10")(index) if few else
                      plt.get_cmap("viridis")(0.93 * index / (own - 1)))
            is_named = few or not (belongs or index % every)
            self.axes.plot(x, y, style, label=label if is_named else None,
                           **{"color": colour, "markersize": 3.5, **options})
        labels = [curve[0] for curve in self.curves if curve[0]]
        if labels:
            below = max(map(len, labels)) > 26
            self.axes.legend(
                fontsize=8 if len(labels) <= 12 else 6.5,
                loc="upper center" if below else "upper left",
                bbox_to_anchor=(0.5, 0.) if below else (1.01, 1.),
                ncol=2 if below else 1, borderaxespad=5. if below else 0.,
                title=f"one in {every} of {own}" if every > 1 else None)
        for name in self.log:
            label_ticks(getattr(self.axes, name + "axis"))
        save(self.figure, directory, self.name)


def label_ticks(axis):
    """Gives a logarithmic axis more than three labels."""
    low, high = axis.get_view_interval()
    for decades, multiples in MULTIPLES:
        if numpy.log10(high / low) <= decades:
            axis.set_major_locator(ticker.LogLocator(subs=multiples) if multiples
                                   else ticker.AutoLocator())
            axis.set_major_formatter(ticker.StrMethodFormatter("{x:g}"))
            axis.set_minor_formatter(ticker.NullFormatter())
            return


def save(figure, directory, name):
    """As PNG and SVG."""
    path = os.path.join(directory, name)
    figure.savefig(path + ".png", dpi=120, bbox_inches="tight")
    figure.savefig(path + ".svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    print(path + ".png")


def over_iterations(plot, study, rows):
    for row in rows:
        # All iterations at first, then one in each percent.
        k, n = [], 1
        while n <= len(row.history):
            k.append(n)
            n = max(n + 1, n + n // 100)
        k = numpy.array(k[:-1] + [len(row.history)] if k else [], dtype=int)
        fitted = plot.name == "fit" and row.rate and (
            not study.fitted or row.case.values[0] in study.fitted)
        if row.minimum is not None and (fitted or plot.name != "fit"):
            plot.add(row.case.label, k, row.errors()[k - 1])
        if fitted:
            exponent, factor, *ends = row.rate
            plot.add(f"k^{exponent:.0f}", ends,
                     [factor * float(k)**exponent for k in ends], "--",
                     belongs=True)


def over_sweep(plot, study, rows):
    """Iterations, or their kinds, over the last sweep over numbers."""
    axis = axis_of(study)
    plot.axes.set_xlabel(study.sweeps[axis].label)
    for kind in (("total",) if plot.name == "iterations" else
                 ("long", "short", "null")):
        for name, group in studies.groups(study, rows,
                                          study.sweeps[axis]).items():
            title = name if kind == "total" else f"{kind} {name}".strip()
            plot.add(title, [float(row.case.values[axis]) for row in group],
                     [row.at("/iterations/" + kind) for row in group], "o-")


def axis_of(study):
    found = [i for i, sweep in enumerate(study.sweeps) if sweep.has_numbers]
    if not found:
        study.fault("Plots/Kinds", "there is no sweep over numbers")
    return found[-1]


def along_contact(plot, study, rows):
    title = "u_nu" if plot.name == "displacement" else "normal_traction"
    for row in rows:
        file = row.case.path("contact.vtu")
        if row.summary and os.path.exists(file):
            contact = vtu.Contact(file, row.summary)
            name, pieces = contact.pieces()
            plot.axes.set_xlabel(name if len(name) > 1 else
                                 f"{name} along the contact boundary")
            line = "o" if contact.dim == 3 else "-" if title == "u_nu" else "o-"
            values = contact.at_nodes(title)
            for k, (piece, x) in enumerate(pieces):
                plot.add(None if k else row.case.label, x, values[piece], line,
                         belongs=k > 0)


def law(plot, study, rows):
    """Nodes, and the graph of the law where bonds are the same everywhere."""
    graphs = {}
    for row in rows:
        profile = read_csv(row.case.path("contact_profile.csv"))
        if not (row.summary and profile):
            continue
        u, density = profile["u_nu"], profile["normal_force_density"]
        a, M = profile["bond_stiffness"], profile["bond_threshold"]
        plot.add(row.case.label, u, density, "o")
        scene = prm.read(row.case.path("parameters.prm"))
        if "slip_x" not in profile and numpy.ptp(a) + numpy.ptp(M) == 0 and \
                scene["Contact law/Law"] == "winkler":
            ends = graphs.setdefault((a[0], M[0]), [0., 0.])
            ends[:] = min(ends[0], u.min()), max(ends[1], density.max())
    for (a, M), (least, most) in graphs.items():
        plot.add(f"a = {a:g}, M = {M:g}" if len(graphs) > 1 else "contact law",
                 [min(least, -2 * M), -M, -M, 0, 0], [0, 0, -a * M, 0, most],
                 "-", color="0.6", zorder=0)


def columns(study, rows, kind, log):
    """'Y over X', columns or sweeps over numbers: a curve for each value of all
    sweeps but X, or but the last one if X is none."""
    names = kind.split(" over ")
    if len(names) != 2:
        study.fault("Plots/Kinds", f"there is no plot '{kind}'; known are Y over "
                    "X and " + ", ".join(KINDS))
    y, x = study.read({"Plots/Kinds": names}, "Plots/Kinds", lambda names: [
        study.values_of(name) for name in names])
    plot = Plot(kind.replace(" ", "-").replace("/", "_"),
                f"{names[0]} over {names[1]}.", names[1], names[0], log)
    along = [sweep for sweep in study.sweeps if sweep.label == names[1]]
    for label, group in studies.groups(
            study, rows, (along or study.sweeps or [None])[-1]).items():
        both = [[value if isinstance(value, (int, float)) else None
                 for value in map(values, group)] for values in (x, y)]
        plot.add(label, *both, "o-")
    for power in study.powers if plot.curves else ():
        _, h, error, *_ = plot.curves[0]
        base = f"({names[1]})" if " " in names[1] else names[1]
        plot.add(f"{base}^{power:g}", h, error[0] * (h / h[0])**power, "--",
                 color="0.6", zorder=0)
    return plot


ERROR = "(J(x_k) - J_min) / |J_min|"
KINDS = {
    "convergence": (over_iterations, "The distance from J_min of the "
                    "mesh over the iterations.", "iteration k", ERROR, "xy"),
    "fit": (over_iterations, "Fitted lines C k^rate, each in the window it is "
            "fitted on.", "iteration k", ERROR, "xy"),
    "iterations": (over_sweep, "Iterations until the method stops.", "",
                   "iterations", ""),
    "steps": (over_sweep, "Kinds of steps.", "", "steps", ""),
    "displacement": (along_contact, "Normal displacement of the contact "
                     "boundary; negative: lifted off.", "",
                     "normal displacement u_nu", ""),
    "force": (along_contact, "Normal traction of the contact boundary; "
              "positive: pressed, negative: held.", "", "normal traction", ""),
    "law": (law, "Normal force density of the contact nodes over their normal "
            "displacement, on the graph of the contact law.",
            "normal displacement u_nu", "normal force density", "")}


def parse(kind):
    """The name of a kind of plots, and which axes are logarithmic, 'x', 'y' or 'xy':
    those of the kind, and what 'log', 'log x' or 'log y' behind it asks for."""
    name, asked, axis = re.fullmatch(r"(.*?)( log(?: ([xy]))?)?", kind).groups()
    return name, KINDS.get(name, [""])[-1] or (axis or "xy" if asked else "")


def draw(study, rows):
    """All plots that the study wants; returns those with something in them,
    and the others."""
    directory = os.path.join(study.directory, "plots")
    os.makedirs(directory, exist_ok=True)
    drawn, empty = [], []
    for kind in study.kinds:
        name, log = parse(kind)
        if name in KINDS:
            function, *description, _ = KINDS[name]
            plot = Plot(name, *description, log)
            function(plot, study, rows)
        else:
            plot = columns(study, rows, name, log)
        (drawn if plot.curves else empty).append(plot)
        plot.save(directory)
    return drawn, empty


def check(study):
    """Throws BadInput where a plot is not known or not possible."""
    for kind in study.kinds:
        name, log = parse(kind)
        if name in ("iterations", "steps"):
            axis_of(study)
        elif name not in KINDS:
            plt.close(columns(study, [], name, log).figure)
