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

METHOD = "Solver/Method"
SHORT_NAMES = {"iterations": "/iterations/total", "long": "/iterations/long",
               "short": "/iterations/short", "null": "/iterations/null",
               "unknowns": "/degrees_of_freedom",
               "contact nodes": "/contact_nodes", "v": "/stop_criterion",
               "law violation": "/law_violation",
               "seconds": "/timings_s/total"}
LEVELS = ("level unknowns", "level error", "level ratio",
          "last level unknowns", "least ratio", "largest ratio")
# More iterations than the best value needs that are still good.
GOOD_SHARE = 1.1


class Study:
    """What a file says, and its cases. Throws BadInput."""

    DEFAULTS = {"Study/Title": "", "Study/Description": "", "Study/Scene": "",
                "Study/Settings": "", "Study/Methods": "",
                "Study/Columns": "status | iterations | J",
                "Study/Minimum": "",
                "Study/Accepted statuses": "success",
                "Study/Fields": "false", "Study/Fit window": "1e-3, 1e-8",
                "Study/Output directory": "output/{study}",
                "Preparation/Settings": "", "Plots/Kinds": "",
                "Plots/Fitted cases": "", "Plots/Powers": "",
                "Reference/File": "", "Reference/Label": "reference",
                "Reference/Rows": "", "Reference/Key": "value",
                "Reference/Columns": "", "Reference/Minimum": "0"}

    def __init__(self, file, changes=()):
        entries = prm.read(file)
        for change in changes:
            name, _, value = change.partition("=")
            entries[name.strip()] = value.strip()
            entries.where[name.strip()] = "--set"
        self.file = file
        self.name = os.path.splitext(os.path.basename(file))[0]
        self.folder = os.path.dirname(file)
        self.faults = []
        self.where = entries.where
        self.check_names(entries)
        value = {**self.DEFAULTS, **entries}
        self.title = value["Study/Title"] or self.name
        self.description = value["Study/Description"]
        self.directory = value["Study/Output directory"].replace("{study}",
                                                                 self.name)
        self.accepted = prm.items(value["Study/Accepted statuses"])
        self.fields = value["Study/Fields"] == "true"
        self.minimum = prm.number(value["Study/Minimum"])
        self.fitted = prm.items(value["Plots/Fitted cases"])
        self.powers = [float(p) for p in prm.items(value["Plots/Powers"])]
        self.kinds = prm.items(value["Plots/Kinds"])
        self.settings = self.read(value, "Study/Settings", prm.pairs)
        self.preparation = self.read(value, "Preparation/Settings", prm.pairs)
        self.window = self.read(value, "Study/Fit window", lambda text:
                                [float(w) for w in text.split(",")])
        self.columns = [column for column in (
            self.read({"Study/Columns": name}, "Study/Columns", Column)
            for name in prm.items(value["Study/Columns"])) if column]
        self.sweeps = self.read_sweeps(value)
        self.by_title = {column.title: column for column in self.columns}
        self.reference = self.read(value, "Reference/Columns", lambda _:
                                   Reference(self, value))
        if self.faults:
            raise BadInput(*self.faults)
        self.make_cases()

    def fault(self, entry, text):
        self.faults.append(f"{self.where.get(entry, self.file)}: {entry}: {text}")

    def read(self, value, entry, parse):
        try:
            return parse(value[entry])
        except ValueError as error:
            self.fault(entry, error)
            return None

    def check_names(self, entries):
        sweep = re.compile(r"Sweep \d+/(Parameter|Label|Values)$")
        for entry in entries:
            if not (entry in self.DEFAULTS or sweep.match(entry) or
                    entry.startswith("Cases/")):
                near = difflib.get_close_matches(
                    entry, [*self.DEFAULTS, "Sweep 1/Parameter",
                            "Sweep 1/Values", "Sweep 1/Label"], 1)
                self.fault(entry, "there is no such entry" + "".join(
                    f"; do you mean {name}?" for name in near))

    def read_sweeps(self, value):
        """Scenes if there are several, Cases, Sweep 1, ..., methods."""
        sweeps = []
        names = prm.items(value["Study/Scene"])
        self.scenes = [path for name in names for path in sorted(
            glob.glob(os.path.join(self.folder, name)))]
        if len(self.scenes) < max(1, len(names)):
            self.fault("Study/Scene", f"there is no file for {names}")
        if len(self.scenes) > 1:
            sweeps.append(Sweep("scene", [
                (os.path.splitext(os.path.basename(path))[0], path, {})
                for path in self.scenes]))
        named = {entry[6:]: text for entry, text in value.items()
                 if entry.startswith("Cases/")}
        if named:
            sweeps.append(Sweep("case", [
                self.named_case(name, text) for name, text in named.items()]))
        numbers = sorted({entry.split("/")[0] for entry in value
                          if entry.startswith("Sweep ")})
        for section in numbers:
            parameter = value.get(section + "/Parameter", "")
            text = value.get(section + "/Values", "")
            values = self.read({section: text}, section, sweep_values) or []
            if not parameter or not values:
                self.fault(section + "/Parameter",
                           "a sweep needs Parameter and Values")
            for one in values:
                if len(prm.items(one, "&")) != len(prm.items(parameter, "&")):
                    self.fault(section + "/Values", f"'{one}' has not as many "
                               f"parts as {parameter}")
            if len(set(values)) < len(values):
                self.fault(section + "/Values", "a value is there twice")
            sweeps.append(Sweep(
                value.get(section + "/Label", "") or parameter,
                [(one, None, dict(zip(prm.items(parameter, "&"),
                                      prm.items(one, "&"))))
                 for one in values]))
        methods = prm.items(value["Study/Methods"])
        if len(methods) > 1:
            sweeps.append(Sweep("method", [(method, None, {METHOD: method})
                                           for method in methods]))
        elif methods and self.settings is not None:
            self.settings[METHOD] = methods[0]
        return sweeps

    def named_case(self, name, text):
        """NAME = [SCENE] | A/B=1 | C=2."""
        first, *rest = prm.items(text) or [""]
        scene = None
        if first.endswith(".prm"):
            scene = os.path.join(self.folder, first)
            if not os.path.exists(scene):
                self.fault("Cases/" + name, f"there is no file {scene}")
        elif first:
            rest = [first] + rest
        settings = self.read({"Cases/" + name: " | ".join(rest)},
                             "Cases/" + name, prm.pairs)
        return name, scene, settings or {}

    def make_cases(self):
        self.cases, self.minima = [], []
        minima, directories = {}, set()

        def directory(folder, label):
            name = re.sub(r"[^A-Za-z0-9=.,+\-_]", "_", label.replace(" ", ""))
            path = os.path.join(self.directory, folder, name)
            while path in directories:
                path += "_"
            directories.add(path)
            return path

        preparation = os.path.join(self.directory, "preparation")
        outputs = {f"Output/{kind} VTU": str(self.fields).lower()
                   for kind in ("Body", "Contact")}
        for values in itertools.product(*(s.values for s in self.sweeps)):
            scene = self.scenes[0]
            settings = {**outputs, **self.settings}
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
            if self.minimum is not None or not self.needs_minima():
                continue
            # The exact minimum of what this case minimises.
            settings = {name: text for name, text in settings.items()
                        if not name.startswith("Solver/")}
            key = scene, tuple(sorted(settings.items()))
            if key not in minima:
                label = ", ".join([*fixed, "exact minimum"])
                minima[key] = cases.Case(
                    label, [], scene,
                    {**settings, METHOD: "majorise minimise"},
                    directory("minima", ", ".join(fixed) or "minimum"))
                self.minima.append(minima[key])
            case.minimum = minima[key]
        self.first = None
        if self.preparation:
            self.first = cases.Case("preparation", [], self.scenes[0],
                                    {**outputs, **self.preparation},
                                    preparation)

    def needs_minima(self):
        return (any(column.needs_minimum for column in self.columns) or
                not {"convergence", "fit"}.isdisjoint(self.kinds))

    def all_cases(self):
        return ([self.first] if self.first else []) + self.minima + self.cases


class Sweep:
    """A list of (text, scene or None, settings)."""

    def __init__(self, label, values):
        self.label = label
        self.values = values

    def numbers(self):
        """The values as numbers > 0, or None."""
        numbers = [prm.number(value[0]) for value in self.values]
        return numbers if all(n and n > 0 for n in numbers) else None


def sweep_values(text):
    """'a | b', or 'geometric FIRST LAST COUNT'."""
    if not text.startswith("geometric"):
        return prm.items(text)
    words = text.split()[1:]
    numbers = [prm.number(word) for word in words]
    if len(numbers) != 3 or None in numbers or min(numbers) <= 0 or \
            numbers[2] != int(numbers[2]) or not 2 <= numbers[2] <= 1000:
        raise ValueError("expected 'geometric FIRST LAST COUNT' with numbers > 0 "
                         "and 2 to 1000 values")
    return [f"{value:.6g}" for value in numpy.geomspace(
        numbers[0], numbers[1], int(numbers[2]))]


class Row:
    """A case with what it found."""

    def __init__(self, study, case):
        self.case = case
        self.summary = case.summary()
        self.status = case.status()
        self.history = case.table("history.csv").get("functional",
                                                     numpy.array([]))
        self.minimum = study.minimum
        if case.minimum and case.minimum.status() == "success":
            self.minimum = case.minimum.summary()["functional"]
        self.rate = (fit_rate(self.errors(), *study.window)
                     if self.minimum is not None else None)

    def at(self, pointer):
        """What is at a JSON pointer of the summary, or None."""
        found = self.summary
        for key in pointer.strip("/").split("/"):
            if isinstance(found, list):
                found = dict(enumerate(found)).get(prm.number(key))
            elif isinstance(found, dict):
                found = found.get(key)
            else:
                return None
        return None if isinstance(found, (dict, list)) else found

    def functional(self, iteration=None):
        if iteration and iteration < len(self.history):
            return self.history[iteration - 1]
        return self.at("/functional")

    def errors(self):
        return (self.history - self.minimum) / abs(self.minimum)

    def h(self):
        """The edge of the cells of a box."""
        scene = self.case.parameters() if self.summary else {}
        first = [prm.number(scene.get("Mesh/" + name, "").split(",")[0])
                 for name in ("Lengths", "Cells")]
        return None if None in first else first[0] / first[1]


class Column:
    """A column of the table. Throws ValueError if there is none of that
    name."""

    def __init__(self, name):
        self.title, self.pointer, self.iteration = name, "", None
        self.kind = name
        self.digits = 2
        definition = re.match(r"(?:(.*?)\s*=\s*)?(/.*?)(?:\s+to\s+(\d+))?$",
                              name)
        at = re.match(r"(J|error) at (\d+)$", name)
        if name in SHORT_NAMES:
            self.kind, self.pointer = "number", SHORT_NAMES[name]
        elif definition:
            self.kind, self.pointer = "number", definition[2]
            self.title = definition[1] or definition[2]
            self.digits = int(definition[3] or 2)
        elif at:
            self.kind, self.iteration = at[1], int(at[2])
        elif name.startswith("order of "):
            self.kind, self.of = "order", name[9:]
        elif name not in ("status", "J", "J_min", "error", "rate", "window",
                          "h", "fronts", *LEVELS):
            raise ValueError(f"there is no column '{name}'")
        if self.kind in ("J", "J_min"):
            self.digits = 11
        self.needs_minimum = self.kind in ("J_min", "error", "rate", "window")

    def value(self, row):
        """A number, words or None."""
        J = row.functional(self.iteration)
        if self.kind == "status":
            return row.status
        if self.kind == "J_min":
            return row.minimum
        if self.kind == "number":
            return row.at(self.pointer)
        if not row.summary:
            return None
        if self.kind == "J":
            return J
        if self.kind == "error" and row.minimum is not None:
            return (J - row.minimum) / abs(row.minimum)
        if self.kind == "rate" and row.rate:
            return row.rate[0]
        if self.kind == "window" and row.rate:
            return f"{row.rate[2]} to {row.rate[3]}"
        if self.kind == "h":
            return row.h()
        if self.kind == "fronts":
            return fronts(row.case.table("certified_sides.csv"))
        if self.kind in LEVELS:
            return levels(row.summary).get(self.kind)
        return None

    def text(self, value):
        if value is None:
            return ""
        if isinstance(value, (str, bool)):
            return str(value)
        if isinstance(value, int) or (value == round(value) and
                                      abs(value) < 1e9):
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
        self.rows = []
        if not value["Reference/File"]:
            self.columns = {}
            return
        table = cases.read_csv(os.path.join(study.folder,
                                            value["Reference/File"]))
        wanted = prm.pairs(value["Reference/Rows"])
        self.key = value["Reference/Key"]
        missing = {self.key, *self.columns.values(), *wanted} - set(table)
        if missing or not set(self.columns) <= {c.title for c in study.columns}:
            raise ValueError("not all columns are there: "
                             + ", ".join(missing or self.columns))
        for cells in zip(*table.values()):
            row = dict(zip(table, cells))
            if all(is_same(row[name], text) for name, text in wanted.items()):
                self.rows.append(row)

    def value(self, case, column):
        for row in self.rows:
            if is_same(row[self.key], case.values[0]):
                found = row[self.columns[column.title]]
                number = prm.number(found)
                if number is None or math.isnan(number):
                    return None
                if column.kind == "error":
                    return (number - self.minimum) / abs(self.minimum)
                return number
        return None


def is_same(a, b):
    """As numbers if both are."""
    x, y = prm.number(a), prm.number(b)
    return a == b if x is None or y is None else x == y


def fit_power_law(x, y):
    """(exponent, factor) of y ~ factor x^exponent, None if x is one value."""
    if len(x) < 2 or min(x) == max(x):
        return None
    exponent, logarithm = numpy.polyfit(numpy.log(x), numpy.log(y), 1)
    return exponent, math.exp(logarithm)


def fit_rate(errors, begin, end):
    """(exponent, factor, first, last iteration) of a power law between the first
    iterations with these errors; None for fewer than three."""
    below = numpy.nonzero(errors <= begin)[0]
    if not len(below):
        return None
    first = below[0]
    last = next((k for k in below if errors[k] <= end), len(errors) - 1)
    k = numpy.array([k for k in range(first, last + 1) if errors[k] > 0])
    if len(k) < 3:
        return None
    return (*fit_power_law(k + 1, errors[k]), k[0] + 1, k[-1] + 1)


def order(column, rows, index, sweeps):
    """The power of h with which a quantity falls from the mesh before to this
    one; of J, which falls to an unknown limit, its differences do."""
    def before(k):
        if k < 1:
            return None
        a, b = rows[k - 1], rows[k]
        others = sum(x != y for x, y in zip(a.case.values, b.case.values))
        return k - 1 if sweeps and others == 1 and a.h() and b.h() and \
            a.h() > b.h() else None

    previous = before(index)
    if previous is None:
        return None
    new, old = (column.value(rows[k]) for k in (index, previous))
    distance = math.log(rows[previous].h() / rows[index].h())
    if column.kind == "J":
        third = before(previous)
        if third is None:
            return None
        new, old = old - new, column.value(rows[third]) - old
    return math.log(old / new) / distance if old and new and old * new > 0 \
        else None


def levels(summary):
    """The estimate of the error beside the error, to the limit that J and its
    estimate on the last meshes have; the first mesh, and the least and the
    largest ratio on all that have four times the last estimate."""
    found = summary.get("levels") or []
    found = list(found.values()) if isinstance(found, dict) else found
    if len(found) < 3:
        return {}
    J = [level["functional"] for level in found]
    estimates = [level["estimated_error"] for level in found]
    error = [e * abs(j) for e, j in zip(estimates, J)]
    limit = J[-1] - (J[-3] - J[-1]) / (error[-3] - error[-1]) * error[-1]
    ratios = [(level["unknowns"], (j - limit) / abs(limit),
               estimate / ((j - limit) / abs(limit)))
              for level, j, estimate in zip(found, J, estimates)
              if level is found[0] or estimate > 4 * estimates[-1]]
    all_ratios = [ratio for _, _, ratio in ratios]
    return dict(zip(LEVELS, [*ratios[0], ratios[-1][0], min(all_ratios),
                             max(all_ratios)]))


def fronts(sides):
    """The lengths of the pieces of the contact boundary on which the state of
    bonds is not certain, of a certificate."""
    ends = [((x0, y0), (x1, y1)) for x0, y0, x1, y1, state in zip(
        *(sides[c] for c in ("x0", "y0", "x1", "y1", "state")))
            if state == "uncertain"] if sides else []
    pieces = []
    for side in ends:
        own, rest = [side], []
        for piece in pieces:
            touches = any(math.dist(a, b) < 1e-9 for other in piece
                          for a in other for b in side)
            (own if touches else rest).extend(piece if touches else [piece])
        pieces = [*rest, own]
    return " + ".join(f"{sum(math.dist(*side) for side in piece):.3g}"
                      for piece in pieces) or "none"


def best_values(study, rows):
    """For each value of the first sweep the value of the second, over numbers,
    with the fewest iterations, and the range that needs at most 10 % more."""
    if len(study.sweeps) < 2 or not study.sweeps[1].numbers():
        return []
    groups = {}
    for row in rows:
        values = row.case.values
        groups.setdefault((values[0], *values[2:]), []).append(row)
    result = []
    for key, group in groups.items():
        x = [float(row.case.values[1]) for row in group]
        n = [row.at("/iterations/total") if row.status == "success" and
             row.at("/iterations/total") else math.inf for row in group]
        best = n.index(min(n))
        if n[best] == math.inf:
            continue
        first = last = best
        while first > 0 and n[first - 1] <= GOOD_SHARE * n[best]:
            first -= 1
        while last + 1 < len(n) and n[last + 1] <= GOOD_SHARE * n[best]:
            last += 1
        result.append({study.sweeps[0].label: key[0],
                       **dict(zip((s.label for s in study.sweeps[2:]),
                                  key[1:])),
                       "h": group[0].h(), "best": x[best],
                       "iterations": n[best],
                       "smallest within 10 %": min(x[first], x[last]),
                       "largest within 10 %": max(x[first], x[last]),
                       "at an end of the values":
                           "yes" if best in (0, len(n) - 1) else "no"})
    return result


def fit_best(found):
    """The power law of the best values over h, without those at an end."""
    inner = [row for row in found if row["at an end of the values"] == "no"]
    return fit_power_law([row["h"] for row in inner],
                         [row["best"] for row in inner])
