#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_ranks.py DEBOND PRM_DIRECTORY [RANKS...]: scenes with each feature answer the same on
several ranks as on one: exit code, word, bond states, J to 1e-10, the error of the mesh,
probes, reactions, notes, the displacement at each vertex in the order of one rank, and the
cells of the body once. Without RANKS each scene is run on one of 2, 3 and 4 ranks, else on all
that are given. Ranks end together: one message and one exit code for bad input, for
what one rank alone cannot do and for a signal to one of them; certificates are refused."""
import json, os, re, shutil, signal, subprocess, sys, tempfile, time
import xml.etree.ElementTree as xml
from collections import Counter

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import msh
from run_scenes import scene_text
from vtu import Piece

DEBOND, PRM = sys.argv[1:3]
RANKS = [int(n) for n in sys.argv[3:]]
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1",
                   OMPI_MCA_mpi_yield_when_idle="1", OMPI_MCA_btl_tcp_if_include="lo")
AUTOMATIC, MM = ["Solver/Method=automatic"], ["Solver/Method=majorise minimise"]
BAR = ["Dimension=3", "Mesh/Lengths=0.4, 0.04, 0.04", "Mesh/Cells=16, 4, 4",
       "Loads/Traction top=0; if(x < 0.2, 0.69, -0.345); 0"]
TRI = ["Mesh/Source=file", "Mesh/File=tri.msh"]
MG = MM + ["Solver/Linear solver=multigrid"]
SOFT = ["Contact law/Law=bilinear", "Contact law/Bond stiffness=690",
        "Contact law/Bond strength=0.138", "Contact law/Fracture energy=1e-4"]

JOINT = ["Mesh/Cells=40, 4", "Mesh/Cuts=y = 0.02", "Boundary conditions/Contact boundary=cut_1"]
HELD_BY_BONDS = ["Parts/low=left: y < 0.02", "Boundary conditions/Clamped boundaries=low",
                 "Loads/Traction top=0; if(x > 0.2, 0.05, 0.02)"]
PLIES = ["Material/Young moduli=69, 20, 20", "Material/Poisson ratios=0.3, 0.3, 0.3",
         "Material/Shear moduli=10, 10, 8", "Material/Axis angle=25"]
AXIS = ["Symmetry=axis", "Boundary conditions/Clamped boundaries=right",
        "Loads/Temperature change=100*x", "Material/Thermal expansion=1e-5"]

FAULT = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.4, 0.04};
Point(5) = {0.1, 0.015, 0};
Point(6) = {0.2, 0.025, 0};
Point(7) = {0.3, 0.02, 0};
Spline(5) = {5, 6, 7};
Line {5} In Surface {1};
Mesh.MeshSizeMax = 0.01;
Physical Surface("bar") = {1};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2};
Physical Curve("top") = {3};
Physical Curve("left") = {4};
Physical Curve("fault") = {5};
"""

STRIPS = """SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 0.4, 0.02};
Rectangle(2) = {0, 0.02, 0, 0.4, 0.02};
Physical Surface("lower") = {1};
Physical Surface("upper") = {2};
Physical Curve("bottom") = {1};
Physical Curve("right") = {2, 6};
Physical Curve("top") = {7};
Physical Curve("left") = {4, 8};
MeshSize{ PointsOf{ Surface{1}; } } = 0.013;
MeshSize{ PointsOf{ Surface{2}; } } = 0.01;
"""

# Of each a name, a scene and what differs in it.
SCENES = [
    ("plane", "benchmark-40x4", MM),
    ("joint", "benchmark-40x4", MM + JOINT),
    ("joint and foundation, degree 2, held by bonds", "benchmark-40x4",
     MM + JOINT + HELD_BY_BONDS + ["Mesh/Degree=2", "Contact law/Quadrature=gauss 4",
                                   "Boundary conditions/Contact boundary=cut_1, bottom"]),
    ("joint in 3D, by aggregates", "benchmark-40x4",
     MG + BAR + JOINT + ["Mesh/Cells=16, 4, 2", "Contact law/Tangential displacement=free"]),
    ("path of a joint that ends inside", "benchmark-40x4",
     MM + JOINT + SOFT + ["Mesh/Cuts=y = 0.02 && x < 0.3", "Load path/Factors=0.5, 1, 0.5",
                          "Load path/Bonds heal=false"]),
    ("joint along a group, refined", "benchmark-40x4",
     MM + ["Mesh/Source=file", "Mesh/File=fault.geo", "Mesh/Cuts=fault",
           "Boundary conditions/Contact boundary=bottom, fault",
           "Accuracy/Maximum unknowns=2000"]),
    ("joint of meshes that do not match, refined", "benchmark-40x4",
     MM + ["Mesh/Source=file", "Mesh/File=strips.geo", "Mesh/Interfaces=upper | lower",
           "Boundary conditions/Contact boundary=interface_1", "Loads/Traction top=0; 1e-4",
           "Contact law/Tangential displacement=bonded",
           "Contact law/Bond shear stiffness=0.4",
           "Accuracy/Maximum unknowns=2000"]),
    ("joint, refined", "benchmark-40x4",
     MM + JOINT + ["Mesh/Cells=10, 4", "Accuracy/Maximum unknowns=2000"]),
    ("axis by levels", "benchmark-40x4", MG + AXIS),
    ("direction, axis, degree 2, refined", "benchmark-40x4",
     MM + AXIS + ["Mesh/Cells=20, 4", "Mesh/Degree=2", "Contact law/Quadrature=gauss 4",
                  "Boundary conditions/Foundation normal=0.2; -1",
                  "Accuracy/Maximum unknowns=1500"]),
    ("orthotropic", "benchmark-40x4", MM + PLIES),
    ("orthotropic bar by levels", "benchmark-40x4", MG + BAR + PLIES),
    ("friction of a bar by levels", "benchmark-40x4",
     MG + BAR + ["Contact law/Friction bound=0.02"]),
    ("path with friction in 3D", "benchmark-40x4",
     MM + BAR + ["Contact law/Friction coefficient=0.3", "Load path/Factors=0.5, 1, 0.3",
                 "Load path/Bonds heal=false", "Load path/Global branch=none"]),
    ("proof", "benchmark-40x4", MM + ["Solver/Prove=true", "Solver/Search=full"]),
    ("energy bundle", "benchmark-40x4", ["Solver/Method=energy bundle"]),
    ("bar", "benchmark-40x4", MM + BAR),
    ("turned bar by levels", "benchmark-40x4",
     MG + BAR + ["Mesh/Cells=20, 4, 4", "Mesh/Rotation=30",
                     "Loads/Traction top=-0.1; 0.2; 0"]),
    ("plane by levels", "benchmark-160x16", MG + ["Mesh/Cells=80, 16"]),
    ("triangles of a file by aggregates", "benchmark-40x4", MG + TRI),
    ("degree 2", "benchmark-40x4",
     MM + ["Mesh/Degree=2", "Contact law/Quadrature=gauss 4"]),
    ("refined", "benchmark-40x4",
     MM + ["Mesh/Cells=10, 2", "Accuracy/Maximum unknowns=2000"]),
    ("refined, degree 2", "benchmark-40x4",
     MM + ["Mesh/Cells=10, 2", "Mesh/Degree=2", "Contact law/Quadrature=gauss 4",
           "Accuracy/Maximum unknowns=1500"]),
    ("path", "load-path-690", ["Load path/Factors=0:0.25:2.5, 2:-0.5:0"]),
    ("path by levels", "benchmark-40x4",
     MG + ["Load path/Factors=0.5, 1, 0.5, 0", "Load path/Bonds heal=false"]),
    ("proof by levels", "benchmark-40x4", MG + ["Solver/Prove=true"]),
    ("degree 2, gap, refined by aggregates", "benchmark-40x4",
     MG + ["Mesh/Cells=20, 4", "Mesh/Degree=2", "Contact law/Quadrature=gauss 4",
           "Accuracy/Maximum unknowns=3000", "Contact law/Initial gap=1e-4*x"]),
    ("ring", "cookbook/ring", []),
    ("ring, halved, by levels", "cookbook/ring",
     MG + ["Mesh/Refinements=2", "Solver/Search=none"]),
    ("parts and displacements", "cookbook/double-cantilever", []),
    ("two materials", "cookbook/bimaterial-strip", []),
    ("held by bonds", "cookbook/tape", []),
    ("comes off", "cookbook/tack", []),
    ("slender", "benchmark-40x4",
     AUTOMATIC + ["Mesh/Lengths=0.4, 0.002", "Mesh/Cells=200, 1"]),
    ("two sides", "benchmark-40x4", AUTOMATIC + [
        "Boundary conditions/Clamped boundaries=left", "Contact law/Tangential displacement=free",
        "Boundary conditions/Contact boundary=bottom, right"]),
    ("patches", "benchmark-40x4", AUTOMATIC + [
        "Mesh/Cells=13, 2", "Contact law/Bond stiffness=2000", "Contact law/Bond threshold=1e-3",
        "Loads/Traction top=0; if(x<0.1,1.1,if(x<0.2,-0.6,if(x<0.3,1.3,-0.5)))"]),
    ("stepped", "stepped", []),
    ("softening", "benchmark-40x4", MM + SOFT),
    ("softening path", "benchmark-40x4", MM + SOFT + [
        "Load path/Factors=0.3, 0.6, 1, 0.5", "Load path/Bonds heal=false"]),
    ("gap and probe", "benchmark-40x4",
     MM + ["Contact law/Initial gap=1e-4*(1 + x)", "Probes/end=0.37, 0.02"]),
    ("temperature", "benchmark-40x4",
     MM + ["Material/Thermal expansion=1e-5", "Loads/Temperature change=100*x"]),
    # A note speaks of the load on all faces.
    ("traction that jumps", "benchmark-40x4", MM + ["Loads/Traction top=0; if(x < 0.123, 0, 1)"]),
    # A note speaks of the body's size, of which each rank has a part.
    ("square", "benchmark-40x4", MM + [
        "Mesh/Lengths=1, 1", "Mesh/Cells=8, 8", "Contact law/Bond threshold=0.6",
        "Loads/Traction top=0; 0.01"]),
    ("lowest states of a path of displacements", "benchmark-40x4", MM + [
        "Loads/Traction top=", "Boundary conditions/Clamped boundaries=left",
        "Boundary conditions/Displacement right=free; 0.02",
        "Load path/Displacement factors=0.25:0.25:1", "Load path/Global branch=prove"]),
]


def launch(n, scenes, settings, directory, working_directory=None):
    if directory:
        settings = [*settings, "Output/Directory=" + directory]
    command = [DEBOND, *scenes, *("--set=" + setting for setting in settings)]
    if n > 1:
        command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(n)] + command
    return subprocess.Popen(command, env=ENVIRONMENT, cwd=working_directory, text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                            stderr=subprocess.PIPE)


def run(*arguments):
    process = launch(*arguments)
    out, errors = process.communicate()
    return process.returncode, out, errors


def fail(*words):
    print("FAILED:", *words)
    sys.exit(1)


def close(a, b, relative, size=0.):
    return abs(a - b) <= max(relative * max(abs(a), abs(b)), size)


def numbers(value):
    if isinstance(value, dict):
        return [x for key in sorted(value) for x in numbers(value[key])]
    if isinstance(value, list):
        return [x for entry in value for x in numbers(entry)]
    return [value] if isinstance(value, (int, float)) else []


def differences(one, several):
    """Between two folders of results."""
    a, b = (json.load(open(folder + "/summary.json")) for folder in (one, several))
    if one != several and b["degrees_of_freedom"] < 100000:
        said = [note for note in b["notes"] if f" ranks take longer than one for {b['degrees_of_freedom']} " in note]
        if len(said) != 1 or any(" ranks " in note for note in a["notes"]):
            yield "note", a["notes"], b["notes"]
        b["notes"] = [note for note in b["notes"] if note not in said]
    for key in ("status", "minimum", "bond_states", "cells", "contact_nodes", "notes"):
        if key == "minimum":
            a[key], b[key] = a[key].get("state"), b[key].get("state")
        if a[key] != b[key]:
            yield key, a[key], b[key]
    force = max(map(abs, numbers(a["reactions"]) + numbers(a["applied_force"])), default=0.)
    for key, relative, size in (("functional", 1e-10, 0.), ("estimated_error", 1e-5, 0.),
                                ("largest_von_mises", 1e-6, 0.),
                                ("probes", 1e-6, 1e-6 * (a["largest_displacement"] or 0.)),
                                ("reactions", 1e-6, 1e-6 * force)):
        for x, y in zip(numbers(a.get(key)), numbers(b.get(key))):
            if not close(x, y, relative, size):
                yield key, x, y
    if a["status"] != "success":
        return
    u, v = ([float(x) for x in open(folder + "/displacement.txt")] for folder in (one, several))
    size = 1e-6 * max(map(abs, u))
    if len(u) != len(v) or any(abs(x - y) > size for x, y in zip(u, v)):
        yield "displacement.txt", max(abs(x - y) for x, y in zip(u, v)), size


def cells(bodies, most_at_a_point):
    """Corners of the cells of several files, rounded, in some order."""
    result = []
    for body in bodies:
        n = body.cells["offsets"][0]
        nodes = body.cells["connectivity"]
        points = [tuple(round(x, 7) for x in body.points[3 * i:3 * i + 3])
                  for i in range(body.n_points)]
        if max(Counter(points).values()) > most_at_a_point:
            fail("points are there twice")
        result += [tuple(sorted(points[i] for i in nodes[n * k:n * (k + 1)]))
                   for k in range(body.n_cells)]
    return sorted(result)


def check_bodies(name, one, several, n):
    """body.pvtu declares what its parts have, which together are the body of one rank."""
    parts = [f"body.rank{k}.vtu" for k in range(n)]
    bodies = [Piece(f"{several}/{part}") for part in parts]
    whole = Piece(one + "/body.vtu")
    (joined,) = xml.parse(several + "/body.pvtu").getroot()
    if [piece.get("Source") for piece in joined.iter("Piece")] != parts:
        fail(name, "body.pvtu joins other files")
    for body in [whole, *bodies]:
        for kind, fields in (("PPointData", body.at_points), ("PCellData", body.in_cells)):
            if [array.get("Name") for array in joined.find(kind)] != list(fields):
                fail(name, "body.pvtu has other fields", *fields)
    n_bodies = 2 if "joint" in name else 1
    if cells(bodies, n_bodies) != cells([whole], n_bodies):
        fail(name, "on", n, "ranks: other cells")


def check_scenes(directory):
    """All that are for one number of ranks in one run."""
    prm = os.path.join(directory, "prm")
    shutil.copytree(PRM, prm)
    files = []
    for number, (_, scene, settings) in enumerate(SCENES):
        folder, base = os.path.split(scene)
        files.append(os.path.join(prm, folder, f"ranks-{number}.prm"))
        with open(files[-1], "w") as file:
            file.write(scene_text(base + ".prm", [
                s.replace("Mesh/File=", f"Mesh/File={directory}/") for s in settings] + [
                "Output/Displacement=true", "Output/Machine details=false",
                f"Output/Directory={number}"]))
    for n in 1, 2, 3, 4:
        folder = os.path.join(directory, f"on-{n}")
        os.mkdir(folder)
        numbers = [k for k in range(len(SCENES)) if n == 1 or n in (RANKS or [2 + k % 3])]
        code, out, errors = run(n, [files[k] for k in numbers], [], None, folder)
        if code != 0 or errors:
            fail("on", n, "ranks:", code, errors)
        for k, log in zip(numbers, re.split("^== ", out, flags=re.MULTILINE)[1:], strict=True):
            name, one, several = SCENES[k][0], f"{directory}/on-1/{k}", f"{folder}/{k}"
            if len(re.findall("^Result", log, re.MULTILINE)) != 1:
                fail(name, "on", n, "ranks prints", log)
            for difference in differences(one, several):
                fail(name, "on", n, "ranks:", *difference)
            if os.path.exists(several + "/body.pvtu"):
                check_bodies(name, one, several, n)


def check_start(directory):
    """A displacement of one number of ranks is the start of another one."""
    scene = os.path.join(PRM, "benchmark-40x4.prm")
    folder = os.path.join(directory, "start")
    if run(3, [scene], MM + ["Output/Displacement=true"], folder)[0] != 0:
        fail("no start")
    code, out, errors = run(
        2, [scene], ["Solver/Euclidean bundle/Start=" + folder + "/displacement.txt"],
        os.path.join(directory, "from"))
    iterations = int(re.search(r"^  iterations +(\d+)", out, re.MULTILINE).group(1))
    if code != 0 or iterations > 10:
        fail("from a start:", code, iterations, errors)
    # Pieces of more ranks do not remain beside the body of fewer.
    run(1, [scene], MM, folder)
    if [file for file in os.listdir(folder) if file.startswith("body") and file != "body.vtu"]:
        fail("pieces remain:", os.listdir(folder))
    print("start")


def check_ends(directory):
    """How ranks end together."""
    scene = os.path.join(PRM, "benchmark-40x4.prm")
    for settings, code, message in (
            (["Certificate/Kind=global"], 2, "Certificate/Kind: several ranks"),
            (["Mesh/Cells=0, 4"], 2, "Mesh/Cells"),
            (["Loads/Traction top=0; if(x > 0.39, log(-1), 0)"], 2, "Loads/Traction top"),
            (["Mesh/Cells=1, 1"], 2, "Mesh/Source: 4 cells cannot be shared by 5 ranks; start"),
            (["Boundary conditions/Clamped boundaries=left, right, bottom"], 2, "Boundary")):
        folder = os.path.join(directory, "refused")
        n = 5 if "shared" in message else 3
        found, out, errors = run(n, [scene], settings, folder)
        if found != code or errors.count(message) != 1 or os.path.exists(folder):
            fail(settings, "ends with", found, errors)
    # A folder that the first rank cannot make.
    blocked = os.path.join(directory, "blocked")
    open(blocked, "w").close()
    found, out, errors = run(2, [scene], MM, os.path.join(blocked, "results"))
    if found != 5 or errors.count("debond:") != 1:
        fail("a folder that cannot be made ends with", found, errors)
    # A signal to the last rank alone, or to mpirun, which kills ranks a second after it has told
    # them to end, and has an exit code of its own; before there is a result nothing is written.
    for number, to_launcher in ((signal.SIGINT, False), (signal.SIGTERM, False),
                                (signal.SIGTERM, True), (signal.SIGINT, True)):
        folder = os.path.join(directory, f"signalled-{int(number)}-{to_launcher}")
        for wait in (0.5, 5, 20):
            process = launch(2, [scene], MM + ["Load path/Factors=0:0.001:2"], folder)
            for k in range(600):
                time.sleep(0.1)
                ranks = subprocess.run(
                    ["pgrep", "-f", "--", "^" + re.escape(DEBOND) + " .*" + folder],
                    capture_output=True, text=True).stdout.split()
                if len(ranks) == 2 and os.path.exists(folder + "/parameters.prm"):
                    break
            time.sleep(wait)
            os.kill(process.pid if to_launcher else int(ranks[-1]), number)
            out, errors = process.communicate(timeout=60)
            if process.returncode != (1 if to_launcher else 4):
                fail("a signal ends with", process.returncode, errors)
            # On a busy machine they may be killed before they have written it.
            if os.path.exists(folder + "/summary.json"):
                break
        status = json.load(open(folder + "/summary.json"))["status"]
        if status != "interrupted" or not os.path.exists(folder + "/load_path.csv"):
            fail("a signal ends with the status", status, errors)
        if [file for file in os.listdir(folder) if file.endswith(".partial")]:
            fail("half-written files", os.listdir(folder))
    print("ends")


with tempfile.TemporaryDirectory() as directory:
    with open(directory + "/tri.msh", "w") as file:
        file.write(msh.triangles())
    with open(directory + "/fault.geo", "w") as file:
        file.write(FAULT)
    with open(directory + "/strips.geo", "w") as file:
        file.write(STRIPS)
    check_ends(directory)
    check_start(directory)
    check_scenes(directory)
