# SPDX-License-Identifier: LGPL-2.1-or-later
"""The plots of studies, as PNG and SVG."""

import os

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

from . import study as studies
from .prm import BadInput

# More curves than these have the colours of a scale, in their order.
MOST_COLOURS = 10
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
        for axis, values in (("x", x), ("y", y)):
            if axis in self.log:
                shown &= values > 0
        if shown.any():
            self.curves.append((label, x[shown], y[shown], style, options))

    def save(self, directory):
        own = sum(not c[4].get("belongs") for c in self.curves)
        scale = plt.get_cmap("tab10" if own <= MOST_COLOURS else "viridis")
        every = -(-own // MOST_LABELS)
        index = -1
        for label, x, y, style, options in self.curves:
            belongs = options.pop("belongs", False)
            index += not belongs
            is_named = own <= MOST_COLOURS or not (belongs or index % every)
            self.axes.plot(x, y, style, label=label if is_named else None, **{
                "color": scale(index if own <= MOST_COLOURS else
                               0.93 * index / (own - 1)),
                "markersize": 3.5, **options})
        labels = [curve[0] for curve in self.curves if curve[0]]
        if labels:
            below = max(map(len, labels)) > 26
            self.axes.legend(
                fontsize=8 if len(labels) <= 12 else 6.5,
                loc="upper center" if below else "upper left",
                bbox_to_anchor=(0.5, -0.14) if below else (1.01, 1.),
                ncol=2 if below else 1, borderaxespad=0.,
                title=f"one in {every} of {own}" if every > 1 else None)
        for ending in ("png", "svg"):
            self.figure.savefig(
                os.path.join(directory, f"{self.name}.{ending}"), dpi=120,
                metadata={"Date": None} if ending == "svg" else None)
        plt.close(self.figure)


def thinned(values):
    """Iterations that a curve is drawn through: all at first, then one in each
    percent."""
    k, numbers = 1, []
    while k < len(values):
        numbers.append(k)
        k = max(k + 1, k + k // 100)
    return numpy.array(numbers + [len(values)] * (len(values) > 0), dtype=int)


ERROR = "(J(x_k) - J_min) / |J_min|"


def history(study, rows):
    plot = Plot("history", "The functional over the iterations.",
                "iteration k", "J(x_k)")
    for row in rows:
        k = thinned(row.history)
        plot.add(row.case.label, k, row.history[k - 1])
    return plot


def add_errors(plot, row):
    k = thinned(row.history)
    plot.add(row.case.label, k, row.errors()[k - 1])


def convergence(study, rows):
    plot = Plot("convergence", "The distance from the exact minimum of the mesh "
                "over the iterations, both logarithmic.", "iteration k", ERROR,
                "xy")
    for row in rows:
        if row.minimum is not None:
            add_errors(plot, row)
    return plot


def fit(study, rows):
    plot = Plot("fit", "Fitted lines C k^rate, each in the window it is fitted "
                "on.", "iteration k", ERROR, "xy")
    for row in rows:
        if row.rate and (not study.fitted or
                         row.case.values[0] in study.fitted):
            add_errors(plot, row)
            exponent, factor, *ends = row.rate
            plot.add(f"k^{exponent:.0f}", ends,
                     [factor * float(k)**exponent for k in ends], "--",
                     belongs=True)
    return plot


def axis_of(study):
    """The sweep over numbers > 0 that the x axis shows: the last one."""
    found = [i for i, sweep in enumerate(study.sweeps) if sweep.numbers()]
    if not found:
        raise BadInput(f"{study.file}: Plots/Kinds: there is no sweep over "
                       "numbers > 0")
    return found[-1]


def groups(study, rows, without):
    """The rows by the values of all sweeps but one, in their order."""
    result = {}
    for row in rows:
        name = ", ".join(f"{sweep.label} = {value}" for sweep, value in
                         zip(study.sweeps, row.case.values)
                         if sweep is not without)
        result.setdefault(name, []).append(row)
    return result


def over_axis(study, rows, plot, pointer, title=""):
    axis = axis_of(study)
    for name, group in groups(study, rows, study.sweeps[axis]).items():
        plot.add(", ".join(filter(None, (title, name))),
                 [float(row.case.values[axis]) for row in group],
                 [row.at(pointer) for row in group], "o-")
    return plot


def iterations(study, rows):
    return over_axis(study, rows, Plot(
        "iterations", "Iterations until the method stops.",
        study.sweeps[axis_of(study)].label, "iterations", "xy"),
        "/iterations/total")


def steps(study, rows):
    plot = Plot("steps", "Kinds of steps.", study.sweeps[axis_of(study)].label,
                "steps", "x")
    for kind in ("long", "short", "null"):
        over_axis(study, rows, plot, "/iterations/" + kind, kind)
    return plot


def best(study, rows):
    plot = Plot("best", "The value that needs the fewest iterations, over the "
                "edge h of the cells, with the fitted power of h.", "h",
                study.sweeps[1].label, "xy")
    found = studies.best_values(study, rows)
    h = [row["h"] for row in found]
    for key in ("smallest within 10 %", "largest within 10 %"):
        plot.add(key, h, [row[key] for row in found], "o-")
    law = studies.fit_best(found)
    if law:
        plot.add(f"h^{law[0]:.2f}", h, [law[1] * x**law[0] for x in h])
    plot.add("fewest iterations", h, [row["best"] for row in found], "o",
             color="k")
    return plot


def position(profile):
    """(name, values, whether no two are at one place) of where nodes are along
    the contact boundary: the coordinate if it is parallel to an axis, else the
    length if it is straight, else the coordinate in which it is longest."""
    axes = [axis for axis in "xyz" if axis in profile]
    x = numpy.array([profile[axis] for axis in axes]).T
    extent = numpy.ptp(x, axis=0)
    longest = int(numpy.argmax(extent))
    first, last = (x[numpy.lexsort(x.T[::-1])[k]] for k in (0, -1))
    way = last - first
    length = numpy.linalg.norm(way) or 1.
    along = (x - first) @ way / length
    off = numpy.linalg.norm(x - first - numpy.outer(along, way / length), axis=1)
    name, values = axes[longest], x[:, longest]
    if off.max() < 1e-6 * length and extent[longest] < (1 - 1e-9) * length:
        name, values = "length along the contact boundary", along
    gaps = numpy.diff(numpy.sort(values))
    return name, values, len(gaps) == 0 or gaps.min() > 1e-9 * length


def along_contact(study, rows, plot, title, style):
    for row in rows:
        profile = row.case.table("contact_profile.csv")
        if row.summary and profile:
            name, x, in_a_row = position(profile)
            plot.axes.set_xlabel(name)
            order = numpy.argsort(x)
            plot.add(row.case.label, x[order], profile[title][order],
                     style if in_a_row else "o")
    return plot


def displacement(study, rows):
    return along_contact(study, rows, Plot(
        "displacement", "Normal displacement of the contact boundary; negative: "
        "lifted off.", "", "u_nu"), "u_nu", "-")


def force(study, rows):
    return along_contact(study, rows, Plot(
        "force", "Normal force density of the contact boundary; positive: "
        "pressed, negative: held.", "", "normal force density"),
        "normal_force_density", "o-")


def law(study, rows):
    """Nodes of bonds that are the same everywhere, on the graph of their law."""
    plot = Plot("law", "Normal force density of the contact nodes over their "
                "normal displacement, on the graph of the contact law.", "u_nu",
                "normal force density")
    graphs = {}
    for row in rows:
        profile = row.case.table("contact_profile.csv")
        if row.summary and profile:
            u, density = profile["u_nu"], profile["normal_force_density"]
            a, M = profile["bond_stiffness"], profile["bond_threshold"]
            plot.add(row.case.label, u, density, "o")
            if numpy.ptp(a) == 0 and numpy.ptp(M) == 0 and \
                    row.case.parameters().get("Contact law/Law") == "brittle":
                ends = graphs.setdefault((a[0], M[0]), [0., 0.])
                ends[:] = min(ends[0], u.min()), max(ends[1], density.max())
    for (a, M), (least, most) in graphs.items():
        plot.add(f"a = {a:g}, M = {M:g}" if len(graphs) > 1 else "contact law",
                 [min(least, -2 * M), -M, -M, 0, 0], [0, 0, -a * M, 0, most],
                 "-", color="0.6", zorder=0)
    return plot


def proof(study, rows):
    """How the gap between J and its lower bound closes."""
    plot = Plot("proof", "The gap between J and its lower bound over the time of "
                "the proof.", "s", "gap relative to J", "xy")
    for row in rows:
        table = row.case.table("proof.csv")
        if table:
            plot.add(row.case.label, table["seconds"],
                     (table["functional"] - table["lower_bound"]) /
                     abs(table["functional"]))
    return plot


def columns(study, rows, kind):
    """'Y over X', both columns: a curve for each value of all sweeps but the
    last."""
    names = kind.split(" over ")
    titles = {column.title: column for column in study.columns}
    try:
        y, x = [titles.get(name) or studies.Column(name) for name in names]
    except ValueError as error:
        raise BadInput(f"{study.file}: Plots/Kinds: {kind}: {error}") from error
    name = kind.replace(" ", "-").replace("/", "_")
    plot = Plot(name, f"{names[0]} over {names[1]}.", names[1], names[0])
    found = groups(study, rows, study.sweeps[-1] if study.sweeps else None)
    points = [(label, [x.value(row) for row in group],
               [y.value(row) for row in group])
              for label, group in found.items()]
    numbers = [v for _, *both in points for values in both for v in values
               if v is not None]
    if any(isinstance(v, str) for v in numbers):
        raise BadInput(f"{study.file}: Plots/Kinds: {kind}: these are words")
    if numbers and min(numbers) > 0:
        plot.log = "xy"
        plot.axes.set(xscale="log", yscale="log")
    for label, *both in points:
        plot.add(label, *both, "o-")
    if plot.curves and "x" in plot.log:
        _, x, y, *_ = plot.curves[0]
        for power in study.powers:
            plot.add(f"{names[1]}^{power:g}", x, y[0] * (x / x[0])**power, "--",
                     color="0.6", zorder=0)
    return plot


KINDS = {f.__name__: f for f in (history, convergence, fit, iterations, steps,
                                 best, displacement, force, law, proof)}


def draw(study, rows):
    """Draws all plots that the study wants; returns those with something in
    them, and the kinds of the others."""
    directory = os.path.join(study.directory, "plots")
    os.makedirs(directory, exist_ok=True)
    drawn, empty = [], []
    for kind in study.kinds:
        plot = (KINDS[kind](study, rows) if kind in KINDS else
                columns(study, rows, kind))
        if plot.curves:
            plot.save(directory)
            drawn.append(plot)
        else:
            plt.close(plot.figure)
            empty.append(kind)
    return drawn, empty


def check(study):
    """Throws BadInput where a plot is not known or not possible."""
    for kind in study.kinds:
        if kind in ("iterations", "steps"):
            axis_of(study)
        elif kind == "best":
            if len(study.sweeps) < 2 or not study.sweeps[1].numbers():
                raise BadInput(f"{study.file}: Plots/Kinds: best needs a second "
                               "sweep over numbers > 0")
        elif kind not in KINDS:
            if kind.count(" over ") != 1:
                raise BadInput(f"{study.file}: Plots/Kinds: there is no plot "
                               f"'{kind}'; known are Y over X and "
                               + ", ".join(KINDS))
            columns(study, [], kind)
