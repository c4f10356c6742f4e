# SPDX-License-Identifier: LGPL-2.1-or-later
"""Entries of a scene from a measured curve by least squares, see doc/guide/fit.md."""

import argparse
import dataclasses
import json
import os
import sys

import numpy

from . import cases, prm, runs
from .curves import read_measured
from .fit_model import Model, Parameter
from .runs import Error

CURVE = "unit_displacement_work over displacement_factor"
CORRELATED = 0.95  # more is told
NEAR = 0.01        # a value is at a bound, by the range between both
NOTHING = 1e-8     # changes of the curve, by the largest value
NEGLIGIBLE = 1e-4  # residuals, by the largest value
PART = 0.8         # of what is known of a parameter, whose place is told


@dataclasses.dataclass
class Fit:
    """What was found: `curve` are the measured x and the fitted y there, `computed` the
    curve of all load factors, `sensitivities` d y / d ln(value), `known` the part of x
    that PART of what is known of a value comes from (None if it is not known)."""

    names: list
    values: numpy.ndarray
    standard_errors: numpy.ndarray
    correlation: numpy.ndarray
    residuals: numpy.ndarray
    curve: tuple
    computed: tuple
    sensitivities: numpy.ndarray
    known: list
    warnings: list
    converged: bool
    runs: int

    @property
    def rms(self):
        return float(numpy.sqrt((self.residuals**2).mean()))

    def text(self):
        """What scripts/fit prints."""
        lines = [f"{name} = {value:.6g} +- {error:.2g}" for name, value, error in
                 zip(self.names, self.values, self.standard_errors)]
        lines += [f"correlation of {self.names[i]} and {self.names[j]}: "
                  f"{self.correlation[i, j]:.2f}"
                  for j in range(len(self.names)) for i in range(j)]
        y = self.curve[1] - self.residuals
        part = self.rms / (max(abs(y)) or 1.)
        lines.append(f"rms of the residuals: {self.rms:.3g}, {part:.2%} of the largest "
                     f"of {len(y)} measured values")
        lines += [f"{PART:.0%} of what is known of {name} comes from x = "
                  f"{ends[0]:.4g} to {ends[1]:.4g}"
                  for name, ends in zip(self.names, self.known) if ends]
        lines += [f"warning: {warning}" for warning in self.warnings]
        return "\n".join([*lines, f"{self.runs} runs, " + (
            "converged" if self.converged else "NOT CONVERGED")])

    def write(self, directory, title="y over x"):
        """fit.json, fit.csv and the picture."""
        from . import plots

        (x, fitted), y = self.curve, self.curve[1] - self.residuals
        name_y, _, name_x = title.partition(" over ")
        plot = plots.Plot("fit", title, name_x, name_y)
        plot.add("fitted", *self.computed)
        plot.add("measured", x, y, "o")
        plot.save(directory)
        replace(os.path.join(directory, "fit.csv"), "".join(
            ",".join(map(str, row)) + "\n" for row in [
                ["x", "measured", "fitted", *(
                    f"d fitted / d ln({name})" for name in self.names)],
                *numpy.column_stack([x, y, fitted, self.sensitivities]).tolist()]))
        replace(os.path.join(directory, "fit.json"), json.dumps({
            "parameters": {name: {
                "value": value, "standard_error": error if error < numpy.inf else None,
                "known_from": known} for name, value, error, known in zip(
                    self.names, self.values, self.standard_errors, self.known)},
            "correlation": self.correlation.tolist(), "rms": self.rms,
            "points": len(x), "runs": self.runs, "converged": self.converged,
            "warnings": self.warnings}, indent=2) + "\n")


def replace(path, text):
    """Writes a file that is there only when all of it is."""
    with open(path + ".new", "w", encoding="utf8") as file:
        file.write(text)
    os.replace(path + ".new", path)


def place(x, known):
    """The shortest range of x with PART of what `known` has at each."""
    order = numpy.argsort(x)
    x, total = x[order], numpy.cumsum(known[order])
    ends = numpy.searchsorted(total, numpy.append(0, total[:-1]) + PART * total[-1] *
                              (1 - 1e-12))
    first = min(numpy.nonzero(ends < len(x))[0], key=lambda k: x[ends[k]] - x[k])
    return float(x[first]), float(x[ends[first]])


def judged(model, q, r, noise, converged):
    """The Fit of these q and residuals."""
    slopes, jumps = model.slopes_of_both_sides(q)
    sizes = numpy.linalg.norm(slopes, axis=0)
    is_known = sizes > NOTHING * max(abs(r + model.at([q])[0]))
    unit = slopes / numpy.where(is_known, sizes, 1)
    # Of values that the curve cannot tell apart the correlation is 1, nearly.
    inverse = numpy.linalg.inv(unit.T @ unit + 1e-12 * numpy.eye(len(q)))
    size = numpy.sqrt(inverse.diagonal())
    sigma = noise or numpy.sqrt((r**2).sum() / (len(r) - len(q)))
    values, rates = numpy.transpose([(p.value(part), p.slope(part)) for p, part in
                                     zip(model.parameters, q)])
    fit = Fit([p.name for p in model.parameters], values, numpy.where(
        is_known, sigma * size * rates / numpy.where(is_known, sizes, 1), numpy.inf),
        inverse / numpy.outer(size, size), r, (model.x, model.at([q])[0]),
        model.curves([q])[0], slopes * values / rates, [], [], converged,
        len(model.found))
    for i, parameter in enumerate(model.parameters):
        judge(fit, i, parameter, q[i], jumps[i])
        twins = abs(fit.correlation[i]) > 1 - 1e-6
        fit.known.append(place(model.x, (unit @ inverse[:, i])**2)
                         if is_known[i] and twins.sum() == 1 else None)
    judge_residuals(fit, noise)
    return fit


def judge(fit, i, parameter, q, jumps):
    """Warnings on the value of a parameter."""
    name = parameter.name
    if jumps and not numpy.isfinite(fit.standard_errors[i]):
        fit.warnings.append(f"only jumps of the curve depend on {name}: its standard "
                            "error is not known")
    elif not numpy.isfinite(fit.standard_errors[i]):
        fit.warnings.append(f"no measured point depends on {name} near "
                            f"{fit.values[i]:.4g}: start elsewhere")
    elif jumps:
        fit.warnings.append(f"the curve jumps at {jumps} of the points when {name} "
                            "changes by a step: its standard error leaves that out")
    for twin in numpy.nonzero(abs(fit.correlation[i, :i]) > CORRELATED)[0]:
        fit.warnings.append(f"the curve hardly tells {fit.names[twin]} from {name}: "
                            f"their correlation is {fit.correlation[i, twin]:.4f}")
    for bound, end in zip((parameter.low, parameter.high), parameter.bounds):
        if abs(q - end) < NEAR * numpy.ptp(parameter.bounds):
            fit.warnings.append(f"{name} is at its bound {bound:g}")


def judge_residuals(fit, noise):
    """Warnings on what is left."""
    r = fit.residuals
    if noise and fit.rms > 2 * noise:
        fit.warnings.append(f"the rms of the residuals, {fit.rms:.3g}, is more than "
                            "twice the noise: no values in these bounds give it")
    elif fit.rms > NEGLIGIBLE * max(abs(fit.curve[1])) and len(r) > 9 and (
            r[1:] * r[:-1]).sum() > 0.5 * (r**2).sum():
        fit.warnings.append("the residuals of neighbouring points are alike: the model "
                            "differs from the curve by more than noise, and values by "
                            "more than their standard errors")


def fit(scene, measured, parameters, curve=CURVE, columns=None, settings=None,
        noise=None, step=0.05, directory=None, program=None, jobs=None,
        evaluations=50, tell=lambda line: None):
    """Fits entries of a scene, {name: (low, high[, start])}, to a measured curve, a
    table or arrays of x and y, and returns a Fit. Throws Error, also for a run that is
    not verified; without convergence in so many `evaluations` the Fit says so."""
    import scipy.optimize

    try:
        entries = prm.read(scene)
    except prm.BadInput as error:
        raise Error(str(error), 2) from None
    parameters = [Parameter(*item, entries) for item in parameters.items()]
    x, y = read_measured(measured, columns)
    if not 0 < len(parameters) < len(x):
        raise Error(f"{len(x)} measured points do not give {len(parameters)} values", 2)
    if not 0 < step < 1 or (noise is not None and not noise > 0):
        raise Error("the step needs to be between 0 and 1, and the noise positive", 2)
    name = os.path.splitext(os.path.basename(scene))[0]
    settings = {key: runs.text(value) for key, value in (settings or {}).items()}
    model = Model(scene, parameters, x, curve, step, settings,
                  directory or f"output/fit-{name}", program, jobs)
    model.check(entries)
    scale = max(abs(y)) or 1.

    def residuals(q):
        model.curves([q] + model.neighbours(q) * (model.jobs > len(q)))
        r = (model.at([q])[0] - y) / scale
        tell(f"{model.case(q).label}: rms {scale * numpy.sqrt((r**2).mean()):.4g}")
        return r

    found = scipy.optimize.least_squares(
        residuals, numpy.ones(len(parameters)), lambda q: model.slopes(q) / scale,
        numpy.transpose([p.bounds for p in parameters]),
        xtol=3e-4, ftol=1e-4, gtol=1e-12, max_nfev=evaluations)
    return judged(model, found.x, scale * found.fun, noise, found.status > 0)


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/fit", description="Fits entries of a scene to a measured curve, "
        "see doc/guide/fit.md. Returns 3 without convergence or if a run is not "
        "verified, 2 for bad input, 4 if interrupted.")
    parser.add_argument("scene", metavar="SCENE.prm")
    parser.add_argument("--measured", metavar="FILE.csv", required=True)
    parser.add_argument("--fit", metavar="SECTION/ENTRY=LOW,HIGH[,START]",
                        required=True, action="append", help="an entry and its bounds")
    parser.add_argument("--curve", metavar="'Y over X'", default=CURVE, help="columns "
                        f"of load_path.csv, also '2*Y over X'; by default {CURVE}")
    parser.add_argument("--columns", metavar="'Y over X'", help="likewise of the "
                        "measured curve; by default its second over its first")
    parser.add_argument("--noise", type=float, help="standard deviation of the "
                        "measured y; by default that of the residuals")
    parser.add_argument("--step", type=float, default=0.05, help="of the differences, "
                        "by default 0.05, which is 5 %% of a value")
    parser.add_argument("--set", metavar="SECTION/ENTRY=VALUE", default=[],
                        action="append", help="change an entry of the scene")
    parser.add_argument("--directory", help="by default output/fit-SCENE")
    parser.add_argument("--evaluations", type=int, default=50, help="the most steps")
    parser.add_argument("--jobs", type=int, help="processes at a time")
    parser.add_argument("--debond", help="a program that is built already")
    options = parser.parse_args()
    name = os.path.splitext(os.path.basename(options.scene))[0]
    directory = options.directory or f"output/fit-{name}"
    try:
        result = fit(
            options.scene, options.measured,
            {entry: values.split(",") for entry, _, values in (
                text.partition("=") for text in options.fit)},
            options.curve, options.columns,
            dict(text.partition("=")[::2] for text in options.set), options.noise,
            options.step, directory, options.debond or cases.build(), options.jobs,
            options.evaluations, lambda line: print(line, flush=True))
    except Error as error:
        print(f"fit: {error}", file=sys.stderr)
        return error.code or 1
    except KeyboardInterrupt:
        print("fit: interrupted; the same command goes on where it stopped",
              file=sys.stderr)
        return 4
    print(result.text())
    result.write(directory, options.curve)
    return 0 if result.converged else 3
