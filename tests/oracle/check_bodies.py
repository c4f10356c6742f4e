#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_bodies.py DEBOND SCENE: the benchmark's bar, 40x4, as a box, from Gmsh
files of two versions (quadrilaterals that are crossed, triangles that are used as
they are, some turned inside out, a coarser mesh that is refined, a mesh in mm),
from a generator, and with parts and regions that make no difference: J is the same
to 1e-12, and so are the contact nodes; also of a bar in 3D. What is wrong with a
mesh or a part is told with its place. The same scene twice gives the same files but for
times and memory, with other numbers of threads the same J, mirrored the mirrored answer.
Cuts along groups of faces are those by conditions and between regions.
"""

import json
import os
import pathlib
import random
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from run_scenes import Scenes, full_entry, read_table

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
shutil.copy(sys.argv[2], scenes.directory / "scene.prm")
MM = "Method=majorise minimise"


def bar(nx, ny, scale=1., crossed=False):
    return msh.box((nx, ny), (0.4 * scale, 0.04 * scale), crossed)


def check_same(cases, names=()):
    """The first of the cases is what the others are."""
    reference, *others = scenes.solve_all([[MM, *entries] for _, *entries in cases])
    for (name, *_), result in zip(cases[1:], others):
        close(name, result.get("functional"), reference["functional"], 1e-12)
        check(name + ", bonds", result.get("bond_states") == reference["bond_states"])
        # The reaction of a side is that of all of it, whatever it is divided into.
        if name in names:
            for side, force in reference["reactions"].items():
                for one, other in zip(force, result["reactions"][side], strict=True):
                    close(f"{name}, reaction {side}", other, one, 1e-9, 1.)
            check("sides", result["reactions"].keys() == {"left", "right"})


def write_mesh(name, *arguments, cut=None, **options):
    (scenes.directory / f"{name}.msh").write_text(msh.text(*arguments, **options)[:cut])


def file(name):
    return ["Source=file", f"File={name}.msh"]


def check_plane():
    meshes = {"quadrilaterals": bar(40, 4), "triangles": bar(40, 4, crossed=True),
              "coarse": bar(20, 2), "mm": bar(40, 4, 1000.)}
    for name, mesh in meshes.items():
        write_mesh(name, *mesh)
    odd = []
    for version in ("2.2", "4.1"):
        for name in ("quadrilaterals", "triangles"):
            odd_name = f"odd-{name}-{version}"
            write_mesh(odd_name, *meshes[name], version=version, is_odd=True)
            odd += [(odd_name, *file(odd_name), "Young modulus=1", "Young modulus all=69"),
                    (odd_name + ", a part of it", *file(odd_name), "Young modulus upper=69")]
    generator = ["Source=generator", "Generator=subdivided_hyper_rectangle",
                 "Clamped boundaries=0, 1", "Contact boundary=2", "Traction top=",
                 "Traction 3=0; if(x < 0.2, 0.69, -0.345)"]
    check_same([
        ("box",), ("quadrilaterals", *file("quadrilaterals")), ("triangles", *file("triangles")),
        ("refined", *file("coarse"), "Refinements=1"),
        ("scaled", *file("mm"), "Scale=0.001"), *odd,
        ("generator", *generator, "Arguments=40, 4 : 0, 0 : 0.4, 0.04 : true"),
        ("generator, refined", *generator, "Arguments=10, 1 : 0, 0 : 0.4, 0.04 : true",
         "Refinements=2"),
        # Pieces with names of their own that make no difference.
        ("a part that is the side", "Parts/glued=bottom: x > -1",
         "Contact boundary=glued"),
        ("tractions of parts that overlap", "Parts/left half=top: x < 0.2",
         "Traction top=0; -0.345", "Traction left half=0; 1.035"),
        ("a region of the same material", "Parts/upper=y > 0.02",
         "Young modulus upper=69"),
        ("regions that are all", "Parts/upper=y > 0.02", "Parts/lower=y <= 0.02",
         "Young modulus=1", "Young modulus upper=69",
         "Young modulus lower=69"),
        ("a part of a clamped side", "Parts/upper end=left: y > 0.02")],
        ["a part of a clamped side"])


def check_solid():
    odd = []
    for version in ("2.2", "4.1"):
        name = "odd-solid-" + version
        write_mesh(name, *msh.box((6, 2, 1), (0.4, 0.04, 0.05)), version=version, is_odd=True)
        odd.append((name, *file(name), "Young modulus upper=69"))
    solid = ["Dimension=3", "Traction top=0; if(x < 0.2, 0.69, -0.345); 0.1"]
    check_same([(name, *solid, *entries) for name, *entries in [
        ("box", "Lengths=0.4, 0.04, 0.05", "Cells=6, 2, 1"), *odd]])


SIDES_OF = {3: ((0, 1), (1, 2), (2, 0)), 4: ((0, 1), (1, 2), (2, 3), (3, 0)),
            8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6),
                (3, 0, 4, 7))}
GROUP = 20
HALF = "y = 0.02 && x < 0.2"


def names(dim, name="glue"):
    return {**{(dim - 1, k): side for k, side in enumerate(msh.SIDES[:2 * dim], 1)},
            (dim, 7): "all", **({(dim - 1, GROUP): name} if name else {})}


def grouped(mesh, is_in, order=None):
    """With the sides of cells whose centre is in the group, each once; in any order and
    turned either way if an order is given."""
    points, faces, cells = mesh
    cells = [((7,), corners) for _, corners in cells]
    known = {}
    for _, corners in cells:
        for side in SIDES_OF[len(corners)]:
            face = [corners[k] for k in side]
            if is_in([sum(points[v][d] for v in face) / len(face)
                      for d in range(len(points[0]))]):
                known.setdefault(frozenset(face), face)
    group = [((GROUP,), face) for face in known.values()]
    if order:
        order.shuffle(group)
        order.shuffle(cells)
        group = [(g, face[::order.choice((1, -1))]) for g, face in group]
    return points, faces + group, cells


def opened(mesh, y, end):
    """The group is an open crack: cells above it have nodes of their own."""
    points, faces, cells = mesh
    new = {v: len(points) + k for k, v in enumerate(
        v for v, p in enumerate(points) if abs(p[1] - y) < 1e-9 and p[0] < end - 1e-9)}
    # Files have the places of both nodes with some digits.
    points = points + [tuple(x * (1 + 1e-13) for x in points[v]) for v in new]

    def above(corners):
        upper = sum(points[v][1] for v in corners) > len(corners) * y
        return [new.get(v, v) if upper else v for v in corners]

    cells = [(g, above(corners)) for g, corners in cells]
    twins = [(g, [new.get(v, v) for v in corners]) for g, corners in faces if g == (GROUP,)]
    return points, [(g, corners if g == (GROUP,) else above(corners))
                    for g, corners in faces] + twins, cells


def on_half(centre):
    return abs(centre[1] - 0.02) < 1e-9 and centre[0] < 0.2


def check_groups():
    """Cuts along a group, with an end inside, are those by a condition."""
    plain = bar(40, 4)
    mixed = (*plain[:2], [(g, part) for k, (g, v) in enumerate(plain[2])
                          for part in ([v] if k % 3 else [v[:3], [v[0], v[2], v[3]]])])
    order = random.Random(2)
    base = ["Contact boundary=cut_1, bottom", "Traction top=0; 0.6"]
    groups = [("quadrilaterals", plain, []), ("triangles", bar(40, 4, crossed=True), []),
              ("coarse", bar(20, 2), ["Refinements=1"]), ("mixed", mixed, [])]
    for name, mesh, more in groups:
        cases = []
        write_mesh("whole-" + name, *grouped(mesh, lambda centre: False), names=names(2, None))
        write_mesh("group-" + name, *grouped(mesh, on_half), names=names(2))
        write_mesh("odd-" + name, *grouped(mesh, on_half, order), names=names(2, None))
        write_mesh("open-" + name, *opened(grouped(mesh, on_half), 0.02, 0.2), names=names(2))
        check_same([("a condition", *base, *file("whole-" + name), "Cuts=" + HALF, *more),
                    (name + ", a group", *base, *file("group-" + name), "Cuts=glue",
                     "Contact boundary=glue, bottom", *more),
                    (name + ", a number", *base, *file("odd-" + name), f"Cuts={GROUP}", *more),
                    (name + ", pressures that cancel", *base, *file("group-" + name), "Cuts=glue",
                     "Pressure cut_1=0.02", "Pressure glue_low=-0.02", "Pressure glue_high=-0.02",
                     *more)]
                   + [(name + ", open already", *base, *file("open-" + name), "Cuts=glue",
                       "Contact boundary=glue, bottom", *more)])


def check_solid_groups():
    solid = ["Dimension=3", "Traction top=0; 0.1; 0", "Contact boundary=cut_1, bottom",
             "Source=file"]
    for n, more in (((6, 2, 1), []), ((3, 2, 1), ["Refinements=1"])):
        mesh = msh.box(n, (0.4, 0.04, 0.05))
        end = 0.4 * (2 * n[0] // 3) / n[0]
        half = lambda c: abs(c[1] - 0.02) < 1e-9 and c[0] < end
        write_mesh("solid", *grouped(mesh, half), names=names(3))
        write_mesh("open-solid", *opened(grouped(mesh, half), 0.02, end), names=names(3))
        check_same([("a condition", *solid, "File=solid.msh", f"Cuts=y = 0.02 && x < {end}",
                     *more),
                    (f"solid {n}", *solid, "File=solid.msh", "Cuts=glue", *more),
                    (f"solid {n}, open already", *solid, "File=open-solid.msh", "Cuts=glue",
                     *more)])


def check_fibre():
    """The surface of a fibre is where it and the matrix meet; its high side is outside."""
    (scenes.directory / "fibre.geo").write_text("""SetFactory("OpenCASCADE");
        Rectangle(1) = {0, 0, 0, 4, 4};
        Disk(2) = {2, 2, 0, 1};
        BooleanFragments{ Surface{1}; Delete; }{ Surface{2}; Delete; }
        Mesh.MeshSizeMax = 0.4;
        Physical Surface("fibre") = {2};
        Physical Surface("matrix") = {3};
        Physical Curve("skin") = Boundary{ Surface{2}; };
        sides() = CombinedBoundary{ Surface{2, 3}; };
        Physical Curve("side") = {sides(0)};
        Physical Curve("all sides") = sides();
        """)
    base = ["Source=file", "File=fibre.geo", "Clamped boundaries=side", "Contact boundary=cut_1",
            "Traction top=", "Traction all sides=0.1; 0.2", "Young modulus=10",
            "Body force=0; -1"]
    results = [solve(MM, *base, "Cuts=" + cut) for cut in (
        "fibre | matrix", "skin", "matrix | fibre")]
    for result, sign in zip(results[1:], (1, -1)):
        close("a fibre", result["functional"], results[0]["functional"], 1e-12)
        for one, other in zip(result["contact_reaction"], results[0]["contact_reaction"],
                              strict=True):
            close("the force on it", one, sign * other, 1e-9, 1.)
    check("it is pulled", results[0]["contact_reaction"][1] < -1., results[0]["contact_reaction"])


# Seven sides of the cells of a cube of 3 x 3 x 3, by their centres.
TWISTED = [(1.5, 1.5, 1), (2, 1.5, 1.5), (1.5, 1.5, 2), (0.5, 1.5, 2), (1.5, 1, 0.5),
           (0.5, 1, 0.5), (0.5, 1, 1.5)]


def check_refused_groups():
    plain = bar(40, 4)
    branch = grouped(plain, lambda c: on_half(c) or abs(c[0] - 0.1) < 1e-9 and c[1] > 0.02)
    partly = grouped(plain, lambda c: on_half(c) or c[0] == 0. and c[1] > 0.02)
    side = grouped(plain, lambda c: c[0] == 0.)
    single = grouped(plain, lambda c: on_half(c) and 0.1 < c[0] < 0.11)
    band = grouped(msh.box((3, 3, 3), (3., 3., 3.)),
                   lambda c: min(sum(abs(x - y) for x, y in zip(c, centre))
                                 for centre in TWISTED) < 1e-9)
    for name, mesh, message in (
            ("branch", branch, "the group glue branches, and cannot be cut along as one, at "
                               "(0.1, 0.02)"),
            ("partly", partly, "leave out its faces there, as at (0, 0.0"),
            ("side", side, "only two of its faces at one place can be the sides of a cut, "
                           "unlike at (0, "),
            ("single", single, "glue has a single face"),
            ("band", band, "the group glue has one side only")):
        write_mesh(name, *mesh, names=names(len(mesh[0][0])))
        more = ["Dimension=3", "Traction top="] if name == "band" else []
        result = solve(*file(name), "Cuts=glue", "Contact boundary=glue", *more)
        check(message, result["exit_code"] == 2 and message in result["errors"]
              and "Mesh/Cuts" in result["errors"], result["errors"])
    result = solve(*file("branch"), "Cuts=glu")
    check("groups that there are", result["exit_code"] == 2
          and "nor a group of faces, as bottom, glue, left, right, top" in result["errors"],
          result["errors"])
    result = solve(*file("branch"), "Contact boundary=glue")
    check("how to cut there", "by Mesh/Cuts = glue" in result["errors"], result["errors"])
    for cuts, n in ([], 1), (["Cuts=glue", "Contact boundary=glue"], 0):
        result = solve(*file("group-quadrilaterals"), *cuts)
        check("notes on a group", len([note for note in result["notes"] if "glue" in note]) == n,
              result["notes"])
    for cuts, n in ([], 1), (["Cuts=glue", "Contact boundary=glue"], 0):
        result = solve(*file("open-quadrilaterals"), *cuts)
        check("notes on two nodes", n == len([note for note in result["notes"]
                                              if "at the same place" in note]), result["notes"])


def check_sides():
    """Of a mesh of two triangles each has two sides on the boundary: the force of a side is
    that of its own nodes, which no other support holds but at corners."""
    points, faces, _ = msh.box((1, 1), (1., 1.))
    place = {point: i for i, point in enumerate(points)}
    at = [place[0., 0.], place[1., 0.], place[1., 1.], place[0., 1.]]
    cells = [((7,), (at[0], at[1], at[3])), ((7,), (at[1], at[2], at[3]))]
    write_mesh("two", points, faces, cells)
    result = solve(MM, *file("two"), "Contact boundary=", "Clamped boundaries=left", "Traction top=",
                   "Displacement bottom=free; if(x > 0.5, 0.01, 0)", "Traction right=1; 2",
                   "Probes/grip=force left")
    for one, other in zip(result["probes"]["grip"], result["reactions"]["left"], strict=True):
        close("the force of a side", one, other, 1e-12, 1.)
    # A crack whose front comes to sides that move: a translation opens nothing.
    result = solve(MM, "Dimension=3", "Lengths=4, 2, 1", "Cells=8, 4, 2", "Cuts=y = 1 && x < 2",
                   "Clamped boundaries=", "Contact boundary=cut_1", "Traction top=",
                   *(f"Displacement {side}=free; 0.01; free" for side in ("front", "back", "right")),
                   "Displacement left=0; 0.01; 0", "Young modulus=100", "Bond stiffness=10")
    check("a translation takes no energy and opens nothing", abs(result["functional"]) < 1e-20
          and result["broken_zone"] == 0. and result["largest_opening"] < 1e-15, result["functional"])


def check_temperature():
    """Half of a change, as such and by a load path."""
    stresses = [solve(MM, "Traction top=", "Thermal expansion=1e-5", *entries)["largest_von_mises"]
                for entries in (["Temperature change=30"], ["Temperature change=60",
                                                            "Factors=0.5"])]
    close("stresses of half a change", *stresses, 1e-9)


def check_layers():
    """Pulled off from below: bonds and layers are springs in a row."""
    heights, width, pull = (0.07, 0.05, 0.08), 0.1, 3e-4
    for moduli in ((2., 5e8, 3.), (4e8, 2., 7e7), (3e10, 1., 2.), (1., 9e10, 4.)):
        softness = sum(h / E for h, E in zip(heights, moduli))
        result = solve(MM, f"Lengths={width}, 0.2", "Cells=5, 20",
                       "Parts/middle=y > 0.07 && y < 0.12", "Parts/upper=y > 0.12",
                       f"Young modulus={moduli[0]}", f"Young modulus middle={moduli[1]}",
                       f"Young modulus upper={moduli[2]}", "Poisson ratio=0", "Traction top=",
                       f"Traction bottom=0; {pull}", "Clamped boundaries=top",
                       "Roller boundaries=left, right", f"Bond stiffness={0.7 / softness!r}",
                       "Bond threshold=1")
        close(f"layers of {moduli}", result["functional"],
              -pull**2 * width * softness / (2. * (1. + 0.7)), 1e-12)


def check_thin_ply():
    """The estimate of a ply between two interfaces, wider than it is thick, is that of its mirror
    image: each side finds the one across, and none of the next interface."""
    load = "0; if(x < 0.2, 0.0069, -0.0069)"
    estimates = []
    for side, cuts, stiffness, bottom, top in (
            ("bottom", (0.02, 0.021), (6900, 69), "", load),
            ("top", (0.019, 0.02), (69, 6900), load.replace("if", "-if"), "")):
        estimates.append(solve(
            MM, "Cells=4, 40", f"Cuts=y = {cuts[0]}, y = {cuts[1]}", f"Traction top={top}",
            f"Traction bottom={bottom}", f"Clamped boundaries=left, {side}",
            "Contact boundary=cut_1, cut_2", f"Bond stiffness cut_1={stiffness[0]}",
            f"Bond stiffness cut_2={stiffness[1]}",
            "Tangential displacement=free")["estimated_error"])
    close("thin ply", *estimates, 1e-9)


def check_refused():
    """What is wrong with a file; errors.txt has what needs none."""
    write_mesh("cut", *bar(40, 4), cut=-500)
    for message, *entries in (
            ("none.msh cannot be read", *file("none")),
            ("Gmsh does not read this", "Source=file", "File=scene.prm"),
            ("cut.msh: Gmsh does not read this", *file("cut")),
            ("A mesh of triangles or tetrahedra is not refined", *file("triangles"),
             "Refinements=1"),
            ("the body has no boundary glued, but bottom, left, right, top", *file("mm"),
             "Contact boundary=glued"),
            ("the mesh has no tetrahedra or hexahedra", *file("mm"), "Dimension=3")):
        result = solve(*entries)
        check(message, result["exit_code"] == 2 and message in result["errors"], result["errors"])


def written(name, *settings):
    """The files of a run, with numbers of the summary that are not those of the machine."""
    folder = scenes.directory / "written"
    shutil.rmtree(folder, ignore_errors=True)
    scenes.run("scene.prm", *("--set=" + full_entry(entry) for entry in (
        "Output/Directory=written", "Output/Displacement=true", *settings)))
    files = {file.name: file.read_bytes() for file in folder.iterdir()}
    summary = json.loads(files.pop("summary.json"))
    for key in ("timings_s", "peak_memory_bytes", "memory_estimate_bytes"):
        check(f"{name} has {key}", summary.pop(key, None) is not None)
    return summary, files, read_table(folder / "contact_profile.csv")


def check_again(method, tolerance, distance):
    """The paper's method ends at a distance that its stop tolerance allows, the others are
    exact. Displacements are compared relative to M."""
    solver = "Method=" + method
    first, again, mirrored = (written(method, solver, *more) for more in (
        [], [], ["Traction top=0; if(x > 0.2, 0.69, -0.345)"]))
    check(method + ", the same files", first == again)
    close(method + ", mirrored", mirrored[0]["functional"], first[0]["functional"], tolerance)
    for row, other in zip(first[2], mirrored[2][::-1], strict=True):
        close(method + ", mirrored u_nu", other["u_nu"], row["u_nu"], distance, 0.002)
    if method == "euclidean bundle":
        return
    J = []
    for threads in "1", "2", "4":
        os.environ.update(dict.fromkeys(
            ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "DEAL_II_NUM_THREADS"), threads))
        # Large enough that the threads have something to do.
        J.append(solve(solver, "Cells=160, 16")["functional"])
        close(f"{method}, {threads} threads", J[-1], J[0], 1e-12)


check_again("majorise minimise", 1e-12, 1e-9)
check_again("energy bundle", 1e-12, 1e-9)
check_again("euclidean bundle", 1e-9, 1e-3)
# What was written can be run again from another folder.
(scenes.directory / "elsewhere").mkdir()
output = scenes.directory / "output"
scenes.run("scene.prm", f"--set=Output/Directory={output}", "--set=" + full_entry(MM))
shutil.copy(output / "parameters.prm", scenes.directory / "elsewhere")
again = scenes.run("elsewhere/parameters.prm")
check("the effective scene", again.returncode == 0, again.stderr)
scenes.all_of(globals())
