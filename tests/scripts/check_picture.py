# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pictures of a run in 2D, of quadratic displacements, on two ranks and in 3D, of a load
path and its steps and a proof; what meshio reads of the files is what the run found. What
pictures of curved sides, several thresholds, two materials and glued sides in 3D show."""
import json
import os
import subprocess

import meshio
import numpy

from common import DEBOND, SOURCE, near

from debond import picture, prm, vtu

QUADRATIC = ["benchmark-40x4.prm", "Solver/Method=automatic", "Mesh/Degree=2",
             "Contact law/Quadrature=gauss 4", "Probes/end=0.37, 0.04"]
RUNS = {
    "plane": ["benchmark-40x4.prm", "Solver/Method=automatic"],
    "quadratic": QUADRATIC,
    "ranks": QUADRATIC,
    "solid": ["bar-3d.prm", "Solver/Method=automatic"],
    "path": ["benchmark-40x4.prm", "Solver/Method=automatic",
             "Load path/Factors=0:0.25:1.25, 1:-0.25:0",
             "Output/Load path body VTU=true"],
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
    grid = vtu.Body(bodies)
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



def refusal(directory, *options):
    done = subprocess.run([SOURCE / "scripts" / "picture", directory, *options],
                          capture_output=True, text=True)
    assert done.returncode == 2, (options, done)
    return done.stderr


# A path by named columns, and what cannot be drawn.
picture.draw_path([picture.Run("path", None, "")], ["contact_reaction_y over mean_top_y"])
for options, words in (
        (["--path", "contact_reaction over factor"], "but contact_reaction_"),
        (["--path", "status over factor"], "status of load_path.csv has no numbers"),
        (["--path", "J over factor", "--step", "2"], "not for a --step"),
        (["--step", "peak"], "no largest force"),
        (["--step", "99"], "no step 99, but 1 to"), (["--step", "0"], "no step 0, but 1 to"),
        (["--units", "mm"], "LENGTH, STRESS")):
    assert words in refusal("path", *options), refusal("path", *options)
assert "for load paths" in refusal("plane", "--path", "J over factor")
assert "no load path" in refusal("plane", "--step", "0")

# The colours leave out few cells and say which.
_, axes = picture.plt.subplots()
picture.colour([axes], numpy.append(numpy.linspace(0, 1, 999), 50.), "s")
bar = axes.figure.axes[-1].get_xlabel()
assert bar == "s\n0.5% cut off, the values are 0 to 50", bar
scale = picture.colour([axes], numpy.append(numpy.linspace(-9, 0, 999), 50.), "s")
assert (scale.norm.vmin, scale.norm(0), scale.norm.vmax) == (-9, 0.5, 50)

# What is rounding, or the same everywhere, has one colour; damage has all from 0 to 1.
for values, usual, words in (([1e-17, 3e-17], 1., ": 0 to rounding"), ([0., 0.], 0., ": 0 to rounding"),
                             ([2., 2. + 1e-7], 1., ": 2 everywhere")):
    scale = picture.colour([axes], numpy.array(values), "s", usual=usual)
    assert axes.figure.axes[-1].get_xlabel() == "s" + words and scale.cmap.N == 1
scale = picture.colour([axes], numpy.array([0., 0.2]), "damage", limits=(0., 1.))
assert (scale.norm.vmin, scale.norm.vmax) == (0., 1.)
for width, aspect, words in (10., 1., "y"), (120., 10., "y\nstretched x 10"):
    axes.set_ylabel("y")
    picture.stretch(axes, width, 1.)
    assert (axes.get_aspect(), axes.get_ylabel()) == (aspect, words)
near(numpy.linalg.det(picture.split(5)).sum(), 1., 1e-12)  # areas

# Words and units of columns: per thickness in 2D.
for text, dim, force, energy in (
        ("mm, MPa", 2, ", N/mm", ", N mm/mm"), ("mm, N/mm^2", 3, ", N", ", N mm"),
        ("m, GPa", 2, ", GN/m", ", GN m/m"), ("in, psi", 3, ", psi in²", ", psi in² in"),
        ("", 2, "", "")):
    units = picture.endings(text, dim == 2)
    assert (units["force"], units["energy"]) == (force, energy), units
units = picture.endings("mm, MPa", True)
for column, words in (("reaction_upper_end_y", "reaction of upper end, y, N/mm"),
                      ("mean_top_x", "mean displacement of top, x, mm"),
                      ("largest_gap", "largest opening, mm"), ("J", "J, N mm/mm"),
                      ("broken_zone", "size of the broken zone, mm"),
                      ("force_imbalance", "force imbalance")):
    assert picture.words_for(column, units) == words, picture.words_for(column, units)


def figures(scene, *settings, **options):
    """Of a run: the figures by their names, in place of files."""
    if scene:
        subprocess.run([DEBOND, SOURCE / "prm" / scene] + [
            word for setting in [*settings, "Output/Directory=run",
                                 "Solver/Method=automatic"]
            for word in ("--set", setting)], check=True, stdout=subprocess.DEVNULL)
    picture.plt.close("all")
    drawn = {}
    save, picture.plots.save = picture.plots.save, (
        lambda figure, directory, name: drawn.update({name: figure}))
    picture.draw(options.pop("directory", "run"), **options)
    picture.plots.save = save
    return drawn


def legend(figure):
    (words,) = [[text.get_text() for text in axes.get_legend().get_texts()]
                for axes in figure.axes if axes.get_legend()]
    return words


def read_contact(file="run/contact.vtu"):
    with open(os.path.dirname(file.replace("load_path/", "")) + "/summary.json") as summary:
        return vtu.Contact(file, json.load(summary))


def breaks(figure):
    """The thresholds that the contact picture shows."""
    return {round(float(-y), 6) for line in figure.axes[0].lines if line.get_label() == "bonds break"
            for y in line.get_ydata() if y < 0}


FREE = "Contact law/Tangential displacement=free"
# Where nodes are along curved sides, around corners and on several sides.
for scene, settings, name, pieces, length in (
        ("cookbook/ring.prm", [], "length along the contact boundary", 1, numpy.pi * 10),
        ("benchmark-40x4.prm", [FREE, "Boundary conditions/Contact boundary=bottom, right",
                                "Boundary conditions/Clamped boundaries=left"],
         "length along the contact boundary", 1, 0.44),
        ("benchmark-40x4.prm", [FREE, "Boundary conditions/Contact boundary=left, right",
                                "Boundary conditions/Clamped boundaries=bottom"],
         "y", 2, 0.04),
        ("benchmark-40x4.prm", [FREE, "Boundary conditions/Contact boundary=left, top",
                                "Boundary conditions/Clamped boundaries=bottom",
                                "Mesh/Rotation=30"],
         "length along the contact boundary", 1, 0.44),
        ("benchmark-40x4.prm", ["Boundary conditions/Contact boundary=bottom, top",
                                "Loads/Traction top="], "x", 2, 0.4)):
    drawn = figures(scene, *settings)
    found, along = read_contact().pieces()
    assert found == name and len(along) == pieces, (found, len(along))
    near(max(x[-1] for _, x in along), length, 1e-3)
    assert all((numpy.diff(x) >= 0).all() for _, x in along)
    nodes = read_contact().nodes
    for piece, x in along:  # from node to node
        steps = numpy.linalg.norm(numpy.diff(nodes[piece], axis=0), axis=1)
        assert abs(steps - numpy.diff(x)).max() < 1e-5
    assert drawn["contact"].axes[1].get_xlabel() == name

# Bonds break where there are bonds, at their thresholds.
BENCH = "benchmark-40x4.prm"
for settings, thresholds in (
        ([], {0.002}), (["Contact law/Law=none"], set()),
        (["Contact law/Bond stiffness=0"], set()),
        (["Contact law/Bond stiffness=if(x > 0.2, 69, 0)"], {0.002}),
        (["Contact law/Bond threshold=if(x > 0.2, 0.002, 0.004)"], {0.002, 0.004})):
    drawn = figures(BENCH, *settings)
    contact, profile = read_contact(), picture.read_csv("run/contact_profile.csv")
    states = {round(float(x), 4): state for x, state in zip(contact.nodes[:, 0],
                                                            contact.state)}
    assert states == {0: "held", 0.4: "held", **dict(zip(
        profile["x"].round(4).tolist(), profile["state"]))}, states
    assert breaks(drawn["contact"]) == thresholds, (settings, breaks(drawn["contact"]))
    assert ("bonds break" in legend(drawn["contact"])) == bool(thresholds)
ends = figures(BENCH, "Contact law/Bond stiffness=if(x > 0.2, 69, 0)")["contact"].axes[0]
(line,) = [line for line in ends.lines if line.get_label() == "bonds break"]
assert line.get_xdata()[numpy.isfinite(line.get_ydata())].min() > 0.2

# Of bonds that shear the slip in the direction of x, on the lower side and on the upper
# one, and in 3D its size.
BONDED = ["Contact law/Tangential displacement=bonded", "Solver/Search=none"]
for side, load in ("bottom", "top"), ("top", "bottom"):
    drawn = figures(BENCH, *BONDED, f"Boundary conditions/Contact boundary={side}",
                    "Loads/Traction top=", f"Loads/Traction {load}=0.01*y; 0.002")
    assert [axes.get_ylabel() for axes in drawn["contact"].axes] == [
        "normal displacement", "normal traction", "slip", "shear traction"]
    profile = picture.read_csv("run/contact_profile.csv")
    slips = dict(zip(profile["x"].round(4), profile["slip_x"]))
    dots = numpy.concatenate([dots.get_offsets() for dots
                              in drawn["contact"].axes[2].collections])
    assert min(slips.values()) < 0 < max(slips.values()) and len(dots) > len(slips)
    for x, slip in dots[numpy.isfinite(dots[:, 1])]:
        near(slip, slips[round(float(x), 4)], 1e-5)
drawn = figures("bar-3d.prm", *BONDED)
assert [axes.get_xlabel() for axes in drawn["contact"].axes[-2:]] == [
    "slip", "shear traction"], drawn["contact"].axes

# Without contact nodes, and without contact.vtu, only the body is drawn.
for setting in "Mesh/Cells=1, 1", "Output/Contact VTU=false":
    assert set(figures(BENCH, setting)) - {"history"} == {"body"}

# A state has its part of the boundary in the legend, also without a colour of its own.
del picture.STATES["bonded"]
words = {"at rest", "held", "bonded (15.4%)"}  # 6 of 39 nodes
assert words <= set(legend(figures(BENCH)["body"])), legend(figures("")["body"])


def cells(axes):
    return next(c for c in axes.collections if isinstance(c, picture.PolyCollection))


# Lines of cells where these are large; lines between materials.
for n, is_dark in (("40, 4", True), ("400, 40", False)):
    drawn = cells(figures(BENCH, "Mesh/Cells=" + n)["body"].axes[0])
    alpha = drawn.get_edgecolor()[:, 3]
    assert ((alpha > 0.3) & (alpha < 0.4)).any() == is_dark, alpha
two = ["Parts/upper=y > 0.02", "Material/Young modulus upper=7"]
drawn = cells(figures(BENCH, *two)["body"].axes[0])
body = vtu.Body(["run/body.vtu"])
lines = body.points[body.borders(body.cells, numpy.arange(len(body.cells)))]
assert lines.shape == (40, 2, 3) and numpy.allclose(lines[:, :, 1], 0.02)
black = (drawn.get_facecolor() == (0, 0, 0, 1)).all(axis=1).sum()
assert black == 40 + 2 * (40 + 4), black

# Stress is averaged over the cells around a node of the same material; not across
# the interface of bodies.
for name, settings in ("material", two), ("cut", ["Mesh/Cuts=y = 0.02", "Boundary conditions/Contact boundary=cut_1"]):
    figures(BENCH, *settings)
    body = vtu.Body(["run/body.vtu"])
    mean, own = (body.at_corners("stress_xx", averaged) for averaged in (True, False))
    assert (own == body.in_cells("stress_xx")[:, None]).all() and (own != mean).any()
    upper = body.points[body.cells].mean(axis=1)[:, 1] > 0.02
    at = numpy.isclose(body.points[body.cells], (0.2, 0.02, 0.)).all(axis=2)
    for side in upper, ~upper:
        shown = at & side[:, None]
        assert shown.sum() > 1 and numpy.ptp(mean[shown]) == 0, name
        near(mean[shown][0], own[shown].mean(), 1e-6)
    assert abs(mean[at & upper[:, None]][0] - mean[at & ~upper[:, None]][0]) > 1e-3
assert not picture.is_rounding(body.in_cells("von_mises"), body.usual_stress())
body.meshes[0].cell_data = {
    field: [numpy.float64(values[0]) * (1e-40 if "energy" in field else 1e-20)]
    for field, values in body.meshes[0].cell_data.items()}
assert picture.is_rounding(body.in_cells("von_mises"), body.usual_stress())

# In 3D: up is away from the glued side, which one of the views is of.
for side, normal in (("bottom", (0, -1, 0)), ("top", (0, 1, 0)), ("front", (0, 0, 1))):
    settings = [f"Boundary conditions/Contact boundary={side}", "Mesh/Cells=10, 2, 2",
                "Loads/Traction top=", "Parts/middle=x > 0.1 && x < 0.3",
                "Material/Young modulus middle=7"]
    drawn = figures("bar-3d.prm", *settings)["body"]
    body, contact = vtu.Body(["run/body.vtu"]), read_contact()
    above, below = picture.views(body, contact, None)
    for view in above, below:
        assert numpy.allclose(view @ view.T, numpy.eye(3))
        near(numpy.linalg.det(view), 1, 1e-12)
        assert view[1] @ normal < -0.5 and abs(view[0] @ normal) < 1e-12
    assert above[2] @ normal < 0 < below[2] @ normal
    colours = [set(map(tuple, cells(axes).get_facecolor())) for axes in drawn.axes[:2]]
    (blue,) = picture.colours_of(["contact"])
    assert blue in colours[1] and blue not in colours[0]
    assert (0, 0, 0, 1) in colours[0]  # between the materials
    one = figures("", view=(30., 40.))["body"]
    assert len(one.axes) == 2 and len(picture.views(body, contact, (30, 40))) == 1
box = [text.get_text() for text in drawn.axes[0].texts]
assert box == ["x: 0.4", "y: 0.04", "z: 0.04"], box

# A cut in 3D, in the only step of a path: the higher side is up, a closed interface is
# hidden, parts are those of load_path.csv, and there is a map of forces.
drawn = figures("bar-3d.prm", "Mesh/Cuts=y = 0.03", "Boundary conditions/Contact boundary=cut_1",
                "Mesh/Cells=20, 4, 2", "Mesh/Degree=2", "Contact law/Quadrature=gauss 4",
                "Load path/Factors=0.7", "Loads/Traction top=0; if(x < 0.2, 5, -5); 0")
(view,) = picture.views(vtu.Body(["run/body.vtu"]), read_contact(), None)
assert view[1, 1] > 0.5 and "load_path" in drawn
row = picture.read_csv("run/load_path.csv")
assert {"held", *(f"{state} ({row[state + '_part'][0]:.1%})" for state in (
    "contact", "broken"))} <= set(legend(drawn["contact"])), legend(drawn["contact"])
assert any("normal traction" in axes.get_xlabel() for axes in drawn["contact"].axes)
drawn["body"].canvas.draw()
pixels = numpy.asarray(drawn["body"].canvas.buffer_rgba())[:, :, :3] / 255.
blue, red = ((abs(pixels - one[:3]) < 0.01).all(axis=2).sum()
             for one in picture.colours_of(["contact", "broken"]))
assert blue < 300 < red, (blue, red)  # the legend has about 100

# The force over the displacement of the support that moves, of several runs with their
# names; of loads the largest reaction. Damage in 2D and in 3D, on a page.
drawn = figures("cookbook/softening-cantilever.prm", "Load path/Displacement factors=1, 3",
                "Mesh/Cells=80, 1", units="mm, MPa", field="damage")
(axes, bar), path = drawn["load_path"].axes, picture.read_csv("run/load_path.csv")
assert (axes.get_xlabel(), axes.get_ylabel()) == (
    "displacement of left, y, mm", "reaction of left, y, N/mm")
assert axes.lines[0].get_xdata().tolist() == [1., 3.] and axes.get_xlim()[0] <= 0 and (
    axes.lines[0].get_ydata() == path["reaction_left_y"]).all()
assert (axes.collections[0].get_array() == path["broken_part"] + path["softening_part"]).all()
damage = drawn["contact"].axes[2]
assert damage.get_ylabel() == "damage" and damage.get_ylim() == (-0.03, 1.03)
both = picture.draw_path([picture.Run("run", None, "")] * 2, [], ["a", "b"]).axes
assert legend(both[0].figure) == ["a", "b"] and len(both) == 1
picture.draw_together(["run", "path"], "two", "", ["J over factor"])
assert os.path.getsize("two.png") > 10000
assert picture.force_over_displacement(picture.read_csv("path/load_path.csv")) == [
    "reaction_left_y over mean_top_y"]
assert len(picture.draw_path([picture.Run("path", None, "")], ["all"]).axes) == 4
assert "for load paths" in refusal("plane", "--together", "two")
assert "there is no field none" in refusal("plane", "--field", "none")
drawn = figures("bar-3d.prm", field="damage")
titles = {axes.get_xlabel() for axes in drawn["contact"].axes}
assert "damage" in titles and drawn["contact"].get_figheight() < 12, titles

# A step of a load path: its states, its title, and what it needs.
path = picture.read_csv("path/load_path.csv")
step = int(path["broken_part"].argmax()) + 1
assert 1 < step < len(path["step"])
drawn = figures("", directory="path", step=step, units="m, GPa")
assert set(drawn) == {f"body-{step}", f"contact-{step}"}, set(drawn)
title = f"step {step} of {len(path['step'])}, load factor {path['factor'][step - 1]:.4g}"
assert drawn[f"body-{step}"].axes[0].get_title().startswith(title + "\ndisplacement x ")
contact = read_contact(f"path/load_path/contact-{step:05d}.vtu")
near((contact.state == "broken").sum() / (contact.state != "held").sum(),
     path["broken_part"][step - 1], 0.05)
for figure in drawn.values():
    broken = f"broken ({path['broken_part'][step - 1]:.1%})"
    assert broken in legend(figure), legend(figure)
os.remove(f"path/load_path/body-{step:05d}.vtu")
half = subprocess.run([SOURCE / "scripts" / "picture", "path", "--step", str(step)],
                      capture_output=True, text=True)
assert half.returncode == 0 and "Output/Load path body VTU = true" in half.stderr
assert half.stdout == f"path/contact-{step}.png\n", half.stdout

# A path that is unloaded ends with a picture of what has come off, which says the step,
# is enlarged as the loaded one, and has no openings by rounding.
drawn = figures(BENCH, "Load path/Factors=1, 0.01", "Load path/Bonds heal=false")
words = drawn["body"].axes[0].get_title()
assert words.startswith("step 2 of 2, load factor 0.01\ndisplacement x 2,"), words
picture.NEGLIGIBLE = 1.1
drawn = figures("")
for name in "body", "contact":
    assert {word.split(" (")[0] for word in legend(drawn[name])} <= {
        "at rest", "held", "contact", "bonded", "broken but closed"}, legend(drawn[name])
