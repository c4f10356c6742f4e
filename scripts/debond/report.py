# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs studies and writes what came out: tables, plots and a page."""

import argparse
import csv
import os
import subprocess
import sys

from . import cases, plots
from . import study as studies
from .prm import BadInput


def markdown(titles, rows):
    def line(cells):
        return "| " + " | ".join(
            cell.replace("|", "\\|").replace("_", "\\_") for cell in cells) + \
            " |"
    return "\n".join([line(titles), "|---" * len(titles) + "|",
                      *map(line, rows)]) + "\n"


def write(path, text):
    with open(path, "w", encoding="utf8") as file:
        file.write(text)


def table(study, rows):
    """Titles, and for each case its cells as values and as text."""
    titles = [sweep.label for sweep in study.sweeps]
    for column in study.columns:
        titles.append(column.title)
        if column.title in study.reference.columns:
            titles.append(f"{column.title} ({study.reference.label})")
    values, texts = [], []
    for index, row in enumerate(rows):
        cells = [(value, value) for value in row.case.values]
        for column in study.columns:
            value = (studies.order(
                studies.Column(column.of) if column.of not in
                study.by_title else study.by_title[column.of],
                rows, index, study.sweeps)
                if column.kind == "order" else column.value(row))
            cells.append((value, column.text(value)))
            if column.title in study.reference.columns:
                value = study.reference.value(row.case, column)
                cells.append((value, column.text(value)))
        values.append([value for value, _ in cells])
        texts.append([text for _, text in cells])
    return titles, values, texts


def write_csv(path, titles, rows):
    with open(path, "w", encoding="utf8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(titles)
        writer.writerows(rows)


def write_series(study, rows, name, series):
    """The cases as one series for ParaView; its time is their number."""
    lines = "".join(
        f'<DataSet timestep="{k}" part="0" file="{path}"/>\n'
        for k, path in enumerate(os.path.relpath(
            os.path.join(row.case.directory, name), study.directory)
            for row in rows if row.summary))
    write(os.path.join(study.directory, series),
          '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n'
          f"<Collection>\n{lines}</Collection>\n</VTKFile>\n")


def write_results(study, program):
    """Returns the lines of the cases that failed."""
    rows = [studies.Row(study, case) for case in study.cases]
    for column in study.columns:
        if column.kind == "number" and any(row.summary for row in rows) and \
                all(column.value(row) is None for row in rows):
            raise BadInput(f"{study.file}: Study/Columns: no case has "
                           f"{column.pointer} in its summary.json")
    titles, values, texts = table(study, rows)
    text = markdown(titles, texts)
    path = os.path.join(study.directory, "table")
    write_csv(path + ".csv", titles, values)
    write(path + ".md", text)
    print("\n" + text, flush=True)
    version = subprocess.run([program, "--version"], check=True,
                             capture_output=True, text=True).stdout.split("\n")
    page = [f"# {study.title}\n", study.description + "\n"
            if study.description else "",
            f"Made by `scripts/study {study.file}`, {', '.join(version[:2])}.\n",
            text]
    best = studies.best_values(study, rows)
    if best:
        law = studies.fit_best(best)
        page += ["## Best values\n", markdown(
            list(best[0]), [[f"{v:.3g}" if isinstance(v, float) else str(v)
                             for v in row.values()] for row in best])]
        if law:
            page.append(f"Fitted: best {study.sweeps[1].label} = {law[1]:.3g} "
                        f"h^{law[0]:.3g}, without those at an end.\n")
    if study.fields:
        write_series(study, rows, "body.vtu", "fields.pvd")
        write_series(study, rows, "contact.vtu", "contact.pvd")
        page.append("For ParaView: [body](fields.pvd), [contact boundary]"
                    "(contact.pvd).\n")
    drawn, empty = plots.draw(study, rows)
    for plot in drawn:
        page.append(f"![{plot.name}](plots/{plot.name}.png)\n*{plot.caption}* "
                    f"([SVG](plots/{plot.name}.svg))\n")
    page += [f"The plot {kind} has no points.\n" for kind in empty]
    failed = [f"{case.label}: {case.status()}: "
              f"{case.summary().get('message', '')}".rstrip(": ")
              for case in study.all_cases() if case.status() not in
              (study.accepted if case in study.cases else ["success"])]
    if failed:
        page += ["Failed:\n", *(f"* {line}" for line in failed), ""]
    page.append("The table with all digits: [CSV](table.csv).\n")
    write(os.path.join(study.directory, "index.md"),
          "\n".join(part for part in page if part != ""))
    print(f"Written: {study.directory}/index.md")
    return failed


def run(file, program=cases.PROGRAM, changes=(), jobs=None):
    """Runs a study; returns 0, 3 if a case failed, 4 if interrupted."""
    study = studies.Study(file, changes)
    plots.check(study)
    with cases.lock(study.directory):
        print(f"{study.title}: {len(study.cases)} cases, {len(study.minima)} "
              "exact minima", flush=True)
        try:
            afresh = bool(study.first) and cases.run(program, [study.first],
                                                     jobs) > 0
            if not study.first or study.first.summary():
                cases.run(program, study.minima + study.cases, jobs, afresh)
        except cases.Interrupted:
            print(f"{file}: interrupted; the same command goes on where it "
                  "stopped", file=sys.stderr)
            return 4
        failed = write_results(study, program)
    for line in failed:
        print(f"{file}: case {line}", file=sys.stderr)
    return 3 if failed else 0


def validate(file, program, changes=()):
    """Reads and checks the scenes of all cases; returns 0 or 2."""
    study = studies.Study(file, changes)
    plots.check(study)
    for case in study.all_cases():
        settings = [word for name, value in case.settings.items()
                    for word in ("--set", f"{name}={value}")]
        done = subprocess.run([program, case.scene, "--print-parameters",
                               *settings], capture_output=True, text=True)
        if done.returncode:
            raise BadInput(f"{file}: case {case.label}: {done.stderr.strip()}")
    print(f"{file}: valid, {len(study.cases)} cases")
    return 0


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/study", description="Runs studies, see "
        "doc/guide/studies.md. The same command goes on where one was "
        "interrupted. Returns 3 if a case failed, 2 for bad input.")
    parser.add_argument("studies", metavar="STUDY.prm", nargs="+")
    parser.add_argument("--validate", action="store_true",
                        help="read and check only")
    parser.add_argument("--set", metavar="SECTION/ENTRY=VALUE", default=[],
                        action="append", help="change an entry of the studies")
    parser.add_argument("--jobs", type=int, help="processes at a time")
    parser.add_argument("--debond", help="a program that is built already")
    options = parser.parse_args()
    if not options.debond:
        cases.build()
    program = options.debond or cases.PROGRAM
    worst = 0
    for file in options.studies:
        try:
            code = (validate(file, program, options.set) if options.validate
                    else run(file, program, options.set, options.jobs))
        except BadInput as error:
            for line in error.lines:
                print(f"study: {line}", file=sys.stderr)
            code = 2
        worst = worst or code
        if code == 4:
            break
    return worst
