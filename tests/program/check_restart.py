#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_restart.py DEBOND PRM_DIRECTORY: a run that was killed, or that is to go further, goes on
to the results of a run in one piece, on another number of ranks too; starts from another run."""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

debond, prm = (str(pathlib.Path(argument).resolve()) for argument in sys.argv[1:])
os.chdir(tempfile.mkdtemp())
environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1")


def command(scene, directory, settings, ranks=1):
    start = [] if ranks == 1 else ["mpirun", "--oversubscribe", "-n", str(ranks)]
    return [*start, debond, f"{prm}/{scene}.prm", f"--set=Output/Directory={directory}",
            *(entry if entry.startswith("--") else "--set=" + entry for entry in settings)]


def run(*arguments, code=0):
    result = subprocess.run(command(*arguments), env=environment, capture_output=True, text=True,
                            stdin=subprocess.DEVNULL, check=False)
    if result.returncode != code:
        sys.exit(f"{arguments}: exit code {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout + result.stderr


def refused(words, *arguments):
    said = run(*arguments, code=2)
    if said.count(words) != 1:
        sys.exit(f"{arguments}: not {words!r} once: {said}")


def kill_after(line, *arguments):
    """Without a chance to write anything more."""
    with subprocess.Popen(command(*arguments), env=environment, stdout=subprocess.PIPE,
                          text=True) as process:
        for printed in process.stdout:
            if line in printed:
                break
        process.kill()
    if process.returncode != -9:
        sys.exit(f"{arguments} ended before {line!r}")


def rows(directory):
    with open(f"{directory}/load_path.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary(directory):
    return json.loads(pathlib.Path(directory, "summary.json").read_text(encoding="utf-8"))


def differ(first, second):
    """Words, or numbers such as those of places, to the rounding of different starts."""
    try:
        one, other = ([float(number) for number in text.replace(";", " ").split()]
                      for text in (first, second))
    except ValueError:
        return first != second
    return len(one) != len(other) or any(
        abs(a - b) > 1e-9 * max(abs(a), 1e-9) for a, b in zip(one, other))


def compare_paths(first, second):
    first, second = rows(first), rows(second)
    if len(first) != len(second):
        sys.exit(f"{len(first)} and {len(second)} steps")
    for one, other in zip(first, second):
        for column, value in one.items():
            # Residuals are rounding, and a method counts from its own start.
            if column not in ("law_violation", "equilibrium_residual", "force_imbalance",
                              "iterations") and differ(value, other[column]):
                sys.exit(f"step {one['step']}: {column} {value} and {other[column]}")


# Bonds that break for good are remembered, at nodes and between them. On the way back the broken
# ones do not return: the energy that they have taken stays.
factors = "Load path/Factors=0:0.1:2.5, 2.5:-0.25:0"
for quadrature in ("nodal", "gauss 2"):
    path = ("load-path-690", ["Load path/Bonds heal=false", factors,
                              f"Contact law/Quadrature={quadrature}", "Output/Load path body VTU=true"])
    run(path[0], "whole", path[1])
    if float(rows("whole")[-1]["dissipated_energy"]) <= 0.:
        sys.exit("nothing is broken at the end")
    kill_after(" 2.2 ", path[0], "killed", path[1])
    first_step = pathlib.Path("killed/load_path/body-00001.vtu").stat().st_mtime_ns
    run(path[0], "killed", [*path[1], "--restart"], 3)
    compare_paths("whole", "killed")
    if pathlib.Path("killed/load_path/body-00001.vtu").stat().st_mtime_ns != first_step:
        sys.exit("the run starts from the beginning")
    steps = pathlib.Path("killed/load_path_body.pvd").read_text(encoding="utf-8").count("<DataSet")
    if steps != len(rows("whole")):
        sys.exit(f"load_path_body.pvd has {steps} steps")
# A path that is whole goes on with more factors; multigrid has its own start.
multigrid = ["Solver/Linear solver=multigrid", "Load path/Bonds heal=false"]
run("load-path-690", "more", [*multigrid, "Load path/Factors=0:0.1:2.5"], 2)
run("load-path-690", "more", [*multigrid, factors, "--restart"])
run("load-path-690", "whole", [*multigrid, factors])
compare_paths("whole", "more")

# Refined meshes: the same ones, with the same J.
refined = ("benchmark-40x4", ["Solver/Method=automatic", "Accuracy/Target=5e-4"])
run(refined[0], "refined", refined[1])
kill_after(" mesh 2 ", refined[0], "killed-mesh", refined[1])
if " 640 triangles" in run(refined[0], "killed-mesh", [*refined[1], "--restart"], 2):
    sys.exit("the run starts on the first mesh")
for key in ("functional", "degrees_of_freedom", "contact_nodes"):
    one, other = (summary(directory).get(key) for directory in ("refined", "killed-mesh"))
    if one is None or differ(str(one), str(other)):
        sys.exit(f"refined: {key} {one} and {other}")
# A path on a refined mesh, stopped on the last one.
both = ["Accuracy/Target=2e-3", "Load path/Bonds heal=false",
        "Load path/Factors=0.5:0.5:2.5, 2:-0.5:0", "Output/Load path body VTU=true"]
run("load-path-690", "both", both)
# Each step has been computed once there, and its file is of that mesh.
last = summary("both")
if last["iterations"]["total"] != last["levels"][-1]["iterations"]:
    sys.exit(f"{last['iterations']} on a mesh with {last['levels'][-1]['iterations']}")
for k in range(1, len(rows("both")) + 1):
    file = pathlib.Path(f"both/load_path/body-{k:05}.vtu").read_text(encoding="latin-1")
    if f'NumberOfCells="{last["cells"]}"' not in file:
        sys.exit(f"the file of step {k} is of another mesh")
kill_after("        2.5 ", "load-path-690", "both-again", both)
if " 640 triangles" in run("load-path-690", "both-again", [*both, "--restart"], 2):
    sys.exit("the run starts on the first mesh")
compare_paths("both", "both-again")

# What was interrupted is the start.
slow = ["Solver/Euclidean bundle/Stop tolerance=1e-300"]
with subprocess.Popen(command("benchmark-40x4", "slow", slow), env=environment,
                      stdout=subprocess.PIPE, text=True) as process:
    for printed in process.stdout:
        if printed.startswith("        500 "):
            process.terminate()
before = summary("slow")["functional"]
run("benchmark-40x4", "slow", ["Solver/Euclidean bundle/Maximum iterations=1", *slow,
                               "--restart"], code=3)
if not summary("slow")["functional"] <= before:
    sys.exit(f"J rises from {before}")

# What does not fit is said, and what there is stays.
refused("Mesh/Cells was 40,4 and is 20,2", "load-path-690", "more",
        [*multigrid, "Mesh/Cells=20, 2", "--restart"])
refused("step 1 was with factor 0", "load-path-690", "more",
        [*multigrid, "Load path/Factors=1:1:3", "--restart"])
# A mesh file with as many vertices elsewhere is another one.
body = [f"Mesh/File={os.getcwd()}/ring.msh", "Load path/Factors=0.5, 1"]
ring = pathlib.Path(prm, "cookbook/ring.msh").read_text(encoding="utf-8")
pathlib.Path("ring.msh").write_text(ring, encoding="utf-8")
run("cookbook/ring", "ring", body)
pathlib.Path("ring.msh").write_text(ring.replace("13.125 0 0", "13.135 0 0"), encoding="utf-8")
refused("is of another mesh", "cookbook/ring", "ring", [*body, "--restart"])
# So is one that a file of the geometry has changed, on as many ranks as one likes; names of files
# and comments in them are not the mesh.
dimensions = pathlib.Path("dimensions.geo")
pathlib.Path("bar.geo").write_text("""Include "dimensions.geo"; // 1
Point(1) = {0, 0, 0, size}; Point(2) = {L, 0, 0, size};
Point(3) = {L, 0.2, 0, size}; Point(4) = {0, 0.2, 0, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("left") = {4}; Physical Curve("right") = {2};
Physical Curve("top") = {3}; Physical Surface("bar") = {1};
""", encoding="utf-8")
bar = ["Mesh/Source=file", f"Mesh/File={os.getcwd()}/bar.geo"]
dimensions.write_text("L = 1; size = 0.2;", encoding="utf-8")
run("load-path-690", "bar", [*bar, "Load path/Factors=1, 2"])
geometry = pathlib.Path("bar.geo").read_text(encoding="utf-8")
pathlib.Path("bar.geo").write_text(geometry.replace("// 1", "// 2"), encoding="utf-8")
run("load-path-690", "bar", [*bar, "Load path/Factors=1, 2, 3", "--restart"], 2)
dimensions.write_text("L = 1.2; size = 0.24;", encoding="utf-8")
for ranks in 1, 2:
    refused("is of another mesh", "load-path-690", "bar",
            [*bar, "Load path/Factors=1, 2, 3, 4", "--restart"], ranks)
# Half a file, and single bits of it.
state = pathlib.Path("more/restart.state")
whole = state.read_bytes()
places = [round(k * (len(whole) - 1) / 20) for k in range(21)]
for damaged in [whole[:5000], b"", *(
        whole[:k] + bytes([whole[k] ^ 1 << k % 8]) + whole[k + 1:] for k in places)]:
    state.write_bytes(damaged)
    refused("is not the state", "load-path-690", "more", [*multigrid, factors, "--restart"])
if "starts from the beginning" not in run("benchmark-40x4", "new",
                                          ["Solver/Method=automatic", "--restart"]):
    sys.exit("no word on a missing state")

# A run starts where another one ended, and not from what does not fit its scene. With a proximal
# weight that large no step is long enough to be taken.
bar = ["Mesh/Cells=10, 1", "Solver/Method=euclidean bundle",
       f"Solver/Euclidean bundle/Start={os.getcwd()}/bar/displacement.txt"]
run("benchmark-40x4", "bar", [*bar[:2], "Solver/Euclidean bundle/Proximal weight=0.05",
                              "Output/Displacement=true"])
run("benchmark-40x4", "again", [*bar, "Solver/Euclidean bundle/Proximal weight=1e9"])
end, again = summary("bar"), summary("again")
if again["iterations"]["total"] or any(end[key] != again[key]
                                       for key in ("functional", "law_violation")):
    sys.exit(f"the end is not the start: {end} {again}")
other = "is not the displacement of a scene with"
refused(other, "benchmark-40x4", "start", [*bar, "Mesh/Cells=11, 1"])
refused("does not satisfy the scene's boundary conditions", "benchmark-40x4", "start",
        [*bar, "Loads/Traction top=", "Boundary conditions/Clamped boundaries=left, right, top"])
pathlib.Path("bar/displacement.txt").write_text("0 0 x\n", encoding="utf-8")
refused(other, "benchmark-40x4", "start", bar)
pathlib.Path("bar/displacement.txt").unlink()
refused(other, "benchmark-40x4", "start", bar)
