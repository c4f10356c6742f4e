#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_assembly.py DEBOND [SEED [COUNT]]: bodies whose meshes do not match, beside a program of
its own: numbers of an earlier one, homogeneous states, matching meshes beside cuts, random pairs,
the order of the error."""
import math
import os
import pathlib
import sys
from random import Random

# Threads take longer than products of such a size.
os.environ["OPENBLAS_NUM_THREADS"] = "1"
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from assemblies import Body, Law, Problem, spaced, write
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
check, close = scenes.check, scenes.close
SEED, COUNT = (int(x) for x in (sys.argv[2:4] + ["1", "40"][len(sys.argv[2:4]):]))
QUADRATIC = ["Degree=2", "Quadrature=gauss 3"]
JOINT, DEAD = ("up_bottom", "lo_top"), "Search=none"


def solve(problem, *more):
    entries = problem.entries(scenes.directory) if isinstance(problem, Problem) else [problem]
    return scenes.solve(*entries, *more)


def compare(name, problem, result, random, tolerance=1e-9):
    """J of the program's jumps, the least J, what supports bear. Whether J is the least one."""
    if result["status"] == "comes off" or "is not across all of" in result["errors"]:
        return False
    check(name + ": success", result["status"] == "success", result["errors"])
    if result["status"] != "success":
        return False
    problem.close_curves()
    problem.condense()
    dim, places = problem.dim, {tuple(problem.points[bond.where].round(7) + 0.): k
                                for k, bond in enumerate(problem.bonds)}
    x, missing = np.zeros((len(places), dim)), set(places)
    for row in result["profile"]:
        place = tuple(round(row[axis], 7) + 0. for axis in "xyz"[:dim])
        if place in missing:
            missing.remove(place)
            slip = [row.get("slip_" + axis, 0.) for axis in "xyz"[:dim]]
            x[places[place]] = row["u_nu"], *problem.frames[places[place]][1:] @ slip
    if dim == 3 and np.ptp([frame[0] for frame in problem.frames], axis=0).max() > 1e-9:
        tolerance = 1e-5  # along the normals of facets, ends of bent sides leave slivers
    check(name + ": nodes", not missing, missing)
    if missing:
        return False
    x = np.concatenate([x[:, 0], x[:, 1:].ravel()])[:len(problem.g)]
    J, size, word = result["functional"], abs(problem.terms(x)).sum(), result["minimum"]["state"]
    close(name + ": J of its jumps", J, problem.J(x), tolerance, size)
    own = min(map(problem.J, problem.candidates(random)), default=math.inf)
    check(name + ": least", word != "global" or own >= J - tolerance * size, (J, own))
    forces, noise = problem.reactions(x), abs(problem.S).max() * abs(x).max()
    scale = max(np.abs(forces).max(), abs(problem.f).sum(), 1e-2 * noise)
    check(name + ": balance", result["force_imbalance"] < 1e-9 or np.abs(forces).max()
          < 1e-9 * noise, result["force_imbalance"])
    for body, force in zip(problem.bodies, forces):
        theirs = sum((np.array(r) for side, r in result["reactions"].items()
                      if side.startswith(body.name + "_")), np.zeros(dim))
        # The axis is no support with a name.
        check(f"{name}: supports of {body.name}", abs(theirs - force)[
            problem.is_axis:].max() <= 100 * tolerance * scale, (theirs, force))
    return word == "global"


# ------------------------------------------------------------------ checks


def strips(na, nb, random=(None, None), to=lambda p: p, L=40., start=0., thick=2., ny=2):
    """Above and below y = 0."""
    return [Body(name, [spaced(L, n, r, start), spaced(thick, ny, None, y)], E, .3, None, to, away)
            for name, n, r, y, E, away in (("up", na, random[0], 0., 1000., 1),
                                           ("lo", nb, random[1], -thick, 2000., -1))]


# J of a program of another's, from rest, at these factors.
PEELED = {("up", "winkler"): (2.97730149541e-01, 9.07835382513e-01, 1.76733841824, 3.24221991695),
          ("up", "bilinear"): (2.76061345692e-01, 8.35999379117e-01, 1.64164313550, 3.05386131481),
          ("lo", "winkler"): (2.76735809276e-01, 8.45051534292e-01, 1.68769493219, 3.09220604437),
          ("lo", "bilinear"): (2.78154187823e-01, 8.37855084429e-01, 1.64380883842, 3.05588474110)}


def check_peeled_strips():
    for (slave, kind), row in PEELED.items():
        law = Law(50., .0282842712474619) if kind == "winkler" else Law(100., .01, 1., .02)
        for factor, J in zip((.2, .6, 1., 1.5), row):
            problem = Problem(strips(20, 33), [JOINT if slave == "up" else JOINT[::-1]], {
                "up_right": (0., 0.), "lo_right": (0., 0.), "up_tip": (.2 * factor, factor),
                "lo_tip": (None, -.2 * factor)}, {}, [law]).condense()
            name = f"{slave}, {kind}, {factor}"
            close(name + ", own", problem.J(problem.descend()), J, 1e-10)
            close(name, solve(problem, DEAD).get("functional"), J, 1e-10)


def check_rings():
    """J without bounds by another program, and with bounds."""
    for na, nb, slave, J in ((12, 12, "up", -6.966522622997e-03),
                             (12, 18, "up", -6.961214770569e-03),
                             (12, 18, "lo", -6.965676529024e-03),
                             (18, 12, "up", -6.972436071760e-03)):
        bodies = [Body(name, [spaced(math.pi / 2, n), spaced(1., 4, None, r)], 1000., .3, None,
                       lambda p: p[1] * np.array([math.cos(p[0]), math.sin(p[0])]))
                  for name, n, r in (("up", na, 2.), ("lo", nb, 1.))]
        problem = Problem(bodies, [JOINT if slave == "up" else JOINT[::-1]], {"up_top": (0., 0.)},
                          {"lo_left": (0., -1.)}, [Law(50., 1e3, .4)], "bonded").condense()
        w = [bond.branches[0][0] for bond in problem.bonds]
        free = np.linalg.solve(problem.S + np.diag([*w, *(.4 * x for x in w)]), problem.g)
        name = f"{na}, {nb}, {slave}"
        close(name + ", own", problem.J(free), J, 1e-10)
        compare(name, problem, solve(problem, DEAD), Random(1), 1e-10)


def homogeneous(name, bodies, area, *more, turn=None, symmetry=""):
    """Pulled, pressed and sheared: all jumps, and J."""
    dim, law = bodies[0].dim, Law(50., 1., .4)
    turn = np.eye(dim) if turn is None else turn
    along, up = turn[:, 0], turn[:, -1]
    soft = sum(body.height / body.E for body in bodies)
    sides = [f"{b.name}_{side}" for b in bodies for side in b.sides]
    # Held along the interface on it or away from it, or by shear.
    cases = [(1., "free", (kind, "_front", "lo_bottom")) for kind in ("_right", "_tip")[:4 - dim]]
    cases += [(-1., "free", cases[0][2]), (0., "bonded", ())]
    for pull, tangential, rollers in cases if symmetry == "" else [(1., "free", ("lo_bottom",))]:
        if pull:
            supports, loads = {}, {"up_top": pull * up}
            J, s = -area / 2 * (soft + (pull > 0) / 50.), -max(pull, 0.) / 50.
        else:
            supports, loads = {"lo_bottom": [0.] * dim}, {"up_top": along, **{
                side: up * (1 if "right" in side else -1) for side in sides
                if side.endswith(("left", "tip", "right"))}}
            J, s = -area / 2 * (2.6 * soft + 1 / 20.), 0.
        held = ", ".join(side for side in sides if side.endswith(rollers))
        result = solve(Problem(bodies, [JOINT], supports, loads, [law], tangential, symmetry),
                       *more, DEAD, "Roller boundaries=" + held)
        case = f"{name}, {pull}, {rollers[:1]}"
        check(case, result["status"] == "success", result["errors"])
        close(case + ": J", result.get("functional"), J, 1e-10)
        jumps = [(row["u_nu"], math.hypot(*(row[key] for key in row if key.startswith("slip_"))))
                 for row in result["profile"] if row["state"] != "held"]
        slip = 0. if pull else 1 / 20.
        check(case + ": jumps", jumps and max(abs(x - s) + abs(t - slip) for x, t in jumps)
              < 1e-12, (s, slip, jumps))


def check_homogeneous():
    for na, nb, is_graded, degrees, more in (
            (20, 33, 0, 0, ()), (33, 20, 0, 37, ()), (5, 80, 0, 0, ()), (80, 5, 0, 0, ()),
            (20, 33, 1, 37, ()), (5, 80, 1, 37, ()), (80, 5, 1, 37, ()),
            (20, 33, 0, 0, QUADRATIC), (33, 20, 1, 37, QUADRATIC), (5, 80, 1, 37, QUADRATIC)):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        turn = np.array([[c, -s], [s, c]])
        random = [Random(k) if is_graded else None for k in (1, 2)]
        homogeneous(f"{na}/{nb}, {is_graded}, {degrees}, {more[:1]}", strips(
            na, nb, random, lambda p: turn @ p), 40., *more, turn=turn)
    rollers = [f"{body}_{side}" for body in ("up", "lo") for side in ("left", "tip", "right")]
    result = solve(Problem(strips(20, 33), [JOINT], {}, {"up_top": (0., 1.)}, [
        Law(50., 1.)]), DEAD, "Roller boundaries=lo_bottom, " + ", ".join(rollers))
    close("held at both ends", result.get("functional"), -.4546, 1e-10)
    for na, nb, start in ((5, 8, 1.), (8, 5, 1.), (3, 7, 0.), (7, 3, 0.)):
        bodies = strips(na, nb, [Random(1), Random(2)], L=2., start=start)
        homogeneous(f"of revolution {na}/{nb}, {start}", bodies,
                    math.pi * ((start + 2)**2 - start**2), symmetry="axis")
    for na, nb in (((4, 4, 2), (5, 6, 2)), ((6, 5, 2), (4, 4, 2)), ((2, 3, 1), (7, 5, 2))):
        homogeneous(f"solids {na}, {nb}", [Body(
            name, [spaced(1., n[0]), spaced(1., n[1]), spaced(.5, n[2], None, z)], E, .3,
            Random(name)) for name, n, z, E in (("up", na, 0., 1000.), ("lo", nb, -.5, 2000.))], 1.)


def random_law(random, E, size):
    k, M = E * 10**random.uniform(-2, .5), size * 10**random.uniform(-1.5, .5)
    return Law(k, M, random.uniform(.2, 2.), k * M * M / 2 * random.uniform(1.5, 8.)
               if random.random() < .4 else None)


def check_matching_meshes():
    """As one mesh that is cut."""
    for case in range(16):
        random, dim, is_axis = Random(case), 3 if case % 4 == 3 else 2, case % 4 == 2
        E, bend, seed = 10**random.uniform(1, 4), random.uniform(-.3, .3), random.random()
        n = [random.randint(2, 8 if dim == 2 else 3) for _ in range(dim - 1)] + [2]
        axes = [spaced(random.uniform(1., 4.), m, random, (1 + case % 3) * is_axis * (d == 0))
                for d, m in enumerate(n)]
        upward = np.array([0.] * (dim - 1) + [1.])
        bodies = [Body(name, axes, e, random.uniform(0., .4), Random(seed), lambda p, e=e: (
            p * (1 - 2 * upward * (e == E)) + upward * bend * math.sin(p[0])), 1)
                  for name, e in (("up", 2 * E), ("lo", E))]
        tangential = random.choice(["free", "fixed", "bonded"])
        problem = Problem(bodies, [("up_bottom", "lo_bottom")], {
            "lo_top": 0. * upward, "up_top": [0. if tangential == "free" else None] * (dim - 1) + [
                random.uniform(-.01, .02)]}, {"up_right": E * random.uniform(-.003, .01) * upward},
                          [random_law(random, E, .01)], tangential, "axis" * is_axis)
        more = [DEAD, *(QUADRATIC if case % 3 == 1 else [])]
        first, second = solve(problem, *more), solve(
            problem, *write(scenes.directory, bodies, True), "Mesh/Interfaces=", "Cuts=lo | up",
            "Contact boundary=cut_1", *more)
        name = f"{case}, {dim}, {tangential}"
        check(name, first["status"] == second["status"] == "success", (
            first["errors"], second["errors"]))
        close(name, first.get("functional"), second.get("functional", math.nan), 1e-11)


def random_problem(random):
    """Two or three bodies, bent or turned, of revolution or solids."""
    dim = random.choice([2, 2, 2, 3])
    is_axis, n_bodies = dim == 2 and random.random() < .2, 3 if random.random() < .2 else 2
    L, E, size = random.uniform(1., 5.), 10**random.uniform(0, 4), 10**random.uniform(-4, -2)
    start = random.choice([0., random.uniform(.3, 2.)]) * is_axis
    bend, angle = (random.choice([0., random.uniform(-.03, .03) * L]) * (not is_axis),
                   random.choice([0., random.uniform(0., 6.)]) * (dim == 2 and not is_axis))
    c, s, y, bodies = math.cos(angle), math.sin(angle), 0., []
    is_longer = n_bodies == 2 and random.random() < .2

    def to(p):
        p = p + np.array([0.] * (dim - 1) + [bend * math.sin(2 * p[0] / L)])
        return np.array([[c, -s], [s, c]]) @ p if dim == 2 else p
    for k in range(n_bodies):
        n = random.randint(3 if bend else 2, 4 if dim == 3 else 9)
        axes = [spaced(L * (1 + .2 * (k and is_longer)), n, random, start),
                *([spaced(1., random.randint(1, 3), random)] * (dim == 3))]
        height = random.uniform(.3, 1.5)
        y -= height
        bodies.append(Body(f"b{k}", [*axes, spaced(height, random.randint(1, 4 - dim), random, y)],
                           E * 10**random.uniform(-.5, .5), random.uniform(0, .45), random, to,
                           1 if k == 0 else -1 if k == n_bodies - 1 else 0))
    joints = [(f"b{k}_bottom", f"b{k + 1}_top") for k in range(n_bodies - 1)]
    joints = [joint[::random.choice([1, 1, -1])] for joint in joints]
    tangential = random.choice(["free", "fixed", "bonded"])
    laws = [random_law(random, E, size)] * len(joints)
    if random.random() < .15 and tangential != "bonded":
        laws = [Law()] * len(joints)
    elif random.random() < .5 and not laws[0].softens:
        laws[-1] = Law(laws[0].k * 2., laws[0].polygon[1][0] / 2, .7)
    u, low = [size * random.uniform(-1., 1.) for _ in range(dim)], f"b{n_bodies - 1}_"
    loads, supports, rest = {}, {low + "bottom": [0.] * dim}, [None] * (dim - 1)
    kind = random.choice(["clamped", "rollers", "bonds"])
    if kind == "clamped" and start == 0. != is_axis:
        supports["b0_top"] = [*rest, abs(u[1])]
    elif kind == "clamped" or n_bodies == 3 and tangential == "free":
        supports = {f"b{k}_right": [0.] * dim for k in range(n_bodies)}
        supports.update({"b0_tip": [random.choice([None, u[0]]), *rest[1:], abs(u[-1])],
                         low + "tip": [*rest, -u[0]]})
    elif kind == "rollers" or tangential == "free":
        supports["b0_top"] = [0., *u[1:-1], random.choice([u[-1], abs(u[-1])])]
        supports.update({f"b0_{side}": [0., *rest] for side in ("left", "tip", "right")
                         if random.random() < .5})
        loads["b0_left"] = [0.] * (dim - 1) + [E * abs(u[-1]) * random.uniform(.01, .5)]
    elif laws[0].k:
        loads["b0_right"] = [E * x * random.uniform(.01, .3) for x in u]
    if not laws[0].k or random.random() < .4:
        loads["b0_top"] = [*(E * .1 * x * bool(laws[0].k) for x in u[:-1]),
                           -E * abs(u[-1]) * .1 * (random.uniform(-1., 1.) if laws[0].k else 1.)]
    held = {f"{body.name}_{side}" for body in bodies for side in body.sides
            if not is_axis or start or side not in ("left", "tip")}
    return Problem(bodies, joints, {k: u for k, u in supports.items() if k in held}, {
        k: t for k, t in loads.items() if k in held and k not in supports}, laws,
                   tangential, "axis" * is_axis, random.choice(["plane stress", "plane strain"]))


def check_random_pairs():
    n_global = 0
    for case in range(COUNT):
        random = Random(f"{SEED} {case}")
        problem = random_problem(random)
        n_global += compare(f"{SEED} {case}", problem, solve(problem), random)
    check("global", n_global >= COUNT / 4, n_global)


def check_order():
    """Half the size of cells, a quarter of the error."""
    more = ["Bond stiffness=1e5", "Bond threshold=1", "Tangential displacement=free", DEAD]
    load = "0; cos(3.141592653589793 * x) + 2"
    exact = solve(*more, "Lengths=1, 2", "Cells=24, 48", "Cuts=y = 1", *QUADRATIC,
                  "Parts/upper=y > 1", "Young modulus=2000", "Young modulus upper=1000",
                  "Poisson ratio=0.3", "Clamped boundaries=", "Contact boundary=cut_1",
                  "Roller boundaries=left, right, bottom", "Traction top=" + load)["functional"]
    for na, nb in ((1, 1), (2, 3), (3, 2), (1, 4)):
        errors = []
        for m in (4, 8, 16):
            rollers = ", ".join(f"{body}_{side}" for body in ("up", "lo") for side in (
                "left", "tip", "right"))
            result = solve(Problem(strips(na * m, nb * m, L=1., thick=1., ny=2 * m), [JOINT],
                                   {}, {}, [Law(1e5)]), *more, "Traction up_top=" + load,
                           "Roller boundaries=lo_bottom, " + rollers)
            errors.append(abs(result.get("functional", math.nan) / exact - 1))
        check(f"{na}:{nb}", errors[0] > 3 * errors[1] > 9 * errors[2], errors)


scenes.all_of(globals())
