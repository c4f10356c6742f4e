# SPDX-License-Identifier: LGPL-2.1-or-later
"""For the checks of the scripts: an empty directory to work in, the program,
and how to run scripts."""
import atexit
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DEBOND = pathlib.Path(sys.argv[1]).resolve()
sys.path.insert(0, str(SOURCE / "scripts"))

from debond import runs  # noqa: E402

directory = tempfile.mkdtemp()
atexit.register(shutil.rmtree, directory)
os.chdir(directory)


def study(file, *options, code=0):
    """What scripts/study prints."""
    done = subprocess.run([SOURCE / "scripts" / "study", file, "--debond",
                           DEBOND, *options], capture_output=True, text=True)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return done.stdout + done.stderr


def table(folder):
    """Arrays of numbers and lists of words."""
    return {title: cells if cells.dtype.kind == "f" else cells.tolist() for title, cells
            in runs.read_csv(os.path.join(folder, "table.csv")).items()}


def near(a, b, tolerance):
    assert abs(a - b) <= tolerance * abs(b), (a, b)
