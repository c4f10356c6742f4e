#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_load_path.py DEBOND: load paths. A column that is pulled off its bonds uniformly has
closed formulas for both branches, for the factors where it snaps, closes and changes its
global minimum, and for its arc. On the benchmark: what follows from the structure of the
problem (between changes of the bonds displacements are proportional to the factor and J is
quadratic in it; dJ/d(factor) = -<f, u>; the least J is concave in the squared factor), values
of J from an independent code, and meshes that are refined for a path."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes, sawteeth

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
# Height H, nu = 0, clamped at the top, pulled off its bonds at the bottom by the traction
# 1 times the factor. Bonded: |u_nu| = t / (k + a), k = E/H, until that is M. Broken:
# |u_nu| = t / k as long as that is more than M.
E, H, a, M = 10., 0.2, 150., 0.01
k = E / H
BENCHMARK = ["Traction top=0; if(x < 0.2, 0.69, -0.345)",
             "Bond stiffness=690", "Method=majorise minimise"]
NO_GLOBAL = "Global branch=none"


def below(factor):
    """So far from a threshold that bonds are not at it, which they are within 1e-6."""
    return factor * (1. - 1e-5)


def above(factor):
    return factor * (1. + 1e-5)


def listed(*factors):
    return ", ".join(map(repr, factors))


def area_of(dim):
    return 0.3 if dim == 2 else 0.3 * 0.1


WINKLER = [f"Bond stiffness={a}", f"Bond threshold={M}"]


def column(dim, *others, law=WINKLER):
    """With the entries that a path needs."""
    body = ["Lengths=0.3, 0.2", "Cells=3, 2", "Traction bottom=0; 1"]
    if dim == 3:
        body = ["Dimension=3", "Lengths=0.3, 0.2, 0.1", "Cells=2, 2, 1", "Traction bottom=0; 1; 0"]
    return solve(f"Young modulus={E}", "Poisson ratio=0", "Contact boundary=bottom",
                 "Clamped boundaries=top", "Tangential displacement=free", *law, *body, *others)


def moved(dim):
    """By its top, as far as the factor is."""
    return ["Clamped boundaries=", "Traction bottom=", "Displacement top=0; 1" + "; 0" * (dim == 3)]


def check_column(dim, *quadratic):
    """Both branches; the least J changes at the mean of snap and closing."""
    scenes.section(f"Column in {dim}D {quadratic}")
    area, snap, closing = area_of(dim), M * (k + a), M * k
    exchange = math.sqrt(snap * closing)
    up = sorted([0.07 * step for step in range(41)]
                + [near(factor) for near in (below, above) for factor in (snap, closing)])
    path = column(dim, "Factors=" + listed(*up, *up[-2::-1]), "Global branch="
                  + ("search" if quadratic else "prove"), *quadratic)["path"]

    def energy(t, broken):
        return area * (0.5 * a * M * M - 0.5 * t * t / k if broken else -0.5 * t * t / (k + a))

    check("all steps verify", len(path) == 2 * len(up) - 1
          and all(row["status"] == "success" for row in path))
    check("loading and unloading meet the same factors",
          all(one["factor"] == other["factor"] for one, other in zip(path, path[::-1])))
    broken, scale = False, abs(energy(2.8, True))
    for row in path:
        t = row["factor"]
        broken = t > closing if broken else t > snap
        close("broken part", row["broken_part"], broken, 1e-12, 1.)
        close("J", row["J"], energy(t, broken), 1e-12, scale)
        close("gap", row["mean_gap"], t / (k if broken else k + a), 1e-13, 1.)
        check("law", row["law_violation"] <= 1e-11, row["law_violation"])
        least = t > exchange
        close("broken part of the least J", row["global_broken_part"], least, 1e-12, 1.)
        close("the least J", row["global_J"], energy(t, least), 1e-12, scale)
        known = "best known" if quadratic and t != 0. else "global"
        check("words", row["global_minimum"] == known and row["minimum"] == (
            known if broken == least else "local minimum"))


def check_column_for_good(dim, quadrature, degree):
    """Bonds that do not heal: once broken, it stays on the second branch, also where it
    would close, and is pressed on the foundation without bonds."""
    scenes.section(f"Bonds that do not heal in {dim}D, degree {degree}, {quadrature}")
    area, snap, broken = area_of(dim), M * (k + a), False
    path = column(dim, f"Degree={degree}", "Quadrature=" + quadrature, "Factors=-1, 0:0.07:1.96, "
                  f"{listed(below(snap), above(snap))}, 2.03:0.07:2.8, 2.8:-0.07:0, -1, 1",
                  "Bonds heal=false")
    path, history = path["path"], path["history"]
    scale = area * a * M * M
    check("all steps", len(path) == 86)
    # The last step, at the factor 1, has what its bonds have taken in J.
    close("J of the iterations", history[-1]["functional"], path[-1]["J"], 1e-12, scale)
    for row in path:
        broken = broken or row["factor"] > snap
        pull = max(0., row["factor"])
        close("J", row["J"], area * (0.5 * a * M * M - 0.5 * pull**2 / k if broken else
                                     -0.5 * pull**2 / (k + a)), 1e-12, scale)
        close("dissipated energy", row["dissipated_energy"], 0.5 * scale * broken, 1e-12, scale)
        # Closed cracks are not open.
        close("broken zone", row["broken_zone"], area * (broken and pull > 0.), 1e-12, area)


def check_broken_but_closed(dim, quadrature, degree):
    """Where bonds broke for good and the gap is closed again, nodes have a state of their own.
    Those that soften from the opening M on, until 6 M, hold t = k d + a M (6 M - d) / (5 M): at
    the opening d = 2 M they have lost 0.6 of their stiffness, and are contact when closed."""
    soft = ["Law=curve", f"Curve=0:0, {M}:{a * M}, {6. * M}:0"]
    for heals, law, factors, state, damage in (
            (False, WINKLER, "2.8, 0", "broken but closed", 1.),
            (False, WINKLER, "2.8, -1", "broken but closed", 1.),
            (False, WINKLER, "2.8, 0.1", "broken", 1.),
            (False, WINKLER, "1.9, 0", "contact", 0.),
            (False, soft, "3.2, 0", "broken but closed", 1.),
            (False, soft, "2.2, -1", "contact", 0.6),
            (True, WINKLER, "2.8, 0.1", "bonded", 0.)):
        scenes.section(f"Unloaded in {dim}D, {quadrature}, {factors}, heals: {heals}, {law[0]}")
        result = column(dim, f"Degree={degree}", "Quadrature=" + quadrature, NO_GLOBAL,
                        f"Factors={factors}", f"Bonds heal={str(heals).lower()}", law=law)
        check("all nodes", {row["state"] for row in result["profile"]} == {state}
              and result["bond_states"][state] == len(result["profile"]) > 3, result["bond_states"])
        for row in result["profile"]:
            close("damage", row["damage"], damage, 1e-9, 1.)
        close("contact part", result["path"][-1]["contact_part"],
              state in ("contact", "broken but closed"), 1e-12, 1.)


def check_fronts_stay():
    """A strip is peeled from its right end and laid down again: bonds that broke for good leave
    the front where it was, and the broken part does not shrink before the gap closes."""
    for quadrature, *others in (["nodal"], ["gauss 3"], ["gauss 4", "Degree=2"]):
        scenes.section(f"Fronts while a crack closes, {quadrature}, {others}")
        path = solve("Lengths=0.4, 0.02", "Cells=40, 2", "Young modulus=100",
                     "Clamped boundaries=left", "Contact boundary=bottom", "Bond stiffness=100",
                     f"Bond threshold={0.1 * M}", "Tangential displacement=free",
                     "Displacement right=free; 0.03", "Displacement factors=0:0.1:1, 0.9:-0.1:0.3",
                     "Bonds heal=false", "Quadrature=" + quadrature, *others)["path"]
        fronts = [float(row["fronts"].split()[0]) for row in path[10:]]
        check("it ran", 0.1 < fronts[0] < 0.35, fronts)
        check("it stays", max(fronts) - min(fronts) < 1e-10, fronts)
        parts = [row["broken_part"] for row in path[10:]]
        check("what is broken", min(parts) == max(parts) > 0.2, parts)


def check_fronts_in_3d():
    """Lines: where the scene's bonds begin, and of a strip that is peeled from its right end.
    What is broken there is as long as the way from the end to the front, in the mean."""
    scenes.section("Fronts in 3D")
    row = solve("Dimension=3", "Lengths=0.3, 0.2, 0.2", "Cells=6, 2, 4", f"Young modulus={E}", "Poisson ratio=0",
                "Contact boundary=bottom", "Clamped boundaries=top",
                f"Bond stiffness=if(x < 0.0999999, 0, {a})", f"Bond threshold={M}",
                "Traction bottom=0; 1; 0", "Tangential displacement=free", "Factors=0.2",
                NO_GLOBAL)["path"][0]
    for place, z in zip(row["fronts"].split(";"), (0., 0.1, 0.2)):
        check("where bonds begin", max(abs(float(x) - wanted) for x, wanted in
                                       zip(place.split(), (0.1, 0., z))) <= 1e-12, row["fronts"])
    for row in solve("Dimension=3", "Lengths=0.4, 0.02, 0.1", "Cells=40, 1, 6", "Young modulus=100",
                     "Poisson ratio=0.3", "Clamped boundaries=left", "Contact boundary=bottom",
                     "Bond stiffness=100", f"Bond threshold={0.1 * M}",
                     "Tangential displacement=free", "Displacement right=free; 0.03; free",
                     "Displacement factors=0.5, 1", NO_GLOBAL)["path"]:
        least, mean, largest = (float(place.split()[0]) for place in row["fronts"].split(";"))
        close("broken zone", row["broken_zone"], 0.1 * (0.4 - mean), 0.005)
        # The edges are anticlastic: the front is curved, by less than a few cells.
        check("order", 0.1 < least < mean < largest < least + 0.05, row["fronts"])


def check_moved_column(dim, name, n_steps, factors, *entries):
    """Pulled by its top, it has a linear way from the displacement d = 0 to the snap at
    M (1 + a/k), has no force then, and closes at M. The least J is that without bonds from
    M sqrt(1 + a/k) on."""
    scenes.section(f"Column moved in {dim}D, {name}")
    area, snap, broken = area_of(dim), M * (1. + a / k), False
    path = column(dim, *moved(dim), *entries, f"Displacement factors={factors}, " + listed(
        below(snap), above(snap), above(M), below(M)))["path"]
    check("all steps verify", len(path) == n_steps + 4
          and all(row["status"] == "success" for row in path))
    for row in path:
        d = row["displacement_factor"]
        broken = d > M if broken else d > snap
        bonded = k if d < 0. else k * a / (k + a)
        stiffness, least = 0. if broken else bonded, d > M * math.sqrt(1. + a / k)
        for prefix, off in (("", broken), ("global_", least)):
            close(prefix + "J", row[prefix + "J"], 0.5 * area * (
                a * M * M if off else bonded * d * d), 1e-12, area * a * M * M)
            close(prefix + "broken part", row[prefix + "broken_part"], off, 1e-12, 1.)
        known = "global" if d == 0. or "prove" in entries[-1] else "best known"
        check("words", row["global_minimum"] == known and row["minimum"] == (
            known if broken == least else "local minimum"), row)
        close("dJ/d(factor)", row["unit_displacement_work"], area * stiffness * d, 1e-11,
              area * a * M)


def check_moved_columns(dim, quadrature):
    """Clamped at its top, with quadratic displacements; and a tack test, in which it is
    pressed on the foundation and lifted again, in 2D on a fine mesh: rounding adds up in the
    sum of all forces."""
    check_moved_column(dim, "quadratic", 43, "-0.01, 0:0.003:0.06, 0.06:-0.003:0", "Degree=2",
                       "Quadrature=" + quadrature, "Global branch=search")
    free = "; free" * (dim == 3)
    check_moved_column(dim, "tack test", 17, "0:0.011:0.099, -0.01, 0.03, 0.05, 0.2, 0, 0.1, 0",
                       "Cells=" + ("24, 16" if dim == 2 else "3, 3, 2"), "Roller boundaries=left"
                       + ", back" * (dim == 3), "Displacement top=free; 1" + free,
                       "Global branch=prove")


def check_peak():
    """The force of the column rises to a M times its area, at the displacement of the snap,
    between factors that are far from it. On the way back it is no larger. A pull t on the bottom,
    which is no rest, breaks the bonds at a force that is less by t."""
    scenes.section("The largest force")
    t = 0.3 * a * M
    for dim, resolve, factors, *others in (
            (2, 0.01, "0, 0.025, 0.1"), (2, 0.001, "0, 0.1, 0"), (3, 0.01, "0:0.011:0.099"),
            (2, 0.01, "0, 0, 0.1"), (2, 0.01, "0.1"), (2, 0.01, "0.01, 0.03"),
            (2, 0.01, "0, 0.1", "Bonds heal=true"), (2, 0.01, "0, 0.1", f"Traction bottom=0; {t}"),
            (2, 0.01, "0, 0.1", "Degree=2", "Quadrature=gauss 3"),
            (2, 0.01, "0, -0.01, 0.1", "Linear solver=multigrid")):
        peak = column(dim, *moved(dim), "Displacement factors=" + factors, "Bonds heal=false",
                      f"Resolve={resolve}", *others)["load_path"]["peak"]
        snap, force = M * (1. + a / k), a * M * area_of(dim)
        if factors == "0.01, 0.03":
            snap, force = 0.03, force * 0.03 / snap
        pull = t if any("Traction" in entry for entry in others) else 0.
        found, known_to = peak["unit_displacement_work"], peak["known_to"]
        at = f"{factors} {others}"
        check(at + ": within what was asked for", (1. - resolve) * force <= found + pull * area_of(
            dim) <= force * (1. + 1e-9), peak)
        check(at + ": bounded where there is a bound", known_to is None if pull or "heal" in str(
            others) else known_to <= resolve and found * (1. + known_to) >= force * (1. - 1e-9),
              peak)
        close(at + ": at the factor that it belongs to", (k * peak["displacement_factor"] + pull)
              / (k * snap), (found + pull * area_of(dim)) / force, 1e-9)
        close(at + ": the reaction", peak["reactions"]["top"][1], found, 1e-9, force)
    check("none is sought", column(2, *moved(2), "Displacement factors=0, 0.1", "Resolve=0")
          ["load_path"]["peak"] is None)


def check_pulled_and_moved(dim):
    """By t on its bottom and d of its top, each with factors of its own, of which some come
    twice: as by t + k d alone, but for k d^2 / 2. Loads may also be dead."""
    area, pulls, moves = area_of(dim), (0., 0.5, 1.1, 1.1, -1., 1.5, 0.5, 1.1), (
        0., 0., 0., 0.021, 0.021, 0.012, 0., -0.01)
    entries = [*moved(dim), "Traction bottom=0; 1" + "; 0" * (dim == 3)]
    for name, factors, *others in (
            ("both vary", ", ".join(map(str, pulls)), "Global branch=prove"),
            ("dead loads", "0", "Dead loads=bottom", "Quadrature=gauss 2", "Global branch=search")):
        scenes.section(f"Column pulled and moved in {dim}D, {name}")
        path = column(dim, *entries, "Factors=" + factors, *others,
                      "Displacement factors=" + ", ".join(map(str, moves)))["path"]
        check("all steps verify", [row["status"] for row in path] == 8 * ["success"])
        for row, pull, d in zip(path, pulls if "," in factors else 8 * [1.], moves):
            P = pull + k * d
            least = min(0., -P * max(0., P) / (2. * (k + a)),
                        0.5 * a * M * M - P * max(0., P) / (2. * k))
            close("least J", row["global_J"], area * (0.5 * k * d * d + least), 1e-12,
                  area * a * M * M)
            check("word", row["global_minimum"] == (
                "global" if "," in factors else "best known"), row["global_minimum"])


def check_without_pressure(dim):
    """Nothing but the foundation holds the block, and without a pressure on it there are many
    minima with one J. Pressed by q times the factor t over a gap g: J = -A (t q g + (t q)^2
    H/(2 E)), stretched by t e: E (t e)^2 / 2 for each volume, cooled so that it shrinks by
    t e: -E (t e)^2 / (1 - nu), in 3D -3/2 E (t e)^2 / (1 - 2 nu)."""
    nu, g, q, e, area = 0.3, 0.02, 0.4, 0.005, area_of(dim)
    volume = area * H
    block = [f"Young modulus={E}", f"Poisson ratio={nu}", NO_GLOBAL, "Thermal expansion=1e-3",
             "Clamped boundaries=", "Contact boundary=bottom", "Law=none",
             "Tangential displacement=free"]
    block += ["Lengths=0.3, 0.2", "Cells=6, 4", "Roller boundaries=left"] if dim == 2 else [
        "Dimension=3", "Lengths=0.3, 0.2, 0.1", "Cells=3, 3, 2", "Roller boundaries=left, back"]
    for name, entries, energy in (
            ("over a gap", [f"Initial gap={g}", "Factors=0, 0.5, 0, 2, 0",
                            f"Traction top=0; {-q}" + "; 0" * (dim == 3)],
             lambda t: -area * (t * q * g + (t * q)**2 * H / (2. * E))),
            ("stretched", ["Displacement factors=0, 1, -1, 2, 0",
                           f"Displacement right={0.3 * e}; free" + "; free" * (dim == 3)],
             lambda t: 0.5 * E * (t * e)**2 * volume),
            ("cooled", ["Temperature change=-5", "Factors=0, 1, -1, 2, 0"],
             lambda t: -E * (t * e)**2 * volume * (1. / (1. - nu) if dim == 2
                                                   else 1.5 / (1. - 2. * nu)))):
        scenes.section(f"Without pressure on the foundation in {dim}D, {name}")
        path = solve(*block, *entries)["path"]
        check("all steps", len(path) == 5 and all(r["status"] == "success" for r in path))
        for row in path:
            close("J", row["J"], energy(row["displacement_factor"]), 1e-11, abs(energy(2.)))


def check_column_arc(dim, is_moved):
    """From 0 along the bonded states to the snap, then with the gap M and a falling pull of
    the bonds back to where they close, then along the broken states."""
    scenes.section(f"Arc of the column in {dim}D, {'moved' if is_moved else 'loaded'}")
    area = area_of(dim)
    snap, closing = (M * (1. + a / k), M) if is_moved else (M * (k + a), M * k)
    end = round(1.4 * snap, 6)
    factors = f"0:{end / 20.}:{end}"
    result = column(dim, NO_GLOBAL, "Arc=true", *(moved(dim) + ["Displacement factors=" + factors]
                                                  if is_moved else ["Factors=" + factors]))
    # From rest the body leaves the foundation at once.
    arc = result["arc"]
    arc = arc[sum(row["largest_gap"] == 0. for row in arc) - 1:]
    check("rest, snap, closing and end", len(arc) == 4, len(arc))
    for row, t, w, word in zip(arc, (0., snap, closing, end),
                               (0., M, M, end if is_moved else end / k),
                               ("stable", "stable", "unstable", "stable")):
        bonds = 0.5 * a * min(w, M)**2
        energy, work = (0.5 * k * (t - w)**2 + bonds, k * (t - w)) if is_moved else (
            0.5 * k * w * w + bonds - t * w, w)
        close("factor", row["displacement_factor" if is_moved else "factor"], t, 1e-12, snap)
        for gap in ("mean_gap", "largest_gap"):
            close("gap", row[gap], w, 1e-12, M)
        close("J", row["J"], area * energy, 1e-12, area * a * M * M)
        close("work on the unit load or displacement",
              row["unit_displacement_work" if is_moved else "unit_load_work"], area * work,
              1e-12, area * (a * M if is_moved else M))
        # Of a column that moves without bonds all forces are rounding.
        check("law", abs(work) <= 1e-12 or row["law_violation"] <= 1e-9)
        check("the way back is unstable", row["status"] == word)
    for row in result["path"]:
        check("the followed path snaps there", (row["broken_part"] > 0.) == (
            row["displacement_factor" if is_moved else "factor"] > snap))


def check_structure(path, least, n_steps):
    """What holds for any path; of differences, at so many of the first steps."""
    n_compared = 0
    for number, row in enumerate(path):
        J, t = row["J"], row["factor"]
        scale = row["elastic_energy"] + row["adhesion_energy"] + abs(t * row["unit_load_work"])
        check("law and equilibrium", max(row["law_violation"], row["equilibrium_residual"],
                                         row["force_imbalance"]) <= 1e-9)
        if row["global_J"] != "":
            check("global branch above the followed one", row["global_J"] <= J + 1e-12 * scale)
        if 0 < number < min(len(path) - 1, n_steps):
            left, right = path[number - 1], path[number + 1]
            if (left["broken_part"] == row["broken_part"] == right["broken_part"]
                    and left["factor"] != right["factor"]):
                n_compared += 1
                h = right["factor"] - left["factor"]
                close("dJ/d(factor) = -<f, u>", right["J"] - left["J"],
                      -h * row["unit_load_work"], 1e-10, scale)
                close("second differences of J", right["J"] - 2. * J + left["J"], -0.25 * h
                      * (right["unit_load_work"] - left["unit_load_work"]), 1e-10, scale)
    check("differences at many steps", n_compared >= least, n_compared)


def check_first_break(name, factors, factor, *scene):
    """That bonds break first at a factor, in steps of these factors."""
    path = solve(*BENCHMARK, NO_GLOBAL, *scene,
                 f"{factors}=0, {listed(below(factor), above(factor))}")["path"]
    parts = [row["broken_part"] for row in path]
    check(name, len(parts) == 3 and parts[1] == 0. < parts[2], (factor, parts))


def at_rest(row):
    return row["J"] == 0. and row["largest_gap"] == 0.


def check_benchmark():
    """Beside an independent code, and with half the steps."""
    result = solve(*BENCHMARK, "Factors=0:0.1:2.5, 2.5:-0.1:0")
    path, totals = result["path"], result["load_path"]
    check_structure(path, 30, 1000)
    full = path[10]
    close("J of the intact state at factor 1", full["J"], -7.354549556e-05, 1e-9)
    close("J of the global branch at factor 1", full["global_J"], -2.3973127534e-04, 1e-10)
    check("which is told", full["minimum"] == "local minimum"
          and full["global_minimum"] == "global")
    # The gap of the intact state is proportional to the factor.
    snap = 0.002 / full["largest_gap"]
    check_first_break("the snap where the largest gap is M", "Factors", snap)
    check("in the step that passes this factor",
          snap < totals["largest_break"]["factor"] < snap + 0.1)
    check("bonds close below factor 1", totals["largest_closing"]["factor"] < 1.)
    check("nothing is left at rest", at_rest(path[-1]) and path[-1]["minimum"] == "global")
    # The least of parabolas in the factor is concave in its square.
    for left, row, right in zip(path[:24], path[1:25], path[2:26]):
        x = [one["factor"]**2 for one in (left, row, right)]
        line = (left["global_J"] * (x[2] - x[1]) + right["global_J"] * (x[1] - x[0])) / (
            x[2] - x[0])
        check("global branch concave in the squared factor",
              line - row["global_J"] <= 1e-12 * abs(right["global_J"]))
    halved = solve(*BENCHMARK, "Factors=0:0.05:2.5, 2.5:-0.05:0", NO_GLOBAL)
    check("snap with half the steps",
          snap < halved["load_path"]["largest_break"]["factor"] < snap + 0.05)
    for step in range(21):
        close("J with half the steps", halved["path"][2 * step]["J"], path[step]["J"], 1e-12,
              abs(path[20]["J"]))
    check("no global branch if none is wanted", halved["path"][10]["global_J"] == "")

    scenes.section("One factor")
    single = solve(*BENCHMARK, "Search=none")
    one = solve(*BENCHMARK, "Factors=1")
    check("as many iterations as a single run", single["iterations"] == one["iterations"])
    for mine, other in zip(one["profile"], single["profile"]):
        close("u_nu", mine["u_nu"], other["u_nu"], 1e-13, single["largest_displacement"])
    for factor, result in ((1., one), (0.5, solve(*BENCHMARK, "Factors=0.5"))):
        close("J, a quarter under half the load", result["functional"],
              factor**2 * single["functional"], 1e-12)


def check_other_laws():
    """Other quadratures, no bonds, and what ends a path."""
    for name, *entries in (("gauss 2",), ("gauss 4", "Degree=2")):
        scenes.section(name)
        result = solve(*BENCHMARK, "Factors=0:0.1:2.5, 2.5:-0.1:0", NO_GLOBAL,
                       "Quadrature=" + name, *entries)
        path = result["path"]
        check_structure(path, 19, 20)  # later points break between nodes
        check("bonds break", max(row["broken_part"] for row in path) > 0.5)
        change = result["load_path"]["largest_break"]
        # Where the largest gap is M; that at a Gauss point is less.
        check("after that of nodes", change["factor"] >= 0.002 / path[10]["largest_gap"] * 0.99)
        check("nothing is left at rest", at_rest(path[-1]))

    scenes.section("No adhesion, both signs of the load")
    path = solve(*BENCHMARK, "Factors=-1, -0.5, 0.25, 0.5, 1", "Cells=20, 2", "Law=none")["path"]
    close("J, quadratic for a pressure", path[0]["J"], 4. * path[1]["J"], 1e-12)
    close("and for a pull", path[4]["J"], 4. * path[3]["J"], 1e-12)
    check("global", path[0]["minimum"] == path[3]["minimum"] == "global")

    scenes.section("What ends a path")
    for entry, n_steps, message in (
            ("Solver/Majorise minimise/Maximum iterations=2", 6,
             "load path, step 6, factor 2.5: majorise-minimise: relative residual"),
            ("Verification/Tolerance=1e-300", 2, "load path, step 2, factor 0.5: verification")):
        result = solve(*BENCHMARK, "Factors=0:0.5:4", entry)
        check(entry, len(result["path"]) == n_steps and message in result["errors"],
              result["errors"])
    off = solve("Bond stiffness=69", "Clamped boundaries=",
                "Traction top=0; if(x < 0.2, 0.069, 0.0345)", "Cells=20,2",
                "Factors=0.5, 1, 10", "Accuracy/Target=1e-4")
    check("a body that comes off, on a refined mesh", off["status"] == "comes off"
          and len(off["path"]) == 2 and len(off["levels"]) > 2
          and off["levels"][-1]["estimated_error"] < 1e-4)


def check_arcs():
    """Along a curve of stationary states the derivative of J by the factor is the work on the
    unit load or displacement, which is linear between breakpoints."""
    # Without bonds at the corner that is moved: they break between breakpoints.
    moving = ["Traction top=", "Parts/Glued=bottom: x < 0.39", "Contact boundary=Glued",
              "Displacement right=free; 0.02", "Clamped boundaries=left",
              "Displacement factors=0:0.25:1"]
    for name, scene in (("loaded", ["Factors=0:0.5:2.5"]), ("moved", moving),
                        ("moved, bonds do not heal", moving + ["Bonds heal=false"])):
        scenes.section("Arc of the benchmark, " + name)
        result = solve(*BENCHMARK, NO_GLOBAL, "Arc=true", *scene)
        arc, path = result["arc"], result["path"]
        factor = "factor" if name == "loaded" else "displacement_factor"
        check("ends where the path ends", arc[-1][factor] == path[-1][factor])
        words = [row["status"] for row in arc]
        check("has unstable states", words.count("unstable") > 2)
        check("and no others", set(words) == {"stable", "unstable"})
        check("law", all(row["law_violation"] <= 1e-9 for row in arc))
        changes = [(after["displacement_factor"] - before["displacement_factor"])
                   * (before["unit_displacement_work"] + after["unit_displacement_work"]) / 2.
                   - (after["factor"] - before["factor"]) * (before["unit_load_work"] + after[
                       "unit_load_work"]) / 2. for before, after in zip(arc, arc[1:])]
        for change, before, after in zip(changes, arc, arc[1:]):
            close("J is the integral of the work", after["J"] - before["J"], change, 1e-10,
                  max(map(abs, changes)))
        # A bond that comes to its threshold stays there in unstable states.
        check_first_break("the first break of the path is on it", "Factors" if name == "loaded"
                          else "Displacement factors", arc[words.index("unstable") - 1][factor],
                          *scene)
    scenes.section("Arc back to rest")
    back = solve(*BENCHMARK, NO_GLOBAL, "Arc=true", "Factors=2:-0.5:0")
    check("where all is zero", at_rest(back["arc"][-1]) and back["arc"][-1]["factor"] == 0.)
    check("each state is verified",
          {row["status"] for row in back["arc"]} <= {"stable", "unstable"})
    check("without a note", not back["notes"])


def check_arc_of_steps():
    """Each node goes through all pieces of its law, of which there are many."""
    steps = range(1, 81)
    result = solve(BENCHMARK[0], NO_GLOBAL, "Arc=true", "Factors=0, 30", "Cells=5, 1", "Law=curve",
                   "Curve=" + sawteeth([690. * (1. - 0.0125 * (step - 1)) for step in steps],
                                       [0.0001 * step for step in steps]))
    nodes = sum(result["bond_states"].values())
    broken = result["bond_states"]["broken"]
    check("some nodes break", broken >= 2, result["bond_states"])
    check("ends where the path ends", result["arc"][-1]["factor"] == 30.)
    check("a state for each piece that a broken node has left",
          len(result["arc"]) > broken * len(steps), len(result["arc"]))
    check("more than 20 for each node", len(result["arc"]) > 100 + 20 * nodes)
    check("without a note", not any("arc" in note for note in result["notes"]), result["notes"])
    # Two nodes change at one factor, but for rounding.
    L = 73000.
    arc = solve(NO_GLOBAL, "Arc=true", "Factors=0.419, 2.724",
                f"Lengths={7.854905527390874 * L}, {4.291882178918444 * L}", "Cells=5, 2",
                "Young modulus=1.2632818378701813e-05", f"Parts/upper=y > {2.2 * L}",
                f"Parts/pu=left: y > {2.2 * L}",
                "Young moduli upper=2.2027e-05, 4.5519e-05, 1.03551e-05",
                "Poisson ratios upper=0.07097, -0.09853, 0.13176",
                "Shear moduli upper=3.2834e-06, 3.88677e-06, 7.31477e-06",
                "Clamped boundaries=right", "Contact boundary=bottom",
                f"Displacement pu=free; {0.0142656 * L}", "Pressure top=-1.1512677979133876e-08",
                "Law=bilinear", "Bond stiffness=1.905680960226034e-10",
                "Bond strength=3.551543469510946e-08",
                "Fracture energy=1.9507540865316708e-05")["arc"]
    check("an arc", len(arc) > 5, len(arc))
    check("a row for each corner", all(abs(a["factor"] - b["factor"]) > 1e-9
                                       for a, b in zip(arc, arc[1:])), arc)


def check_parts():
    """A column without bonds to the left of 0.1. At 0.4 it could not open by M without any
    bonds, and at 4 no bond holds."""
    result = solve("Lengths=0.3, 0.2", "Cells=6, 2", f"Young modulus={E}", "Poisson ratio=0",
                   "Contact boundary=bottom", "Clamped boundaries=top",
                   f"Bond stiffness=if(x < 0.0999999, 0, {a})", f"Bond threshold={M}",
                   "Traction bottom=0; 1", "Tangential displacement=free",
                   "Factors=-1, 0.2, 0.4, 4, 0.4", NO_GLOBAL)
    check("all steps", len(result["path"]) == 5)
    check("a break and a closing", result["load_path"]["largest_break"]["factor"] == 4.
          and result["load_path"]["largest_closing"]["factor"] == 0.4)
    # Of the nodes 0, 0.05 and 0.1, ..., 0.3 the last five have bonds.
    for row, contact, bonded, broken in zip(result["path"], (1., 0., 0., 0., 0.),
                                            (0., 0.75, 0.75, 0., 0.75), (0., 0., 0., 0.75, 0.)):
        for name, part in (("contact", contact), ("bonded", bonded), ("broken", broken),
                           ("free", 1. - contact - bonded - broken)):
            close(f"{name} part", row[name + "_part"], part, 1e-12, 1.)
        close("broken zone", row["broken_zone"], 0.3 if broken else 0.1 * (1. - contact), 1e-10, 1.)
        front = str(row["fronts"]).split()
        check("fronts", not front if broken else len(front) == 2
              and abs(float(front[0]) - 0.1) <= 1e-12, front)


def check_refined():
    """One mesh for all factors, beside a uniform one that is much finer (of the least J that
    of linear displacements is off by 7e-4)."""
    quadratic = ["Degree=2", "Quadrature=gauss "]
    for name, target, cells, most, entries in (
            ("linear", 5e-3, "160,16", 6000, []),
            ("quadratic", 1e-3, "80,8", 2000, [quadratic[0], quadratic[1] + "8"]),
            ("bonds that do not heal", 1e-2, "80,8", 4000,
             [quadratic[0], quadratic[1] + "4", "Bond stiffness=690",
              "Factors=0.5:0.5:2.5, 1, 0.5", "Bonds heal=false"])):
        scenes.section("A path on a refined mesh, " + name)
        scene = [*BENCHMARK, "Bond stiffness=69", "Cells=20,2",
                 "Factors=0.5:0.5:2", NO_GLOBAL, *entries]
        refined = solve(*scene, f"Accuracy/Target={target}")
        uniform = solve(*scene, "Cells=" + cells)
        levels = refined["levels"]
        check("no shortfall", refined["status"] == "success", refined["status"])
        check("the estimate is below the target on the last mesh, and before only unchecked",
              levels[-1]["estimated_error"] <= target and (levels[-2]["error_factor"] is None or
                                                           target < levels[-2]["estimated_error"]))
        check("all factors", len(refined["path"]) == len(uniform["path"]) > 3)
        # The estimate is of J with the bonds as they are: that other bonds broke for good on
        # the way is no part of it.
        for one, other in zip(refined["path"], uniform["path"]):
            close("J", *(row["J"] - row["dissipated_energy"] for row in (one, other)),
                  1.25 * target)
        check("fewer unknowns than the uniform mesh", levels[-1]["unknowns"] < most)


def check_cells_at_edge():
    """E*/a = (0.91 / (1 - 0.3^2)) / 5 = 0.2, where bonds of one part of the bottom end: cells of
    1/20 are a quarter of it. A softer region beside it, with Young's modulus 0.091, has no say."""
    block = ["Lengths=2, 1", "Young modulus=0.91", "Poisson ratio=0.3", "Hypothesis=plane strain",
             "Clamped boundaries=", "Roller boundaries=left", "Traction top=",
             "Displacement top=free; 0.0001", "Method=automatic", "Tangential displacement=free",
             "Bond threshold=0.01", "Bond stiffness=if(x < 1, 5, 0)", "Displacement factors=1, 2",
             "Parts/soft=x > 1.5", "Young modulus soft=0.091", NO_GLOBAL]
    for name, size, *scene in (
            ("linear", 0.25, "Cells=40, 20"),
            ("quadratic", 0.25, "Cells=40, 20", "Degree=2",
             "Quadrature=gauss 4"),
            ("finer", 0.125, "Cells=80, 40"),
            # The sides of four triangles of a square.
            ("solid", 1., "Dimension=3", "Lengths=2, 1, 0.2", "Cells=10, 5, 1",
             "Displacement top=free; 0.0001; free",
             "Roller boundaries=left, front, back"),
            ("no edge", 0., "Cells=40, 20", "Bond stiffness=5")):
        result = solve(*block, *scene)
        for row in result["path"]:
            close("cells at the edge, " + name, row["cell_size_at_edge"], size, 1e-9)
        close("of the path", result["load_path"]["cell_size_at_edge"], size, 1e-9)
        # A quarter of 0.2 makes the first bond break at 0.0314 instead of 0.0248.
        note = [note for note in result["notes"] if note.startswith("E*/a")]
        check("note of " + name, len(note) == (size > 0), result["notes"])
    soft = solve(*block, "Cells=40, 20", "Law=bilinear", "Bond stiffness=5", "Bond threshold=",
                 "Bond strength=0.05", "Fracture energy=0.01", "Traction factor=if(x < 1, 1, 0)")
    check("bonds that soften share their load over another length",
          soft["status"] == "success" and soft["load_path"]["cell_size_at_edge"] == 0 and
          not any("E*/a" in note for note in soft["notes"]), (soft["errors"], soft.get("notes")))


def check_estimate_for_good():
    """All bonds break, and the body is unloaded until their gaps are less than M: what is
    left is that without bonds, and so is its estimate."""
    for degree, rule, tolerance in ((1, "nodal", 3e-3), (2, "gauss 3", 1e-9)):
        scenes.section(f"The estimate after unloading, degree {degree}")
        scene = [*BENCHMARK, "Traction top=0; 0.69", NO_GLOBAL, f"Degree={degree}",
                 "Bond threshold=1e-6", "Quadrature=" + rule, "Factors=1, 1e-5"]

        def estimate(*entries):
            result = solve(*scene, *entries)
            return result["estimated_error"] * abs(result["functional"])

        none = estimate("Law=none")
        # Of nodes those of the clamped corners hold.
        close("is that without bonds", estimate("Bonds heal=false"), none, tolerance)
        check("not that with bonds", abs(estimate() / none - 1.) > 0.1)


def check_search_beside_path():
    """Where one step from rest leads is a state that the search knows, whatever the method
    starts from and wherever the points of the quadrature are."""
    for cells, M in ((5, 0.0037), (6, 0.0036)):
        plate = ["Dimension=3", "Lengths=30, 1.1, 30", f"Cells={cells}, 1, {cells}", "Degree=2",
                 "Parts/shaft=top: x < 4.5 && z < 4.5", "Young modulus=70000",
                 "Clamped boundaries=", "Roller boundaries=left, back",
                 "Displacement shaft=free; 0.0095; free", "Tangential displacement=free",
                 "Quadrature=gauss 2", "Bond stiffness=5000", f"Bond threshold={M}"]
        found = solve(*plate)
        path = solve(*plate, "Factors=0, 1", NO_GLOBAL)
        check("word", found["minimum"]["state"] == "best known")
        check("J", 0. < found["functional"] <= path["functional"] * (1. + 1e-9))


scenes.all_of(globals(), *(("", *check) for check in (
    *((test, dim, *others) for dim in (2, 3) for test, *others in (
        [check_column], [check_column, "Degree=2", "Quadrature=gauss 3"],
        [check_moved_columns, f"gauss {5 - dim}"], [check_pulled_and_moved],
        [check_without_pressure], [check_column_arc, False], [check_column_arc, True])),
    *((check_column_for_good, *case) for case in (
        (2, "nodal", 1), (2, "gauss 2", 1), (2, "gauss 3", 2), (3, "gauss 2", 2))),
    [check_broken_but_closed, 2, "nodal", 1], [check_broken_but_closed, 3, "gauss 2", 2])))
