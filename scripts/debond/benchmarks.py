# SPDX-License-Identifier: LGPL-2.1-or-later
"""Contact solves beside linear solves of the same bodies without contact."""

import argparse
import glob
import os
import pathlib
import statistics
import subprocess
import sys

from . import cases, plots, report
from . import study as studies
from .runs import SOURCE

SOLVERS = ("cholesky", "ml", "hypre")


def measure(program, study, case, repetitions):
    """A row of the table: medians of contact and linear solves that alternate;
    None if the scene is not solved."""
    matrices = cases.Case(case.label, [], case.scene, {
        **case.settings, "Output/Matrices": "true"}, case.directory + ".mtx")
    cases.run(program, [matrices], 1)
    if matrices.status() not in study.accepted:
        print(f"{case.label}: {matrices.status()}", file=sys.stderr)
        return None
    seconds = {name: [] for name in ("contact", *SOLVERS)}
    steps = {}
    for _ in range(repetitions):
        cases.run(program, [case], 1, afresh=True)
        seconds["contact"].append(case.summary()["timings_s"]["solve"])
        done = subprocess.run([program + "-baselines", matrices.directory,
                               *SOLVERS], check=True, stdout=subprocess.PIPE,
                              text=True)
        for line in done.stdout.splitlines()[1:]:
            solver, time, steps[solver], *_ = line.split(",")
            seconds[solver].append(float(time))
    for name in os.listdir(matrices.directory):
        if name.endswith(".mtx"):
            os.remove(matrices.path(name))
    row = studies.Row(study, case)
    median = {name: statistics.median(s) for name, s in seconds.items()}
    best = min(SOLVERS, key=median.get)
    ratios = [c / b for c, b in zip(seconds["contact"], seconds[best])]
    return {"study": study.title, "case": case.label,
            "unknowns": row.at("/degrees_of_freedom"),
            "contact nodes": row.at("/contact_nodes"),
            **{f"{name}, s": seconds for name, seconds in median.items()},
            "ml steps": steps["ml"], "hypre steps": steps["hypre"],
            "contact / best": statistics.median(ratios),
            "least": min(ratios), "largest": max(ratios), "best": best,
            "peak, MB": row.at("/peak_memory_bytes") / 1e6}


def write(rows, directory):
    path = os.path.join(directory, "contact_solve")
    report.write_csv(path + ".csv", rows[0], [row.values() for row in rows])
    pathlib.Path(path + ".md").write_text(report.markdown(rows[0], [
        [f"{v:.3g}" if isinstance(v, float) else v for v in row.values()]
        for row in rows]))
    plot = plots.Plot("contact-ratio", "", "unknowns",
                      "contact / the quickest linear solve", "x")
    for study in dict.fromkeys(row["study"] for row in rows):
        own = [row for row in rows if row["study"] == study]
        unknowns = [row["unknowns"] for row in own]
        # One body on finer and finer meshes, or several bodies.
        plot.add(study, unknowns, [row["contact / best"] for row in own],
                 "o-" if unknowns == sorted(unknowns) else "o")
    plot.axes.axhline(1, color="k", lw=0.7)
    plot.save(directory)
    print(f"Written: {path}.md")


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/benchmarks", description="Measures contact solves of the "
        "studies of prm/benchmarks/ beside linear solves by CHOLMOD, ML and "
        "hypre, one after the other, and writes tables and a picture.")
    parser.add_argument("studies", nargs="*", metavar="STUDY.prm")
    parser.add_argument("--quick", action="store_true",
                        help="the first case of each study, once")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--output", default="output/benchmarks")
    options = parser.parse_args()
    program = cases.build("debond debond-baselines")
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    rows = []
    for file in options.studies or sorted(glob.glob(
            os.path.join(SOURCE, "prm", "benchmarks", "*.prm"))):
        study = studies.Study(file, [
            f"Study/Output directory={options.output}/{{study}}"])
        for case in study.cases[:1] if options.quick else study.cases:
            rows.append(measure(program, study, case, 1 if options.quick
                                else options.repetitions))
    found = [row for row in rows if row]
    write(found, options.output)
    return 0 if len(found) == len(rows) else 3
