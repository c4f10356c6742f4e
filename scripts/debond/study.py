# SPDX-License-Identifier: LGPL-2.1-or-later
"""A study: a scene with several values of its parameters, and what its runs
have in common. doc/guide/studies.md describes its files."""

import difflib
import glob
import itertools
import math
import os
import re

import numpy

from . import cases, prm
from .prm import BadInput
from .runs import read_csv

METHOD = "Solver/Method"
SHORT_NAMES = {"iterations": "/iterations/total", "long": "/iterations/long",
               "short": "/iterations/short", "null": "/iterations/null",
               "unknowns": "/degrees_of_freedom",
               "contact nodes": "/contact_nodes", "v": "/stop_criterion",
               "law violation": "/law_violation",
               "seconds": "/timings_s/total"}
LEVELS = ("level unknowns", "level error", "level ratio",
          "last level unknowns", "least ratio", "largest ratio")
NAMES = ("status", "J", "J_min", "error", "rate", "window", "h", *LEVELS)
FORMS = ("J at N", "error at N", "order of COLUMN", "TITLE = /POINTER",
         "TITLE = largest COLUMN", "TITLE = least COLUMN")


class Study:
    """What a file says, and its cases. Throws BadInput."""

    DEFAULTS = dict.fromkeys((
        "Study/Title", "Study/Description", "Study/Scene", "Study/Settings",
        "Study/Methods", "Study/Minimum", "Preparation/Settings",
        "Plots/Kinds", "Plots/Fitted cases", "Plots/Powers", "Reference/File",
        "Reference/Rows", "Reference/Columns"), "")
    DEFAULTS.update({
        "Study/Columns": "status | iterations | J",
        "Study/Accepted statuses": "success", "Study/Fields": "false",
        "Study/Fit window": "1e-3, 1e-8", "Reference/Label": "reference",
        "Study/Output directory": "output/{study}",
        "Reference/Key": "value", "Reference/Minimum": "0"})
    OF_SWEEPS = re.compile(r"Sweep \d+/(Parameter|Label|Values)$|Cases/")

    def __init__(self, file, changes=()):
        self.file, self.where = file, {}
        entries = prm.read(file, places=self.where)
        for change in changes:
            name, _, value = change.partition("=")
            entries[name.strip()] = value.strip()
        self.folder = os.path.dirname(file)
        for entry in entries:
            if entry not in self.DEFAULTS and not self.OF_SWEEPS.match(entry):
                near = difflib.get_close_matches(entry, self.DEFAULTS, 1)
                self.fault(entry, "there is no such entry" + "".join(
                    f"; do you mean {name}?" for name in near))
        value = {**self.DEFAULTS, **entries}
        name = os.path.splitext(os.path.basename(file))[0]
        self.title = value["Study/Title"] or name
        self.description = value["Study/Description"]
        self.directory = value["Study/Output directory"].replace("{study}", name)
        self.accepted = prm.items(value["Study/Accepted statuses"])
        self.minimum = prm.number(value["Study/Minimum"])
        self.kinds = prm.items(value["Plots/Kinds"])
        self.fitted = prm.items(value["Plots/Fitted cases"])
        self.powers = self.read(value, "Plots/Powers", lambda text: [
            *map(float, prm.items(text))])
        self.window = self.read(value, "Study/Fit window", lambda text: [
            *map(float, text.split(","))])
        self.settings = self.read(value, "Study/Settings", prm.pairs)
        self.preparation = self.read(value, "Preparation/Settings", prm.pairs)
        for kind in ("Body", "Contact"):
            self.settings[f"Output/{kind} VTU"] = value["Study/Fields"]
        self.columns = self.read(value, "Study/Columns", lambda text: {
            column.title: column for column in map(Column, prm.items(text))})
        self.sweeps = self.read_sweeps(value)
        self.reference = self.read(value, "Reference/Columns", lambda _:
                                   Reference(self, value))
        self.make_cases()

    def fault(self, entry, text):
        raise BadInput(f"{self.where.get(entry, self.file)}: {entry}: {text}")

    def read(self, value, entry, parse):
        try:
            return parse(value[entry])
        except ValueError as error:
            return self.fault(entry, error)

    def read_sweeps(self, value):
        """Scenes if there are several, Cases, Sweep 1, ..., methods: each with a
        label and a list of (text, scene or None, settings)."""
        sweeps = []
        names = prm.items(value["Study/Scene"])
        self.scenes = [path for name in names for path in sorted(
            glob.glob(os.path.join(self.folder, name)))]
        if len(self.scenes) < max(1, len(names)):
            self.fault("Study/Scene", f"not all files are there: {names}")
        if len(self.scenes) > 1:
            sweeps.append(Sweep("scene", [
                (os.path.basename(path)[:-4], path, {})
                for path in self.scenes]))
        named = [self.named_case(entry, value) for entry in value
                 if entry.startswith("Cases/")]
        if named:
            sweeps.append(Sweep("case", named))
        for section in sorted({entry.split("/")[0] for entry in value
                               if entry.startswith("Sweep ")}):
            parameter = value.get(section + "/Parameter", "")
            parts = prm.items(parameter, "&")
            entry = section + "/Values"
            values = self.read({entry: "", **value}, entry, sweep_values)
            if not parts or not values or len(set(values)) < len(values):
                self.fault(entry, "a sweep needs Parameter and different Values")
            if any(len(prm.items(one, "&")) != len(parts) for one in values):
                self.fault(entry, f"not all have as many parts as {parameter}")
            sweeps.append(Sweep(value.get(section + "/Label") or
                                parameter.removeprefix("Constants/"), [
                (one, None, dict(zip(parts, prm.items(one, "&"))))
                for one in values]))
        methods = prm.items(value["Study/Methods"])
        if len(methods) > 1:
            sweeps.append(Sweep("method", [(method, None, {METHOD: method})
                                           for method in methods]))
        elif methods:
            self.settings[METHOD] = methods[0]
        return sweeps

    def named_case(self, entry, value):
        """Cases/NAME = [SCENE.prm] | A/B=1 | C=2."""
        words = prm.items(value[entry])
        scene = None
        if words and words[0].endswith(".prm"):
            scene = os.path.join(self.folder, words.pop(0))
            if not os.path.exists(scene):
                self.fault(entry, f"there is no file {scene}")
        return entry[6:], scene, self.read({entry: " | ".join(words)}, entry,
                                           prm.pairs)

    def make_cases(self):
        self.cases, minima, directories = [], {}, set()

        def directory(folder, label):
            name = re.sub(r"[^\w=.,+-]", "_", label.replace(" ", ""))
            while (folder, name) in directories:
                name += "_"
            directories.add((folder, name))
            return os.path.join(self.directory, folder, name)

        needs_minima = not {"J_min", "error", "rate", "window", "convergence",
                            "fit"}.isdisjoint([
                                *(kind.split()[0] for kind in self.kinds),
                                *(c.kind for c in self.columns.values())])
        preparation = os.path.join(self.directory, "preparation")
        for values in itertools.product(*(s.values for s in self.sweeps)):
            scene, settings = self.scenes[0], dict(self.settings)
            words, fixed = [], []
            for sweep, (text, other, own) in zip(self.sweeps, values):
                scene = other or scene
                settings.update(own)
                words.append(f"{sweep.label} = {text}")
                if other or not all(name.startswith("Solver/") for name in own):
                    fixed.append(words[-1])
            settings = {name: text.replace("{preparation}",
                                           os.path.abspath(preparation))
                        for name, text in settings.items()}
            label = ", ".join(words) or "the scene"
            case = cases.Case(label, [value[0] for value in values], scene,
                              settings, directory("cases", label))
            self.cases.append(case)
            if self.minimum is None and needs_minima:
                settings = {name: text for name, text in settings.items()
                            if not name.startswith("Solver/")}
                key = scene, tuple(sorted(settings.items()))
                if key not in minima:
                    minima[key] = cases.Case(
                        ", ".join([*fixed, "exact minimum"]), [], scene,
                        {**settings, METHOD: "majorise minimise"},
                        directory("minima", ", ".join(fixed) or "minimum"))
                case.minimum = minima[key]
        self.minima = list(minima.values())
        self.first = self.preparation and cases.Case(
            "preparation", [], self.scenes[0], self.preparation, preparation)

    def values_of(self, name):
        """A function from rows to what they have in a column, or to the numbers of
        a sweep. Throws ValueError."""
        if name in self.columns:
            return self.columns[name].value
        for index, sweep in enumerate(self.sweeps):
            if sweep.label == name and not sweep.has_numbers:
                raise ValueError(f"not all values of '{name}' are numbers")
            if sweep.label == name:
                return lambda row: prm.number(row.case.values[index])
        return Column(name, [*self.columns, *(
            sweep.label for sweep in self.sweeps if sweep.has_numbers)]).value

    def all_cases(self):
        return [self.first] * bool(self.first) + self.minima + self.cases


class Sweep:
    """A label, and a list of (text, scene or None, settings)."""

    def __init__(self, label, values):
        self.label, self.values = label, values
        self.has_numbers = all(prm.number(text) is not None
                               for text, _, _ in values)


def sweep_values(text):
    """'a | b', 'linear FIRST LAST COUNT' or 'geometric FIRST LAST COUNT'."""
    kind, *ends = text.split() or [""]
    space = {"linear": numpy.linspace, "geometric": numpy.geomspace}.get(kind)
    if not space:
        return prm.items(text)
    try:
        first, last, count = map(float, ends)
        return [f"{x:.6g}" for x in space(first, last, int(count))]
    except ValueError:
        raise ValueError(f"expected {kind} FIRST LAST COUNT") from None


class Row:
    """A case with what it found."""

    def __init__(self, study, case):
        self.case, self.summary = case, case.summary()
        self.status = case.status()
        self.history = read_csv(case.path("history.csv")).get(
            "functional", numpy.array([]))
        self.minimum = study.minimum
        if case.minimum and case.minimum.status() == "success":
            self.minimum = case.minimum.summary()["functional"]
        self.rate = (fit_rate(self.errors(), *study.window)
                     if self.minimum is not None else None)

    def at(self, pointer):
        """What is at a JSON pointer of the summary, or the largest or least number
        of a column of the load path, or None."""
        found = self.find(pointer)
        if isinstance(found, numpy.ndarray) and found.dtype.kind == "f":
            found = found[numpy.isfinite(found)]
            found = max(found, default=None) if pointer.startswith("largest") else \
                min(found, default=None)
        return None if isinstance(found, (dict, numpy.ndarray)) else found

    def find(self, pointer):
        """What is there, lists as dictionaries, or else the last dictionary on the
        way."""
        found = self.summary
        keys = pointer.strip("/").split("/")
        if not pointer.startswith("/"):
            found = read_csv(self.case.path("load_path.csv"))
            keys = pointer.split()[1:]
        for key in keys:
            if not isinstance(found, dict) or key not in found:
                return found if isinstance(found, dict) else {}
            found = found[key]
            if isinstance(found, list):
                found = {str(k): entry for k, entry in enumerate(found)}
        return found

    def functional(self, iteration=None):
        if iteration and iteration < len(self.history):
            return self.history[iteration - 1]
        return self.at("/functional")

    def errors(self):
        return (self.history - self.minimum) / abs(self.minimum)

    def h(self):
        """The edge of the cells of a box, or None."""
        scene = prm.read(self.case.path("parameters.prm"))
        lengths, n = (prm.number(scene[f"Mesh/{name}"].split(",")[0])
                      for name in ("Lengths", "Cells"))
        return lengths / n if scene.get("Mesh/Source") == "box" else None


class Column:
    """A column of the table. Throws ValueError if there is none of that name,
    with those that the study has, if any, and all others."""

    def __init__(self, name, own=()):
        self.title = self.kind = name
        self.pointer, self.iteration, self.digits = "", None, 2
        number = re.match(r"(?:(.*?)\s*=\s*)?(/.*?|(?:largest|least) \w+)"
                          r"(?:\s+to\s+(\d+))?$", name)
        at = re.match(r"(J|error) at (\d+)$", name)
        if name in NAMES:
            pass
        elif name in SHORT_NAMES:
            self.kind, self.pointer = "number", SHORT_NAMES[name]
        elif number:
            self.kind, self.pointer = "number", number[2]
            self.title = number[1] or number[2]
            self.digits = int(number[3] or 2)
        elif at:
            self.kind, self.iteration = at[1], int(at[2])
        elif name.startswith("order of "):
            self.kind = "order"
        else:
            raise ValueError(f"there is no column '{name}', but " + ", ".join(
                (*own, *NAMES, *SHORT_NAMES, *FORMS)))
        if self.kind in ("J", "J_min"):
            self.digits = 11

    def value(self, row):
        """A number, words or None."""
        if self.kind == "status":
            return row.status
        if self.kind == "J_min":
            return row.minimum
        if self.kind == "number" or not row.summary:
            return row.at(self.pointer) if self.pointer else None
        if self.kind == "J":
            return row.functional(self.iteration)
        if self.kind == "error" and row.minimum is not None:
            return ((row.functional(self.iteration) - row.minimum) /
                    abs(row.minimum))
        if self.kind == "rate" and row.rate:
            return row.rate[0]
        if self.kind == "window" and row.rate:
            return f"{row.rate[2]} to {row.rate[3]}"
        if self.kind == "h":
            return row.h()
        return levels(row.summary).get(self.kind)

    def text(self, value):
        if value is None or isinstance(value, (str, bool)):
            return "" if value is None else str(value)
        if value == round(value) and abs(value) < 1e9:
            return str(int(value))
        if 1e-3 <= abs(value) < 1e4 and self.digits < 9:
            return f"{value:.{self.digits}g}"
        return f"{value:.{self.digits - 1}e}"


class Reference:
    """Printed results that stand beside those of the study."""

    def __init__(self, study, value):
        self.label = value["Reference/Label"]
        self.columns = prm.pairs(value["Reference/Columns"])
        self.minimum = float(value["Reference/Minimum"])
        if not value["Reference/File"]:
            return
        table = read_csv(os.path.join(study.folder,
                                            value["Reference/File"]))
        wanted = prm.pairs(value["Reference/Rows"])
        self.key = value["Reference/Key"]
        missing = ({self.key, *self.columns.values(), *wanted} - set(table) or
                   set(self.columns) - set(study.columns))
        if missing:
            raise ValueError("there is no column " + ", ".join(missing))
        rows = (dict(zip(table, cells)) for cells in zip(*table.values()))
        self.rows = [row for row in rows if all(
            is_same(row[name], text) for name, text in wanted.items())]

    def value(self, case, column):
        """What stands beside a cell, a number or None."""
        number = next((row[self.columns[column.title]] for row in self.rows
                       if is_same(row[self.key], case.values[0])), math.nan)
        if not isinstance(number, float) or math.isnan(number):
            return None
        return ((number - self.minimum) / abs(self.minimum)
                if column.kind == "error" else number)


def is_same(a, b):
    """As numbers if both are."""
    x, y = prm.number(a), prm.number(b)
    return a == b if x is None or y is None else x == y


def fit_rate(errors, begin, end):
    """(exponent, factor, first, last iteration) of a power law between the first
    iterations with these errors; None for fewer than three."""
    first, last = (numpy.argmax(errors <= level) if (errors <= level).any() else
                   len(errors) - 1 for level in (begin, end))
    k = first + numpy.nonzero(errors[first:last + 1] > 0)[0]
    if len(k) < 3:
        return None
    exponent, logarithm = numpy.polyfit(numpy.log(k + 1), numpy.log(errors[k]),
                                        1)
    return exponent, math.exp(logarithm), k[0] + 1, k[-1] + 1


def order(study, column, rows, index):
    """The power of h with which a column falls from the mesh before to this
    one, or None."""
    if not index or sum(a != b for a, b in zip(*(
            row.case.values for row in rows[index - 1:index + 1]))) != 1:
        return None
    column = study.columns.get(column.title[9:]) or Column(column.title[9:])
    (H, old), (h, new) = ((row.summary and row.h(), column.value(row))
                          for row in rows[index - 1:index + 1])
    if not (h and H and H > h and old and new and old * new > 0):
        return None
    return math.log(old / new) / math.log(H / h)


def levels(summary):
    """What the residuals of each mesh say of its error beside the error, to the
    limit that J and its estimate on the last meshes have; the first mesh, and the least and the
    largest ratio on all that have four times the last estimate."""
    found = summary.get("levels") or []
    found = list(found.values()) if isinstance(found, dict) else found
    if len(found) < 3:
        return {}
    n, J, estimate = (numpy.array([level[name] for level in found]) for name in
                      ("unknowns", "functional", "estimated_error"))
    estimate = estimate / [level["error_factor"] or 1. for level in found]
    size = estimate * abs(J)
    limit = J[-1] - (J[-3] - J[-1]) / (size[-3] - size[-1]) * size[-1]
    error = (J - limit) / abs(limit)
    count = max(1, (estimate > 4 * estimate[-1]).sum())
    ratio = (estimate / error)[:count]
    return dict(zip(LEVELS, (int(n[0]), error[0], ratio[0], int(n[count - 1]),
                             ratio.min(), ratio.max())))


def groups(study, rows, without):
    """The rows by the values of all sweeps but one, in the order of its numbers."""
    result = {}
    if without and without.has_numbers:
        index = study.sweeps.index(without)
        rows = sorted(rows, key=lambda row: float(row.case.values[index]))
    for row in rows:
        name = ", ".join(f"{sweep.label} = {value}" for sweep, value in
                         zip(study.sweeps, row.case.values)
                         if sweep is not without)
        result.setdefault(name, []).append(row)
    return result


def best_values(study, rows):
    """For each value of the first sweep the value of the second, over numbers of
    the solver, with the fewest iterations, and the range that needs at most 10 % more."""
    if len(study.sweeps) < 2 or not study.sweeps[1].has_numbers or not all(
            name.startswith("Solver/") for _, _, settings in study.sweeps[1].values
            for name in settings):
        return []
    result = []
    for name, group in groups(study, rows, study.sweeps[1]).items():
        x = [float(row.case.values[1]) for row in group]
        n = [row.at("/iterations/total") if row.status == "success" and
             row.at("/iterations/total") else math.inf for row in group]
        best = n.index(min(n))
        if n[best] == math.inf:
            continue
        first = last = best
        while first > 0 and n[first - 1] <= 1.1 * n[best]:
            first -= 1
        while last + 1 < len(n) and n[last + 1] <= 1.1 * n[best]:
            last += 1
        result.append({"": name, "h": group[0].h(),
                       "best " + study.sweeps[1].label: x[best],
                       "iterations": n[best],
                       "smallest within 10 %": min(x[first], x[last]),
                       "largest within 10 %": max(x[first], x[last]),
                       "at an end of the values":
                           "yes" if best in (0, len(n) - 1) else "no"})
    return result

