# SPDX-License-Identifier: LGPL-2.1-or-later
"""Runs scenes of which a test writes the entries, and collects what does not hold."""
import csv
import inspect
import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading


NO_PICTURES = ["Output/Body VTU=false", "Output/Contact VTU=false"]
# Of entries that the tests write without their section; the first that fits counts.
SECTIONS = {
    "Mesh": "Lengths|Cells|Cuts|Degree|Source|File|Rotation|Generator|Arguments|Refinements|Scale",
    "Material": "Young mod|Poisson ratio|Shear moduli|Axis angle|Thermal expansion|Hypothesis",
    "Load path": "Factors|Displacement factors|Arc|Bonds heal|Global branch|Dead loads|Resolve",
    "Contact law": "Law|Quadrature|Tangential|Bond |Fracture|Shear fracture|Mixed mode|Failure|Curve|"
                   "Initial gap|Traction factor",
    "Boundary conditions": "Clamped|Roller|Contact boundary|Foundation normal|Displacement ",
    "Loads": "Traction |Pressure |Force |Body force|Temperature change",
    "Solver": "Linear solver|Method|Search|Prove"}


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
        return [{name: number(cell) for name, cell in row.items()} for row in csv.DictReader(lines)]


def full_entry(entry):
    """PATH=VALUE of an entry that may lack its section."""
    if "/" in entry.split("=")[0]:
        return entry
    return next((section + "/" + entry for section, words in SECTIONS.items()
                 if re.match(words, entry)), entry)


def scene_text(base, settings):
    """A scene that includes another and changes entries, given as PATH=VALUE."""
    lines = ["include " + base]
    for path, value in dict(full_entry(s).split("=", 1) for s in settings).items():
        *sections, entry = path.split("/")
        lines += ["subsection " + section for section in sections]
        lines += [f"set {entry} = {value}"] + ["end"] * len(sections)
    return "\n".join(lines) + "\n"


def sawteeth(stiffnesses, thresholds):
    """Contact law/Curve of springs that break in steps."""
    points = ["0:0"]
    for k, (a, M) in enumerate(zip(stiffnesses, thresholds)):
        softer = stiffnesses[k + 1] if k + 1 < len(stiffnesses) else 0.
        points += [f"{M!r}:{a * M!r}", f"{M!r}:{softer * M!r}"]
    return ", ".join(points)


def turned(entry, degrees):
    """A condition on x and y for the body turned about the origin."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return entry.replace("y", f"({c!r} * y - {s!r} * x)")


class Strand(threading.Thread):
    """Goes through a check, and waits wherever the check needs a scene solved."""

    def __init__(self, check):
        self.title, function, *arguments = check
        super().__init__(target=function, args=arguments, daemon=True)
        self.scene = self.result = self.error = None
        self.may_go_on, self.has_stopped = threading.Semaphore(0), threading.Semaphore(0)
        self.start()

    def run(self):
        self.may_go_on.acquire()
        try:
            super().run()
        except Exception as error:
            self.error = error
        self.scene = None
        self.has_stopped.release()

    def solved(self, *scene):
        """Called by the check."""
        self.scene = scene
        self.has_stopped.release()
        self.may_go_on.acquire()
        return self.result

    def go_on(self):
        """Up to the next scene."""
        self.may_go_on.release()
        self.has_stopped.acquire()
        if self.error:
            raise self.error


class Scenes:
    """Of a program; all files go with this object."""

    def __init__(self, debond):
        self.debond = str(pathlib.Path(debond).resolve())
        self.temporary = tempfile.TemporaryDirectory()
        self.directory = pathlib.Path(self.temporary.name)
        (self.directory / "scene.prm").touch()
        self.n_checks, self.failures, self.title = 0, 0, ""

    def run(self, *arguments):
        return subprocess.run([self.debond, *arguments], cwd=self.directory,
                              capture_output=True, text=True, check=False)

    def summary(self, output):
        """With the rows of its tables. What is no scene has no status."""
        output, summary = self.directory / output, {"status": None}
        if (output / "summary.json").exists():
            summary = json.loads((output / "summary.json").read_text())
        summary.update(exit_code=0, errors="", log="", vtu=b"".join(
            file.read_bytes() for file in output.glob("*.vtu")))
        for name, file in (("path", "load_path"), ("arc", "load_path_arc"),
                           ("profile", "contact_profile"), ("history", "history"),
                           ("sides", "certified_sides"), ("proof_history", "proof")):
            summary[name] = read_table(output / (file + ".csv"))
        shutil.rmtree(output, ignore_errors=True)
        return summary

    def solve(self, *settings, scene="scene.prm"):
        """The summary of a run with its exit code, what it prints to stderr, and the rows
        of its tables; of its VTU files, if they are asked for, what they have."""
        strand = threading.current_thread()
        if isinstance(strand, Strand) and scene == "scene.prm":
            return strand.solved(*settings)
        result = self.run(scene, *("--set=" + full_entry(entry) for entry in (
            *NO_PICTURES, *settings, "Output/Directory=output")))
        summary = self.summary("output")
        summary.update(exit_code=result.returncode, errors=result.stderr, log=result.stdout)
        return summary

    def solve_all(self, scenes):
        """Of lists of entries, in one run of the program, whose start takes longer than most
        scenes. What is no success is run once more for what it prints."""
        names = [f"scene-{k}.prm" for k in range(len(scenes))]
        for name, settings in zip(names, scenes):
            (self.directory / name).write_text(scene_text(
                "scene.prm", [*NO_PICTURES, *settings, "Output/Directory=output-" + name]))
        log = self.run(*names).stdout if len(names) > 1 else ""
        return [self.summary("output-" + name) if re.search(f"^ +0  {name}$", log, re.MULTILINE)
                else self.solve(*settings) for name, settings in zip(names, scenes)]

    def together(self, *checks):
        """Titles, functions that check, and their arguments: what all of them need next is
        solved in one run."""
        strands = [Strand(check) for check in checks]
        while strands:
            for strand in strands:
                strand.go_on()
            strands = [strand for strand in strands if strand.scene is not None]
            for strand, result in zip(strands, self.solve_all(
                    [strand.scene for strand in strands])):
                strand.result = result

    def all_of(self, names, *checks):
        """The functions check_... of a module that have no arguments, and others with titles;
        ends the program."""
        own = [(name[6:].replace("_", " "), function) for name, function in names.items()
               if name.startswith("check_") and not inspect.signature(function).parameters]
        self.together(*own, *checks)
        self.end()

    def section(self, title):
        """Of the checks that follow."""
        strand = threading.current_thread()
        (strand if isinstance(strand, Strand) else self).title = title

    def check(self, name, holds, detail=""):
        """Prints what does not hold."""
        self.n_checks += 1
        if not holds:
            self.failures += 1
            title = getattr(threading.current_thread(), "title", self.title)
            print(f"{title}: {name} {detail}", flush=True)

    def close(self, name, value, expected, tolerance, scale=None):
        """Relative to what is expected, or to a scale."""
        size = abs(expected) if scale is None else scale
        self.check(name, value is not None and abs(value - expected) <= tolerance * size,
                   f"{value!r}, expected {expected!r}")

    def end(self):
        """Prints the number of checks and ends the program."""
        print(f"{self.n_checks} checks, {self.failures} failed")
        sys.exit(1 if self.failures else 0)
