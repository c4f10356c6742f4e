# SPDX-License-Identifier: LGPL-2.1-or-later
"""The package debond: runs, what they return and what they throw, and matrices."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import numpy

from common import DEBOND, SOURCE, near

import debond

# Matplotlib takes a second to load, and not everyone has meshio.
assert not {"matplotlib", "meshio", "scipy"} & set(sys.modules)

os.environ.update(DEBOND=str(DEBOND), OMPI_ALLOW_RUN_AS_ROOT="1",
                  OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                  OMPI_MCA_rmaps_base_oversubscribe="1")
SCENE = SOURCE / "prm" / "benchmark-40x4.prm"
QUICK = {"Solver/Method": "automatic"}


def thrown(code, *arguments, **options):
    """The Error of a run, which has this exit code."""
    try:
        debond.run(*arguments, **options)
    except debond.Error as error:
        assert error.code == code, error.code
        return error
    raise AssertionError(f"no exit code {code}")


# Values are texts, numbers, truth values and lists of them, also of numpy.
found = debond.run(SCENE, {**QUICK, "Mesh/Cells": (20, 2), "Output/Matrices": True,
                           "Contact law/Bond stiffness": numpy.float64(69.5)})
assert found.code == 0 and "Written" in found.log
assert found.directory == pathlib.Path("output/benchmark-40x4").absolute()
scene = (found.directory / "parameters.prm").read_text()
assert "Cells" in scene and "20, 2" in scene and "69.5" in scene
profile = found.profile
assert len(profile["x"]) == found.summary["contact_nodes"] == 19
counts = found.summary["bond_states"]
assert (profile["state"] == "broken").sum() == counts["broken"] > 0
near(found.history["functional"][-1], found.summary["functional"], 1e-9)
assert found.load_path == found.load_path_arc == {}

# The displacement of the contact nodes is that of their profile.
assert found.points.shape == found.displacement.shape == (21 * 3 + 20 * 2, 2)
for x, u in zip(profile["x"], profile["u_nu"]):
    at = numpy.linalg.norm(found.points - (x, 0), axis=1).argmin()
    assert abs(-found.displacement[at, 1] - u) < 1e-6 * abs(profile["u_nu"]).max()

# J of the matrices at s is that of the program, S, g and c_0 are those of A and f.
for of_run, tolerance in (found, 1e-10), (debond.run(
        SOURCE / "prm" / "cookbook" / "double-cantilever.prm", {
            "Output/Matrices": True}), 1e-7):
    problem, profile = debond.matrices(of_run.directory), of_run.profile
    s = profile["u_nu"] - problem.bounds
    held = problem.weights * profile["bond_stiffness"] / 2 * numpy.minimum(
        -s, profile["bond_threshold"])**2
    near(s @ problem.S @ s / 2 - problem.g @ s + held.sum() + problem.c_0,
         of_run.summary["functional"], tolerance)
problem = debond.matrices(found.directory)
A, f, kept = problem.A.toarray(), problem.f, problem.contact
rest = numpy.setdiff1d(numpy.arange(len(f)), kept)
inner = numpy.linalg.solve(A[numpy.ix_(rest, rest)], numpy.column_stack(
    [A[numpy.ix_(rest, kept)], f[rest]]))
mixed = A[numpy.ix_(kept, rest)] @ inner
assert abs(A[numpy.ix_(kept, kept)] - mixed[:, :-1] - problem.S).max() < \
    1e-11 * problem.S.max()
assert abs(f[kept] - mixed[:, -1] - problem.g).max() < 1e-11 * abs(problem.g).max()
near(problem.c_0, -f[rest] @ inner[:, -1] / 2, 1e-11)
F = problem.frames.toarray()
assert abs(F.T @ F - numpy.eye(len(F))).max() < 1e-14
near(problem.weights.sum(), 0.4 - 0.02, 1e-12)  # the corners have the rest
assert not problem.bounds.any()
assert problem.modes.shape == (len(f), 3)

# Of a run without matrices there are none, and the results of the run before have
# lost their displacement.
again = debond.run(SCENE, QUICK)
try:
    debond.matrices(again.directory)
    raise AssertionError("There are no matrices.")
except debond.Error as error:
    assert "Output/Matrices" in str(error)
fresh = debond.Results(again.directory)
assert fresh.summary == again.summary
debond.run(SCENE, QUICK)
try:
    again.displacement
    raise AssertionError("This displacement is that of another run.")
except debond.Error as error:
    assert "another run" in str(error)

# Several ranks, in 3D; a load path with its arc.
solid = [debond.run(SOURCE / "prm" / "bar-3d.prm", QUICK, f"ranks-{n}", ranks=n)
         for n in (1, 2)]
assert len(solid[1].points) > len(solid[0].points) == 593
for one, two in zip(solid[0].points, solid[0].displacement):
    at = numpy.linalg.norm(solid[1].points - one, axis=1).argmin()
    assert abs(solid[1].displacement[at] - two).max() < 1e-6 * abs(two).max() + 1e-9
path = debond.run(SOURCE / "prm" / "cookbook" / "punch.prm", {
    "Load path/Displacement factors": "0:5:30", "Load path/Arc": True})
assert list(path.load_path["displacement_factor"]) == [0, 5, 10, 15, 20, 25, 30]
assert "unstable" in path.load_path_arc["status"]

# Files beside the scene are found from elsewhere.
os.mkdir("scenes")
shutil.copy(SOURCE / "prm" / "cookbook" / "ring.prm", "scenes/base.prm")
shutil.copy(SOURCE / "prm" / "cookbook" / "ring.msh", "scenes/ring.msh")
pathlib.Path("scenes/ring.prm").write_text("include base.prm\n")
near(debond.run("scenes/ring.prm").summary["functional"], debond.run(
    SOURCE / "prm" / "cookbook" / "ring.prm").summary["functional"], 1e-12)

# What is wrong is said with all messages; results that did not converge are kept.
error = thrown(2, SCENE, {"Mesh/Cels": 3, "Solver/Mehtod": "automatic"})
assert "Mesh/Cels" in str(error) and "Solver/Mehtod" in str(error)
assert not error.results
few = {"Solver/Euclidean bundle/Maximum iterations": 10}
error = thrown(3, SCENE, few, directory="few")
assert "NOT CONVERGED" in str(error), error
assert error.results.summary["status"] == "iteration limit"
kept = debond.run(SCENE, few, directory="few", check=False)
assert kept.code == 3 and kept.summary["status"] == "iteration limit"
assert "there is no such file" in str(thrown(2, "nothing.prm", check=False))
assert "Cells" in str(thrown(2, SCENE, {"Mesh/Cells": "0, 1"}, ranks=2))

# Numbers of numpy are numbers.
switched = debond.run(SCENE, {**QUICK, "Mesh/Cells": numpy.array([20., 2.]),
                              "Solver/Prove": numpy.True_, "Material/Young modulus":
                              numpy.array(69.)}, directory="switched")
assert switched.summary["cells"] == 160 and switched.summary["minimum"]["state"] == "global"

# After an interruption there is what the program had.
child = subprocess.Popen([sys.executable, "-c", f"""
import debond
debond.run({str(SCENE)!r}, {{"Mesh/Cells": (160, 16), "Solver/Method": "automatic",
                           "Load path/Factors": "0:0.001:3"}}, "cut")
"""], env={**os.environ, "PYTHONPATH": str(SOURCE / "scripts")}, stderr=subprocess.PIPE)
while not os.path.exists("cut"):
    assert child.poll() is None, child.stderr.read()
    time.sleep(0.05)
time.sleep(1.)
child.send_signal(signal.SIGINT)
assert b"KeyboardInterrupt" in child.communicate()[1]
assert debond.Results("cut").summary["status"] == "interrupted"

# The program of $DEBOND, of the source tree, and of PATH.
tree = pathlib.Path("tree").absolute()
shutil.copytree(SOURCE / "scripts" / "debond", tree / "scripts" / "debond")
os.makedirs(tree / "build")
os.mkdir("bin")
TELL = "import debond.runs; print(debond.runs.program())"


def program():
    done = subprocess.run([sys.executable, "-c", TELL], capture_output=True, text=True,
                          env={**os.environ, "PYTHONPATH": str(tree / "scripts"),
                               "PATH": str(pathlib.Path("bin").absolute())})
    return done.stdout.strip() or done.stderr


assert program() == str(DEBOND)
del os.environ["DEBOND"]
assert "scripts/build" in program()
for place in pathlib.Path("bin").absolute() / "debond", tree / "build" / "debond":
    place.symlink_to(DEBOND)
    assert program() == str(place), program()
