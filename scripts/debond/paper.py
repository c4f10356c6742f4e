# SPDX-License-Identifier: LGPL-2.1-or-later
"""The tables and figures of the paper, and the pictures of the pages."""

import argparse
import os
import shutil
import subprocess

from . import cases, picture, report
from .runs import SOURCE

# Studies of prm/studies/, and which of their plots the pages show as what.
STUDIES = {
    "figures-4-6": {"displacement": "displacement", "force": "force",
                    "law": "law"},
    "table-1": {"convergence": "figure-7", "fit": "figure-7-fit"},
    "table-2": {"convergence": "figure-8"},
    "table-3": {"convergence": "figure-9"},
    "table-4": {"convergence": "figure-10"},
    "table-5": {"steps": "figure-11"},
    "table-6": {"convergence": "figure-12"},
    "table-7": {"convergence": "figure-13"},
    "table-8": {"convergence": "figure-14"},
    "energy-norm": {"convergence": "energy-norm"}, "line-search": {},
    "proximal-weight": {"iterations": "proximal-weight"},
    "proximal-weight-scaled": {}, "distance-weight": {}}

# Scenes, settings and units, and which of their pictures the pages show.
SCENES = [
    ("benchmark-40x4", "", "m, GPa", {"body": "body"}),
    ("load-path-690", "40, 4", "m, GPa", {"load_path": "load-path-40x4"}),
    ("load-path-690", "80, 8", "m, GPa", {"load_path": "load-path-80x8"}),
    ("cookbook/tape", "", "mm, MPa", {"body": "cookbook-tape",
                                      "contact": "cookbook-tape-front"}),
    ("cookbook/cattaneo", "", "mm, MPa", {"contact": "cookbook-cattaneo"}),
    *((f"cookbook/{name}", "", "mm, MPa", {"body": f"cookbook-{name}"})
      for name in ("ring", "double-cantilever", "bimaterial-strip", "peel", "blister",
                   "wafer", "delamination")),
    *((f"cookbook/{name}", "", "mm, MPa", {"load_path": f"cookbook-{name}"})
      for name in ("double-cantilever-path", "r-curve", "punch",
                   "softening-cantilever", "snap-back"))]

# What the pictures of these load paths show over the displacement's factor.
PATHS = {"cookbook/double-cantilever-path": ("reaction_left_y", "fronts"),
         "cookbook/r-curve": ("reaction_left_y", "fronts"),
         "cookbook/punch": ("reaction_top_y", "largest_gap"),
         "cookbook/softening-cantilever": ("reaction_left_y", "softening_part"),
         "cookbook/snap-back": ("reaction_top_y", "largest_gap")}


def make_pictures(program):
    for name, cells, units, pictures in SCENES:
        directory = f"output/pictures/{name}-{cells}".replace(", ", "x")
        subprocess.run([program, f"prm/{name}.prm", "--set",
                        f"Output/Directory={directory}",
                        *(["--set", f"Mesh/Cells={cells}"] if cells else [])],
                       check=True, stdout=subprocess.DEVNULL)
        picture.draw(directory, units, path=[
            f"{column} over displacement_factor" for column in PATHS.get(name, ())] or
            ["all"] * ("load_path" in pictures))
        for own, shown in pictures.items():
            shutil.copy(f"{directory}/{own}.png", f"doc/pictures/{shown}.png")


def copy_study(name):
    """The table, if pages have it, and the plots that they show."""
    for plot, shown in STUDIES.get(name, {}).items():
        shutil.copy(f"output/{name}/plots/{plot}.png",
                    f"doc/pictures/paper-{shown}.png")
    shown = f"doc/notes/reproduction/{name}.csv"
    if os.path.exists(shown):
        shutil.copy(f"output/{name}/table.csv", shown)


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/paper", description="Makes the tables and figures of the "
        "paper, in output/STUDY/index.md. What was made before is not repeated.")
    parser.add_argument("studies", metavar="STUDY", nargs="*",
                        help="of prm/studies/, without ending; all if none")
    parser.add_argument("--doc", action="store_true",
                        help="write tables and figures to doc/ as well, and "
                        "without STUDY all other pictures of pages")
    parser.add_argument("--debond", help="a program that is built already")
    options = parser.parse_args()
    program = os.path.abspath(options.debond or cases.build())
    os.chdir(SOURCE)
    if options.doc and not options.studies:
        make_pictures(program)
    worst = 0
    for name in options.studies or STUDIES:
        code = report.run(f"prm/studies/{name}.prm", program)
        if code == 4:
            return code
        if options.doc:
            copy_study(name)
        worst = worst or code
    return worst
