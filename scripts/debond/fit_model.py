# SPDX-License-Identifier: LGPL-2.1-or-later
"""What fit.py varies, and the runs that compute its curves."""

import contextlib
import io
import os
import subprocess

import numpy

from . import cases, prm, runs
from .curves import curve_of
from .runs import Error

QUIET = {"Output/Body VTU": "false", "Output/Contact VTU": "false",
         "Output/Load path contact VTU": "false", "Load path/Global branch": "none"}
JUMP = 0.5  # the differences of both sides differ by more, relative to their sum


class Parameter:
    """An entry and its bounds. What is fitted is q, which is 1 at the start: the
    logarithm of the value, or where it may be negative its place in the range."""

    def __init__(self, name, values, scene):
        self.name = name
        try:
            self.low, self.high, *start = map(float, values)
        except (TypeError, ValueError):
            raise Error(f"{name} needs LOW,HIGH or LOW,HIGH,START", 2) from None
        self.is_log = self.low > 0
        ends = numpy.array([self.low, self.high])
        middle = numpy.sqrt(ends.prod()) if self.is_log else ends.mean()
        own = prm.number(scene.get(name, "")) or self.low
        self.start = float([*start, own if self.low < own < self.high else middle][0])
        if not self.low < self.start < self.high:
            raise Error(f"{name}: {self.start:g} is not between {self.low:g} and "
                        f"{self.high:g}", 2)
        self.bounds = 1 + (numpy.log(ends / self.start) if self.is_log else
                           (ends - self.start) / (self.high - self.low))

    def value(self, q):
        return self.start * numpy.exp(q - 1) if self.is_log else (
            self.start + (q - 1) * (self.high - self.low))

    def slope(self, q):
        """d value / dq"""
        return self.value(q) if self.is_log else self.high - self.low

    def sides(self, q, step):
        """The places a step ahead and behind that are between the bounds."""
        step = min(step, 0.5 * numpy.ptp(self.bounds))
        return [to for to in (q + step, q - step)
                if self.bounds[0] <= to <= self.bounds[1]]


class Model:
    """The computed curve at the measured x, which keeps all its runs."""

    def __init__(self, scene, parameters, x, curve, step, settings, directory, program,
                 jobs):
        self.scene, self.parameters, self.x, self.curve = scene, parameters, x, curve
        self.step = step
        self.settings, self.directory = {**QUIET, **settings}, directory
        self.program, self.found = program or runs.program(), {}
        self.jobs = jobs or len(os.sched_getaffinity(0))

    def case(self, q):
        names = [parameter.name for parameter in self.parameters]
        texts = [f"{p.value(part):.10g}" for p, part in zip(self.parameters, q)]
        return cases.Case(
            ", ".join(map("{} = {}".format, names, texts)), texts, self.scene,
            {**self.settings, **dict(zip(names, texts))},
            os.path.join(self.directory, "cases", ",".join(texts)))

    def check(self, constants):
        """Throws Error, with the program's words, for an entry that there is not."""
        for name in (parameter.name for parameter in self.parameters):
            if name.startswith("Constants/") and name not in constants:
                raise Error(f"{self.scene} has no constant {name[10:]}", 2)
        case = self.case(numpy.ones(len(self.parameters)))
        done = subprocess.run(
            [self.program, os.fspath(self.scene), "--validate", *(
                f"--set={name}={text}" for name, text in case.settings.items())],
            capture_output=True, text=True, check=False)
        if done.returncode:
            raise Error(done.stderr.replace("debond: ", "").strip(), 2)

    def curves(self, all_q):
        """x and y of each, run as many at a time as `jobs` where they are new."""
        wanted = [self.case(q) for q in all_q]
        new = {case.label: case for case in wanted if case.label not in self.found}
        if new:
            with contextlib.redirect_stdout(io.StringIO()):
                cases.run(self.program, list(new.values()), self.jobs)
        for label, case in new.items():
            if case.status() not in ("success", "comes off"):
                raise Error(f"{label}: the run is not verified: {case.status()}; see "
                            f"{case.path('log')}", 3)
            self.found[label] = self.read(case)
        return [self.found[case.label] for case in wanted]

    def read(self, case):
        file = case.path("load_path.csv")
        table = runs.read_csv(file)
        if not table:
            raise Error(f"{self.scene} has no load path: set Load path/Factors or "
                        "Load path/Displacement factors", 2)
        x, y = curve_of(table, self.curve, file)
        if (numpy.diff(x) <= 0).any():
            raise Error(f"{file}: in '{self.curve}' x does not grow in each row", 2)
        slack = 1e-9 * (x[-1] - x[0])
        if min(self.x) < x[0] - slack or max(self.x) > x[-1] + slack:
            raise Error(f"{file}: '{self.curve}' has x from {x[0]:g} to {x[-1]:g}, but "
                        f"points are measured at {min(self.x):g} to {max(self.x):g}", 2)
        return x, y

    def at(self, all_q):
        """y at the measured x, a row for each."""
        return numpy.array([numpy.interp(self.x, *c) for c in self.curves(all_q)])

    def neighbours(self, q, behind=False):
        """q with a step of each parameter, ahead where it can be, or `behind` ones."""
        places = [p.sides(part, self.step) for p, part in zip(self.parameters, q)]
        return [numpy.where(numpy.arange(len(q)) == k, sides[-1 if behind else 0], q)
                for k, sides in enumerate(places)]

    def slopes(self, q, behind=False):
        """d y / dq by differences, a column for each parameter."""
        moved = self.neighbours(q, behind)
        first, *others = self.at([q, *moved])
        return numpy.column_stack([(other - first) / (to - q)[k] for k, (other, to)
                                   in enumerate(zip(others, moved))])

    def slopes_of_both_sides(self, q):
        """Their mean, or where they differ much the smaller one, since a curve that
        jumps within a step has no slope there; for each parameter how many jumps."""
        ahead, behind = self.slopes(q), self.slopes(q, True)
        smaller = numpy.where(abs(ahead) < abs(behind), ahead, behind)
        apart = abs(ahead - behind)
        return (numpy.where(apart > JUMP * (abs(ahead) + abs(behind)), smaller,
                            (ahead + behind) / 2),
                (apart > abs(smaller).max(axis=0) + 1e-6 * max(abs(self.at([q])[0]))
                 ).sum(axis=0))
