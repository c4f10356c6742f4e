#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_axis.py DEBOND [COUNT [FIRST]]: bodies of revolution and foundations with a direction,
beside finite elements of oracle.py, which share nothing with the program: random boxes and
frustums (S, g, J, law, displacements, forces, stresses, words, proofs), paths and arcs among all
stationary states, domes on a plane, bodies that are glued, refined meshes; and closed forms."""
import itertools
import pathlib
import shutil
import sys
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh
from oracle import LAW
from random_scenes import Draw, body_of, crossed_grid, revolved, tilted, vector
from run_scenes import NO_PICTURES, Scenes, scene_text
from vtu import Piece

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
AXIS = ["Symmetry=axis", "Clamped boundaries="]
ISOTROPIC = ["Young modulus=70", "Poisson ratio=0.3"]
DEGREE_2 = ["Degree=2", "Quadrature=gauss 3"]
MM = "Method=majorise minimise"


def grid(name, n, place):
    """Writes a crossed grid under a map of the unit square. Returns the entries for it, and it."""
    mesh = crossed_grid(n, place)
    (scenes.directory / (name + ".msh")).write_text(mesh.text)
    return ["Source=file", f"File={name}.msh"], mesh


# ------------------------------------------------------------------ random scenes


def read_matrix(file):
    """Of symmetric ones the lower half is there."""
    head, *lines = [line for line in file.read_text().splitlines() if not line.startswith("% ")]
    rows, columns = map(int, lines[0].split())
    values, matrix = list(map(float, lines[1:])), np.zeros((rows, columns))
    if "symmetric" not in head:
        return np.array(values).reshape(columns, rows).T
    matrix.T[np.triu_indices(rows)] = values
    return matrix + np.tril(matrix, -1).T


def run(numbers, all_settings):
    """Of scenes, summaries with S and g of the contact nodes, in one run."""
    names = [f"random-{number}.prm" for number in numbers]
    for name, settings in zip(names, all_settings):
        (scenes.directory / name).write_text(scene_text("scene.prm", [
            *NO_PICTURES, *settings, "Output/Matrices=true", "Output/Directory=out-" + name]))
    scenes.run(*names)
    for name in names:
        output, matrices = scenes.directory / ("out-" + name), {}
        if (output / "S.mtx").exists():
            matrices = {key: read_matrix(output / f"{key}.mtx") for key in ("S", "g")}
        yield {**scenes.summary(output.name), **matrices}


def state_of(body, result):
    """s from the profile in the order of the body's unknowns, and that order: of those that a
    corner may have, the one with the program's S."""
    size = np.abs(body.points).max()
    rows = [row for row in result["profile"] if row["state"] != "held"]
    choices = [[slot for slot in body.node_of
                if np.hypot(*(body.points[slot[0]] - [row["x"], row["y"]])) < 1e-9 * size]
               for row in rows]
    found = None, None, np.inf
    for slots in itertools.product(*choices):
        if len(set(slots)) == len(slots) == len(body.node_of):
            order = [body.node_of[slot] for slot in slots]
            off = np.abs(result["S"] - body.S[np.ix_(order, order)]).max(initial=0.)
            if off < found[2]:
                s = np.zeros(len(order))
                s[order] = [row["u_nu"] - body.gaps[v][k] for row, (v, k) in zip(rows, slots)]
                found = s, order, off
    return found[:2]


def forces_of(body, u):
    """Of all that holds the body on its nodes, on contact edges on the coefficients."""
    forces = (body.strain_forces(u) - body.applied).reshape(-1, 2)
    for v, ends in body.ends.items():
        forces[list(ends)] += forces[v] / 4
        forces[v] /= 2
    return forces


def largest_von_mises(body, u):
    """Of the mean stresses of cells."""
    (C, heat), largest = body.material(), 0.
    for cell in body.cells:
        stress = sum(weight * (C @ (B @ u.reshape(-1, 2)[cell].ravel()) - heat * body.value(
            body.entry("Loads/Temperature change"), p))
                     for weight, (B, _, p, _) in body.strains(cell))
        rest = stress[:3] - stress[:3].mean()
        largest = max(largest, np.sqrt(1.5 * (rest @ rest + 2 * stress[3]**2)))
    return largest


def mean(body, u, name):
    return sum(w * phi @ u.reshape(-1, 2)[face.nodes] for face in body.sides[name]
               for phi, w, _ in body.on(face)) / body.area(name)


def judge(settings, mesh, result, draw):
    """All that a run says beside the body."""
    body = body_of(settings, mesh)
    is_rough = "multigrid" in settings[-1] or "multigrid" in str(result["linear_solver"]) or (
        "bundle" in result["method"])
    loose = 1000. if is_rough else 1.
    s, order = state_of(body, result)
    check("contact nodes", s is not None, result["profile"])
    if s is None or not len(s) or np.abs(s).max() > np.abs(mesh.points).max():
        return
    own = body.S[np.ix_(order, order)]
    if not is_rough:
        close("S", np.abs(result["S"] - own).max(), 0., 1e-9, np.abs(own).max())
        close("g", np.abs(result["g"].ravel() - body.g[order]).max(), 0., 1e-9,
              np.abs(body.g).max() + np.abs(own).max() * np.abs(s).max())
    J, size, u = body.condensed_functional(s), body.size(s), body.displacement(s)
    forces, length = forces_of(body, u), np.abs(u).max()
    scale = np.abs(forces).max() + np.abs(body.applied).max()
    close("J", result["functional"], J, 1e-9 * loose, size)
    shift = 1e-10 * loose * np.abs(s).max() + 1e-12 * max(
        abs(gap) for gaps in body.gaps.values() for gap in gaps)
    force = body.g - body.S @ s
    violation = max(body.law_violation(s, force, shift, 0 * s), s.max() * np.abs(
        body.S).max()) / np.abs([body.g, force]).max()
    check("law", violation < 1e-8 * loose, violation)
    for name, faces in body.sides.items():
        if body.area(name):
            for x, y in zip(result["mean_displacements"][name], mean(body, u, name)):
                close("mean " + name, x, y, 1e-8 * loose, length)
        nodes = {v for face in faces for v in face.nodes}
        at_axis = int(min(body.points[v][0] for v in nodes) == 0.)
        for x, y in list(zip(result["probes"].get("force_" + name, []), sum(
                forces[v] for v in nodes)))[at_axis:]:
            close("force " + name, x, y, 1e-8 * loose, scale)
    close("stress", result["largest_von_mises"], largest_von_mises(body, u), 1e-6 * loose)
    close("applied force", result["applied_force"][1], body.applied[1::2].sum(), 1e-9, scale)
    close("reactions", result["clamped_reaction"][1] + result["contact_reaction"][1],
          forces[:, 1].sum(), 1e-8 * loose, scale)
    check("balance", result["force_imbalance"] < 1e-9 * loose, result["force_imbalance"])
    word = result["minimum"]["state"]
    for _ in range(20 * (word != "stationary")):
        d = np.array([draw.uniform(-1., 1.) for _ in s]) * np.abs(s).max() * 1e-6
        check(f"{word}: J rises", body.condensed_functional(np.minimum(s + d, 0.))
              >= J - 1e-11 * size)
    if body.of[LAW + "Law"] in ("winkler", "none"):
        least = min(map(body.condensed_functional, body.all_minima(draw)[0]), default=np.inf)
        check("above the least", word != "global" or J <= least + 1e-8 * size, (J, least))
        bound = (result.get("proof") or {}).get("lower_bound")
        check("lower bound", bound is None or bound <= least + 1e-10 * size, (bound, least))


def check_random(count=60, first=0):
    drawn = []
    for number in range(first, first + count):
        draw = Draw(number)
        scene = revolved(draw)
        if scene:
            settings, mesh = scene
            (scenes.directory / f"random-{number}.msh").write_text(mesh.text)
            drawn.append((number, draw, settings + [f"File=random-{number}.msh"], mesh))
    counts = {}
    for (number, draw, settings, mesh), result in zip(drawn, run(
            [d[0] for d in drawn], [d[2] for d in drawn])):
        scenes.section(f"Scene {number}")
        if result["status"] == "success":
            judge(settings, mesh, result, draw)
        counts[result["status"]] = counts.get(result["status"], 0) + 1
    scenes.section("Random scenes")
    check("most are solved", counts.get("success", 0) > .7 * count, counts)


# ------------------------------------------------------------------ paths


def stationary(body, factor, are_lasting, kinks):
    """J, s and the energy of broken bonds: of all choices of bonds that hold, are broken (for
    good: anywhere) or are at the threshold, and of nodes that touch."""
    body.set_loads(factor)
    n = len(body.contact_dofs)
    for kinds in itertools.product(("holds", "broken", "kink")[:2 + kinks], repeat=len(body.bonds)):
        Q, g, fixed = body.S.copy(), body.g.copy(), {}
        constant, broken = body.constant + body.condensed_constant, 0.
        for kind, b in zip(kinds, body.bonds):
            (k, _), M, row = b.branches[0], b.threshold, np.zeros(n)
            for i, phi in b.nodes:
                row[i] = phi
            if kind == "holds":
                Q += k * np.outer(row, row)
                g -= k * b.constant * row
                constant += k * b.constant**2 / 2
            else:
                broken += b.branches[-1][1]
            if kind == "kink" and row.any():
                fixed[int(np.argmax(row))] = -M - b.constant, k * M
        noise = 1e-7 * np.abs(g).max()
        for touching in itertools.product((False, True), repeat=n):
            if kinds.count("kink") > len(fixed) or any(touching[i] for i in fixed):
                continue
            rest, s = [i for i in range(n) if not touching[i] and i not in fixed], np.zeros(n)
            for i, (value, _) in fixed.items():
                s[i] = value
            if rest and np.linalg.matrix_rank(Q[np.ix_(rest, rest)]) < len(rest):
                continue
            s[rest] = np.linalg.solve(Q[np.ix_(rest, rest)], (g - Q @ s)[rest])
            force, near = g - Q @ s, 1e-7 * (np.abs(s).max() + max(b.threshold for b in body.bonds))
            if s.max() <= near and force[list(touching)].min(initial=0.) >= -noise and all(
                    -pull - noise <= force[i] <= noise for i, (_, pull) in fixed.items()) and all(
                        -b.trace(s) <= b.threshold + near if kind == "holds" else
                        are_lasting or -b.trace(s) >= b.threshold - near
                        for kind, b in zip(kinds, body.bonds)):
                yield constant + s @ Q @ s / 2 - g @ s + broken, s, broken


def check_path(number):
    """Its states, its global branch and its arc are among all that are stationary."""
    draw = Draw(number)
    inner, tilt = (draw.choice([0., draw.uniform(*ends)]) for ends in ((.3, 2.), (-.3, .3)))
    height = draw.uniform(.4, 1.5)
    entries, mesh = grid(f"path-{number}", (2, draw.between(1, 2)),
                         lambda x, y: (inner + x, height * y + tilt * x))
    is_nodal, is_lasting = draw.chance(.7), draw.chance(.3)
    settings = [*entries, *AXIS, "Young modulus=100", "Poisson ratio=0.3", MM,
                "Quadrature=" + ("nodal" if is_nodal else "gauss 1"),
                "Contact boundary=bottom",
                "Tangential displacement=" + draw.choice(["free", "fixed"]),
                f"Bond stiffness={draw.magnitude(.5, 2.)!r}",
                f"Bond threshold={draw.uniform(.001, .01)!r}",
                f"Initial gap={draw.choice([0., draw.uniform(0., .004)])!r}",
                "Traction top=" + vector(
                    draw.uniform(-.5, .5),
                    f"{draw.uniform(.1, .5)!r}*(1+{draw.uniform(-1., 1.)!r}*x)"),
                draw.choice(["Roller boundaries=right, top", "Clamped boundaries=right",
                                        f"Displacement top=0; {draw.uniform(.002, .02)!r}"])]
    if draw.chance(.4):
        settings.append("Foundation normal=" + vector(*tilted(draw, 40.)))
    path = ["Factors=" + ", ".join(repr(draw.uniform(-.3, 2.)) for _ in range(4)),
            "Bonds heal=" + str(not is_lasting).lower(), "Global branch=" + (
                "none" if is_lasting else "prove" if is_nodal else "search"),
            "Arc=" + str(is_nodal and not is_lasting).lower()]
    result, body = scenes.solve(*settings, *path), body_of(settings, mesh)
    check("arrives", result["status"] in ("success", "comes off"), result["errors"])
    for row in result["path"]:
        at = f"factor {row['factor']}"
        found = list(stationary(body, row["factor"], is_lasting, False))
        size = max(abs(J) for J, *_ in found) + body.size(0 * body.g)
        near = [s for J, s, broken in found if abs(J - row["J"]) < 1e-8 * size and (
            not is_lasting or abs(broken - row["dissipated_energy"]) < 1e-8 * size)]
        check(at, near, (row["J"], [J for J, *_ in found]))
        check(at + ": energies", any(
            abs(row["unit_load_work"] - body.unit_loads @ u) < 1e-6 * size
            and abs(row["elastic_energy"] - u @ body.strain_forces(u) / 2) < 1e-6 * size
            for u in map(body.displacement, near)), row)
        if not is_lasting:
            least = min(J for J, *_ in found)
            check(at + ": least", row["global_J"] >= least - 1e-8 * size and (
                row["global_minimum"] != "global" or row["global_J"] <= least + 1e-8 * size),
                  (row["global_J"], least))
    for row in result["arc"]:
        found = [J for J, *_ in stationary(body, row["factor"], False, True)]
        size = max(map(abs, found), default=0.) + body.size(0 * body.g) + 1e-9
        check(f"arc {row['factor']}", any(abs(J - row["J"]) < 1e-6 * size for J in found),
              (row["J"], found))


# ------------------------------------------------------------------ other bodies


def same_J(name, body, result, minima):
    """The J of a run is that of a minimum, or of a descent from rest."""
    values = [body.condensed_functional(s) for s in minima]
    check(name, result["status"] == "success" and values and min(
        abs(J - result["functional"]) for J in values) < 1e-9 * abs(values[0]),
          (result.get("functional"), values, result["errors"]))


def check_domes():
    """A sphere's polygon is pressed onto a plane, along the plane's normal."""
    for n, more in itertools.product(((4, 2), (8, 3)), (
            ["Law=none"], ["Law=none", *DEGREE_2],
            ["Bond stiffness=5", "Bond threshold=0.01"])):
        entries, mesh = grid(f"dome-{n[0]}", n, lambda x, y: (
            .7 * x, (1 - np.sqrt(1 - .49 * x * x)) * (1 - y) + .8 * y))
        settings = [*entries, *AXIS, *ISOTROPIC, *more, "Contact boundary=bottom",
                    "Foundation normal=0; -1", "Initial gap=y",
                    "Displacement top=free; -0.05", "Tangential displacement=free"]
        body = body_of(settings, mesh)
        same_J(f"{n}, {more}", body, scenes.solve(*settings), body.all_minima(Draw(1))[0])


def check_cuts():
    """A box of the program that is cut along y = 1."""
    points, faces, cells = msh.box((3, 4), (1.5, 2.), crossed=True)
    low = sorted((v for v, p in enumerate(points) if p[1] == 1.), key=lambda v: points[v][0])
    upper = {v: len(points) + k for k, v in enumerate(low)}
    triangles = [[upper.get(v, v) if sum(points[w][1] for w in cell) > 3. else v for v in cell]
                 for _, cell in cells]
    sides = {"cut_1": [(upper[a], upper[b]) for a, b in zip(low, low[1:])]}
    for (group,), face in faces:
        above = sum(points[v][1] for v in face) > 2.
        sides.setdefault(msh.SIDES[group - 1], []).append(
            [upper.get(v, v) if above else v for v in face])
    points += [points[v] for v in low]
    for more in ([], DEGREE_2, ["Tangential displacement=free"], ["Initial gap=0.002*x"],
                 ["Quadrature=gauss 2"]):
        settings = [*AXIS, *ISOTROPIC, "Lengths=1.5, 2", "Cells=3, 4", "Cuts=y = 1",
                    "Clamped boundaries=bottom", "Contact boundary=cut_1",
                    "Traction top=0.2; 0.5*(1+x)", "Bond stiffness=60",
                    "Bond threshold=0.05", MM, "Search=none", *more]
        body = body_of(settings, SimpleNamespace(points=points, simplices=triangles, sides=sides), [
            (up, v) for v, up in upper.items()])
        same_J(f"cut, {more}", body, scenes.solve(*settings), [body.descend([0] * len(body.bonds))])


def check_refined():
    """On the mesh that the program came to, whose vertices are numbers of single precision."""
    for more in ([], DEGREE_2):
        settings = [*AXIS, *ISOTROPIC, *more, "Lengths=2, 1", "Cells=4, 2",
                    "Contact boundary=bottom", "Roller boundaries=right", "Traction top=0; 0.1*x",
                    "Bond stiffness=30", "Bond threshold=0.02", "Accuracy/Maximum unknowns=500", MM]
        (scenes.directory / "refined.prm").write_text(
            scene_text("scene.prm", [*settings, "Output/Directory=refined"]))
        scenes.run("refined.prm")
        shutil.copy(scenes.directory / "refined/body.vtu", scenes.directory)
        result, piece = scenes.summary("refined"), Piece(scenes.directory / "body.vtu")
        n = piece.cells["offsets"][0]
        cells = [piece.cells["connectivity"][k:k + 3] for k in range(0, n * piece.n_cells, n)]
        number = {v: k for k, v in enumerate(sorted({v for cell in cells for v in cell}))}
        points = [piece.points[3 * v:3 * v + 2] for v in number]
        cells = [[number[v] for v in cell] for cell in cells]
        sides = {side: [(a, b) for cell in cells for a, b in zip(cell, cell[1:] + cell[:1])
                        if points[a][axis] == points[b][axis] == value]
                 for side, axis, value in (("right", 0, 2.), ("bottom", 1, 0.), ("top", 1, 1.))}
        check("levels", len(result["levels"]) > 1)
        body = body_of(settings, SimpleNamespace(points=points, simplices=cells, sides=sides))
        same_J("refined", body, result, [body.descend([0] * len(body.bonds))])


def check_directions():
    """The normals of the body given as directions change nothing; all is turned together."""
    plain = ["Lengths=2, 1", "Cells=6, 3", "Young modulus=100", "Contact boundary=bottom",
             "Clamped boundaries=left", "Bond stiffness=50", "Bond threshold=0.01"]
    plain_J, tilted_J = [], []
    for degrees, more in itertools.product((0, 30, -125), (
            [], DEGREE_2, ["Tangential displacement=free"],
            ["Tangential displacement=bonded"])):
        c, t = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))

        def turned(x, y, times=""):
            return vector(*(f"{float(z)!r}{times}" for z in (c * x - t * y, t * x + c * y)))
        scene = [*plain, *more, f"Rotation={degrees}", "Traction top=" + turned(.3, 1.)]
        J, *others = [scenes.solve(*scene, *normal)["functional"] for normal in (
            [], ["Foundation normal=" + turned(0, -7.)],
            ["Foundation normal bottom=" + turned(0, -1., "*(1 + x^2)")])]
        for other in others:
            close(f"{degrees}, {more}", other, J, 1e-12)
        if not more:
            plain_J.append(J)
            tilted_J.append(scenes.solve(*scene, "Foundation normal=" + turned(.6, -1.))[
                "functional"])
    for J in plain_J[1:] + tilted_J[1:]:
        close("turned", J, (plain_J if J in plain_J else tilted_J)[0], 1e-12)
    check("tilted", abs(tilted_J[0] / plain_J[0] - 1) > 1e-3, (tilted_J, plain_J))


# ------------------------------------------------------------------ closed forms


def check_tube():
    """That of Lame."""
    E, nu, p, a, b = 70., .3, 2., 1., 2.
    A = p * a * a / (b * b - a * a)
    exact = (1 + nu) / E * A * ((1 - 2 * nu) * a + b * b / a)
    for more, order, tolerance in (([], 3.3, 1e-3), (DEGREE_2, 12., 1e-6)):
        errors = []
        for n in (5, 10, 20):
            result = scenes.solve(
                *grid(f"tube-{n}", (n, n // 5), lambda x, y: (a + (b - a) * x, .4 * y))[0], *AXIS,
                *ISOTROPIC, *more, "Contact boundary=", f"Pressure left={p}",
                "Roller boundaries=bottom, top")
            errors.append(result["mean_displacements"]["left"][0] / exact - 1)
            check("balance", result["force_imbalance"] < 1e-10, result["force_imbalance"])
        check(f"{more}", abs(errors[-1]) < tolerance and all(
            x / y > order for x, y in zip(errors, errors[1:])), errors)


def check_cylinder():
    """Uniform states: tension and heat; a column on bonds, which hold up to their strength; a
    shaft that shrinks in a ring to which it is glued, or is pressed in."""
    E, nu, R, H, sigma, heat, k = 70., .3, 1.5, 2., 5., 3e-3, 100.
    area, stiff = np.pi * R * R, E / (1 + nu) / (1 - 2 * nu)
    entries = [*grid("cylinder", (4, 3), lambda x, y: (R * x, H * y))[0], *AXIS, *ISOTROPIC,
               "Thermal expansion=1e-3", f"Bond stiffness={k}"]
    ring = ["Contact boundary=right", "Roller boundaries=bottom, top", "Bond threshold=1"]
    for more in ([], DEGREE_2):
        result = scenes.solve(*entries, *more, "Contact boundary=", "Roller boundaries=bottom", f"Traction top=0; {sigma}",
                              "Temperature change=3")
        means = result["mean_displacements"]
        close("radius", means["right"][0], R * (heat - nu * sigma / E), 1e-12)
        close("length", means["top"][1], H * (sigma / E + heat), 1e-12)
        close("stress", result["largest_von_mises"], sigma, 1e-10)
        close("reaction", result["reactions"]["bottom"][1], -sigma * area, 1e-12)
        for M, status in ((sigma / k * 1.00001, "success"), (sigma / k * .99999, "comes off")):
            pulled = scenes.solve(*entries, *more, "Contact boundary=bottom",
                                  f"Force top=0; {sigma * area!r}", f"Bond threshold={M!r}",
                                  "Search=none", "Tangential displacement=free")
            check("strength", pulled["status"] == status, (M, pulled["status"]))
            if status == "success":
                close("column", pulled["functional"], -area * sigma**2 / 2 * (1 / k + H / E), 1e-12)
                close("pull", pulled["contact_reaction"][1], -sigma * area, 1e-11)
                check("opening", max(abs(row["u_nu"] * k / sigma + 1)
                                     for row in pulled["profile"]) < 1e-11)
        cold = scenes.solve(*entries, *more, *ring, "Temperature change=-3")
        close("shrinks", cold["mean_displacements"]["right"][0],
              -R * (1 + nu) * heat * stiff / (stiff + k * R), 1e-11)
        tight = scenes.solve(*entries, *more, *ring, "Initial gap=-0.01")
        close("press fit", tight["functional"], np.pi * H * stiff * .01**2, 1e-11)
        close("pressure", tight["profile"][1]["normal_force_density"], stiff * .01 / R, 1e-10)


def check_units():
    """The estimated error in other units of length."""
    for more in ([], DEGREE_2):
        errors = [scenes.solve(
            *AXIS, *ISOTROPIC, *more, f"Lengths={L}, {L}", "Cells=6, 6", "Clamped boundaries=bottom", "Contact boundary=", "Traction top=0; 1")[
                "estimated_error"] for L in (1., 1000.)]
        close(f"error of the mesh, {more}", errors[1], errors[0], 1e-6)


if __name__ == "__main__":
    check_random(*map(int, sys.argv[2:]))
    if len(sys.argv) > 2:
        scenes.end()
    scenes.all_of(globals(), *((f"path {number}", check_path, number) for number in range(12)))
