#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_shear.py DEBOND: bonds that bear shear as well as opening. Homogeneous states in closed
form, on a foundation and in the oblique joint of code_aster's V3.04.001; strips beside a program
of its own (dense matrices, a change of basis, majorise-minimise or branch and bound); the limits
without shear stiffness and with a large one; bodies turned, mirrored, in other units, of degree 2
and with other solvers."""
import math
import pathlib
import sys
from random import Random

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes, turned

# Whether the least J is searched for and proved.
PROVES = True

scenes = Scenes(sys.argv[1])
solve, check = scenes.solve, scenes.check
NODAL = "Quadrature=nodal"
DEGREE_2 = ["Degree=2", "Quadrature=gauss 3"]
GAUSS = ["Quadrature=gauss 2"]
FROM_REST = "Search=none"
NO_HEALING = ["Bonds heal=false", "Global branch=none"]
TANGENTIAL = "Tangential displacement="
BONDED = TANGENTIAL + "bonded"


def close(name, value, expected, tolerance, scale=None):
    """As that of the scenes; a missing value or an empty cell is not close."""
    scenes.close(name, value if isinstance(value, (int, float)) else None, expected, tolerance,
                 scale)


def bonds(normal, shear, energy):
    return [BONDED, f"Bond stiffness={normal!r}", "Bond threshold=",
            f"Bond shear stiffness={shear!r}", f"Fracture energy={energy!r}"]


def vector(*components):
    return "; ".join(repr(float(x)) for x in components)


# ------------------------------------------------------------------ homogeneous states


def column(E, nu, sigma, tau, dimension=2, hypothesis="plane stress"):
    """A box on bonds alone, with the tractions of a state of stress in which its faces stay
    straight: sigma upwards, tau along x (and z), and what keeps it from getting wider."""
    if dimension == 2 and hypothesis == "plane stress":
        across, modulus = nu, E / (1 - nu**2)
    else:
        across, modulus = nu / (1 - nu), E * (1 - nu) / (1 + nu) / (1 - 2 * nu)
    lengths, cells = ((3, 2), (3, 2)) if dimension == 2 else ((3, 2, 1.5), (2, 1, 1))
    entries = [f"Dimension={dimension}", "Lengths=" + ", ".join(map(str, lengths)),
               "Cells=" + ", ".join(map(str, cells)), f"Young modulus={E!r}",
               f"Poisson ratio={nu!r}", "Clamped boundaries=", "Contact boundary=bottom"]
    if dimension == 2:
        entries += ["Hypothesis=" + hypothesis]
    tractions = {"top": (tau[0], sigma, *tau[1:])}
    for side, sign in (("left", -1), ("right", 1)):
        tractions[side] = (sign * across * sigma, sign * tau[0], *(0. for _ in tau[1:]))
    for side, sign in (("back", -1), ("front", 1))[:2 * (dimension - 2)]:
        tractions[side] = (0., sign * tau[1], sign * across * sigma)
    entries += [f"Traction {side}={vector(*t)}" for side, t in tractions.items()]
    area = math.prod(lengths) / lengths[1]
    return entries, area, lengths[1], modulus, E / 2 / (1 + nu)


def check_columns():
    """The least J is that of the complementary energy, with its sign changed."""
    for name, more, dimension, hypothesis in (
            ("nodal", [NODAL], 2, "plane stress"), ("gauss", GAUSS, 2, "plane strain"),
            ("degree 2", DEGREE_2, 2, "plane stress"), ("3D", [NODAL], 3, ""),
            ("3D, degree 2", DEGREE_2, 3, "")):
        for E, kn, kt, sigma, tau in ((1000., 50., 20., 0.3, (0.2, -0.15)),
                                      (3., 7., 900., 1e-3, (-4e-3, 1e-3))):
            tau = tau[:dimension - 1]
            energy = .5 * (sigma**2 / kn + sum(t * t for t in tau) / kt)
            scene, area, height, modulus, shear = column(E, .3, sigma, tau, dimension, hypothesis)
            at = f"{name}, E {E}"
            held = solve(*scene, *more, FROM_REST, *bonds(kn, kt, energy * (1 + 1e-5)))
            check(at + " holds", held["status"] == "success", (held["status"], held["errors"]))
            close(at + ": J", held.get("functional"), -area * (energy + height / 2 * (
                sigma**2 / modulus + sum(t * t for t in tau) / shear)), 1e-10)
            check(at + ": law", held["law_violation"] < 1e-9, held["law_violation"])
            check(at + ": states", bool(held["profile"]) and all(
                row["state"] == "bonded" for row in held["profile"]))
            size = math.hypot(sigma / kn, *(t / kt for t in tau))
            for row in held["profile"]:
                node = f"{at}, ({row['x']}, {row['y']}): "
                close(node + "opening", -row["u_nu"], sigma / kn, 1e-10, size)
                for axis, t in zip("xz", tau):
                    close(node + "slip_" + axis, row["slip_" + axis], t / kt, 1e-10, size)
                close(node + "slip_y", row["slip_y"], 0, 1e-10, size)
                close(node + "shear force", row["shear_force_density"], math.hypot(*tau), 1e-8)
                close(node + "pull", row["normal_force_density"], -sigma, 1e-8)
                close(node + "by the law", row["normal_traction"], -sigma, 1e-8)
                close(node + "in shear", row["shear_traction"], math.hypot(*tau), 1e-8)
                close(node + "mode", row["mode_mixity"],
                      sum(t * t for t in tau) / kt / (2 * energy), 1e-8)
            off = solve(*scene, *more, FROM_REST, *bonds(kn, kt, energy * (1 - 1e-5)))
            check(at + " comes off", off["status"] == "comes off", (off["status"], off["errors"]))
            # Each of two energies is just enough for the traction along its direction.
            for part, wanted in ((1e-5, "success"), (-1e-5, "comes off")):
                apart = solve(*scene, *more, FROM_REST, *bonds(kn, kt, sigma**2 / kn / 2 * 1.5),
                              "Bond failure=separate",
                              "Shear fracture energy="
                              f"{.5 * sum(t * t for t in tau) / kt * (1 + part)!r}")
                check(f"{at}, separate, {part}", apart["status"] == wanted or wanted != "success"
                      and apart["status"] != "success", (apart["status"], apart["errors"]))
                if wanted == "success":
                    close(f"{at}, separate: J", apart.get("functional"), held.get("functional"),
                          1e-10)


def check_pressed():
    """In contact bonds hold in shear until their energy is spent."""
    kn, kt, energy, E, nu = 50., 20., .02, 1000., 0.
    for dimension, more in ((2, [NODAL]), (2, DEGREE_2), (2, GAUSS), (3, [NODAL])):
        tau = (.6, -.3)[:dimension - 1]
        scene, area, height, _, shear = column(E, nu, -2., tau, dimension)
        size = math.hypot(*tau)
        scene += bonds(kn, kt, energy)
        at = f"{dimension}D, {more[0]}"
        held = solve(*scene, *more, FROM_REST)
        close(at + ": J", held.get("functional"), -area / 2 * (
            size**2 / kt + height * (4 / E + size**2 / shear)), 1e-10)
        check(at + ": mode", all(row["mode_mixity"] == 1 for row in held["profile"]))
        for row in held["profile"]:
            check(at + " is in contact", (row["u_nu"], row["state"]) == (0, "contact"), row)
            close(at + ": slip", row["slip_x"], tau[0] / kt, 1e-10)
            close(at + ": shear force", row["shear_force_density"], size, 1e-9)
        # With the top moved, so that there is something to hold what has come off.
        moved = [e for e in scene if "Traction top" not in e]
        slip = [t / kt + height * t / shear for t in tau]
        moved += ["Displacement top=" + vector(slip[0], -2 * height / E, *slip[1:])]
        factor = math.sqrt(2 * energy * kt) / size
        steps = factor / 2, factor * (1 - 1e-9), factor * (1 + 1e-9)
        factors = ", ".join(map(repr, steps))
        path = solve(*moved, *more, *NO_HEALING, "Factors=" + factors,
                     "Displacement factors=" + factors)["path"]
        check(at + ": path", len(path) == 3, path)
        for row, b in zip(path[:2], steps):
            close(f"{at}, {b}: J", row["J"], area * b * b / 2 * (
                size**2 / kt + height * (4 / E + size**2 / shear)), 1e-10)
            check(f"{at}, {b}: nothing broke", row["dissipated_energy"] == 0)
        if len(path) == 3:
            close(at + ": broken", path[2]["dissipated_energy"], area * energy, 1e-10)


def check_layers():
    """Two layers with bonds in series, moved at the top: opening, slip, J and first break."""
    kn, kt, energy, move = 50., 20., .02, (.5, 1.)
    heights, moduli = (2., 2.), (1000., 2000.)
    across = sum(h / E for h, E in zip(heights, moduli))
    along = 2 * across
    p, t = move[1] / (1 + kn * across), move[0] / (1 + kt * along)
    breaks = math.sqrt(2 * energy / (kn * p**2 + kt * t**2))
    stress, J = kn * p, .5 * (move[1]**2 / (across + 1 / kn) + move[0]**2 / (along + 1 / kt))
    lift = " + ".join([repr(p), f"{stress / moduli[0]!r} * min(y, {heights[0]!r})",
                       f"{stress / moduli[1]!r} * max(y - {heights[0]!r}, 0)"])
    scene = ["Lengths=6, 4", "Cells=3, 4", f"Young modulus={moduli[0]!r}",
             f"Parts/upper=y > {heights[0]!r}", f"Young modulus upper={moduli[1]!r}",
             "Poisson ratio=0", "Clamped boundaries=", "Contact boundary=bottom",
             "Displacement top=" + vector(*move), *bonds(kn, kt, energy), *NO_HEALING]
    # The shear at the sides is a load, or comes from sides that are led up and down; with one cell
    # no vertex is free along the normal then.
    led = [f"Displacement {side}=free; {lift}" for side in ("left", "right")]
    for name, sides in (("loads", [f"Traction left={vector(0, -kt * t)}",
                                   f"Traction right={vector(0, kt * t)}"]),
                        ("led", led), ("led, one cell", [*led, "Cells=1, 4"])):
        for more in ([NODAL], DEGREE_2, GAUSS):
            steps = breaks / 2, breaks * (1 - 1e-9), breaks * (1 + 1e-9)
            factors = ", ".join(map(repr, steps))
            path = solve(*scene, *sides, *more, "Displacement factors=" + factors,
                         *(["Factors=" + factors] if name == "loads" else []))["path"]
            at = f"{name}, {more[0]}"
            check(at + " has all steps", len(path) == 3, path)
            for row, b in zip(path[:2], steps):
                close(f"{at}, {b}: J", row["J"], 6 * J * b * b, 1e-10)
                if name != "led, one cell":
                    close(f"{at}, {b}: opening", row["largest_gap"], b * p, 1e-10)
                close(f"{at}, {b}: reaction", row["reaction_top_x"], 6 * b * kt * t, 1e-10)
                check(f"{at}, {b}: nothing broke", row["dissipated_energy"] == 0)
            check(at + ": broken", len(path) == 3 and path[2]["dissipated_energy"] > 0, path)


def check_softening_column():
    """A column without elasticity to speak of: the law itself in the effective opening."""
    k, ratio, strength, energy = 100., .4, 1., .02
    first, last = strength / k, 2 * energy / strength
    # Directions of the displacement and effective openings, the last ones on the way back.
    for angle in (0., .7, math.pi / 2):
        steps = (.5 * first, .5 * (first + last), .8 * last, .3 * last, 1.1 * last)
        move = (math.sin(angle) / math.sqrt(ratio), math.cos(angle))
        path = solve("Lengths=2, 1", "Cells=2, 1", "Young modulus=1e7", "Poisson ratio=0",
                     "Clamped boundaries=", NODAL, "Contact boundary=bottom",
                     "Displacement top=" + vector(*move), f"Displacement left=free; {move[1]!r}",
                     f"Displacement right=free; {move[1]!r}", *bonds(k, ratio * k, energy),
                     "Law=bilinear", f"Bond strength={strength!r}", *NO_HEALING,
                     "Displacement factors=" + ", ".join(map(repr, steps)))["path"]
        check(f"{angle} has all steps", len(path) == len(steps), path)
        most = 0.
        for row, l in zip(path, steps):
            most = max(most, l)
            damage = min(max(last * (most - first) / most / (last - first), 0), 1)
            taken = energy * damage * first / (last - damage * (last - first))
            close(f"{angle}, {l}: J", row["J"], 2 * (taken + (1 - damage) * k * l * l / 2), 2e-4)
            close(f"{angle}, {l}: dissipated", row["dissipated_energy"], 2 * taken, 4e-4,
                  2 * energy)
            # Closed bonds soften as open ones do.
            close(f"{angle}, {l}: softening", row["softening_part"], float(first < most < last),
                  1e-12)


# ------------------------------------------------------------------ an oblique joint


SQUARE = """Point(1) = {0,0,0,250}; Point(2) = {1000,0,0,250}; Point(3) = {1000,1000,0,250};
Point(4) = {0,1000,0,250};
Line(1) = {1,2}; Line(2) = {2,4}; Line(3) = {4,1}; Line(4) = {2,3}; Line(5) = {3,4};
Curve Loop(1) = {1,2,3}; Plane Surface(1) = {1};
Curve Loop(2) = {4,5,-2}; Plane Surface(2) = {2};
Physical Surface("a") = {1}; Physical Surface("b") = {2};
Physical Curve("low") = {1}; Physical Curve("left") = {3};
Physical Curve("right") = {4}; Physical Curve("up") = {5};
"""


def check_oblique():
    """Pulled by sigma along x, the joint at 45 degrees opens by sigma / (2 k_n) and slips by
    sigma / (2 k_t); V3.04.001 of code_aster."""
    (scenes.directory / "square.geo").write_text(SQUARE)
    E, nu, kn, kt, sigma = 30000., .2, 20., 40., 3.
    law = [f"Young modulus={E!r}", f"Poisson ratio={nu!r}",
           "Contact boundary=cut_1", *bonds(kn, kt, 1e3), FROM_REST]
    diagonal = ["Source=file", "File=square.geo", "Clamped boundaries=",
                "Roller boundaries=low, left", f"Traction right={sigma!r}; 0"]
    cosine = math.sqrt(.5)
    turned = ["Lengths=1000, 1000", "Cells=4, 4", "Rotation=45", "Clamped boundaries=",
              f"Displacement left={sigma / E!r} * x; {-nu * sigma / E!r} * y"]
    turned += [f"Traction {side}={vector(sign * sigma * cosine, 0)}"
               for side, sign in (("right", 1), ("bottom", 1), ("top", -1))]
    cube = ["Dimension=3", "Lengths=1000, 1000, 1000", "Cells=2, 2, 1",
            *(e + ("; 0" if "Traction" in e else "") for e in turned[2:-4])]
    cube += [f"Displacement left={sigma / E!r} * x; {-nu * sigma / E!r} * y; "
             f"{-nu * sigma / E!r} * z"]
    cube += [e + "; 0" for e in turned[-3:]]
    for name, scene, area, height in (
            ("a | b", [*diagonal, "Cuts=a | b"], 1000 / cosine, 1.),
            ("b | a", [*diagonal, "Cuts=b | a"], 1000 / cosine, 1.),
            ("degree 2", [*diagonal, "Cuts=a | b", *DEGREE_2], 1000 / cosine, 1.),
            ("turned", [*turned, "Cuts=x = 500"], 1000, 1.),
            ("3D", [*cube, "Cuts=x = 500"], 1000, 1000.)):
        result = solve(*law, *scene)
        check(name + " holds", result["status"] == "success", (result["status"], result["errors"]))
        check(name + " has nodes", len(result["profile"]) > 3)
        for row in result["profile"]:
            close(name + ": opening", -row["u_nu"], sigma / (2 * kn), 1e-10)
            close(name + ": slip", math.hypot(*(row[key] for key in row if "slip_" in key)),
                  sigma / (2 * kt), 1e-10)
            close(name + ": shear", row["shear_force_density"], sigma / 2, 1e-8)
            close(name + ": mode", row["mode_mixity"], kn / (kn + kt), 1e-9)
        if name != "3D" and name != "turned":
            # Rollers do no work: J is half the work of the load, with its sign changed.
            close(name + ": J", result.get("functional"), -.5 * (
                sigma**2 / E * 1e6 + area * (sigma / 2)**2 * (1 / kn + 1 / kt)), 1e-10)


# ------------------------------------------------------------------ strips


STRIPS = ["Lengths=40, 4", "Cells=20, 4", "Cuts=y = 2", "Parts/upper=y > 2", "Parts/tl=left: y > 3",
          "Parts/bl=left: y < 1", "Parts/end=left: y > 2", "Young modulus=2000",
          "Young modulus upper=1000", "Poisson ratio=0.3", "Clamped boundaries=right",
          "Contact boundary=cut_1", NODAL]
FOUNDATION = ["Lengths=40, 2", "Cells=20, 2", "Parts/tl=left: y > 1", "Young modulus=1000",
              "Poisson ratio=0.3", NODAL, "Clamped boundaries=right", "Contact boundary=bottom"]
LAW = bonds(50., 20., .02)


def strips(name, factor):
    """L: pulled at the end; D: moved there; F: one of them on a foundation."""
    foundation = name.startswith("F")
    scene = FOUNDATION if foundation else [e if "Cells" not in e else
                                           f"Cells={name[1:]}, 4" for e in STRIPS]
    if "D" in name:
        scene = [*scene, f"Displacement tl={vector(.2 * factor, factor)}"]
        if not foundation:
            scene += [f"Displacement bl=free; {-.2 * factor!r}"]
    else:
        scene = [*scene, f"Traction {'left' if foundation else 'end'}="
                 + vector(.2 * factor, .1 * factor)]
    return [*scene, *LAW]


# Factor, J from rest, broken, least J, broken.
TABLE = {
    "L20": ((.5, -1.622934876568e-02, 0, -1.622934876568e-02, 0),
            (1., -6.491739506272e-02, 0, -6.491739506272e-02, 0),
            (1.4, -1.272380943229e-01, 0, -1.272380943229e-01, 0),
            (1.6, -1.661885313606e-01, 0, -2.757861984678e-01, 19),
            (1.8, -2.103323600032e-01, 0, -5.456044074352e-01, 19)),
    "L10": ((1., -4.550491975316e-02, 0, -4.550491975316e-02, 0),
            (2., -1.820196790126e-01, 0, -1.820196790126e-01, 0)),
    "D20": ((.2, 3.411094908212e-01, 3, 2.944456067013e-01, 5),
            (.6, 9.502380904419e-01, 7, 8.839118054890e-01, 10),
            (1., 1.779755015247, 10, 1.691799221291, 14),
            (1.5, 3.183277302121, 13, 3.076537957952, 17),
            (2., 4.996643852301, 16, 4.931979118030, 18)),
    "D10": ((.2, 3.811167864319e-01, 2, 3.373391987231e-01, 3),
            (.6, 1.113548646214, 4, 9.844311585626e-01, 6),
            (1., 2.154832011658, 5, 1.837041392455, 8),
            (2., 5.548165569818, 8, 5.350890607916, 10)),
    "F20": ((.5, -1.834869186235e-04, 0, -1.834869186235e-04, 0),
            (1., -7.339476744938e-04, 0, -7.339476744938e-04, 0),
            (1.4, -1.438537442008e-03, 0, -3.614033976365e-02, 19),
            (2., -2.935790697975e-03, 0, -8.472020575887e-01, 20)),
    "FD20": ((.2, 3.488021397405e-01, 4, 3.323578081148e-01, 5),
             (.6, 1.006612289214, 9, 9.607772042836e-01, 12),
             (1., 1.760797080990, 14, 1.734800298907, 16),
             (1.5, 3.091781784079, 17, 3.078935040691, 18))}


def broken(result):
    return sum(row["state"] == "broken" for row in result["profile"])


def check_profile(name, result, kn, kt, energy):
    """What the bonds of each node bear is what their law says of its opening and slip."""
    rows = [row for row in result["profile"] if row["state"] != "held"]
    scale = math.sqrt(2 * kn * energy)
    for row in rows:
        at = f"{name} at {row['x']}"
        slip = math.hypot(row["slip_x"], row["slip_y"])
        parts = kn * row["u_nu"]**2, kt * slip**2
        holds = sum(parts) <= 2 * energy
        close(at + ": shear", row["shear_force_density"], holds * kt * slip, 1e-9, scale)
        if row["state"] != "contact":
            close(at + ": pull", row["normal_force_density"], holds * kn * row["u_nu"], 1e-9, scale)
        close(at + ": mode", row["mode_mixity"] * sum(parts), parts[1], 1e-9)


def check_tractions():
    """With Gauss' rule the force of a node is a mean around it; its traction is what the law
    says of the opening and slip there, of an edge in its middle."""
    kn, kt = 50., 20.
    rows = solve(*STRIPS, *bonds(kn, kt, 1e3), "Traction end=0.2; 0.1", *DEGREE_2)["profile"]
    check("many", len(rows) > 30)
    scale = max(abs(row["normal_force_density"]) for row in rows)
    off = 0.
    for row, before, after in zip(rows, [{}, *rows], [*rows[1:], {}]):
        at, is_edge = f"at {row['x']}", row["x"] % 2 == 1
        u, slip = (.5 * row[key] + .25 * (before.get(key, 0.) + after.get(key, 0.))
                   if is_edge else row[key] for key in ("u_nu", "slip_x"))
        close(at + ": shear", row["shear_traction"], kt * abs(slip), 1e-9, scale)
        if row["state"] == "contact":
            check(at + ": pressed", row["normal_traction"] == row["normal_force_density"])
        else:
            close(at + ": pull", row["normal_traction"], kn * u, 1e-9, scale)
            off = max(off, abs(row["normal_force_density"] - row["normal_traction"]) / scale)
    check("they differ", off > .01, off)
    separate = solve(*STRIPS, *bonds(kn, kt, .02), "Bond failure=separate", NODAL,
                     "Shear fracture energy=0.03", "Traction end=0.2; 0.1")
    for row in separate["profile"]:
        close(f"separate, at {row['x']}", row["shear_traction"], row["shear_force_density"], 1e-9,
              scale)


def check_all_held():
    """Without a contact node J is that of the bonds at vertices that are moved along them."""
    result = solve("Lengths=5, 10", "Cells=5, 1", "Young modulus=100", "Poisson ratio=0",
                   "Clamped boundaries=", "Displacement right=0; -0.01", "Displacement top=0; free",
                   "Displacement bottom=0; free", "Displacement left=free; -0.01",
                   "Contact boundary=left", *bonds(300., 300., 1e3), NODAL)
    close("J", result.get("functional"), 10 * 300 * .01**2 / 2, 1e-9)
    check("no note says that bonds decide nothing", not any(
        "decide nothing" in note for note in result["notes"]), result["notes"])


def check_strips():
    for name, rows in TABLE.items():
        for factor, from_rest, n_from_rest, least, n_least in rows:
            at = f"{name}, {factor}"
            result = solve(*strips(name, factor), FROM_REST)
            close(at + ", from rest", result.get("functional"), from_rest, 1e-9)
            check(at + ", broken", broken(result) == n_from_rest, broken(result))
            check(at + ", balance", result["force_imbalance"] < 1e-10)
            check_profile(at, result, 50., 20., .02)
            if PROVES:
                result = solve(*strips(name, factor), "Prove=true")
                close(at + ", least", result.get("functional"), least, 1e-9)
                check(at + ", least, broken", broken(result) == n_least, broken(result))
                check(at + " is proved", result.get("proof", {}).get("status") == "proved")
                check_profile(at + ", least", result, 50., 20., .02)


def check_three_strips():
    scene = ["Lengths=40, 5", "Cells=10, 5", "Cuts=y = 2, y = 3", "Parts/top_strip=y > 3",
             "Parts/low_strip=y < 2", "Young modulus=500", "Young modulus top_strip=1000",
             "Young modulus low_strip=2000", "Poisson ratio=0.3", "Clamped boundaries=right", NODAL,
             "Contact boundary=cut_1, cut_2", *LAW, "Parts/tl=left: y > 4", "Parts/bl=left: y < 1"]
    for factor, from_rest, n_from_rest, least, n_least in (
            (.2, 4.700819017672e-01, 4, 3.327248375590e-01, 3),
            (.6, 1.530478376150, 6, 9.861502994298e-01, 6),
            (1., 2.724952762123, 8, 1.835961798966, 8)):
        moved = [*scene, "Displacement tl=" + vector(.2 * factor, factor),
                 f"Displacement bl=free; {-.2 * factor!r}"]
        result = solve(*moved, FROM_REST)
        close(f"{factor}, from rest", result.get("functional"), from_rest, 1e-9)
        check(f"{factor}, broken", broken(result) == n_from_rest, broken(result))
        if PROVES:
            result = solve(*moved, "Prove=true")
            close(f"{factor}, least", result.get("functional"), least, 1e-9)
            check(f"{factor}, least, broken", broken(result) == n_least, broken(result))


STEPS = (.2, .6, 1., 1.5, 1., .5, 0., 1., 2.)
SEPARATE = ["Bond failure=separate", "Shear fracture energy=0.04"]
BILINEAR = [*bonds(100., 40., .02), "Bond strength=1", "Law=bilinear"]
# Totals and what was dissipated at each of the steps.
PATHS = {
    "common": (LAW, (.3411094908212, .9502380904419, 1.779755015247, 3.183277302121,
                     1.692567689832, .7981419224580, .5, 1.692567689832, 4.996643852301),
               (.1, .26, .38, .5, .5, .5, .5, .5, .62)),
    "separate": ([*LAW, *SEPARATE],
                 (.3554343752197, 1.211318430691, 2.359280110136, 4.157783506876,
                  2.325681558612, 1.226420389653, .86, 2.325681558612, 6.254850258719),
                 (.1, .22, .46, .86, .86, .86, .86, .86, 1.18)),
    "bilinear": (BILINEAR, (.3016823950142, .8960007834076, 1.703979872620, 3.086836391785,
                            1.743201394846, .9370203966818, .6682933972939, 1.743201394846,
                            4.937292232969),
                 (.18, .3842051291336, .5452480956434, *[.6682933972939] * 5, .74)),
    "exponential": ([*BILINEAR, "Law=exponential"],
                    (.2969580840781, .8921326380052, 1.700001234665, 3.082811757207,
                     1.750580440403, .9512416503211, .6847953869604, 1.750580440403,
                     4.933294270284),
                    (.1671844269594, .3677706566792, .5262857170822, *[.6847953869604] * 5,
                     .7285810339559))}


def moved_strips(law, *more, steps=STEPS):
    return [*(e for e in strips("D20", 1.) if e not in LAW), *law, *more,
            "Displacement factors=" + ", ".join(map(repr, steps))]


def check_paths():
    for name, (law, totals, dissipated) in PATHS.items():
        smooth = name in ("bilinear", "exponential")
        path = solve(*moved_strips(law, *NO_HEALING))["path"]
        check(name + " has all steps", len(path) == len(STEPS), path)
        for row, total, taken in zip(path, totals, dissipated):
            at = f"{name}, step {row['step']:g}"
            # The dissipated energy is flat at a minimum of one that softens.
            close(at + ": total", row["J"], total, 1e-8 if smooth else 1e-9)
            close(at + ": dissipated", row["dissipated_energy"], taken, 1e-6 if smooth else 1e-12)
            check(at + ": law", row["law_violation"] < 1e-7, row["law_violation"])
            if not smooth:
                # Of springs that are on or off what is not dissipated is half the work.
                close(at + ": work", 2 * (row["J"] - taken),
                      row["displacement_factor"] * row["unit_displacement_work"], 1e-9, total)
        if PROVES and name == "common":
            rows = [row for row in TABLE["D20"] if row[0] in STEPS]
            path = solve(*moved_strips(law, "Global branch=prove",
                                       steps=[row[0] for row in rows]))["path"]
            for row, (factor, _, _, least, _) in zip(path, rows, strict=True):
                close(f"{name}, {factor}, on a path", row["global_J"], least, 1e-9)
                check("is proved", row["global_minimum"] == "global")
    # The first bond breaks where it stores its energy: below that all is linear.
    stored = max(row["normal_traction"]**2 / 50. + row["shear_traction"]**2 / 20. for row in solve(
        *moved_strips(LAW, *NO_HEALING, steps=(.01,)))["profile"]) / 2
    first = .01 * math.sqrt(.02 / stored)
    for part in 1 - 1e-9, 1 + 1e-9:
        for steps in ((first * part,), (.01, first * part)):
            path = solve(*moved_strips(LAW, *NO_HEALING, steps=steps))["path"]
            check(f"first break {part}, {steps}", bool(path) and (
                path[-1]["dissipated_energy"] > 0) == (part > 1), path)


# Factor, total and dissipated energy of paths in steps of .05 to 1.5 and back, with the mode of
# the step before; G_II / G_I = 2.5.
MIXED = {
    ("bilinear", "benzeggagh-kenane 2"): ((.5, .7646418758813, .327876826541),
                                          (1., 1.79129897571, .5444400556784),
                                          (1.5, 3.206485736211, .7357518984634),
                                          (1., 1.833855826351, .7357518984634),
                                          (.5, 1.010277880435, .7357518984634)),
    ("bilinear", "power law 1.3"): ((.5, .7745329679699, .3394058642068),
                                    (1., 1.833515253619, .5678281732311),
                                    (1.5, 3.28379650961, .7534779959584),
                                    (1., 1.878064002026, .7534779959584),
                                    (.5, 1.034624497475, .7534779959584)),
    ("winkler", "benzeggagh-kenane 2"): ((.5, .792262515403, .2232679641707),
                                         (1., 1.878773094976, .3608165412771),
                                         (1.5, 3.318930453018, .5186433082585),
                                         (1., 1.763215372596, .5186433082585),
                                         (.5, .8297863243428, .5186433082585)),
    ("exponential", "benzeggagh-kenane 2"): ((.5, .747904808009, .3083263003423),
                                             (1., 1.775771205036, .5441201462348),
                                             (1.5, 3.197043994055, .7142335619868),
                                             (1., 1.817704865128, .7142335619868),
                                             (.5, .9901013877722, .7142335619868))}


def check_mixed_mode():
    for (law, mode), rows in MIXED.items():
        k = 500. if (law, mode) == ("bilinear", "benzeggagh-kenane 2") else 100.
        entries = bonds(k, k if k == 500. else .4 * k, .02)
        if law == "winkler":
            entries = bonds(50., 20., .02)
        else:
            entries += ["Law=" + law, "Bond strength=1"]
        steps = [k * .05 for k in range(1, 31)] + [1., .5]
        path = solve(*moved_strips(entries, *NO_HEALING, "Mixed mode=" + mode,
                                   "Shear fracture energy=0.05", steps=steps))["path"]
        check(f"{law}, {mode} has all steps", len(path) == len(steps), path)
        for step, (factor, total, taken) in zip((10, 20, 30, 31, 32), rows):
            at = f"{law}, {mode}, step {step}"
            if len(path) == len(steps):
                close(at + ": total", path[step - 1]["J"], total, 1e-7)
                close(at + ": dissipated", path[step - 1]["dissipated_energy"], taken, 1e-6)
    # Bonds that are led with one and the same mode take the energy of that.
    for mode, energy in (("benzeggagh-kenane 1.7", lambda m: .02 + .03 * m**1.7),
                         ("power law 1.3", lambda m: ((1 - m)**1.3 / .02**1.3
                                                      + m**1.3 / .05**1.3)**(-1 / 1.3))):
        for m in (0., .3, 1.):
            normal, slip = math.sqrt(1 - m), math.sqrt(m / .4)
            path_entries = ["Lengths=2, 1", "Cells=2, 1", "Young modulus=1e7", "Poisson ratio=0",
                            "Clamped boundaries=", NODAL, "Contact boundary=bottom", *NO_HEALING,
                            "Displacement top=" + vector(slip, normal),
                            f"Displacement left=free; {normal!r}",
                            f"Displacement right=free; {normal!r}", *bonds(100., 40., .02),
                            "Law=bilinear", "Bond strength=1", "Mixed mode=" + mode,
                            "Shear fracture energy=0.05"]
            path = solve(*path_entries, "Displacement factors=0.005, 0.02, 0.2")["path"]
            check(f"{mode}, {m} has all steps", len(path) == 3, path)
            close(f"{mode}, {m}: energy", path[-1]["dissipated_energy"] if path else None,
                  2 * energy(m), 1e-4)
            # At once, from rest, on stiff bonds: the mode is that of the step itself.
            path = solve(*path_entries, "Displacement factors=0.2")["path"]
            close(f"{mode}, {m}: energy at once", path[-1]["dissipated_energy"] if path else None,
                  2 * energy(m), 1e-4)
    # With one energy for all modes it is the law without a mode, also where bonds are a field.
    field = moved_strips([BONDED], *NO_HEALING, steps=(.3, .6, 1.))
    field += ["Bond stiffness=if(x > 4, 50, 0)", "Bond shear stiffness=20", "Fracture energy=0.02"]
    compare("one energy", solve(*field, "Mixed mode=benzeggagh-kenane 2",
                                "Shear fracture energy=0.02")["path"], solve(*field)["path"], 1e-12)
    errors = solve(*strips("D10", 1.), "Mixed mode=power law 1",
                   "Shear fracture energy=0.05")["errors"]
    check("a single state is refused", "Contact law/Mixed mode" in errors, errors)


class Six:
    """Bonds of six free numbers in the effective opening at a fixed mode m."""

    def __init__(self, law, mode, eta, criterion, numbers):
        self.numbers = numbers
        self.K, self.Ks, self.N, self.T, self.G1, self.G2 = numbers
        self.law, self.mode, self.eta, self.criterion = law, mode, eta, criterion

    def at(self, m):
        """Strength, energy, end of the spring."""
        parts = (1 - m) / self.N**2, self.Ks / self.K * m / self.T**2
        strength = (sum(parts) if self.criterion == "quadratic" else max(parts))**-.5
        energy = (self.G1 + (self.G2 - self.G1) * m**self.eta if "kenane" in self.mode else
                  (((1 - m) / self.G1)**self.eta + (m / self.G2)**self.eta)**(-1 / self.eta))
        return strength, energy, strength / self.K

    def state(self, m, opening, most):
        """What has been taken, and what is stored."""
        strength, energy, first = self.at(m)
        if most <= first:
            return 0., .5 * self.K * opening**2
        if self.law == "bilinear":
            last = 2 * energy / strength
            traction = max(0., strength * (last - most) / (last - first))
            whole = energy - .5 * traction * max(0., last - most)
        else:
            rest = energy - .5 * strength * first
            traction = strength * math.exp(-strength * (most - first) / rest)
            whole = energy - rest * traction / strength
        return whole - .5 * traction * most, .5 * traction / most * opening**2

    def entries(self, name=""):
        """Of a part of the boundary, or with what holds for all."""
        own = [f"{entry}{name}={number!r}" for entry, number in zip(
            ("Bond stiffness", "Bond shear stiffness", "Bond strength", "Bond shear strength",
             "Fracture energy", "Shear fracture energy"), self.numbers)]
        return own if name else [
            *own, "Bond threshold=", "Law=" + self.law, f"Mixed mode={self.mode} {self.eta!r}",
            "Failure criterion=" + self.criterion, BONDED]


def six_numbers(random, law, mode, criterion):
    """Of which bonds can break: they take more than they have stored, in any mode."""
    while True:
        K, r = random.choice((50., 1e4)), random.uniform(.2, 3)
        N, T = random.uniform(.5, 2), random.uniform(.5, 2)
        bonds = Six(law, mode, random.choice((1., 1.7, 2.5)), criterion, (
            K, K * r, N, T, random.uniform(1.3, 8) * N * N / 2 / K,
            random.uniform(1.3, 8) * T * T / 2 / K / r))
        if all(energy > 1.02 * .5 * strength * first for strength, energy, first in map(
                bonds.at, (.01 * k for k in range(101)))):
            return bonds


def check_six_numbers():
    """At one mode throughout bonds have the strength of the criterion and the energy of the
    mode, whatever else they are made of; here on two parts of the bottom, or by place."""
    random = Random(7)
    for number in range(48):
        law, mode, criterion = (random.choice(choices) for choices in (
            ("bilinear", "exponential"), ("benzeggagh-kenane", "power law"),
            ("quadratic", "largest")))
        here = six_numbers(random, law, mode, criterion)
        weak = six_numbers(random, law, mode, criterion)
        weak.eta = here.eta
        by_place = number % 3 == 0
        if by_place:
            # Numbers in shear are those of a part; one of the others is an expression here.
            weak.numbers = weak.K, weak.Ks, weak.N, weak.T, weak.G1, weak.G2 = (
                here.K, here.Ks, here.N, here.T, here.G1 * 1.07, here.G2)
            entries = [e if not e.startswith("Fracture") else
                       f"Fracture energy=if(x < 1, {weak.G1!r}, {here.G1!r})"
                       for e in here.entries()]
        else:
            entries = [*here.entries(), "Parts/weak=bottom: x < 1", *weak.entries(" weak")]
        slip, normal = random.uniform(0, 1), random.uniform(0, 1)
        if number % 5 == 0:
            slip, normal = (0., 1.) if number % 2 else (1., 0.)
        # Parts of shear and openings at a displacement of 1. The first steps show the modes of
        # both before they soften.
        at_one = []
        for bonds in (here, weak):
            square = normal**2 + bonds.Ks / bonds.K * slip**2
            at_one.append((bonds, 1 - normal**2 / square, square**.5))
        ends = [bonds.at(m)[2] / opening for bonds, m, opening in at_one]
        steps = [*sorted(.3 * end for end in ends), *(max(ends) * random.uniform(.1, 6) for _ in range(6)),
                 1e3 * max(ends)]
        path = solve("Lengths=2, 1", "Cells=2, 1", "Young modulus=1e9", "Poisson ratio=0",
                     "Clamped boundaries=", "Quadrature=gauss 2", "Contact boundary=bottom",
                     "Displacement top=" + vector(slip, normal), *entries,
                     f"Displacement left=free; {normal!r}", f"Displacement right=free; {normal!r}",
                     *NO_HEALING, "Displacement factors=" + ", ".join(map(repr, steps)))
        at = f"{number}, {law}, {mode}, {criterion}"
        check(f"{at} has all steps", len(path["path"]) == len(steps), path["errors"])
        most = 0.
        for row, factor in zip(path["path"], steps):
            most = max(most, factor)
            taken = stored = 0.
            for bonds, m, opening in at_one:
                one, other = bonds.state(m, factor * opening, most * opening)
                taken, stored = taken + one, stored + other
            scale = here.G1 + here.G2 + weak.G1 + weak.G2
            close(f"{at}, {factor}: dissipated", row["dissipated_energy"], taken, 1e-4, scale)
            close(f"{at}, {factor}: J", row["J"], taken + stored, 3e-4, scale + stored)


def check_opening():
    """The glue of a double cantilever only opens, whatever rounding makes of slips ahead of the
    crack: it has its energy without a mode in steps of any length. An arm that is stiffer by a
    hundredth adds little slip."""
    scene = ["Lengths=30, 2", "Cells=60, 4", "Cuts=y = 1", "Parts/upper=left: y > 1",
             "Parts/lower=left: y < 1", "Parts/crack=cut_1: x < 8", "Parts/arm=y > 1",
             "Young modulus=70000", "Poisson ratio=0", "Clamped boundaries=right",
             "Displacement upper=free; 0.5", "Displacement lower=free; -0.5",
             "Contact boundary=cut_1", BONDED, "Bond stiffness=1000",
             "Fracture energy=0.2", *NO_HEALING]
    mixed = ["Shear fracture energy=1", "Mixed mode=benzeggagh-kenane 2"]
    for name, law in (("winkler", ["Bond stiffness crack=0"]),
                      ("bilinear", ["Law=bilinear", "Bond strength=15",
                                    "Traction factor=if(x < 8, 0, 1)"])):
        for modulus, tolerance in ((70000, 1e-9), (70700, 2e-3)):
            stiff = [*law, f"Young modulus arm={modulus}"]
            without = solve(*scene, *stiff, "Displacement factors=1")["path"][-1]
            for steps in "1", "0.2, 1", "0.2:0.2:1", "0.1:0.1:1":
                path = solve(*scene, *stiff, *mixed, "Displacement factors=" + steps)
                at = f"{name}, {modulus}, steps {steps}"
                check(at + ": no note on the mode",
                      not any("mode of bonds" in note for note in path["notes"]))
                for key in "J", "reaction_upper_y":
                    close(f"{at}: {key}", path["path"][-1][key] if path["path"] else None,
                          without[key], tolerance)


# ------------------------------------------------------------------ limits and invariances


def compare(name, path, other, tolerance, scale=1.):
    """Of two load paths, the second one with scale times the energies. The parts of J are flat at
    a minimum of bonds that soften, but for J itself."""
    check(name + " has all steps", len(path) == len(other) > 0, (len(path), len(other)))
    for a, b in zip(path, other):
        for key in "J", "dissipated_energy", "elastic_energy":
            close(f"{name}, step {b['step']:g}: {key}", a[key], scale * b[key],
                  tolerance if key == "J" else math.sqrt(tolerance), scale * other[-1]["J"])


def check_limits():
    scenes.section("Limits")
    solid = ["Dimension=3", "Lengths=10, 4, 2", "Cells=5, 4, 1", "Cuts=y = 2",
             "Parts/tl=left: y > 3", "Parts/bl=left: y < 1", "Young modulus=1000", *STRIPS[-4:],
             "Displacement tl=0.05; 0.1; 0.02", "Displacement bl=free; -0.1; free"]
    law = [e for e in LAW if "shear" not in e and e != BONDED]
    for name, scene in (("D20", [e for e in strips("D20", .6) if e not in LAW]),
                        ("FD20", [e for e in strips("FD20", .6) if e not in LAW]),
                        ("degree 2", [*(e for e in strips("D10", .6) if e not in LAW), *DEGREE_2]),
                        ("3D", solid)):
        both = [solve(*scene, *law, TANGENTIAL + "free", FROM_REST),
                solve(*scene, *bonds(50., 0., .02), FROM_REST)]
        close(name + ", without shear stiffness", both[1]["functional"], both[0]["functional"],
              1e-9)
        check(name + ", broken", broken(both[0]) == broken(both[1]) > 0)
        check(name + ": slip without force", max(
            abs(row["tangential_force_x"]) for row in both[1]["profile"]) < 1e-9 * max(
                abs(row["normal_force"]) for row in both[1]["profile"]))
        fixed = solve(*scene, *bonds(50., 20., .02)[1:3], "Fracture energy=100",
                      TANGENTIAL + "fixed", FROM_REST)["functional"]
        last = None
        for kt in (1e5, 1e7, 1e9):
            off = 1 - solve(*scene, *bonds(50., kt, 100.), FROM_REST)["functional"] / fixed
            check(f"{name}, fixed but for 1 / {kt}", 0 < off < 1e4 / kt, off)
            check(f"{name}, {kt}: in proportion", last is None or abs(last / off / 100 - 1) < .1,
                  (last, off))
            last = off


def check_invariances():
    scenes.section("Invariances")
    both = ["Displacement tl=0.2; 1", "Displacement bl=-0.1; -0.2"]
    plain = [*(e for e in moved_strips([]) if e[:15] not in ("Displacement tl", "Displacement bl")),
             *NO_HEALING]
    for name, law in (("common", LAW), ("separate", [*LAW, *SEPARATE]), ("bilinear", BILINEAR)):
        other = solve(*plain, *both, *law)["path"]
        tolerance = 1e-7 if name == "bilinear" else 1e-10
        for degrees in (37, 180, -90):
            c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            moved = [f"Displacement {side}=" + vector(c * x - s * y, s * x + c * y)
                     for side, x, y in (("tl", .2, 1.), ("bl", -.1, -.2))]
            compare(f"{name}, turned by {degrees}", solve(
                *(turned(e, degrees) if e.startswith("Parts") else e for e in plain), *law, *moved,
                f"Rotation={degrees}")["path"], other, tolerance)
        # The bodies exchanged: what was above is below.
        compare(name + ", mirrored", solve(
            *(e for e in plain if "Young" not in e), *law, "Young modulus=1000",
            "Young modulus upper=2000", "Displacement tl=-0.1; 0.2",
            "Displacement bl=0.2; -1")["path"], other, tolerance)
        # The steps of multigrid are inexact, and may break another bond in a cascade of many.
        for solver in ("Linear solver=multigrid", "Method=energy bundle"):
            n = 3 if name == "separate" else len(STEPS)
            compare(f"{name}, {solver}", solve(*plain, *both, *law, solver)["path"][:n],
                    other[:n], max(tolerance, 1e-8))
        # In metres and pascal, energies by thickness stay.
        factors = {"Lengths": 1e-3, "modulus": 1e6, "stiffness": 1e9, "energy": 1e3,
                   "Bond strength": 1e6}
        metres = []
        for entry in [*plain, *law]:
            key, value = entry.split("=", 1)
            for word, factor in factors.items():
                if word in key and value:
                    value = ", ".join(repr(float(x) * factor) for x in value.split(","))
            metres.append(f"{key}={value}")
        metres += ["Cuts=y = 0.002", "Parts/upper=y > 0.002", "Parts/tl=left: y > 0.003",
                   "Parts/bl=left: y < 0.001", "Parts/end=left: y > 0.002",
                   "Displacement tl=2e-4; 1e-3", "Displacement bl=-1e-4; -2e-4"]
        compare(name + ", m and Pa", solve(*metres)["path"], other, tolerance)

    # One cell in z that does not move along it is the plane body in plane strain. Crossed cells
    # of 24 tetrahedra are not those of four triangles: homogeneous states alone are the same.
    for sigma in (.3, -.3):
        scene, area, *_ = column(1000., .3, sigma, (.2,), 2, "plane strain")
        flat = solve(*scene, *LAW, NODAL, FROM_REST)
        solid = ["Dimension=3", "Lengths=3, 2, 1", "Cells=3, 2, 1",
                 *(e + "; 0" if "Traction" in e else e for e in scene[3:] if "Hypo" not in e),
                 "Roller boundaries=back, front"]
        solid = solve(*solid, *LAW, NODAL, FROM_REST)
        close(f"plane strain in 3D, {sigma}", solid["functional"], flat["functional"], 1e-10)
        check(f"both hold, {sigma}", flat["status"] == solid["status"] == "success")

    # Half of twice as much: a second strip below, mirrored, takes away slip but no opening.
    up, down = (vector(0, x) for x in (.5, -.5))
    two = solve(*plain, *LAW, "Young modulus=1000", "Displacement tl=" + up,
                "Displacement bl=" + down)["path"]
    half = solve(*FOUNDATION, *bonds(100., 1., .01), TANGENTIAL + "free", *NO_HEALING,
                 "Bond shear stiffness=", "Displacement tl=" + up,
                 "Displacement factors=" + ", ".join(map(repr, STEPS)))["path"]
    compare("twice the half", two, half, 1e-10, 2.)


def scaled(entries, L, E):
    """The entries in other units of length and of stress, with constants for both."""
    units = {"Lengths": "L", "Young modulus": "E", "Displacement": "L", "Traction": "E",
             "stiffness": "E/L", "threshold": "L", "strength": "E", "energy": "E*L"}
    result = [f"Constants/L={L!r}", f"Constants/E={E!r}"]
    for entry in entries:
        key, value = entry.split("=", 1)
        unit = next((unit for word, unit in units.items()
                     if word in key and "factors" not in key), None)
        if unit and value:
            separator = "; " if ";" in value else ", "
            value = separator.join(part if part.strip() == "free" else f"({part})*{unit}"
                                   for part in value.split(separator.strip()))
            value = value.replace("x", "(x/L)")
        elif "Parts" in key or "Cuts" in key:
            value = value.replace("y", "y/L") if "Cuts" not in key else value + "*L"
        elif "Curve" in key:
            value = ", ".join("{}*L:{}*E".format(*point.split(":")) for point in value.split(","))
        result.append(f"{key}={value}")
    return result


def check_nothing_left():
    """Through the unloaded state, and to the end of all bonds: where nothing acts forces are
    rounding, and J is what bonds have taken. In three units."""
    bottom = "Contact boundary=bottom"
    free = "Clamped boundaries="
    cases = {"separate": ["Lengths=12, 1.5", "Cells=3, 2", "Young modulus=2152",
                          "Poisson ratio=0.201", bottom, BONDED, "Clamped boundaries=right",
                          "Traction top=-0.2685; 0.9248*(1-0.02*x)",
                          "Bond stiffness=13870*(1+0.018*x)", "Bond threshold=0.0012",
                          "Bond failure=separate", "Bond shear stiffness=14100",
                          "Shear fracture energy=0.02528", "Quadrature=midpoint",
                          "Factors=0.58, 0, 0.08, 0.39, -0.47, 0, -0.38, 0, 0.29, 1, 1.2, 0"],
             "two bodies": ["Lengths=3.18, 1.685", "Cells=2, 2", "Cuts=y = 0.8425",
                            "Parts/end=left: y > 0.8425", "Young modulus=173.8",
                            "Poisson ratio=0.3", BONDED, "Clamped boundaries=bottom, end",
                            "Contact boundary=cut_1", "Traction top=-0.3946; 1.813*(1+0.049*x)",
                            "Bond stiffness=401.7*(1+0.039*x)", "Bond threshold=0.006518",
                            "Quadrature=gauss 2", "Bond shear stiffness=245",
                            "Factors=0.14, 0.23, 0, 0.1, 0.45, 0.41, 0, -0.36, 0, 1, 4, 0"],
             "rigid at first": ["Lengths=6.7, 4.1", "Cells=8, 2", "Young modulus=1483",
                                "Poisson ratio=0.33", bottom, free, TANGENTIAL + "fixed",
                                "Displacement top=0.05; 0", "Law=curve",
                                "Curve=0:21.35, 0.0037:22.48, 0.0111:22.23, 0.0185:0",
                                "Displacement factors=0.34, 0.88, -0.34, 0, 0.36, 0, 3, 0"],
             "slid off": ["Lengths=5, 10", "Cells=10, 2", "Young modulus=100", "Poisson ratio=0",
                          free, BONDED, "Contact boundary=left", "Displacement right=0; -0.62",
                          "Displacement bottom=0; free", "Displacement top=0; free", "Law=bilinear",
                          "Bond stiffness=30000", "Bond strength=3", "Fracture energy=0.9",
                          "Displacement factors=1, 8, 0"]}
    for name, entries in cases.items():
        factor = "displacement_factor" if "Displacement" in entries[-1] else "factor"
        for L, E in ((1., 1.), (1e-3, 1e6), (1e3, 1e-3)):
            at = f"{name}, {L}"
            result = solve(*scaled(entries, L, E), *NO_HEALING)
            check(at + " succeeds", result["status"] == "success", result["errors"])
            unit = E * L**2
            for row in result["path"]:
                if row[factor] == 0. or name == "slid off":
                    close(f"{at}, {row['step']:g}: J", row["J"], row["dissipated_energy"], 1e-9,
                          unit * 1e-3)
            if name == "slid off":
                close(at + ": all is taken", result["path"][-1]["J"], 9 * unit, 1e-9)


scenes.all_of(globals())
