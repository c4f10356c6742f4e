#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_cookbook.py DEBOND DIRECTORY: the scenes of the cookbook against closed
forms (doc/cookbook/). Of errors on three meshes the one on the finest is within a
bound, and each less than on the mesh before.
"""

import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes, DIRECTORY = Scenes(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
check, close = scenes.check, scenes.close


def solve(name, *settings):
    return scenes.solve(*settings, scene=DIRECTORY / (name + ".prm"))


def path_of(name, *settings):
    """The rows of its load path, without what is empty; of fronts x of the first one."""
    return [{title: float(str(value).split()[0]) for title, value in row.items()
             if title not in ("status", "minimum") and value != ""}
            for row in solve(name, *settings)["path"]]


def within(name, exact, value, bound):
    close(name, value, exact, bound)


def compare(name, exact, values, bound):
    """Of coarse meshes to fine ones."""
    errors = [abs(value / exact - 1.) for value in values]
    check(name, errors[-1] <= bound and errors == sorted(errors, reverse=True), (exact, values))


def first_break(rows):
    """The first factor after which bonds that do not heal are broken."""
    return next(row["factor"] for row in rows if row["dissipated_energy"] > 0.)


def ring():
    """J by Lame's solution u = A r + B / r with an elastic rim."""
    E, nu, pull, inner, outer, a = 1000., 0.3, 2., 10., 20., 50.
    c = E / (1. - nu * nu)
    rows = [[c * (1. + nu), -c * (1. - nu) / inner**2],
            [c * (1. + nu) + a * outer, -c * (1. - nu) / outer**2 + a / outer]]
    det = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]
    A, B = pull * rows[1][1] / det, -pull * rows[1][0] / det
    u = A * inner + B / inner
    return 0.5 * pull * u * 2. * math.pi * inner / 4.


def root(function, low, high):
    """Where it changes its sign, by bisection."""
    for _ in range(100):
        middle = 0.5 * (low + high)
        if function(low) * function(middle) <= 0.:
            high = middle
        else:
            low = middle
    return 0.5 * (low + high)


def held_beam(EI, k, a):
    """The deflections of the end and of the crack's tip for a force of 1 at the end: a
    cantilever of length a whose end is a beam that bonds hold where they are
    stretched, and that lies on the foundation beyond. There w = w' = w'' = 0, so that
    w = C (sin t cosh t - cos t sinh t), t being the rate times the distance."""
    rate = (k / (4. * EI))**0.25

    def curvature(t):
        return math.cos(t) * math.sinh(t) + math.sin(t) * math.cosh(t)

    t = root(lambda t: 2. * rate * a * math.cos(t) * math.cosh(t) + curvature(t),
             0.5 * math.pi, math.pi)
    C = a / (2. * EI * rate**2 * curvature(t))
    w = C * (math.sin(t) * math.cosh(t) - math.cos(t) * math.sinh(t))
    slope = 2. * C * rate * math.sin(t) * math.sinh(t)
    return w + slope * a + a**3 / (3. * EI), w


def running_crack(EI, k, threshold, lift, first, last):
    """Force and length of a crack that has run from `first` to where its tip is at
    the threshold there, a function of its place."""
    def excess(a):
        end, tip = held_beam(EI, k, a)
        return end * threshold(a) / tip - lift

    a = root(excess, first, last)
    return lift / held_beam(EI, k, a)[0], a


def blister():
    """The deflection of the middle by pressure before bonds break, and the pressure
    that breaks the first: as `held_beam`, with the force p a at the tip and
    w = w_0 + B x^2 / 2 + p x^4 / (24 D) before it. The deflection has that of shear,
    p a^2 / (2 kappa G h) with kappa = 5/6."""
    E, nu, h, a, k, energy = 70000., 0.3, 1., 20., 2000., 0.001
    D = E * h**3 / (12. * (1. - nu * nu))
    shear = E / (2. * (1. + nu)) * 5. / 6.
    rate = (k / (4. * D))**0.25

    def at_tip(t):
        C = -a / (4. * D * rate**3 * math.cos(t) * math.cosh(t))
        w = C * (math.sin(t) * math.cosh(t) - math.cos(t) * math.sinh(t))
        slope = 2. * C * rate * math.sin(t) * math.sinh(t)
        B = 2. * C * rate**2 * (math.cos(t) * math.sinh(t) +
                                math.sin(t) * math.cosh(t)) - a**2 / (2. * D)
        return w, slope, B

    def mismatch(t):
        _, slope, B = at_tip(t)
        return slope + B * a + a**3 / (6. * D)

    w, _, B = at_tip(root(mismatch, 0.5 * math.pi + 1e-9, math.pi))
    middle = w - B * a**2 / 2. - a**4 / (24. * D)
    return (middle + a**2 / (2. * shear * h), math.sqrt(2. * energy / k) / w)


def bimaterial():
    """Minus the opening at the free end, by Timoshenko's curvature."""
    E1, E2, t1, t2, difference, length, k = 2e5, 7e4, 1., 1., 2e-4, 40., 1000.
    m, n, h = t1 / t2, E1 / E2, t1 + t2
    curvature = 6. * difference * (1. + m)**2 / (
        h * (3. * (1. + m)**2 + (1. + m * n) * (m * m + 1. / (m * n))))
    y1, y2 = 0.5 * t1, t1 + 0.5 * t2
    y0 = (E1 * t1 * y1 + E2 * t2 * y2) / (E1 * t1 + E2 * t2)
    EI = (E1 * t1 * (t1**2 / 12. + (y1 - y0)**2) + E2 * t2 * (t2**2 / 12. + (y2 - y0)**2))
    rate = (k / (4. * EI))**0.25
    return -curvature * (0.5 * length**2 + math.tanh(0.5 * math.pi) * length / rate + 0.5 / rate**2)


def crack_couple():
    """The moment at which a beam of the cookbook's strips comes off."""
    E, h, k, M = 70000., 2., 200., 0.02
    return math.sqrt(k * M**2 * E * h**3 / 12.)


def lap_joint(t, L):
    """By Volkersen, with the shear of the strips in the stiffness of the glue: what the
    glue bears at both ends for a force of 1, and how far the ends come apart."""
    E, k = 70000., 1. / (1. / 100. + (2. + t) / (3. * 35000.))
    A, B = 1. / (2. * E), 1. / (t * E)
    w = math.sqrt(k * (A + B))
    c, s = math.cosh(w * L), math.sinh(w * L)
    ends = [w * (X * c + Y) / ((A + B) * s) for X, Y in ((A, B), (B, A))]
    # The force of the lower strip is (1 - n) (1 - cosh) + (n + (1 - n) cosh wL) sinh / s.
    n = B / (A + B)
    return ends, ends[0] / k + B * ((1. - n) * (L - s / w) +
                                    (n + (1. - n) * c) * (c - 1.) / (w * s))


def lap_joint_path(lift):
    """The force on strips of 200 mm whose glue breaks where it bears 2.83 MPa."""
    strength = math.sqrt(2. * 100. * 0.04)

    def state(bonded):
        ends, stretch = lap_joint(2., bonded)
        force = strength / ends[0]
        return force, force * (stretch + (200. - bonded) / 140000.)

    if lift < state(200.)[1]:
        return lift / lap_joint(2., 200.)[1]
    return state(root(lambda bonded: state(bonded)[1] - lift, 85., 200.))[0]


def end_loaded_split(a):
    """The slip at the tip of a crack of length a and the deflection of the end for a
    force of 1: arms as beams, whose deflections are equal."""
    E, h, L, k = 70000., 2., 160., 100.
    w = math.sqrt(8. * k / (E * h))
    c, s = math.cosh(w * (L - a)), math.sinh(w * (L - a))
    A = (a + s / w) / c
    moment = (A * (w * a * s + c - 1.) + L - a * c - s / w) / w**2
    return 3. / (4. * h * k) * (1. + A * w * s - c), (
        (L**3 + 3. * a**3 + 9. * moment) / (2. * E * h**3) +
        1.2 * L / (E / 2. * 2. * h))


for n in 8, 16, 32:
    subprocess.run(["gmsh", "-2", "-format", "msh41", "-setnumber", "n", str(n),
                    DIRECTORY / "ring.geo", "-o", scenes.directory / f"ring-{n}.msh"],
                   check=True, stdout=subprocess.DEVNULL)
compare("ring, J", ring(), [solve("ring", f"File={scenes.directory}/ring-{n}.msh")["functional"]
                            for n in (8, 16, 32)], 5e-4)
EI = 70000. * 2.**3 / 12.
compare("double cantilever, force", 0.5 / held_beam(EI, 200., 60.)[0],
        [solve("double-cantilever", "Cells=" + cells, "Search=none")["reactions"]["left"][1]
         for cells in ("160, 2", "320, 4", "640, 8")], 0.02)
compare("bimaterial strip, opening", bimaterial(),
        [solve("bimaterial-strip", "Cells=" + cells, "Search=none")["profile"][-1]["u_nu"]
         for cells in ("100, 2", "200, 4", "400, 8")], 0.02)
# The moment is the work on what is prescribed, by the angle. Not the growth
# of J: bonds that snap set energy free.
plateau, energies = [], []
for cells in "160, 2", "320, 4", "640, 8":
    rows = path_of("peel", "Cells=" + cells)
    half = rows[len(rows) // 2:]
    first, last = half[0], half[-1]
    moments = [1e3 * row["unit_displacement_work"] for row in half]
    plateau.append(sum(moments) / len(moments))
    # What is stored is a parabola in the angle while no bond breaks.
    for row, moment in zip(half, moments):
        stored = row["J"] - row["dissipated_energy"]
        angle = 1e-3 * row["displacement_factor"]
        close("peel, moment and energy", 2. * stored / angle, moment, 1e-8)
    growth = (last["J"] - first["J"]) / (1e-3 * (
        last["displacement_factor"] - first["displacement_factor"]))
    check("peel, energy of snaps", growth <= min(moments), (growth, moments))
    energies.append((last["dissipated_energy"] -
                     first["dissipated_energy"]) /
                    (last["broken_zone"] - first["broken_zone"]))
compare("peel, moment", crack_couple(), plateau, 0.05)
for energy in energies:
    close("peel, energy by crack length", energy, 0.04, 0.05)

# c = a sqrt(1 - Q / (mu P)) of what sticks, to the size of a cell.
for cells in 80, 160:
    for row in solve("cattaneo", f"Cells={cells}, {cells}")["path"]:
        P, Q = abs(row["reaction_top_y"]), row["reaction_top_x"]
        half = math.sqrt(4. * P * 20. * 2. * (1. - 0.3**2) / math.pi)
        close("cylinders, contact", 8. * row["contact_part"], half, 0.6 * 16. / cells, 1.)
        close("cylinders, sticks", 8. * row["stick_part"], half * math.sqrt(1. - Q / (0.3 * P)),
              0.6 * 16. / cells, 1.)

openings = []
for cells in "8, 4", "16, 8", "32, 16":
    result = solve("tack", "Cells=" + cells)
    check("tack", (result["status"], result["load_path"]["comes_off_at"]) == ("comes off", 1.4))
    openings.append(result["path"][9]["largest_gap"])
compare("tack, opening of the edge at p = 0.05", 0.05 * 1.5, openings, 2e-3)

# Fronts wait between the points of the bonds until the next one is stretched far
# enough, which makes forces too large by a part that falls with the cells' length
# over that of the zone in which bonds are stretched: 7 to 10 %, half of that.
for name, k, threshold, lifts in (
        ("double-cantilever-path", 200., lambda x: 0.01, {1.2, 1.8}),
        ("r-curve", 2000., lambda x: math.sqrt(
            2. * (0.0025 + 0.005 * (x - 60.) / 40.) / 2000.), {1., 1.75})):
    for cells, bound in ("160, 1", 0.11), ("320, 2", 0.06):
        rows = path_of(name, "Cells=" + cells)
        top = max(range(len(rows)), key=lambda n: rows[n]["displacement_factor"])
        for row in rows[:top + 1]:
            lift = row["displacement_factor"]
            if lift not in lifts:
                continue
            force, tip = running_crack(EI, k, threshold, lift, 60., 150.)
            within(f"{name}, {cells}, force at {lift}", force, row["reaction_left_y"], bound)
            within(f"{name}, {cells}, crack at {lift}", tip, row["fronts"], 0.5 * bound)
        if name == "r-curve":
            continue
        # The crack closes, and its tip stays; its place in a cell is known while
        # the bonds next to it are stretched.
        tips = [row["fronts"] for row in rows[top:]]
        size = 160. / int(cells.split(",")[0])
        check("double cantilever, tip", rows[-1]["broken_zone"] <= 0.
              and max(tips) - min(tips) <= 1.5 * size, tips)

# Linear fracture mechanics knows neither stiffness nor strength: w = P a^3 / (3 EI), P =
# sqrt(2 G EI) / a. Bonds that soften are stretched before the crack, which lowers the
# peak, but not the force once the zone has its length.
couple = math.sqrt(2. * 0.04 * EI)
for strength, least in (8, 0.92), (1, 0.83):
    rows = path_of("softening-cantilever", "Cells=160, 1", f"Bond strength={strength}")
    for row in rows:
        if row["displacement_factor"] in {2.5, 3., 4.}:
            a = math.sqrt(3. * EI * row["displacement_factor"] / couple)
            within(f"softening cantilever, strength {strength}, force at "
                   f"{row['displacement_factor']}", couple / a,
                   row["reaction_left_y"], 0.01)
    peak = max(row["reaction_left_y"] for row in rows) * 60. / couple
    check(f"softening cantilever, peak for {strength}", least < peak < least + 0.05, peak)

# Both layers of the double cantilever beam of Alfano and Crisfield, 20 wide.
couple = math.sqrt(135300. / (1. - 0.24 * 0.24 * 9. / 135.3) * 1.5**3 / 12.)
rows = path_of("delamination")
for row in rows:
    opening = row["displacement_factor"]
    if opening in {2.5, 3., 4.}:
        within(f"delamination, force at {opening}",
               20. * math.sqrt(2. * 0.28**1.5 * couple / (3. * opening)),
               20. * row["reaction_upper_end_y"], 0.03)
within("delamination, largest force", 62.2,
       20. * max(row["reaction_upper_end_y"] for row in rows), 0.02)

for t in 2, 1:
    ends, stretch = lap_joint(t, 50.)
    for n in 1, 2:
        result = solve("lap-joint", f"Constants/t={t}", f"Constants/n={n}")
        for end, row in zip(ends, (result["profile"][0], result["profile"][-1])):
            within(f"lap joint 2/{t}, shear at {row['x']}", 100. * end,
                   row["shear_force_density"], 0.005)
        within(f"lap joint 2/{t}, stretch", 100. * stretch,
               -result["probes"]["pulled end"][0], 0.0005)
for row in path_of("lap-joint-path"):
    lift = row["displacement_factor"]
    if 0. < lift < 0.184:
        within(f"lap joint, force at {lift}", lap_joint_path(lift),
               row["reaction_lower_end_x"], 0.015)
    elif lift > 0.1855:
        check(f"lap joint at {lift}", row["broken_part"] == 1., row)

slip, deflection = end_loaded_split(60.)
result = solve("end-loaded-split", "Cells=80, 2")
within("end-loaded split, slip", 0.5 * slip, max(
    abs(row["slip_x"]) for row in result["profile"] if row["x"] >= 60.), 0.001)
within("end-loaded split, deflection", 0.5 * deflection, -result["probes"]["end"][1], 0.001)
strength = math.sqrt(2. * 0.01 / 100.)
rows = path_of("end-loaded-split-path", "Cells=80, 2")
for row in rows[1:rows.index(max(rows, key=lambda row: row["fronts"])) + 1]:
    lift = row["displacement_factor"]
    if lift < 3.35:
        within(f"end-loaded split, force at {lift}", lift / deflection,
               row["reaction_right_y"], 0.001)
    elif lift > 3.9:
        a = root(lambda a: end_loaded_split(a)[1] * strength /
                 end_loaded_split(a)[0] - lift, 80., 155.)
        within(f"end-loaded split, force at {lift}",
               strength / end_loaded_split(a)[0], row["reaction_right_y"], 0.03)
        within(f"end-loaded split, crack at {lift}", a, row["fronts"], 0.02)

# The published loads are of a mesh as well; those of beam theory are 1.5 to 3.5 % less.
for c, load, lift, bending, mode in ((92.9, 128.5, 1.64, 126.59, 0.1981),
                                     (41.3, 385., 1.34, 379.03, 0.4940),
                                     (27.3, 751., 1.65, 725.17, 0.7924)):
    arm = f"Constants/c={c}"
    rows = path_of("mixed-mode-bending", arm)
    intact, computed = rows[0], 25.4 * first_break(rows)
    within(f"mixed-mode bending {c}, load", load, computed, 0.025)
    within(f"mixed-mode bending {c}, of beams", bending, computed, 0.02)
    within(f"mixed-mode bending {c}, displacement", lift,
           intact["unit_load_work"] * computed / (25.4 * intact["factor"]), 0.025)
    within(f"mixed-mode bending {c}, mode", mode, next(
        row["mode_mixity"] for row in solve("mixed-mode-bending", arm, "Factors=P")["profile"]
        if row["x"] > 25.4 - 1e-9), 0.02)
    within(f"mixed-mode bending {c}, energy by mode", computed, 25.4 * first_break(path_of(
        "mixed-mode-bending-by-mode", arm)), 0.002)
rows = path_of("mixed-mode-bending-path")
within("mixed-mode bending, glue that softens", 371.5 / 25.4, next(
    before["factor"] for before, row in zip(rows, rows[1:])
    if row["broken_part"] > 0.1), 0.005)

# The opening p of the glue has the traction 1.1 (1 - p / p_c); the cube is stretched by
# 2 mm per MPa.
arc = solve("snap-back")["arc"]
within("snap-back, strength", 2.2, arc[1]["displacement_factor"], 1e-10)
within("snap-back, end", 1.8 / 1.1, arc[2]["displacement_factor"], 1e-10)
check("snap-back, states",
      [row["status"] for row in arc] == ["stable", "stable", "unstable", "stable"])

# The middle to what shear changes where bonds hold the strip, (h/a)^2 = 1/400 of
# bending times a small number; the pressure to what the root is wider than a
# line, and to fronts that wait.
middle, critical = blister()
pressures = []
for cells in "40, 1", "80, 2", "160, 4":
    rows = path_of("blister", "Cells=" + cells, "Factors=0.75:0.002:0.85")
    within(f"blister, {cells}, middle", middle,
           rows[0]["probe_middle_y"] / (0.03 * rows[0]["factor"]), 0.01)
    pressures.append(0.03 * first_break(rows))
compare("blister, pressure that breaks bonds", critical, pressures, 0.02)

# J is flat in the crack's length at its minimum, so that its place is known to a
# percent only.
E = 169000. / (1. - 0.06**2)
_, length = running_crack(E * 0.5**3 / 12., 1e5, lambda x: math.sqrt(2e-3 / 1e5), 0.05, 2., 25.)
for cells in "60, 1", "120, 1":
    within(f"wafer, {cells}, crack", length, solve("wafer", "Cells=" + cells)["broken_zone"], 0.01)

# A uniform stress, which elements have exactly.
stiffness, a, threshold, width = 1000. / 10., 50., 0.01, 20.
off, on = threshold * (1. + a / stiffness), threshold
for settings in [], ["Displacement factors=0, " + ", ".join(
        repr(1e3 * lift) for lift in (off * (1. - 1e-9), off * (1. + 1e-9), on * (1. + 1e-9),
                                      on * (1. - 1e-9)))]:
    held = True
    for row in path_of("punch", *settings):
        lift = 1e-3 * row["displacement_factor"]
        held = lift < (off if held else on)
        force = width * lift * (stiffness if lift <= 0. else stiffness * a / (stiffness + a)
                                if held else 0.)
        close(f"punch, force at {lift}", row["reaction_top_y"], force, 1e-10, 1.)
scenes.end()
