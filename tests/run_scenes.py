# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes of which a test writes the entries, and collects what does not hold."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile


def number(value):
    """Of a cell of a table, which may be a word."""
    try:
        return float(value)
    except ValueError:
        return value


def read_table(file):
    """The rows of a table, each a dictionary; none if there is no such file."""
    if not file.exists():
        return []
    with open(file, encoding="utf-8") as lines:
        return [{name: number(cell) for name, cell in row.items()}
                for row in csv.DictReader(lines)]


class Scenes:
    """Of a program; all files go with this object."""

    def __init__(self, debond):
        self.debond = str(pathlib.Path(debond).resolve())
        self.temporary = tempfile.TemporaryDirectory()
        self.directory = pathlib.Path(self.temporary.name)
        (self.directory / "scene.prm").touch()
        self.n_checks, self.failures, self.title = 0, 0, ""

    def solve(self, *settings, scene="scene.prm"):
        """The summary of a run with its exit code, what it prints to stderr, and the rows
        of its tables. What is no scene has no status."""
        output = self.directory / "output"
        for file in output.glob("*.*") if output.exists() else ():
            file.unlink()
        result = subprocess.run(
            [self.debond, scene, "--set=Output/Body VTU=false",
             "--set=Output/Contact VTU=false", "--set=Output/Directory=output",
             *("--set=" + entry for entry in settings)],
            cwd=self.directory, capture_output=True, text=True, check=False)
        summary = {"status": None}
        if (output / "summary.json").exists():
            summary = json.loads((output / "summary.json").read_text())
        summary.update(exit_code=result.returncode, errors=result.stderr, log=result.stdout)
        for name, file in (("path", "load_path"), ("arc", "load_path_arc"),
                           ("profile", "contact_profile"), ("history", "history")):
            summary[name] = read_table(output / (file + ".csv"))
        return summary

    def section(self, title):
        """Of the checks that follow."""
        self.title = title

    def check(self, name, holds, detail=""):
        """Prints what does not hold."""
        self.n_checks += 1
        if not holds:
            self.failures += 1
            print(f"{self.title}: {name} {detail}", flush=True)

    def close(self, name, value, expected, tolerance, scale=None):
        """Relative to what is expected, or to a scale."""
        size = abs(expected) if scale is None else scale
        self.check(name, value is not None and abs(value - expected) <= tolerance * size,
                   f"{value!r}, expected {expected!r}")

    def end(self):
        """Prints the number of checks and ends the program."""
        print(f"{self.n_checks} checks, {self.failures} failed")
        sys.exit(1 if self.failures else 0)
