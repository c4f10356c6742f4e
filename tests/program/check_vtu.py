#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_vtu.py DEBOND: the fields of the VTU files are where ParaView looks for them, and agree
with the other files. Quadratic displacements have quadratic cells, whose displacements in the
middles of edges on the contact boundary are what the coefficients in contact_profile.csv say."""
import json
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes, full_entry, read_table
from vtu import Piece

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
PLANE = ["Cells=10, 2", "Traction top=0.1; if(x < 0.2, 0.69, -0.345)"]
SOLID = ["Dimension=3", "Lengths=0.4, 0.04, 0.08",
         "Traction top=0.1; if(x < 0.2, 0.69, -0.345); 0.05"]
STATES = {"broken but closed": -1, "contact": 0, "bonded": 1, "kink": 2, "broken": 3, "free": 4,
          "held": 5}


def near(name, a, b, scale=1.):
    close(name, a, b, 1., 1e-5 * abs(b) + 1e-6 * abs(scale))


def solve(name, *settings):
    """The folder, and the contact nodes by their places."""
    scenes.section(name)
    run = scenes.run("scene.prm", *("--set=" + full_entry(entry) for entry in (
        *settings, "Output/Directory=" + name)))
    check("exit code", run.returncode == 0, run.stderr)
    rows = read_table(scenes.directory / name / "contact_profile.csv")
    return scenes.directory / name, run.stdout, {
        tuple(round(row.get(x, 0.), 6) for x in "xyz"): row for row in rows}


def vector(field, i):
    return field[3 * i:3 * i + 3]


def place(piece, i):
    return tuple(round(x, 6) for x in vector(piece.points, i))


def check_body(folder, summary, dim, n_cells, n_points):
    body = Piece(folder / "body.vtu")
    check("cells", body.n_cells == n_cells == summary["cells"], body.n_cells)
    check("points", body.n_points == n_points, body.n_points)
    u = body.at_points["displacement"]
    near("von Mises stress", max(body.in_cells["von_mises"]), summary["largest_von_mises"])
    near("displacement", max(math.hypot(*vector(u, i)) for i in range(n_points)),
         summary["largest_displacement"])
    check("fields of points", {*body.at_points} == {"displacement"})
    check("fields of cells", {"strain_energy_density", "error_density"} <= {*body.in_cells})
    if dim == 2:
        for xx, yy, xy, zz, mises in zip(*(body.in_cells[name] for name in (
                "stress_xx", "stress_yy", "stress_xy", "stress_zz", "von_mises"))):
            near("stress_zz", zz, 0.33 * (xx + yy), mises)
            near("von Mises", mises, math.sqrt(
                ((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2 + 3 * xy**2))


def check_contact(folder, profile, dim, n_faces):
    """Each share of a face has the values of the node that it belongs to."""
    contact = Piece(folder / "contact.vtu")
    at_points, corners, n_held = contact.at_points, 2 * (dim - 1), 0
    check("shares", contact.n_cells == dim * n_faces, contact.n_cells)
    check("fields", {*contact.in_cells} == {"bond_state"} and {*at_points} - {"broken_at"} == {
        "displacement", "tangential_force_density", "u_nu", "gap", "normal_force_density",
        "normal_traction", "law_violation", "bond_stiffness", "bond_threshold", "damage", "initial_gap"}, at_points)
    for cell, state in enumerate(contact.in_cells["bond_state"]):
        i = corners * cell  # the vertex that the share belongs to
        row = profile.get(place(contact, i), {"state": "held", "u_nu": 0.})
        density = at_points["normal_force_density"]
        check("state", state == STATES[row["state"]], (place(contact, i), row))
        near("u_nu", at_points["u_nu"][i], row["u_nu"], 1e-3)
        if "broken_at" in at_points and len(row) > 2:
            factor = at_points["broken_at"][i]
            check("broken at", row["broken_at"] in ("", factor) and math.isnan(factor) == (
                row["broken_at"] == ""), (factor, row))
        if len(row) > 2:
            near("force", density[i], row["normal_force_density"])
            # Bonds are at the nodes, whose forces are those of the law.
            near("traction", at_points["normal_traction"][i], row["normal_force_density"], 1.)
            check("force everywhere", not any(map(math.isnan, density[i:i + corners])))
        else:
            n_held += 1
            check("clamped", math.isnan(density[i]) and place(contact, i)[0] in (0, 0.4))
    check("some are held", n_held > 0)


def check_files(name, dim, n_cells, n_points, n_faces, *settings):
    folder, _, profile = solve(name, *settings)
    summary = json.loads((folder / "summary.json").read_text())
    check_body(folder, summary, dim, n_cells, n_points)
    check_contact(folder, profile, dim, n_faces)
    # The foundation's tangential forces, node by node, are its resultant.
    resultant = summary["tangential_reaction"]
    for x, force in zip("xyz", resultant):
        near("tangential force", sum(row["tangential_force_" + x] for row in profile.values()),
             force, 0.01)
    check("along x", abs(resultant[0]) > 1e-3)
    near("none across", resultant[1], 0., 0.01)


def check_quadratic(name, dim, cell_type, n_points, said, *settings):
    folder, log, profile = solve(name, *settings, "Degree=2")
    check("said", said in log, log)
    body, edges = Piece(folder / "body.vtu"), [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    n_corners, edges = dim + 1, edges[:3 * (dim - 1)]
    n_nodes = n_corners + len(edges)
    check("types", set(body.cells["types"]) == {cell_type})
    check("points", body.n_points == n_points and body.cells["offsets"][0] == n_nodes)
    u, found = body.at_points["displacement"], []
    for cell in range(body.n_cells):
        nodes = body.cells["connectivity"][n_nodes * cell:n_nodes * (cell + 1)]
        for middle, edge in zip(nodes[n_corners:], edges):
            ends = [nodes[k] for k in edge]
            check("middle", math.dist(vector(body.points, middle), [
                sum(x) / 2 for x in zip(*(vector(body.points, i) for i in ends))]) < 2e-7)
            if max(body.points[3 * i + 1] for i in ends) > 0 or place(body, middle) not in profile:
                continue
            value, *of_ends = (profile.get(place(body, i), {"u_nu": 0.})["u_nu"]
                               for i in (middle, *ends))
            found.append(sum(of_ends) / 4 + value / 2)
            # The normal points down.
            check("coefficients", abs(found[-1] + u[3 * middle + 1]) < 1e-8, found[-1])
    check("many", len(found) >= 10 and max(map(abs, found)) > 1e-4, found)


plane_strain = [*PLANE, "Hypothesis=plane strain"]
check_files("plane", 2, 80, 53, 10, *plane_strain)
# Fields of more than one block.
check_files("fine", 2, 40960, 20833, 320, *plane_strain, "Cells=320, 32")
check_files("solid", 3, 384, 144, 64, *SOLID, "Cells=8, 1, 2")
# Held vertices move with what they are given, and so do the edges beside them.
for degree in "1", "2":
    lifted, _, _ = solve("lifted" + degree, *PLANE, "Degree=" + degree, "Quadrature=gauss 4",
                         "Displacement factors=0, 2", "Clamped boundaries=left",
                         "Displacement right=0; 0.001")
    body, contact = Piece(lifted / "body.vtu"), Piece(lifted / "contact.vtu")
    heights = {place(body, i): body.at_points["displacement"][3 * i + 1]
               for i in range(body.n_points)}
    found = [(heights[place(contact, i)], -contact.at_points["u_nu"][i],
              contact.at_points["gap"][i], contact.at_points["displacement"][3 * i + 1])
             for i in range(contact.n_points) if place(contact, i) in heights]
    check("lifted end", abs(found[-1][0] - 0.002) < 1e-8 and len(found) >= 20, found[-1])
    check("as in the body", all(max(of) - min(of) < 1e-7 for of in found))
closed, _, profile = solve("closed", *PLANE, "Factors=9, 0", "Bonds heal=false",
                           "Output/Load path contact VTU=true")
check_contact(closed, profile, 2, 10)
states = [{*Piece(closed / "load_path" / f"contact-0000{step}.vtu").in_cells["bond_state"]}
          for step in (1, 2)]
check("broken, and closed again", 3 in states[0] and -1 not in states[0]
      and -1 in states[1] and not states[1] & {1, 3}, states)
_, _, sliding = solve("sliding", *PLANE, "Tangential displacement=free")
check("no tangential forces", not any(row["tangential_force_x"] for row in sliding.values()))
check_quadratic("quadratic plane", 2, 22, 185, "80 triangles, 0.4 x 0.04, quadratic displacements\n",
                *PLANE, "Quadrature=gauss 8")
check_quadratic("quadratic solid", 3, 24, 587, "quadratic displacements\n", *SOLID,
                "Cells=6, 1, 2", "Quadrature=gauss 4")
scenes.end()
