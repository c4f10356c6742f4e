# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of a run in 2D, of quadratic displacements, on two ranks and in 3D, of a load
path and a proof; what meshio reads of the files is what the run found."""
import json
import os
import subprocess

import meshio
import numpy

from common import DEBOND, SOURCE, near

from debond import picture, prm

QUADRATIC = ["benchmark-40x4.prm", "Solver/Method=automatic", "Mesh/Degree=2",
             "Contact law/Quadrature=gauss 4", "Probes/end=0.37, 0.04"]
RUNS = {
    "plane": ["benchmark-40x4.prm", "Solver/Method=automatic"],
    "quadratic": QUADRATIC,
    "ranks": QUADRATIC,
    "solid": ["bar-3d.prm", "Solver/Method=automatic"],
    "path": ["benchmark-40x4.prm", "Solver/Method=automatic",
             "Load path/Factors=0:0.25:1.25, 1:-0.25:0"],
    "proof": ["benchmark-40x4.prm", "Solver/Method=majorise minimise",
              "Contact law/Bond stiffness=1e5", "Contact law/Bond threshold=2e-4",
              "Solver/Prove=true"]}
PICTURES = {"path": ["load_path"], "proof": ["proof"]}
LAUNCH = {"ranks": ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2"]}
BODIES = {"ranks": ["ranks/body.rank0.vtu", "ranks/body.rank1.vtu"]}
# The kind of cells and the number of points: vertices, and of degree 2 middles of edges.
GRIDS = {"solid": ("tetra", 593), "quadratic": ("triangle6", 365 + 1004)}

for name, (scene, *settings) in RUNS.items():
    subprocess.run(LAUNCH.get(name, []) + [DEBOND, SOURCE / "prm" / scene] + [
        word for setting in [*settings, f"Output/Directory={name}"]
        for word in ("--set", setting)], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([SOURCE / "scripts" / "picture", name, "--units", "m, GPa"],
                   check=True, stdout=subprocess.DEVNULL)
    for drawn in ["body", "contact", *PICTURES.get(name, [])]:
        for ending in "png", "svg":
            assert os.path.getsize(f"{name}/{drawn}.{ending}") > 10000, drawn
    with open(name + "/summary.json") as file:
        summary = json.load(file)
    bodies = BODIES.get(name, [name + "/body.vtu"])
    for mesh in map(meshio.read, bodies):
        ((kind, cells),) = mesh.cells_dict.items()
        assert len(numpy.unique(mesh.points, axis=0)) == len(mesh.points)
        assert set(mesh.point_data) == {"displacement"}
        assert {len(field) for (field,) in mesh.cell_data.values()} == {len(cells)}
        assert len(bodies) == 2 or (
            kind, len(mesh.points)) == GRIDS.get(name, ("triangle", 365))
    grid = picture.Grid(bodies)
    assert len(grid.cells) == summary["cells"]
    u = grid.at_points("displacement")
    near(numpy.linalg.norm(u, axis=1).max(), summary["largest_displacement"],
         1e-5)
    near(grid.in_cells("von_mises").max(), summary["largest_von_mises"], 1e-5)
    if "end" in summary["probes"]:
        at = numpy.linalg.norm(grid.points[:, :2] - (0.37, 0.04), axis=1).argmin()
        assert abs(u[at, :2] - summary["probes"]["end"]).max() < 1e-6 * abs(u).max()
    faces, owners = grid.boundary()
    corners = grid.points[faces]
    if grid.dim == 2:
        size = numpy.linalg.norm(corners[:, 1] - corners[:, 0], axis=1).sum()
        near(size, 2 * (0.4 + 0.04), 1e-5)
    else:
        size = numpy.linalg.norm(numpy.cross(
            corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
            axis=1).sum() / 2
        near(size, 4 * 0.4 * 0.04 + 2 * 0.04**2, 1e-5)
    assert set(map(tuple, numpy.sort(faces))) <= {
        tuple(sorted(set(cell) - {corner})) for cell in
        grid.cells[owners].tolist() for corner in cell}

# A path by named columns, and a column that there is not.
picture.draw_path("path", ["contact_reaction_y over mean_top_y"])
try:
    picture.draw_path("path", ["force over factor"])
    raise AssertionError("There is no column force.")
except prm.BadInput as error:
    assert "contact_reaction_y" in str(error)

# The colours leave out few cells and say which.
_, axes = picture.plt.subplots()
cells = axes.add_collection(picture.PolyCollection(numpy.zeros((1000, 3, 2))))
picture.colour(axes, cells, numpy.append(numpy.linspace(0, 1, 999), 50.), "s")
bar = axes.figure.axes[-1].get_xlabel()
assert bar == "s; 5 cells above 0.996 cut off, the largest is 50", bar
