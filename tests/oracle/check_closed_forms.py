#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_closed_forms.py DEBOND: scenes whose answers are known. Supports, gaps, bonds that
vary and bodies that only bonds and the foundation hold: columns stretched, pressed, pulled
off and tilted, a block pressed through a gap, halves of symmetric bodies; a foundation that
is far away; total loads. In 2D and 3D and in several units."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes, sawteeth

# Dimension, name, length and modulus.
SYSTEMS = [(2, "GPa and m", 1., 1.), (3, "Pa and m", 1., 1e9), (2, "MPa and mm", 1e3, 1e3)]
scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
BENCHMARK = ["Traction top=0; if(x < 0.2, 0.69, -0.345)", "Method=automatic"]


def box(dim, lengths, cells, E, nu, rollers, *others):
    """A box on a foundation that nothing clamps and that may slide."""
    return [f"Dimension={dim}", "Lengths=" + ", ".join(map(repr, lengths[:dim])), f"Cells={cells}",
            f"Young modulus={E}", f"Poisson ratio={nu}", "Clamped boundaries=",
            "Roller boundaries=" + rollers + ", back" * (dim == 3), "Tangential displacement=free",
            *others]


def components(dim, *values):
    """Of a vector, the last one once more in 3D."""
    return "; ".join(map(str, values + values[-1:] * (dim - len(values))))


def check_stretched(dim, L, unit):
    """A column with planes of symmetry, stretched; then squeezed by so much that it widens
    by more than the gap above it and presses on the foundation."""
    lengths, E, nu, e = (2. * L, 0.5 * L, 0.3 * L), 70. * unit, 0.3, 1e-3
    depth = lengths[2] if dim == 3 else 1.
    area, H = lengths[1] * depth, lengths[1]
    cells = "6, 3" if dim == 2 else "4, 2, 1"

    def scene(strain):
        return box(dim, lengths, cells, E, nu, "left, bottom", "Contact boundary=top", "Law=none",
                   "Displacement right=" + components(dim, 2. * L * strain, "free"))

    for method in ("majorise minimise", "energy bundle", "euclidean bundle"):
        if method == "euclidean bundle" and (dim == 3 or unit != 1.):
            continue  # its weights are for the paper's units
        # Contact forces of rounding are no part of the reactions; the paper's method
        # ends before.
        tolerance = 1e-5 if method == "euclidean bundle" else 1e-10
        result = solve(*scene(e), "Method=" + method, "Verification/Tolerance=0.01",
                       "Solver/Euclidean bundle/Maximum iterations=20000")
        force = E * e * area
        close(method + ", J", result["functional"], 0.5 * force * e * 2. * L, 0.1 * tolerance)
        for side, k, expected in (("right", 0, force), ("left", 0, -force), ("bottom", 1, 0.)):
            close(f"{method}, reaction {side}", result["reactions"][side][k], expected,
                  tolerance, force)

    gap, modulus = 0.4 * nu * e * H, E / (1. - nu * nu)
    pressed = scene(-e) + [f"Initial gap={gap}", "Method=majorise minimise"]

    def stresses(strain):
        across = min(gap / H, -nu * strain)
        return modulus * (strain + nu * across), modulus * (across + nu * strain), across

    def J(strain):
        along, transversal, across = stresses(strain)
        return 0.5 * (along * strain + transversal * across) * 2. * L * area

    result, (along, transversal, _) = solve(*pressed), stresses(-e)
    close("through a gap, J", result["functional"], J(-e), 1e-11)
    close("reaction right", result["reactions"]["right"][0], along * area, 1e-10)
    close("force of the foundation", result["contact_reaction"][1],
          transversal * 2. * L * depth, 1e-10)
    path = solve(*pressed, "Factors=0.2, 1, 2", "Global branch=none")
    for row in path["path"]:
        close(f"through a gap at {row['factor']}", row["J"], J(-e * row["factor"]), 1e-10)


def check_column_on_bonds(dim, L, unit):
    """The top lifted by d: springs E/H and a in series, of which the second one is
    stretched by the gap already; and pulled by q at the side, which opens by H nu q/E."""
    lengths, E, nu = (2. * L, 0.5 * L, 0.3 * L), 70. * unit, 0.3
    H, depth = lengths[1], lengths[2] if dim == 3 else 1.
    a, M, area = 0.5 * E / H, 1e-3 * H, lengths[0] * depth
    cells = "6, 3" if dim == 2 else "4, 2, 1"

    def scene(lift, *others):
        return box(dim, lengths, cells, E, nu, "left", "Contact boundary=bottom",
                   f"Displacement top=free; {lift}" + "; free" * (dim == 3), f"Bond stiffness={a}",
                   f"Bond threshold={M}", *others)

    gap = 0.25 * M
    with_gap = [f"Initial gap={gap}", "Method=majorise minimise"]

    def bonded(lift):
        u = (E / H * lift - a * gap) / (a + E / H)
        return 0.5 * area * (E / H * (lift - u)**2 + a * (u + gap)**2), a * (u + gap) * area

    broken = 0.5 * a * M * M * area
    proved = ["Search=automatic", "Prove=true"]
    result, (J, force) = solve(*scene(0.5 * M), *with_gap, *proved), bonded(0.5 * M)
    close("J", result["functional"], J, 1e-11)
    close("reaction of the top", result["reactions"]["top"][1], force, 1e-10)
    close("force of the foundation", result["contact_reaction"][1], -force, 1e-10)
    # Where both states are minima the search knows which one is lower.
    torn = solve(*scene(1.1 * M), *with_gap, *proved)
    close("J of broken bonds", torn["functional"], broken, 1e-11)
    plain = solve(*scene(1.1 * M), *with_gap, "Search=none")
    close("J of a minimum above it", plain["functional"], bonded(1.1 * M)[0], 1e-11)
    check("which is not called global", plain["minimum"]["state"] == "local minimum"
          and plain["functional"] > 1.1 * broken)
    for one in (result, torn):
        check("the minimum is proved", one["minimum"]["state"] == "global")
    # Bonds break when they are stretched by M, and all at once.
    last = M - gap + a * M / (E / H)
    path = solve(*scene(1.), *with_gap, f"Factors={0.999 * last}, {1.001 * last}",
                 "Global branch=none")["path"]
    close("before bonds break", path[0]["J"], bonded(0.999 * last)[0], 1e-10)
    close("after they broke", path[1]["J"], broken, 1e-10)

    d, q = 1e-3 * H, 1e-3 * E
    place = ", ".join(map(repr, (lengths[0], H, depth)[:dim]))
    loaded = scene(d, "Traction right=" + components(dim, q, 0), f"Parts/half=bottom: x > {L}",
                   "Probes/tip=" + place, "Probes/wall=mean right", "Probes/all of it=mean half",
                   "Probes/glue=force bottom")

    def stress(lift, pull):
        return (lift + H * nu * pull / E) / (1. / a + H / E)

    def check_path(name, settings, loads, lifts, holds, dissipated=0.):
        path = solve(*loaded, *settings)
        check(name + ", all factors", [(row["factor"], row["displacement_factor"])
                                       for row in path["path"]] == list(zip(loads, lifts)))
        for row, is_bonded in zip(path["path"], holds):
            lift, pull = row["displacement_factor"] * d, row["factor"] * q
            sigma = stress(lift, pull) if is_bonded else 0.
            wall = lengths[0] * (pull - nu * sigma) / E
            strain_energy = 0.5 * (sigma**2 + pull**2 - 2. * nu * sigma * pull) / E * area * H
            for expected, scale, tolerance, columns in (
                    (sigma * area, E * area, 1e-13, ["reaction_top_y"]),
                    (-sigma * area, E * area, 1e-13, ["probe_glue_y", "contact_reaction_y"]),
                    (lift, d, 1e-11, ["mean_top_y", "probe_tip_y"]),
                    (wall, d, 1e-11, ["mean_right_x", "probe_wall_x", "probe_tip_x"]),
                    (lift - H * (sigma - nu * pull) / E, d, 1e-11,
                     ["mean_half_y", "probe_all_of_it_y"]),
                    (0. if is_bonded else area, area, 1e-11, ["broken_zone"]),
                    (strain_energy, E * d * d * area / H, 1e-11, ["elastic_energy"]),
                    (0. if is_bonded else dissipated * area, a * M * M * area, 1e-11,
                     ["dissipated_energy"])):
                for column in columns:
                    close(f"{name}, {column}", row[column], expected, tolerance, scale)
        return path

    # Bonds break at d = M (1 + a H/E) = 1.5 d without q; q opens by 0.3 d.
    equal = [0., 0.25, 0.5, 0.75, 1.]
    path = check_path("together", ["Factors=0:0.25:1"], equal, equal, [True] * 5)
    close("probe", path["probes"]["tip"][0], lengths[0] * (q - nu * stress(d, q)) / E, 1e-11)
    close("mean", path["mean_displacements"]["top"][1], d, 1e-11)
    loads, lifts = [0., 0., 1., 1., 0.5], [0., 1., 1., 0.5, 0.5]
    check_path("each its own", ["Factors=0, 0, 1, 1, 0.5",
                                "Displacement factors=0, 1, 1, 0.5, 0.5"], loads, lifts, [True] * 5)
    check_path("bonds heal", ["Displacement factors=0, 1, 2, 1, 0.5"],
               [1.] * 5, [0., 1., 2., 1., 0.5], [True, True, False, False, True])
    check_path("or not", ["Displacement factors=0, 1, 2, 1, 0.5, 0", "Bonds heal=false"], [1.] * 6,
               [0., 1., 2., 1., 0.5, 0.], [True] * 2 + [False] * 4, 0.5 * a * M * M)
    dead = solve(*loaded, "Factors=0, 0.5, 1", "Dead loads=right")
    for row in dead["path"]:
        close("dead load", row["reaction_top_y"], stress(row["factor"] * d, q) * area, 1e-11)


def check_half_of_symmetric_body():
    """The half on a roller is half of it, also turned."""
    for angle in (0., 30., -75.):
        c, s = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        load = f"if(abs(({c}*x+({s})*y)-0.2)<0.1000001, 0.69, -0.345)"
        common = [f"Rotation={angle}", f"Traction top={-s}*{load};{c}*{load}", "Method=automatic"]
        whole = solve(*common, "Cells=40, 4")
        half = solve(*common, "Cells=20, 4", "Lengths=0.2, 0.04", "Clamped boundaries=left",
                     "Roller boundaries=right")
        close(f"half, turned by {angle}", 2. * half["functional"], whole["functional"], 1e-9)


def check_bonds():
    """Given in several ways, and by place."""
    J = solve(*BENCHMARK)["functional"]
    for bonds in (["Bond stiffness=69+0*x"], ["Bond threshold=2e-3*(1+0*y)"],
                  ["Bond stiffness=69+0*x", "Bond threshold=2e-3*(1+0*y)"],
                  ["Bond strength=0.138", "Fracture energy=1.38e-4"],
                  ["Bond strength=0.138+0*x", "Fracture energy=1.38e-4"],
                  ["Bond stiffness=69", "Bond strength=0.138"],
                  ["Bond threshold=0.002", "Bond strength=0.138"],
                  ["Bond stiffness=69", "Fracture energy=1.38e-4"],
                  ["Bond threshold=0.002", "Fracture energy=1.38e-4"],
                  ["Law=curve", "Curve=" + sawteeth([69.], [0.002])]):
        result = solve(*BENCHMARK, *bonds)
        close(", ".join(bonds), result["functional"], J, 1e-12)
    none = solve(*BENCHMARK, "Law=none")["functional"]
    close("no bonds by expression",
          solve(*BENCHMARK, "Bond stiffness=0*x")["functional"], none, 1e-12)
    crack = solve(*BENCHMARK, "Bond stiffness=if(x < 0.25, 0, 69)", "Prove=true")
    check("a crack lies between", none < crack["functional"] < J)
    check("and is proved", crack["minimum"]["state"] == "global")
    check("what is not bonded is free",
          crack["bond_states"]["free"] + crack["bond_states"]["contact"] >= 24)

    # A crack is no part of the contact boundary and does not close; its end is between
    # faces, and so are the points of the rules.
    stepped = ["Law=curve", "Curve=" + sawteeth([210., 40.], [0.001, 0.004]), "Cells=16, 2",
               "Traction top=0; 0.35", "Tangential displacement=free"]
    for rule in ("midpoint", "gauss 3"):
        one = solve(*stepped, "Quadrature=" + rule, "Traction factor=if(x < 0.15, 0, 1)")
        other = solve(*stepped, "Quadrature=" + rule, "Parts/glued=bottom: x > 0.15",
                      "Contact boundary=glued")
        close(f"{rule}, a crack beside a boundary without contact", one["functional"],
              other["functional"], 1e-9)
    # A body that hardly deforms, moved off by d: J is the integral of the factor, whose
    # mean is 1, times j_1.
    for d in (0.0008, 0.002, 0.005):
        energy = 75. * min(d, 0.001)**2 + 25. * min(d, 0.003)**2
        result = solve("Cells=8, 1", "Young modulus=1e7", "Clamped boundaries=",
                       f"Displacement top=0; {d}", "Law=curve", "Curve=" + sawteeth([200., 50.],
                                                                                    [0.001, 0.003]),
                       "Traction factor=5*x")
        close("the integral of a law of steps", result["functional"], 0.4 * energy, 1e-5)


def check_hard_laws():
    """Soft, stiff, tough and brittle bonds; the same steps in all units; a pad with five
    patches, whose minimum branch and bound proves with 54,543 nodes: moves have to be tried
    again from what a proof with few nodes finds."""
    methods = ["Method=majorise minimise", "Method=energy bundle"]
    for a, M in ((69, 0.002), (6.9, 0.002), (690, 0.002), (6900, 0.002), (1e5, 2e-4),
                 (69, 2e-4), (69, 0.01)):
        for method in methods:
            result = solve(*BENCHMARK, method, f"Bond stiffness={a}", f"Bond threshold={M}")
            check(f"a = {a}, M = {M}, {method}", result["status"] == "success"
                  and result["iterations"]["total"] <= 40 and result["law_violation"] <= 1e-9)
    pa = ["Young modulus=69e9", "Bond stiffness=69e9",
          "Traction top=0; if(x < 0.2, 0.69e9, -0.345e9)"]
    mm = ["Lengths=400, 40", "Young modulus=69e3", "Bond stiffness=69",
          "Bond threshold=2", "Traction top=0; if(x < 200, 690, -345)"]
    for method in methods:
        steps = [[row["functional"] for row in solve(*BENCHMARK, method, *units)["history"]]
                 for units in ([], pa, mm)]
        check("as many steps in all units", len(set(map(len, steps))) == 1)
        for one, *others in zip(*steps):
            for other in others:
                close("J of a step", other, 1e9 * one, 1e-10)
    patches = solve("Young modulus=1", "Poisson ratio=0.0958529", "Clamped boundaries=top",
                    "Cells=124, 1", "Lengths=1.7075, 0.111103",
                    "Traction bottom=0; 0.950284*sin(6.283*4.56869*x/1.7075+5.64752)+0.347743",
                    "Bond threshold=0.00697278", "Method=automatic", "Bond stiffness=1372.05",
                    "Search=full")
    close("five patches", patches["functional"], -4.56234928075e-3, 1e-9)


def check_corner(dim):
    """At corners and edges of several sides the foundation alone holds the body."""
    depth = ", 1" * (dim == 3)
    result = solve(f"Dimension={dim}", "Lengths=2, 1" + depth, "Cells=2, 1" + depth,
                   "Young modulus=1", "Clamped boundaries=left", "Contact boundary=bottom, right"
                   + ", back" * (dim == 3), "Bond stiffness=1", "Bond threshold=1",
                   "Traction top=0; 0.01" + "; 0" * (dim == 3))
    for k in range(dim):
        left, foundation = result["reactions"]["left"][k], result["contact_reaction"][k]
        close("force of supports", result["clamped_reaction"][k], left, 1e-14, 0.02)
        close("force of the foundation", foundation + left, -result["applied_force"][k], 1e-14,
              0.02)


def check_resultants():
    """Total forces, pressures and tractions of a bar of 0.4 x 0.04."""
    for loads, expected in (
            (["Force top=0.3; -0.7"], (0.3, -0.7)), (["Force patch=0.3; -0.7"], (0.3, -0.7)),
            (["Pressure top=2"], (0., -0.8)), (["Pressure right=y"], (-0.0008, 0.)),
            (["Pressure top=2", "Force top=0.3; -0.7", "Traction top=1; 1"],
             (0.7, -0.7 + 0.4 - 0.8))):
        result = solve("Cells=20, 4", "Parts/patch=top: x > 0.1 && x < 0.3",
                       "Clamped boundaries=left", *loads)
        for value, component in zip(result["applied_force"], expected):
            close(", ".join(loads), value, component, 1e-14, 1.)


def check_loads():
    """Loads that are no polynomials, and what is said of those that jump inside of a face; the
    bar without contact, by an independent code."""
    bar = ["Cells=40, 4", "Clamped boundaries=left"]
    solid = ["Dimension=3", "Lengths=0.4, 0.04, 0.04", "Cells=7, 1, 3", "Clamped boundaries=left"]
    # A jump misses an eighth of a face times what one of four points may miss.
    for name, k, expected, tolerance, words, *scene in (
            ("a wave", 1, (1. - math.cos(12.)) / 30., 1e-12, (), *bar,
             "Traction top=0; sin(30*x)"),
            ("a jump at the side's own y", 1, 0.8, 1e-12, (), *bar,
             "Traction top=0; if(y < 0.04, 1, 2)"),
            ("a jump inside of a face", 1, 6.9e8 * 0.12345, 0.005 / 8. / 0.12345,
             ("(0.125, 0.04)",), *bar, "Traction top=0; if(x < 0.12345, 6.9e8, 0)"),
            ("a pole", 1, None, 0., ("(0.205, 0.04)",), *bar,
             "Traction top=0; 0.001/(x - 0.2033)^2"),
            ("a body force that jumps", 0, (1e6 + 1.) * 0.2 * 0.04, 1e-12, (), *bar,
             "Body force=if(x < 0.2, 1e6, 1); 0"),
            ("a polynomial in 3D", 1, (0.4 * 0.04)**3 / 9., 1e-12, (), *solid,
             "Traction top=0; x^2*z^2; 0"),
            ("a jump across faces", 1, 0.04 * (0.2 - 0.7 * 0.02), 0.01, ("not smooth",), *solid,
             "Traction top=0; if(x + 0.7*z < 0.2, 1, 0); 0")):
        result = solve(*scene, "Law=none", "Initial gap=1e12", "Verification/Tolerance=1e300")
        notes = [note for note in result["notes"] if "not smooth" in note]
        check(name + ", notes", len(notes) == bool(words)
              and all(word in note for note in notes for word in words), result["notes"])
        if expected:
            close(name, result["applied_force"][k], expected, tolerance)
    for cells, work in (("40, 4", 2. * 6.2397134244e-04), ("80, 8", 0.001267525943)):
        close("J without contact", solve(*BENCHMARK, "Cells=" + cells, "Law=none",
                                         "Initial gap=1")["functional"], -0.5 * work, 1e-9)


def check_forgotten():
    """The paper's strip may leave out modulus and bonds, a body of another length has notes."""
    for lengths, given, expected in (
            ("0.4, 0.1", (), 0), ("100, 10", (), 2), ("100, 10", ("Law=none",), 1),
            ("100, 10", ("Young modulus=7e4", "Bond stiffness=5"), 0)):
        notes = solve("Cells=10, 2", "Lengths=" + lengths, "Traction top=0; 1e-6", *given)["notes"]
        check(f"{lengths}, {given}", sum("default one" in note for note in notes) == expected,
              notes)


def check_heated(dim, hypothesis):
    """A body that expands freely, and one between rollers, which cannot."""
    E, nu, alpha, change, volume = 70., 0.3, 1e-3, 4., 2.
    stress, is_plane_stress = E * alpha * change, dim == 2 and hypothesis == "plane stress"
    body = [f"Dimension={dim}", "Lengths=1, 2" + ", 1" * (dim == 3),
            "Cells=2, 3" + ", 2" * (dim == 3), f"Young modulus={E}", f"Poisson ratio={nu}",
            f"Thermal expansion={alpha}", "Hypothesis=" + hypothesis,
            f"Temperature change={change}", "Clamped boundaries=", "Law=none", "Contact boundary="]
    back = ", back" * (dim == 3)
    free = solve(*body, "Roller boundaries=left, bottom" + back)
    pressure = stress / (1. - nu if is_plane_stress else 1. - 2. * nu)
    # In plane strain the body cannot expand out of the plane.
    strains = 3. if dim == 3 else 2. if is_plane_stress else 2. * (1. + nu)
    close("J", free["functional"], -0.5 * pressure * strains * alpha * change * volume, 1e-12)
    close("its stress", free["largest_von_mises"],
          stress * (dim == 2 and not is_plane_stress), 1e-11, stress)
    held = solve(*body, "Roller boundaries=left, right, bottom, top" + back
                 + ", front" * (dim == 3))
    check("a body that cannot expand does not move", held["largest_displacement"] <= 1e-15)
    for side, force in (("left", 2. * pressure), ("right", -2. * pressure)):
        close(f"force of {side}", held["reactions"][side][0], force, 1e-12)
    # It stays as it is while the body is stretched along x and let go again.
    path = solve(*body, "Roller boundaries=left, bottom" + back, "Displacement right=0.01; free"
                 + "; free" * (dim == 3), "Factors=1, 0.5, 0", "Dead loads=temperature change")
    out_of_plane = dim == 2 and not is_plane_stress
    modulus, part = (E / (1. - nu * nu), 1. + nu) if out_of_plane else (E, 1.)
    for row in path["path"]:
        close("heat that stays", row["reaction_right_x"],
              2. * modulus * (0.01 * row["factor"] - part * alpha * change), 1e-11, stress)
    sigma = -modulus * part * alpha * change
    across = (nu * sigma - stress) * out_of_plane
    close("and its stress", path["largest_von_mises"],
          math.sqrt(sigma * sigma + across * across - sigma * across), 1e-11, stress)


def check_loosened(dim, L, unit, degree, is_moved):
    """A press fit between a roller, or a side that is moved, and the foundation, cooled until
    it is loose: then there is no stress, and a gap of alpha dT H less the interference."""
    lengths, E, nu, alpha = (2. * L, 0.7 * L, 0.9 * L), 70. * unit, 0.3, 1.2e-5
    H, fit = lengths[1], 1e-3 * L
    sides = "top" if dim == 2 else "top, back"
    moved = ["Roller boundaries=left" + ", back" * (dim == 3), "Displacement top=free; "
             + f"{-0.5 * fit}" + "; free" * (dim == 3)]
    body = box(dim, lengths, "13, 5" + ", 4" * (dim == 3), E, nu, "left, " + sides.split(",")[0],
               *(moved if is_moved else []), "Law=none",
               f"Initial gap={-0.5 * fit if is_moved else -fit}", "Hypothesis=plane stress",
               f"Thermal expansion={alpha}", "Temperature change=-1", "Contact boundary=bottom",
               f"Degree={degree}", *(["Quadrature=gauss 2"] if degree == 2 else []),
               "Factors=" + ", ".join(f"{2. * fit / (alpha * H) * part}" for part in (0., 0.25, 0.6,
                                                                                      1., 3., 0.1)),
               "Global branch=none", *(["Displacement factors=1, 1, 1, 1, 1, 1"] if is_moved
                                       else []))
    result = solve(*body)
    check("all steps", result["status"] == "success" and len(result["path"]) == 6, result["errors"])
    area = lengths[0] * (lengths[2] if dim == 3 else 1.)
    for row, part in zip(result["path"], (0., 0.25, 0.6, 1., 3., 0.1)):
        close("gap", row["largest_gap"], max(0., 2. * part - 1.) * fit, 1e-9, fit)
        close("force", row["normal_force"], E * max(0., 1. - 2. * part) * fit / H * area, 1e-9,
              E * fit / H * area)


def check_crack(dim, degree, quadrature, cells, said):
    """A beam that is lifted at its end, which is open where there are no bonds."""
    scenes.section(f"Crack in {dim}D, {said}, degree {degree}, {quadrature}, {cells} cells")
    depth = 3. if dim == 3 else 1.
    lift = "Displacement left=free; 0.5" + "; free" * (dim == 3)
    bonds = ["Bond stiffness=if(x < 40, 0, 1e4)"] if said == "by place" else [
        "Bond stiffness=1e4", "Bond stiffness crack=0",
        "Parts/crack=bottom: x < 40"]
    result = solve(f"Dimension={dim}", "Lengths=100, 1.5" + ", 3" * (dim == 3),
                   f"Cells={cells}, 1" + ", 2" * (dim == 3), f"Degree={degree}",
                   "Young modulus=70000", "Poisson ratio=0", "Clamped boundaries=right", lift,
                   "Contact boundary=bottom", *bonds, "Bond threshold=1",
                   "Quadrature=" + quadrature, "Tangential displacement=free", "Factors=1",
                   "Global branch=none")
    # In cells where bonds begin the zone is a sum over 1024 pieces of a side, or 1024 triangles.
    error = 1e-9 if cells % 5 == 0 else 100. / cells / (1000. if dim == 2 else 10.)
    close("broken zone", result["broken_zone"], 40. * depth, error, depth)
    if cells % 5 == 0:
        close("without bonds", result["without_bonds"], 40. * depth, 1e-12)
    close("on the path", result["path"][0]["broken_zone"], result["broken_zone"], 1e-12)
    if dim == 2 and cells % 5 == 0:
        close("front", float(result["path"][0]["fronts"].split()[0]), 40., 1e-12)


# Bodies that nothing clamps.


def pad(dim, L, unit, nu=0., *others):
    """On a foundation; with nu it may widen, held by planes of symmetry, else tangential
    displacements are fixed."""
    return box(dim, (0.2 * L, 0.1 * L, 0.1 * L), "8, 4" if dim == 2 else "4, 2, 2",
               70. * unit, nu, "left", "Contact boundary=bottom",
               f"Bond stiffness={100. * unit / L}",
               f"Bond threshold={1e-3 * L}") + (
        [] if nu else ["Roller boundaries=",
                       "Tangential displacement=fixed"]) + list(others)


def pulled(dim, p):
    """Traction on the top, upwards."""
    return "Traction top=" + ("0; %s; 0" if dim == 3 else "0; %s") % p


def check_off(result, dim, translation, rotation, work):
    """Comes off by a translation in y and a rotation about z, from the middle of the pad's
    lower side, with what the loads do along it."""
    check("comes off", result["status"] == "comes off" and result["exit_code"] == 0
          and result.get("functional") is None)
    if result["status"] == "comes off":
        off = result["comes_off"]
        for k in range(dim):
            close("translation", off["translation"][k], translation * (k == 1), 1e-9, 1.)
        close("rotation", off["rotation"][-1], rotation, 1e-9, max(1., abs(rotation)))
        close("work", off["work"], work, 1e-9)


def check_held(result, dim, L, unit, a, p):
    """Bonds of stiffness a bear the traction p on the pad."""
    area = 0.2 * L * (0.1 * L if dim == 3 else 1.)
    check("bonds hold it", result["status"] == "success")
    close("J", result["functional"], -0.5 * p * p * area * (0.1 * L / (70. * unit) + 1. / a), 1e-12)
    for row in result["profile"]:
        close("u_nu", row["u_nu"], -p / a, 1e-12)


def check_pad(dim, L, unit):
    """Held by bonds up to their strength, pressed, pulled off, along a path."""
    a, M, area = 100. * unit / L, 1e-3 * L, 0.2 * L * (0.1 * L if dim == 3 else 1.)
    softness = 0.1 * L / (70. * unit)
    p, no_bonds = 0.9 * a * M, "Law=none"
    for nu in (0.3, 0.):
        scene = pad(dim, L, unit, nu)
        held = solve(*scene, pulled(dim, p))
        check_held(held, dim, L, unit, a, p)
        close("force of the foundation", held["contact_reaction"][1], -p * area, 1e-12)
        for law in ([], [no_bonds]):
            result = solve(*scene, pulled(dim, -p), *law)
            close("pressed, J", result["functional"], -0.5 * p * p * area * softness, 1e-12)
            check("and in contact", all(row["u_nu"] == 0. for row in result["profile"]))
        check("just below the threshold",
              solve(*scene, pulled(dim, 0.9999999 * a * M))["status"] == "success")
        check_off(solve(*scene, pulled(dim, 1.0000001 * a * M)), dim, 1., 0.,
                  1.0000001 * a * M * area)
        check("without bonds",
              solve(*scene, pulled(dim, 1e-9 * a * M), no_bonds)["status"] == "comes off")
        check("before it comes to a gap that is closed",
              solve(*scene, pulled(dim, -p), no_bonds, f"Initial gap={1e-4 * L}")[
                  "status"] == "success")
        path = solve(*scene, pulled(dim, a * M), "Factors=0.4, 0.8, 1.2, 0.4")
        check("load path", path["load_path"]["comes_off_at"] == 1.2
              and path["load_path"]["last_factor"] == 0.8)
        close("J before", path.pop("functional"),
              -0.32 * (a * M)**2 * area * (softness + 1. / a), 1e-12)
        check_off(path, dim, 1., 0., 1.2 * a * M * area)

    # Soft bonds at the middle node alone, which nothing but the foundation keeps the body
    # from turning about. In 3D eight triangles meet there, each a quarter of a cell's face.
    soft, of_node = 1e-11 / softness, 2. / 3. * (0.05 * L)**2 if dim == 3 else 0.025 * L
    near = " && ".join(f"abs({x} - {at * L}) < {0.01 * L}"
                       for x, at in (("x", 0.1), ("z", 0.05))[:dim - 1])
    for part in (0.9, 1.00001):
        result = solve(*pad(dim, L, unit), pulled(dim, part * soft * M * of_node / area),
                       f"Bond stiffness=if({near}, {soft}, 0)")
        if part > 1.:
            check("a single bond breaks", result["status"] == "comes off")
        else:
            close("a single bond, J", result["functional"], -0.405 * soft * M * M * of_node, 1e-9)

    # Bonds beside which the body is little more than rounding, or the other way.
    for ratio in (1e-11, 1e-6, 1e6, 1e10) if L == 1. else ():
        a = ratio / softness
        scene = pad(dim, L, unit, 0., f"Bond stiffness={a}")
        check_held(solve(*scene, pulled(dim, 0.9 * a * M)), dim, L, unit, a, 0.9 * a * M)
        above = 1. + max(1e-5, 1e-15 / ratio)
        check_off(solve(*scene, pulled(dim, above * a * M)), dim, 1., 0., above * a * M * area)


def check_end_of_curve(dim, L, unit):
    """Bonds that end with a traction let go of what pulls more."""
    T, area = 1e-3 * unit, 0.2 * L * (0.1 * L if dim == 3 else 1.)
    scene = box(dim, (0.2 * L, 0.1 * L, 0.1 * L), "8, 4" if dim == 2 else "4, 2, 2", 70. * unit, 0.,
                "left", "Contact boundary=bottom", "Law=curve",
                f"Curve=0:0, {1e-3 * L}:{1.1 * T}, {3e-3 * L}:{T}", "Roller boundaries=",
                "Tangential displacement=fixed")
    check_off(solve(*scene, pulled(dim, 1.2 * T)), dim, 1., 0., 0.2 * T * area)
    held = solve(*scene, pulled(dim, 0.99 * T))
    check("bonds that end with a traction hold", held["status"] == "success", held["errors"])


def check_too_slender():
    """A strip whose stiffness is beyond 16 digits: no fault of the program, nor of the scene's
    supports and materials."""
    result = solve("Lengths=10, 0.001", "Cells=150, 1", "Degree=2", "Clamped boundaries=left",
                   "Contact boundary=bottom", "Quadrature=gauss 2", "Traction right=0; 1e-12")
    check("is refused", result["exit_code"] == 2 and "too slender" in result["errors"],
          result["errors"])


def check_coming_off(dim, L, unit):
    """Which loads pull strips and plates off: the foundation bears a resultant that presses
    within its boundary, and a body comes off by turning about the edge that it presses
    beyond."""
    width, p = 0.5 * L if dim == 3 else 1., 1e-3 * unit
    lengths = (L, 0.01 * L) if dim == 2 else (L, 0.02 * L, width)
    height, force, none = lengths[1], p * L * width, [0.] * (2 * dim - 3)
    body = box(dim, lengths, "50, 1" if dim == 2 else "6, 1, 4", 70. * unit, 0.3, "left",
               "Contact boundary=bottom", "Law=none")
    bare = body + ["Roller boundaries=", "Tangential displacement=fixed"]
    # Between planes of symmetry, in which it cannot turn.
    guided = body if dim == 3 else body + ["Tangential displacement=fixed"]
    zero = "; 0" * (dim == 3)

    def top(pressure):
        return f"Traction top=0; {pressure}" + zero

    def right(pull):
        return f"Traction right=0; {pull}" + zero

    def pressed(along, across=0.):
        """The resultant presses at these parts of the half length and width."""
        return top(f"{-p}*(1 + {6. * along / L}*(x - {0.5 * L})"
                   + f" + {6. * across / width}*(z - {0.5 * width})" * (dim == 3) + ")")

    def turn(along, across=0.):
        if dim == 2:
            return [math.copysign(1., -along) / L]
        return [math.copysign(2., across) / L, 0., 0.] if across else [0., 0., -1. / L]

    cases = [("pulled at the top", [*bare, top(p)], (1., none, force)),
             ("without a load", bare, None), ("pressed", [*bare, top(-p)], None),
             ("pressed beyond its end", [*bare, pressed(1.5)], (0.5, turn(1.5), 0.25 * force)),
             ("pressed at its end", [*bare, pressed(0.99999)], None),
             ("pressed a little beyond", [*bare, pressed(1.001)], (0.5, turn(1.), 0.0005 * force)),
             ("guided and pressed beyond", [*guided, pressed(1.5)], None),
             ("guided and lifted at its end", [*guided, right(p)], (1., none, p * height * width)),
             ("clamped", [*bare, top(p), "Clamped boundaries=right"], None)]
    if dim == 2:
        # The moment about the end on which it would turn is zero.
        cases += [("other end", [*bare, pressed(-3.)], (0.5, turn(-3.), force)),
                  ("lifted at its end", [*bare, top(-p), right(49.999 * p)], None),
                  ("a little more", [*bare, top(-p), right(50.001 * p)], ()),
                  ("drawn along", [*bare, f"Traction top={p}; 0",
                                   f"Traction bottom={-p}; {-p}"], None)]
    else:
        # About x, the far side in z goes up if the other is pressed.
        cases += [(f"across {part}", [*bare, pressed(0., part)], None if abs(part) < 1.
                   else (0.5, turn(0., part), 0.5 * force * (abs(part) - 1.)))
                  for part in (0.5, -0.999, 1.001, -2.)]
        cases += [("at a corner, within", [*bare, pressed(0.99, -0.99)], None),
                  ("at a corner, beyond", [*bare, pressed(1.01, -1.01)], ())]
    for name, scene, motion in cases:
        result = solve(*scene)
        check(name, result["status"] == ("success" if motion is None else "comes off"),
              result["status"])
        if motion and result["status"] == "comes off":
            off, (translation, rotation, work) = result["comes_off"], motion
            for k, value in enumerate(off["translation"]):
                close(name + ", translation", value, translation * (k == 1), 1e-9, 1.)
            turned = off["rotation"] if dim == 3 else off["rotation"][-1:]
            for value, expected in zip(turned, rotation, strict=True):
                close(name + ", rotation", value, expected, 1e-9, 2. / min(L, 1.))
            # Of which terms as large as the force may cancel.
            close(name + ", work", off["work"], work, 1e-9, force)


def check_plane_pads(L, unit):
    """Cracks, two nodes, bonds that are lost in rounding."""
    a, M, length = 100. * unit / L, 1e-3 * L, 0.2 * L
    # Only the middle third is glued: it cannot come off under a couple that the foundation
    # bears together with it.
    cracked = pad(2, L, unit, 0., "Bond stiffness="
                  f"if(abs(x - {0.5 * length}) < {0.15 * length}, {a}, 0)")
    held = solve(*cracked, pulled(2, f"{0.1 * a * M}*(x - {0.5 * length})/{length}"))
    check("a couple is borne", held["status"] == "success" and held["bond_states"]["free"] > 0)
    check("the whole strength is not",
          solve(*cracked, pulled(2, 0.9 * a * M))["status"] == "comes off")
    # Two contact nodes have nothing but rigid motions: S is rounding.
    two = pad(2, L, unit, 0., "Cells=1, 8")
    check_held(solve(*two, pulled(2, 0.9 * a * M)), 2, L, unit, a, 0.9 * a * M)
    from_the_side = f"Traction right={1e-5 * unit}; 0"
    check("from the side", solve(*two, from_the_side)["status"] == "success")
    check("without bonds it falls over", solve(
        *two, from_the_side, "Law=none")["status"] == "comes off")
    # Of bonds this soft nothing is left in the forces.
    a = 1e-14 * 70. * unit / (0.1 * L)
    result = solve(*pad(2, L, unit, 0., f"Bond stiffness={a}"), pulled(2, 0.9e-3 * a * L))
    check("bonds lost in rounding", result["status"] == "not verified"
          and result["exit_code"] == 3 and "rounding of the displacements" in result["errors"])


def check_far_foundation():
    """As long as the foundation is not touched the body moves as one without a gap whose
    lower side rises, which has no lifting that could be lost in rounding."""

    def same(name, scene, gap, near, status="success"):
        far = solve(*scene, f"Initial gap={gap}")
        check(f"{name}, gap {gap}", far["status"] == status, far["status"])
        close(f"{name}, gap {gap}, J", far["functional"], near["functional"], 1e-9)
        # The solution is w = u - gap in double precision.
        of_near = near["largest_displacement"]
        close(f"{name}, gap {gap}, displacement", far["largest_displacement"], of_near, 1.,
              1e-9 * of_near + 2.2e-16 * gap)

    multigrid = ["Method=majorise minimise", "Linear solver=multigrid"]
    free = ["Clamped boundaries=left", "Tangential displacement=free", "Law=none"]
    for dim, length in ((2, 1000), (2, 10000), (3, 10000)):
        # Of height 1, pulled lengthwise, so that it gets thinner.
        strip = free + [f"Dimension={dim}", f"Lengths={length}, 1" + ", 1" * (dim == 3),
                        "Cells=" + ("200, 2" if dim == 2 else "30, 1, 1"), "Young modulus=1",
                        "Poisson ratio=0.3", "Traction right=1e-7; 0" + "; 0" * (dim == 3)]
        name, near = f"strip in {dim}D of length {length}", solve(*strip)
        for gap in (1e-3, 1., 10.):
            same(name, strip, gap, near)
        # Rounding of w makes forces of more than 1e-6 of the reaction.
        same(name, strip, 1e4, near, "not verified")
        same(name, strip + ["Method=energy bundle"], 1., near)
        same(name, strip + ["Factors=0.5, 1"], 1., near)
        if (dim, length) == (2, 1000):
            same(name + ", multigrid", strip + multigrid, 1., solve(*strip, *multigrid))
    # A steel bar whose displacements are 1e-9 of the gap and less.
    bar = free + ["Lengths=1, 0.25", "Cells=16, 4", "Rotation=30",
                  "Young modulus=210e9", "Poisson ratio=0.3"]
    for load, status in (("-0.3; 1", "not verified"), ("-30; 100", "success")):
        loaded = bar + ["Traction right=" + load]
        near = solve(*loaded, "Initial gap=1e-5")
        for method in ([], multigrid):
            same("bar, load " + load, loaded + method, 1., near, status)
    for law in ("none", "winkler"):
        rest = free + ["Lengths=1, 0.25", "Cells=16, 4", "Law=" + law, "Bond threshold=1e-4",
                       "Initial gap=0.001 * (1 + x)"]
        result = solve(*rest)
        check("at rest", result["status"] == "success" and result["largest_displacement"] <= 1e-17)
        check("no stress is said to change",
              not any("rounding" in note for note in result["notes"]))
        path = solve(*rest, "Traction top=0; -0.01", "Factors=0:0.25:1")
        check("path to rest", path["status"] == "success" and len(path["path"]) == 5)


def check_gap_at_clamp(gap):
    """A press fit that is zero at the clamp, also if its expression is so to rounding alone;
    where the displacement there is prescribed, it may be zero as well."""
    wedge = ["Lengths=0.3, 0.02", "Cells=15, 1", "Tangential displacement=free"]
    clamped = ["Clamped boundaries=right"]
    moved = ["Clamped boundaries=", "Displacement right=0; 1e-4*(x/3-0.1)"]
    exact = solve(*wedge, *clamped, "Initial gap=1e-3*(x-0.3)")
    for support in clamped, moved:
        result = solve(*wedge, *support, "Initial gap=" + gap)
        close(gap, result["functional"], exact["functional"], 1e-9)
    result = solve(*wedge, *clamped, f"Initial gap={gap} - 1e-12")
    check("more than rounding", "negative where the body is held" in result["errors"])


scenes.all_of(
    globals(),
    *((f"{test.__name__}, {dim}D, {name}", test, dim, length, modulus)
      for dim, name, length, modulus in SYSTEMS
      for test in (check_stretched, check_column_on_bonds, check_pad, check_end_of_curve,
                   check_coming_off)),
    *(("pads in " + name, check_plane_pads, length, modulus)
      for dim, name, length, modulus in SYSTEMS if dim == 2),
    *(("gap at a clamp", check_gap_at_clamp, f"1e-3*(x*{a!r} - {0.3 * a!r})/{a!r}")
      for a in (k * math.pi for k in range(1, 52, 5))),
    *((f"loosened, {dim}D, {name}", check_loosened, dim, length, modulus, degree, is_moved)
      for dim, name, length, modulus in SYSTEMS for degree in (1, 2)
      for is_moved in (False, True)),
    *(("crack", check_crack, *case) for case in (
        (2, 1, "nodal", 25, "by place"), (2, 1, "nodal", 25, "by part"),
        (2, 1, "midpoint", 25, "by place"), (2, 1, "gauss 3", 50, "by part"),
        (2, 2, "gauss 2", 25, "by part"), (2, 2, "gauss 4", 50, "by place"),
        (2, 1, "gauss 4", 33, "by place"), (2, 2, "gauss 4", 33, "by place"),
        (3, 1, "nodal", 10, "by place"), (3, 2, "gauss 2", 10, "by part"))),
    *((f"{test.__name__} {arguments}", test, *arguments) for test, *arguments in (
        [check_corner, 2], [check_corner, 3], [check_heated, 2, "plane stress"],
        [check_heated, 2, "plane strain"], [check_heated, 3, "plane stress"])))
