# SPDX-License-Identifier: LGPL-2.1-or-later
"""Single runs of the program, and what they have written."""

import csv
import dataclasses
import functools
import glob
import json
import os
import pathlib
import re
import shutil
import subprocess
import types

import numpy

from . import prm

SOURCE = os.path.abspath(os.path.join(__file__, "../../.."))


class Error(RuntimeError):
    """The program's messages, with its exit `code` (None if it did not run) and
    the `results`, if there are any."""

    def __init__(self, message, code=None, results=None):
        super().__init__(message)
        self.code, self.results = code, results


def program():
    """The path of the program: $DEBOND, that of the source tree around this
    package, or the one on PATH. Throws Error if there is none."""
    built = os.path.join(SOURCE, "build", "debond")
    found = os.environ.get("DEBOND") or (
        built if os.path.exists(built) else shutil.which("debond"))
    if not found:
        raise Error("there is no program debond: build it with scripts/build, "
                    "or name it in the environment variable DEBOND")
    return os.path.abspath(found)


def read_summary(directory):
    """summary.json as a dictionary, empty if there is no complete one."""
    try:
        with open(os.path.join(directory, "summary.json"),
                  encoding="utf8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def read_csv(path):
    """The columns of a table by their titles: arrays of numbers, of places their x,
    or arrays of words where not all are numbers; empty if there is no such file."""
    if not os.path.exists(path):
        return {}
    with open(path, newline="", encoding="utf8") as file:
        rows = list(csv.reader(line for line in file
                               if line.strip() and line[0] != "#"))
    columns = {}
    for title, *cells in zip(*rows):
        numbers = [prm.number(cell.partition(" ")[0] or "nan") for cell in cells]
        columns[title] = numpy.array(cells if None in numbers else numbers)
    return columns


def bodies(directory, name="body"):
    """The .vtu files of this name: one, or those of several ranks."""
    files = glob.glob(os.path.join(directory, name + ".vtu"))
    return files or sorted(glob.glob(os.path.join(directory, name + ".rank*.vtu")))


@dataclasses.dataclass
class Results:
    """What a run wrote to a directory. The tables are dictionaries of arrays by the
    titles of their columns, empty if the run has no such table."""

    directory: pathlib.Path
    log: str = dataclasses.field(default="", repr=False)
    code: int = 0

    def __post_init__(self):
        self.directory = pathlib.Path(self.directory).absolute()
        self.summary = read_summary(self.directory)
        if not self.summary:
            raise Error(f"{self.directory} has no summary.json of a run")
        self.history, self.profile, self.load_path, self.load_path_arc = (
            read_csv(self.directory / f"{name}.csv") for name in
            ("history", "contact_profile", "load_path", "load_path_arc"))

    @functools.cached_property
    def body(self):
        """(points, displacement), read when it is asked for; of points where ranks
        meet, each rank has its own."""
        import meshio

        if read_summary(self.directory) != self.summary:
            raise Error(f"another run has written to {self.directory}")
        meshes = [meshio.read(file) for file in bodies(self.directory)]
        if not meshes:
            raise Error(f"{self.directory} has no body.vtu: the run needs "
                        "Output/Body VTU = true")
        return tuple(numpy.concatenate(parts)[:, :self.summary["dimension"]]
                     for parts in zip(*((mesh.points,
                                         mesh.point_data["displacement"])
                                        for mesh in meshes)))

    @property
    def points(self):
        """The nodes of the body at rest, a row each, in single precision."""
        return self.body[0]

    @property
    def displacement(self):
        """u at the points, a row each, in single precision."""
        return self.body[1]


def text(value):
    """A value of a setting as scenes have it."""
    if numpy.ndim(value):
        return ", ".join(map(text, value))
    return str(value).lower() if isinstance(value, (bool, numpy.bool_)) else str(value)


def run(scene, settings=None, directory=None, ranks=1, check=True):
    """Runs a scene with other settings, such as {'Mesh/Cells': (80, 8)}, and returns
    its Results, by default in output/SCENE. Throws Error with the program's messages
    for any exit code but 0, or with check=False only where there are no results."""
    settings = dict(settings or {})
    if directory is not None:
        settings["Output/Directory"] = directory
    command = [program(), os.fspath(scene)]
    if ranks > 1:
        command = ["mpirun", "-n", str(ranks), *command]
    for name, value in settings.items():
        command += ["--set", f"{name}={text(value)}"]
    with subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace",
                          start_new_session=True) as child:  # Ctrl-C is for Python
        try:
            log, errors = child.communicate()
        except KeyboardInterrupt:
            child.terminate()  # it writes what it has
            child.communicate()
            raise
    code = child.returncode
    said = re.findall(r"^debond: (.*)", errors, flags=re.M)
    written = re.findall(r"^  (.*)summary\.json$", log, flags=re.M)
    results = Results(written[-1], log, code) if written else None
    if code and (check or not results):
        raise Error("\n".join(said) or errors.strip() or f"ended with {code}", code,
                    results)
    return results


def matrices(directory):
    """The discrete problem of a run with Output/Matrices = true, by the names of its
    files: A and frames are sparse, S and modes arrays, f, g, bounds and weights
    vectors, c_0 is a number, and `contact` has the rows of s in A, from 0."""
    import scipy.io

    found = {path.stem: scipy.io.mmread(path)
             for path in pathlib.Path(directory).glob("*.mtx")}
    if "S" not in found:
        raise Error(f"{directory} has no S.mtx: the run needs Output/Matrices = true")
    for name in ("f", "g", "bounds", "weights", "contact", "c_0"):
        found[name] = found[name].ravel()
    found.update({name: found[name].tocsr() for name in ("A", "frames")},
                 c_0=found["c_0"].item(), contact=found["contact"].astype(int) - 1)
    return types.SimpleNamespace(**found)
