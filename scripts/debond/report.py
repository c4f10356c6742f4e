# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs studies and writes what came out: tables, plots and a page."""

import argparse
import csv
import os
import pathlib
import subprocess
import sys

from . import cases, plots
from . import study as studies
from .prm import BadInput


def markdown(titles, rows):
    lines = [titles, ["---"] * len(titles), *rows]
    return "".join("| " + " | ".join(
        str(cell).replace("|", "\\|").replace("_", "\\_")
        for cell in line) + " |\n" for line in lines)


def write_csv(path, titles, rows):
    with open(path, "w", encoding="utf8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([titles, *rows])


def table(study, rows):
    """Titles, and for each case its cells as values and as text."""
    titles = [sweep.label for sweep in study.sweeps]
    values = [list(row.case.values) for row in rows]
    texts = [list(row.case.values) for row in rows]

    def add(title, column, cells):
        titles.append(title)
        for k, cell in enumerate(cells):
            values[k].append(cell)
            texts[k].append(column.text(cell))

    for title, column in study.columns.items():
        cells = [studies.order(study, column, rows, k) if column.kind == "order"
                 else column.value(row) for k, row in enumerate(rows)]
        if column.pointer and any(row.summary for row in rows) and \
                all(cell is None for cell in cells):
            found = next(row for row in rows if row.summary).find(column.pointer)
            raise BadInput(f"{study.file}: Study/Columns: no case has {column.pointer}" +
                           (f", but {', '.join(found)}" if found else ""))
        add(title, column, cells)
        if title in study.reference.columns:
            add(f"{title} ({study.reference.label})", column,
                [study.reference.value(row.case, column) for row in rows])
    return titles, values, texts


def write_results(study, program):
    """Returns the lines of the cases that failed."""
    rows = [studies.Row(study, case) for case in study.cases]
    titles, values, texts = table(study, rows)
    write_csv(os.path.join(study.directory, "table.csv"), titles, values)
    text = markdown(titles, texts)
    pathlib.Path(study.directory, "table.md").write_text(text)
    print("\n" + text, flush=True)
    version = subprocess.run([program, "--version"], check=True, text=True,
                             capture_output=True).stdout.split("\n")
    page = [f"# {study.title}\n", study.description + "\n",
            f"Made by `scripts/study {study.file}`, {', '.join(version[:2])}.\n",
            text]
    best = studies.best_values(study, rows)
    if best:
        page += ["## Best values\n", markdown(
            best[0], [[f"{cell:.3g}" if isinstance(cell, float) else cell
                       for cell in row.values()] for row in best])]
    drawn, empty = plots.draw(study, rows)
    page += [f"![{plot.name}](plots/{plot.name}.png)\n*{plot.caption}* "
             f"([SVG](plots/{plot.name}.svg))\n" for plot in drawn]
    page += [f"The plot {plot.name} has no points.\n" for plot in empty]
    page += [f"J of {row.case.label} is lower than J_min: there are several minima.\n"
             for row in rows if row.minimum is not None and row.functional() is not None
             and row.functional() < row.minimum - 1e-9 * abs(row.minimum)]
    failed = [f"{case.label}: {case.status()}: "
              f"{case.summary().get('message', '')}".rstrip(": ")
              for case in study.all_cases() if case.status() not in
              (study.accepted if case in study.cases else ["success"])]
    page += [f"Failed: {line}\n" for line in failed]
    page.append("The table with all digits: [CSV](table.csv).\n")
    pathlib.Path(study.directory, "index.md").write_text(
        "\n".join(part for part in page if part.strip()))
    print(f"Written: {study.directory}/index.md")
    return failed


def run(file, program, changes=(), jobs=None, only_validate=False):
    """Runs a study; returns 0, 3 if a case failed, 4 if interrupted."""
    study = studies.Study(file, changes)
    plots.check(study)
    print(f"{study.title}: {len(study.cases)} cases, {len(study.minima)} exact "
          "minima", flush=True)
    if only_validate:
        return 0
    try:
        first = [study.first] if study.first else []
        afresh = cases.run(program, first, jobs) > 0
        if all(case.summary() for case in first):
            cases.run(program, study.minima + study.cases, jobs, afresh)
    except KeyboardInterrupt:
        print(f"{file}: interrupted; the same command goes on where it stopped",
              file=sys.stderr)
        return 4
    failed = write_results(study, program)
    for line in failed:
        print(f"{file}: case {line}", file=sys.stderr)
    return 3 if failed else 0


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/study", description="Runs studies, see "
        "doc/guide/studies.md. The same command goes on where one was "
        "interrupted. Returns 3 if a case failed, 2 for bad input.")
    parser.add_argument("studies", metavar="STUDY.prm", nargs="+")
    parser.add_argument("--validate", action="store_true", help="only read them")
    parser.add_argument("--set", metavar="SECTION/ENTRY=VALUE", default=[],
                        action="append", help="change an entry of the studies")
    parser.add_argument("--jobs", type=int, help="processes at a time")
    parser.add_argument("--debond", help="a program that is built already")
    options = parser.parse_args()
    program = options.debond or (None if options.validate else cases.build())
    worst = 0
    for file in options.studies:
        try:
            code = run(file, program, options.set, options.jobs,
                       options.validate)
        except BadInput as error:
            print(f"study: {error}", file=sys.stderr)
            code = 2
        if code == 4:
            return code
        worst = worst or code
    return worst
