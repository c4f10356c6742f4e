# SPDX-License-Identifier: LGPL-2.1-or-later
"""Problems of others beside what they publish: doc/notes/published.md."""

import argparse
import dataclasses
import math
import os
import pathlib
import re
import subprocess

import numpy

from . import cases, peers, plots, report, runs
from .runs import SOURCE

PAGE = "doc/notes/published.md"
# The tables beside the page, and what the page shows of them.
SHOWN = {"problems": ["problem", "source", "quantity", "published", "Debond", "difference"],
         "others": ["optimiser", "above the least", "says", "s"]}
PROBLEMS = []
E_STAR = 1. / 0.91  # of E = 1 and nu = 0.3
LAMINATE = [(0., 0.), (0.5, 30.), (0.5, 20.), (1., 30.), (1., 15.), (2., 25.), (2., 0.)]


@dataclasses.dataclass
class Problem:
    """`solve(run)` yields (quantity, what the source states, Debond's value), and fourth
    a word in place of that of the last run; run(SCENE, SETTINGS) returns the Results.
    The differences may be up to `bounds`, of each row, the last one of all others."""

    title: str
    source: str
    bounds: tuple
    solve: object

    def rows(self):
        """Those of the table; the seconds are of the first row."""
        seconds, found, results = 0., [], None

        def timed_run(*arguments):
            nonlocal seconds, results
            results = run(*arguments)
            seconds += results.summary["timings_s"]["total"]
            return results

        for quantity, stated, value, *word in self.solve(timed_run):
            bound = self.bounds[min(len(found), len(self.bounds) - 1)]
            found.append([quantity, stated, value, value / stated - 1., bound, *(
                word or [state(results)]), results.summary["degrees_of_freedom"]])
        return [[self.title, self.source, *row, seconds if row is found[0] else None]
                for row in found]


def run(scene, settings=None):
    """Results of a scene of prm/, in a folder of output/published/."""
    return runs.run(f"{SOURCE}/prm/{scene}.prm", settings,
                    os.path.abspath(f"output/published/{os.path.basename(scene)}"))


def problem(title, source, *bounds):
    """Adds a function to the PROBLEMS."""
    def add(solve):
        PROBLEMS.append(Problem(title, source, bounds, solve))
        return solve
    return add


def state(results):
    """The word for the minimum, and the certified interval."""
    certified = results.summary.get("certificate")
    return results.summary["minimum"]["state"] + (
        f", J in [{certified['lower']:.5g}, {certified['upper']:.5g}]" if certified else "")


def snap_back(run, scene, opening, lift, force):
    """At an opening on the straight part of the arc on which the glue softens."""
    arc = run(scene).load_path_arc
    for quantity, stated, column in (("displacement", lift, "displacement_factor"),
                                     ("force", force, "reaction_top_y")):
        yield (f"{quantity} at the opening {opening}", stated, numpy.interp(
            opening, arc["mean_gap"][1:3], arc[column][1:3]), "arc, unstable")


@problem("square that snaps back", "code_aster V6.03.118, SSNP118-G", 1e-6)
def square(run):
    return snap_back(run, "published/snap-back-plane", 0.368848, 2.0729525, 0.852052)


@problem("cube that snaps back", "code_aster V6.03.118, SSNP118-H", 1e-6)
def cube(run):
    return snap_back(run, "cookbook/snap-back", 0.368848, 2.0729525, 0.852052)


@problem("square, bilinear law", "code_aster V6.03.118, SSNP118-D", 1e-4)
def bilinear(run):
    return snap_back(run, "published/snap-back-bilinear", 1.45237, 1.699739, 0.123685)


@problem("laminate of Mäkelä, Miettinen, Lukšan, Vlček (1999)",
         "conmech, test_Makela_et_al_1998.py", 0.08)
def laminate(run):
    tip = run("published/laminate").summary["probes"]["tip"][1]
    yield "tip, subgradient method, mm", 9.60656, tip
    tip = run("published/laminate", {"Solver/Search": "none"}).summary["probes"]["tip"][1]
    yield "tip, Powell, mm", 0.99732, tip
    summary = run("published/laminate", {"Certificate/Kind": "global",
                                         "Certificate/Target": 0.005}).summary
    yield "tip on refined meshes, mm", 9.60656, summary["probes"]["tip"][1]


def parabola(results, radius):
    """The pressure in the middle and where it vanishes: p^2 is a parabola in x, of the
    nodes but those at the edge, which is near the radius."""
    x, p = results.profile["x"], results.profile["normal_force_density"]
    inside = x < 0.8 * radius
    slope, top = numpy.polyfit(x[inside]**2, p[inside]**2, 1)
    return math.sqrt(top), math.sqrt(-top / slope)


@problem("Hertz, cylinder on a rigid plane", "Johnson, Contact Mechanics (1985), 4.2", 0.01)
def hertz_cylinder(run):
    R, results = 10., run("published/hertz-cylinder", {"Certificate/Kind": "global"})
    force = 2. * results.summary["contact_reaction"][1]
    half = math.sqrt(4. * force * R / (math.pi * E_STAR))
    top, edge = parabola(results, half)
    yield "largest pressure at Debond's force", math.sqrt(force * E_STAR / (math.pi * R)), top
    yield "half width of contact", half, edge


@problem("Cattaneo, Mindlin: cylinders that slide", "Johnson, Contact Mechanics (1985), 7.2", 0.05)
def cattaneo(run):
    results = run("cookbook/cattaneo")
    path, R, mu = results.load_path, 20., 0.3
    force = abs(path["reaction_top_y"])
    half = numpy.sqrt(4. * force * R / (math.pi * 1. / (2. * (1. - 0.3**2))))
    stick = half * numpy.sqrt(1. - path["reaction_top_x"] / (mu * force))
    # Parts of the boundary of the length 16, and half a cell on each side.
    yield "half width of contact", half[0], 8. * path["contact_part"][0]
    for k in (1, 2, 3):
        yield (f"half width that sticks, shift {0.1 * path['displacement_factor'][k]:.2g}", stick[k],
               8. * path["stick_part"][k])


@problem("Cattaneo, Mindlin: balls that slide", "Mindlin, J. Appl. Mech. 16 (1949)",
         0.02, 0.01, 0.08, 0.12)
def balls(run):
    results = run("published/balls")
    path, profile, R, mu, stiffness = results.load_path, results.profile, 50., 0.4013, 200. / 0.58
    # Half of the balls, on a square of the area 128.
    force = 2. * abs(path["reaction_top_y"])
    radius = numpy.cbrt(3. * force * R / (4. * stiffness))
    stick = radius * numpy.cbrt(1. - 2. * path["reaction_top_x"] / (mu * force))
    yield "radius of contact", radius[-1], numpy.sqrt(256. * path["contact_part"][-1] / math.pi)
    near = numpy.hypot(profile["x"], profile["z"]) < 0.3
    load = profile["normal_force"][near]
    part = (0.3 / radius[-1])**2
    yield ("mean pressure within 0.3", force[-1] / (math.pi * 0.3**2) * (1. - (1. - part)**1.5),
           load.sum() / (load / profile["normal_force_density"][near]).sum())
    for k in (1, 2):
        yield (f"radius that sticks, shift {0.0081 * path['displacement_factor'][k]:.3g}", stick[k],
               numpy.sqrt(256. * path["stick_part"][k] / math.pi))


@problem("square on a rough plane", "code_aster V6.04.128, SSNV128", 0.05)
def rough_square(run):
    profile = run("published/rough-square").profile
    for x, stated in ((0., 2.86e-5), (0.00125, 2.72e-5), (0.005, 2.28e-5), (0.0075, 1.98e-5),
                      (0.01125, 1.50e-5)):
        yield (f"displacement at {x:g} m", stated, numpy.interp(x, profile["x"],
                                                               profile["slip_x"]))


@problem("punch with a rounded edge", "Konter, NAFEMS (2006); code_aster V6.01.122, SSNA122",
         0.03, 0.01, 0.01, 0.08, 0.03, 0.05, 0.01, 0.08)
def rounded_punch(run):
    for mu, stated in (0.1, {"A": (0.128580, 88.6652), "B": (0.130794, 95.4740)}), (
            0, {"A": (0.130734, 91.1006), "B": (0.132941, 94.1221)}):
        results = run("published/rounded-punch", {"Constants/mu": mu})
        for model, (lift, stress) in stated.items():
            yield (f"displacement of the middle, friction {mu}, model {model}, mm", lift,
                   -results.summary["probes"]["middle"][1])
            yield (f"stress there, friction {mu}, model {model}, MPa", stress,
                   results.profile["normal_force_density"][0])


@problem("end-notched flexure, faces that rub", "beam theory", 0.01, 0.01, 0.02, 0.01)
def rough_crack(run):
    E, L, h, a, P, mu = 70000., 60., 2., 40., 4., 0.5
    EI = E * h**3 / 12.
    at_once = {"Load path/Factors": 1}
    smooth = run("published/rough-crack", {"Constants/mu": 0, **at_once})
    deflection = -smooth.summary["probes"]["middle"][1]
    yield "deflection without friction, mm", P * (2. * L**3 + 3. * a**3) / (96. * EI), deflection
    path = run("published/rough-crack").load_path
    yield ("what friction takes of it, mm", mu * P * a**2 * h / (32. * EI),
           deflection + path["probe_middle_y"][path["factor"] == 1.][0])
    # It slides back below the part q of the force.
    slip, q = h * P * (a**2 / 8. - mu * h * a / 6.) / EI, (3. * a - 4. * mu * h) / (
        3. * a + 4. * mu * h)
    yield ("energy lost up to P and down to 0.1 P, N", mu * P * slip / 8. * (1. + q - 0.01 / q),
           path["dissipated_energy"][-1])
    rate = [run("published/rough-crack", {"Constants/mu": mu, "Constants/a": a + da, **at_once}
                ).load_path["elastic_energy"][0] * da for mu in (0, 0.5) for da in (1., -1.)]
    yield ("energy release rate, with friction to without, (1 - 2/3 mu h / a)^2",
           (1. - 2. / 3. * mu * h / a)**2, sum(rate[2:]) / sum(rate[:2]))


@problem("two beams that slide on each other", "Goodman, Klumpp, J. Appl. Mech. 23 (1956)",
         0.02, 0.02, 0.01, 0.01)
def slip_damping(run):
    E, L, h, p, mu = 70000., 40., 2., 1., 0.3
    first = 4. / 3. * mu * p * h
    P = 3. * first
    for cell in 0.25, 0.125:
        path = run("published/slip-damping", {"Constants/cell": cell}).load_path
        up = path["factor"] == 1.
        yield (f"deflection at the largest force, cells of {cell} mm, mm",
               2. * (P - mu * p * h) * L**3 / (E * h**3), path["probe_end_y"][up][0])
        yield (f"energy lost in a cycle, cells of {cell} mm, N",
               8. * mu * p * (P - first) * L**3 / (E * h**2),
               numpy.diff(path["dissipated_energy"][up])[0])


@problem("Hertz, sphere on a rigid plane", "Johnson, Contact Mechanics (1985), 4.2", 0.01)
def hertz_sphere(run):
    R, results = 10., run("published/hertz-sphere")
    force = results.summary["contact_reaction"][1]
    radius = (0.75 * force * R / E_STAR)**(1. / 3.)
    top, edge = parabola(results, radius)
    yield ("largest pressure at Debond's force",
           (6. * force * E_STAR**2 / (math.pi**3 * R**2))**(1. / 3.), top)
    yield "radius of contact", radius, edge


@problem("ball whose middle plane is moved", "code_aster V6.04.104, SSNV104",
         0.05, 0.05, 1e-3, 0.03, 0.01)
def ball(run):
    R, modulus = 50., 20000. / 0.91
    for u, h, stated in (2., 0.5, 2798.3), (2., 0.125, 2798.3), (1., 0.1, 1978.7), (
            0.02, 0.02, 2. * modulus / math.pi * math.sqrt(0.02 / 50.)):
        results = run("published/sphere", {"Constants/u": u, "Constants/h": h})
        top = parabola(results, math.sqrt(R * u))[0]
        yield f"stress at the pole, {u:g} mm, cells of {h} mm, MPa", stated, top
        if (u, h) == (2., 0.125):
            force = results.summary["contact_reaction"][1]
            yield ("the same by Hertz from Debond's force, MPa",
                   (6. * force * modulus**2 / (math.pi**3 * R**2))**(1. / 3.), top)


@problem("thick tube with a pressure inside", "Lamé", 1e-3, 2.5e-4, 6.25e-5)
def thick_tube(run):
    for n in 10, 20, 40:
        yield f"displacement of the inner wall, {n} cells", 1.3 / 3. * 4.4, run(
            "published/thick-tube", {"Constants/n": n}).summary["probes"]["inside"][0]


@problem("cylinder on a block", "Konter, NAFEMS (2006), benchmark 1, by Hertz", 0.002, 0.01)
def roller(run):
    force, R, modulus = 35000., 50., 1. / (0.91 / 70000. + 0.91 / 210000.)
    for h in 0.4, 0.2, 0.1:
        half = math.sqrt(4. * force * R / (math.pi * modulus))
        top, edge = parabola(run("published/roller", {"Constants/h": h, "Constants/g": 1.5 * h}),
                             half)
        yield f"largest pressure, cells of {h} mm, MPa", force / (0.5 * math.pi * half), top
        yield f"half width of contact, cells of {h} mm, mm", half, edge


def mode(n, r, material):
    """In plane strain sigma_rr, sigma_r_theta, u_r and u_theta at the radius r, a column for
    each of Michell's functions with cos(n theta), n = 0 or 2, the second half of them
    singular at r = 0."""
    E, nu = material
    kappa = 3. - 4. * nu
    parts = [[1., r**-2], [0., 0.], [(kappa - 1.) * r / 2., -1. / r], [0., 0.]] if n == 0 else [
        [-2., 0., -4. / r**2, -6. / r**4], [2., 6. * r**2, -2. / r**2, -6. / r**4],
        [-2. * r, (kappa - 3.) * r**3, (kappa + 1.) / r, 2. / r**3],
        [2. * r, (kappa + 3.) * r**3, (1. - kappa) / r, 2. / r**3]]
    return numpy.array(parts) * [[1.], [1.], [(1. + nu) / E], [(1. + nu) / E]]


def between_rings(n, radii, inner, outer, rim, k=None):
    """What mode() has, at the middle one of the radii, on the inner of two rings that slide on
    each other, or that springs of the stiffness k join: sigma_rr and sigma_r_theta are given
    at the rim. Without a first radius the inner one is a disc."""
    a, b, c = radii
    none = numpy.zeros((4, n + 2))
    inside, outside = numpy.hstack((mode(n, b, inner), none)), numpy.hstack(
        (none, mode(n, b, outer)))
    bore = numpy.hstack((mode(n, a, inner), none))[:2] if a else numpy.eye(
        2 * n + 4)[n // 2 + 1:n + 2]
    jump = outer[0] * (outside - inside)[2:]
    equations = numpy.vstack((
        numpy.hstack((none, mode(n, c, outer)))[:2], bore, (outside - inside)[:2],
        jump - outer[0] / k * inside[:2] if k else (jump[0], inside[1])))
    right = numpy.append(rim, numpy.zeros(len(equations) - 2))
    return inside @ numpy.linalg.lstsq(equations, right, rcond=None)[0]


def parts_around(profile):
    """The normal traction's mean and what cos(2 theta) has of it, and the part of
    sin(2 theta) in the shear traction, all from squares."""
    x, y, normal = (profile[name] for name in ("x", "y", "normal_traction"))
    shear = profile.get("shear_traction", 0. * x)
    weight = numpy.sqrt(profile["normal_force"] / profile["normal_force_density"])
    cosine, sine = (x**2 - y**2) / (x**2 + y**2), 2. * x * y / (x**2 + y**2)
    part, mean = numpy.polyfit(cosine, normal, 1, w=weight)
    return mean, part, numpy.sum(weight**2 * sine * shear) / numpy.sum((weight * sine)**2)


def farthest(values, stated):
    """The value that differs most."""
    return max(values, key=lambda value: abs(value - stated))


@problem("ring in a ring", "code_aster V6.03.152, V6.03.167, SSNP152, SSNP167; Michell (1899)",
         5e-4, 0.012, 0.004, 0.004, 0.01, 0.006)
def rings(run):
    radii, material = (0.2, 0.6, 1.), (1e9, 0.2)
    mean, part = (between_rings(n, radii, material, material, (-q, 0.))
                  for n, q in ((0, 1e7), (2, 1e6)))
    for h in 0.03, 0.015, 0.0075:
        cells, word = {"Constants/h": h, "Constants/g": h / 0.6}, f"cells of {h} m"
        pressure = run("published/rings", cells).profile
        yield f"contact pressure, {word}, Pa", 925925.93, parts_around(pressure)[0]
        yield (f"the same, node that differs most, {word}, Pa", 925925.93,
               farthest(pressure["normal_traction"], 925925.93))
        small, large = (run("published/rings", {
            **cells, "Constants/p": 1e7, "Constants/q": q}) for q in (1e5, 1e6))
        yield (f"largest displacement of the joint, 1e5 cos(2 theta), {word}, m", -5.5e-3,
               small.summary["probes"]["right"][0])
        yield (f"1e6 cos(2 theta), its part of the pressure, {word}, Pa", -part[0],
               parts_around(large.profile)[1])
        yield (f"1e6 cos(2 theta), largest pressure, {word}, Pa", -mean[0] - part[0],
               max(large.profile["normal_traction"]))
        yield (f"1e6 cos(2 theta), largest displacement of the joint, {word}, m",
               mean[2] + part[2], large.summary["probes"]["right"][0])


@problem("hollow sphere in another one", "code_aster V6.03.173, SSNP173", 5e-4, 0.025)
def hollow_spheres(run):
    for h in 1, 0.5, 0.25:
        profile = run("published/hollow-spheres",
                      {"Constants/h": h, "Constants/g": 1.5 * h}).profile
        pressure, area = profile["normal_traction"], (
            profile["normal_force"] / profile["normal_force_density"])
        yield (f"contact pressure, cells of {h} mm, MPa", 4.894178,
               numpy.average(pressure, weights=area))
        yield (f"the same, node that differs most, cells of {h} mm, MPa", 4.894178,
               farthest(pressure, 4.894178))


@problem("fibre in a matrix", "Goodier (1933), with springs by Michell", 0.002, 0.005, 0.01)
def fibre(run):
    radii, inner, outer = (None, 1., 8.), (70000., 0.2), (3000., 0.35)
    for k, word in (1e6, "stiff bonds"), (3000., "soft bonds"):
        mean, part = (between_rings(n, radii, inner, outer, rim, k)
                      for n, rim in ((0, (30., 0.)), (2, (10., -10.))))
        for h in 0.04, 0.02:
            found = parts_around(run("published/fibre", {
                "Constants/k": k, "Constants/h": h, "Constants/g": 1.5 * h,
                "Constants/G": 20. * h}).profile)
            for name, stated, value in (
                    ("mean normal traction", mean[0], -found[0]),
                    ("cos(2 theta) in it", part[0], -found[1]),
                    ("sin(2 theta) in the shear", -part[1], found[2])):
                yield f"{word}, {name}, cells of {h} mm, MPa", stated, value


@problem("beam of two tied pieces", "patch test; Timoshenko", 1e-8, 1e-8, 1e-4)
def tied_beam(run):
    pulled = run("published/tied-beam", {"Constants/T": 100, "Constants/Q": 0}).profile
    yield ("normal traction of an inclined side, node that differs most, MPa", -50.,
           farthest(pulled["normal_traction"], -50.))
    yield ("shear there, MPa", 50., farthest(pulled["shear_traction"], 50.))
    yield ("deflection of the end, mm", 10. * 100.**3 / (3. * 70000. * 10.**3 / 12.) + 1.2 *
           10. * 100. / (35000. * 10.), -run("published/tied-beam").summary["probes"]["end"][1])


def pull_off_on_springs(k, w, n):
    """The force that pulls a rigid strip of the half width 1 off a half-plane, to which
    springs of the stiffness k hold it until they have taken w: the springs' integral
    equation by collocation."""
    ends = numpy.sin(0.5 * math.pi * numpy.linspace(0., 1., n + 1))
    x = 0.5 * (ends[1:] + ends[:-1])[:, None]

    def logarithm(a, c):
        return sum(t * numpy.log(abs(t)) * sign for t, sign in ((c - x, 1), (a - x, -1))
                   ) - (c - a)

    left, right = ends[:-1], ends[1:]
    matrix = numpy.eye(n) / k - 2. / (math.pi * E_STAR) * (
        logarithm(left, right) + logarithm(-right, -left))
    p = numpy.linalg.solve(numpy.block([
        [matrix, -numpy.ones((n, 1))], [2. * (right - left), numpy.zeros(1)]]),
        numpy.append(numpy.zeros(n), 1.))[:n]
    edge = p[-1] + (p[-1] - p[-2]) / (x[-1, 0] - x[-2, 0]) * (1. - x[-1, 0])
    return math.sqrt(2. * k * w) / edge


def first_break(run, scene, k):
    """The factor at which the first bond of this stiffness breaks."""
    return run(f"published/{scene}", {"Constants/stiff": k}).load_path_arc["factor"][1]


def load_that_breaks(path):
    """The first factor after which bonds that do not heal are broken."""
    return path["factor"][path["dissipated_energy"] > 0.][0]


@problem("strip contact, pull-off", "Kendall, J. Phys. D 4 (1971); Johnson (1985)",
         0.01, 1e-3, 0.005, 1e-3)
def strip_contact(run):
    w, word = 1e-4, "arc, stable"
    for k in 80., 320.:
        force = first_break(run, "strip-contact", k)
        yield f"sqrt(2 pi a E* w), k = {k:g}", math.sqrt(2. * math.pi * E_STAR * w), force, word
        # The error of the collocation is quadratic.
        coarse, fine = (pull_off_on_springs(k, w, n) for n in (400, 800))
        yield ("the same on springs, integral equation", fine + (fine - coarse) / 3., force,
               word)


@problem("flat circular punch, pull-off", "Kendall, J. Phys. D 4 (1971)", 0.015, 0.01)
def round_punch(run):
    for k in 80., 320.:
        yield (f"sqrt(8 pi E* w a^3), k = {k:g}", math.sqrt(8. * math.pi * E_STAR * 1e-4),
               first_break(run, "round-punch", k), "arc, stable")


@problem("blister under a circular plate", "clamped plate, linear fracture mechanics", 0.01)
def plate_blister(run):
    stiffness, a, G = 70000. * 0.02**3 / (1. - 0.3**2), 20., 0.001
    path = run("published/plate-blister").load_path
    p = path["factor"][0]
    yield ("deflection of the middle, 3 (1 - nu^2) p a^4 / (16 E h^3), mm",
           3. * p * a**4 / (16. * stiffness), path["probe_middle_y"][0])
    yield ("pressure at which it grows, G = 3 (1 - nu^2) p^2 a^4 / (32 E h^3), MPa",
           math.sqrt(32. * stiffness * G / (3. * a**4)), load_that_breaks(path))


@problem("plate with a crack, strength", "Tada, Paris, Irwin (1973)", 0.01)
def cracked_plate(run):
    part = 0.25  # of the width
    shape = (1. - 0.025 * part**2 + 0.06 * part**4) / math.sqrt(math.cos(math.pi * part / 2.))
    for k in 80., 320.:
        yield (f"K of the finite width, k = {k:g}", math.sqrt(2e-4 * E_STAR / math.pi) / shape,
               first_break(run, "cracked-plate", k), "arc, stable")


@problem("JKR, cylinder", "Barquins, J. Adhesion 26 (1988)", 0.08, 0.05, 0.03)
def jkr_cylinder(run):
    R, w = 10., math.pi / 0.91 / 200.
    for M in 0.1, 0.05, 0.025:
        results = run("published/jkr-cylinder", {"Constants/M": M, "Certificate/Kind":
                                                 "global" if M == 0.1 else "none"})
        a = 12. - results.summary["broken_zone"]
        yield (f"pull at Debond's half width {a:.3f}, M = {M}",
               math.sqrt(2. * math.pi * E_STAR * w * a) - math.pi * E_STAR * a**2 / (4. * R),
               -2. * results.summary["contact_reaction"][1])


@problem("JKR, sphere", "Johnson, Kendall, Roberts, Proc. R. Soc. A 324 (1971)",
         0.05, 0.03)
def jkr_sphere(run):
    for M in 0.02, 0.014, 0.01:
        found = [run("published/jkr-sphere", {"Constants/M": M, "Constants/u": u})
                 for u in (0.03, 0.035)]
        yield (f"pull-off, 1.5 pi w R, M = {M}", 4. * E_STAR / 30., max(
            -results.summary["contact_reaction"][1] for results in found))


@problem("heavy strip, lifted at its end", "beam theory", 0.025)
def heavy_strip(run):
    summary = run("published/heavy-strip").summary
    yield "force q L / 2, N", 0.3, summary["reactions"]["right"][1]
    yield "length L off the floor, mm", 60., summary["broken_zone"]
    yield ("J = q^2 L^5 / (60 E I), N", 1e-4 * 60.**5 / (5. * 70000.), run(
        "published/heavy-strip", {"Mesh/Degree": 1, "Contact law/Quadrature": "nodal",
                                  "Certificate/Kind": "global", "Certificate/Target": 0.02}
    ).summary["functional"])


@problem("double cantilever beam", "Alfano, Crisfield, IJNME 50 (2001)", 0.03)
def double_cantilever(run):
    path = run("cookbook/delamination").load_path
    opening, force = path["displacement_factor"], 20. * path["reaction_upper_end_y"]
    yield "largest force, N (their figure)", 61.5, max(force), path["minimum"][-1]
    yield ("force at 3 mm, N (beam theory)", beam_force(3.),
           numpy.interp(3., opening, force), path["minimum"][-1])


def beam_force(opening):
    """Of the two arms of 20 x 1.5 mm while the crack runs."""
    EI = 20. * 135300. / (1. - 0.24**2 * 9. / 135.3) * 1.5**3 / 12.
    return math.sqrt(2. * (0.28 * 20.)**1.5 * math.sqrt(EI) / (3. * opening))


def williams(E1, E2, G12, h):
    """chi h, by which a crack is longer to beams that are not sheared."""
    q = 1.18 * math.sqrt(E1 * E2) / G12
    return h * math.sqrt(E1 / (11. * G12) * (3. - 2. * (q / (1. + q))**2))


def largest_force(run, scene, constants):
    """Of a unit of width, on a path of displacements."""
    results = run(f"published/{scene}",
                  {f"Constants/{name}": value for name, value in constants.items()})
    return results.summary["load_path"]["peak"]["unit_displacement_work"]


def cantilever(run, width, constants, *stated):
    """The largest force beside what others state, (word, force), and beside beams."""
    force = width * largest_force(run, "double-cantilever", constants)
    E1, E2, G12, h, a, G = (constants[name] for name in ("E1", "E2", "G12", "h", "a", "G"))
    beams = width * math.sqrt(G * E1 * h**3 / 12.) / (a + williams(E1, E2, G12, h))
    for word, value in (*stated, ("beams longer by chi h", beams)):
        yield f"largest force, {word}, N", value, force


@problem("double cantilever beam, two strengths", "Alfano, Crisfield, IJNME 50 (2001)",
         0.02, 0.04, 0.015, 0.03, 0.01)
def two_strengths(run):
    laminate = {"L": 100, "a": 30, "h": 1.5, "E1": 135300, "E2": 9000, "nu12": 0.24,
                "G12": 5200, "G23": 3000, "G": 0.28}
    yield from cantilever(run, 20., {**laminate, "strength": 57, "u": 1.5, "cell": 0.1},
                          ("57 MPa (their figure)", 61.5), ("57 MPa (panels)", 64.6))
    weak = [*cantilever(run, 20., {**laminate, "strength": 1.7, "u": 2, "cell": 0.5},
                        ("weak, 1.7 MPa (their figure)", 49.5), ("weak, 1.7 MPa (panels)", 50.9))]
    yield from weak[:-1]  # Beams with a crack have no strength.


@problem("double cantilever beam, T300/977-2",
         "Turon, Dávila, Camanho, Costa, Eng. Fract. Mech. 74 (2007)", 0.02, 0.11, 0.03, 0.01)
def t300(run):
    return cantilever(run, 20., {"a": 55, "h": 1.98, "E1": 150000, "E2": 11000, "G12": 6000,
                                 "G": 0.352},
                      ("test (their figure)", 62.), ("elements (their figure)", 57.),
                      ("panels", 64.1))


@problem("double cantilever beam, AS4/PEEK",
         "Camanho, Dávila, de Moura, J. Compos. Mater. 37 (2003)", 0.08, 0.13, 0.03, 0.02)
def peek(run):
    return cantilever(run, 25.4, {"L": 102, "a": 32.9, "h": 1.56, "E1": 122700, "E2": 10100,
                                  "G12": 5500, "G": 0.969, "strength": 80, "cell": 0.1},
                      ("test", 147.1), ("elements of 1 mm", 155.3), ("panels", 139.9))


@problem("mixed-mode bending, AS4/PEEK", "Camanho, Dávila, NASA/TM-2002-211737",
         0.18, 0.01, 0.09, 0.015, 0.12, 0.04)
def mixed_mode_peek(run):
    E1, L, h = 122700., 51., 1.56
    longer = williams(E1, 10100., 5500., h)
    for mix, a, u, test in (0.2, 33.7, 10.2, 108.09), (0.5, 34.1, 5.7, 275.35), (
            0.8, 31.4, 5.3, 518.66):
        force = 25.4 * largest_force(run, "mixed-mode-bending", {"mix": mix, "a": a, "u": u})
        r = math.sqrt(0.75 * (1. - mix) / mix)
        c = L * (r + 1.) / (3. - r)
        one = 12. * (3. * c - L)**2 * (a + longer)**2
        two = 9. * (c + L)**2 * (a + 0.42 * longer)**2
        G = 0.969 + 0.75 * (two / (one + two))**2.284
        yield f"largest force, {100. * mix:g} % of mode II, test, N", test, force
        yield (f"largest force, {100. * mix:g} % of mode II, beams longer by chi h, N",
               25.4 * math.sqrt(16. * h**3 * L**2 * E1 * G / (one + two)), force)


@problem("strip on concrete, single shear",
         "Yuan, Teng, Seracino, Wu, Yao, Eng. Struct. 26 (2004)", 1e-3)
def strip_on_concrete(run):
    Et, shear, s1, s2 = 256000. * 0.165, 7.2, 0.034, 0.16
    rise, fall = math.sqrt(shear / (s1 * Et)), math.sqrt(shear / ((s2 - s1) * Et))
    low, high = 0., 40.
    while high - low > 1e-9:  # the length that softens
        a = 0.5 * (low + high)
        if math.tanh(rise * (40. - a)) > fall / rise * math.tan(fall * a):
            low = a
        else:
            high = a
    for L, stated, word in (
            (100, math.sqrt(Et * shear * s2), "long bond, sqrt(2 E t G)"),
            (40, shear / fall * s2 / (s2 - s1) * math.sin(fall * low), "bond of 40 mm")):
        yield f"largest force, {word}, N/mm", stated, largest_force(
            run, "strip-on-concrete", {"L": L})


@problem("end-loaded split", "beams with a sheared layer", 1e-3)
def end_loaded_split(run):
    E, h, L, a, k = 70000., 2., 160., 60., 100.
    w = math.sqrt(8. * k / (E * h))
    c, s = math.cosh(w * (L - a)), math.sinh(w * (L - a))
    A = (a + s / w) / c
    moment = (A * (w * a * s + c - 1.) + L - a * c - s / w) / w**2
    results = run("cookbook/end-loaded-split")
    x, slip = results.profile["x"], abs(results.profile["slip_x"])
    yield ("deflection of the end, mm", 0.5 * (
        (L**3 + 3. * a**3 + 9. * moment) / (2. * E * h**3) + 1.2 * L / (E * h)),
        -results.summary["probes"]["end"][1])
    yield ("slip at the tip, mm", 0.375 / (h * k) * (1. + A * w * s - c), max(slip[x >= a]))


@problem("lap joint", "Volkersen (1938)", 5e-3)
def lap_joint(run):
    E, t, L = 70000., 2., 50.
    k = 1. / (1. / 100. + 2. * t / (3. * E / 2.))
    w = math.sqrt(2. * k / (E * t))
    results = run("cookbook/lap-joint", {"Constants/n": 2})
    shear = 100. * w / 2. * (math.cosh(w * L) + 1.) / math.sinh(w * L)
    force = results.profile["shear_force_density"]
    yield "shear at the left end, MPa", shear, force[0]
    yield "at the right end, MPa", shear, force[-1]


@problem("mixed-mode bending", "Krueger, NASA/CR-2012-217562", 0.025)
def mixed_mode_bending(run):
    for c, load, lift in (92.9, 128.5, 1.64), (41.3, 385., 1.34), (27.3, 751., 1.65):
        path = run("cookbook/mixed-mode-bending", {"Constants/c": c}).load_path
        P = load_that_breaks(path)
        word = path["minimum"][-1]
        yield f"load at the lever of {c} mm, N", load, 25.4 * P, word
        yield (f"displacement at the lever of {c} mm, mm", lift,
               path["unit_load_work"][0] * P / path["factor"][0], word)


@problem("bundle method, benchmark", "Czepiel, Schedae Informaticae 20 (2011), tables 1 to 3",
         0.1)
def bundle(run):
    for cells, J in ("40x4", -5.28867e-4), ("80x8", -5.37504e-4), ("160x16", -5.40066e-4):
        yield f"J on {cells} cells, GJ/m", J, run(
            f"benchmark-{cells}", {"Solver/Method": "automatic"}).summary["functional"]
    yield "the same, refined", -5.40066e-4, run("benchmark-40x4", {
        "Solver/Method": "automatic", "Certificate/Kind": "global",
        "Certificate/Target": 0.005}).summary["functional"]


def draw():
    """The double cantilever beam and the sphere of JKR beside their closed forms."""
    figure, (left, right) = plots.plt.subplots(1, 2, figsize=(9., 3.6))
    path = run("cookbook/delamination").load_path
    opening = path["displacement_factor"]
    left.plot(opening, 20. * path["reaction_upper_end_y"], ".-", label="Debond")
    running = opening[opening > 1.5]
    left.plot(running, [beam_force(d) for d in running], "k--", label="beam theory")
    left.set(xlabel="opening of the ends, mm", ylabel="force, N",
             title="Double cantilever beam")
    for M, style in (0.02, "^"), (0.014, "s"), (0.01, "o"):
        points = []
        for u in numpy.linspace(-0.02, 0.05, 8):
            summary = run("published/jkr-sphere",
                          {"Constants/M": M, "Constants/u": u}).summary
            points.append((math.sqrt(12.**2 - summary["broken_zone"] / math.pi),
                           -summary["contact_reaction"][1]))
        right.plot(*zip(*points), style, label=f"Debond, M = {M}")
    a = numpy.linspace(0.5, 1.5, 100)
    right.plot(a, E_STAR * (8. / 30. * a**1.5 - 4. / 30. * a**3), "k-", label="JKR")
    right.set(xlabel="radius that the bonds hold", ylabel="pull", title="Sphere")
    for axes in left, right:
        axes.legend()
    figure.savefig(f"{SOURCE}/doc/pictures/published.png", dpi=110)


def others():
    """Rows of what optimisers of others end at on two of the discrete problems."""
    for title, scene, settings, points in (
            ("benchmark, a = 690, 80x8", "benchmark-80x8",
             {"Contact law/Bond stiffness": 690, "Solver/Method": "automatic"},
             [(0., 0.), (0.002, 1.38), (0.002, 0.)]),
            ("laminate, 32x4", "published/laminate", {}, LAMINATE)):
        results = run(scene, {**settings, "Output/Matrices": True})
        least = results.summary["functional"]
        yield (title, "Debond", least, 0., results.summary["minimum"]["state"],
               results.summary["timings_s"]["solve"])
        for name, J, said, seconds in peers.compare(
                peers.Problem(results.directory, points), len(points) == 3):
            yield title, name, J, (J - least) / abs(least), said, seconds


def cell(value):
    return "" if value is None else f"{value:.6g}" if isinstance(value, float) else value


def percent(part):
    return f"{100. * part:+.2g} %" if abs(part) < 10. else ""


def narrow(name, titles, rows):
    """What the page shows: of quantities that only numbers tell apart, as on several
    meshes, the one that differs most, with a problem and its source in its first row;
    of the optimisers those on the first problem."""
    if name == "others":
        rows = [row for row in rows if row[0] == rows[0][0]]
    if name == "problems":
        series = {}
        for row in rows:
            key = row[0], re.sub(r"[\d.]+", "", row[2])
            if key not in series or abs(float(row[5][:-2])) > abs(
                    float(series[key][5][:-2])):
                series[key] = row
        rows = list(series.values())
    columns = [titles.index(title) for title in SHOWN[name]]
    first = {row[0]: row for row in reversed(rows)}
    return report.markdown(SHOWN[name], [
        ["" if titles[k] in ("problem", "source") and row is not first[row[0]] else row[k]
         for k in columns] for row in rows])


def write_to_doc(name, titles, rows):
    """The table as CSV, and what the page shows of it behind <!-- NAME -->."""
    report.write_csv(f"{SOURCE}/doc/notes/published/{name}.csv", titles, rows)
    page = pathlib.Path(SOURCE, PAGE)
    head, _, rest = page.read_text().partition(f"<!-- {name} -->\n\n")
    page.write_text(f"{head}<!-- {name} -->\n\n{narrow(name, titles, rows)}\n" +
                    rest.partition("\n\n")[2])


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/published", description="Runs Debond on problems that others have "
        "published, and prints their results beside its own.")
    parser.add_argument("problems", metavar="WORD", nargs="*",
                        help="those whose title has one of these words; all if none")
    parser.add_argument("--others", action="store_true", help="optimisers of scipy, PETSc, "
                        "GetFEM and Ipopt as well")
    parser.add_argument("--doc", action="store_true",
                        help="write all tables and the picture to doc/")
    parser.add_argument("--debond", help="a program that is built already")
    options = parser.parse_args()
    os.environ["DEBOND"] = os.path.abspath(options.debond or cases.build())
    tables = {"problems": (
        ["problem", "source", "quantity", "published", "Debond", "difference", "accepted",
         "word or interval", "unknowns", "s"],
        [[*map(cell, row[:5]), percent(row[5]), f"{100. * row[6]:g} %", *row[7:9],
          f"{row[9]:.2g}" if row[9] else ""]
         for chosen in PROBLEMS if options.doc or
         any(word in chosen.title for word in options.problems or [""])
         for row in chosen.rows()])}
    if options.doc:
        draw()
    if options.others or options.doc:
        subprocess.run([f"{SOURCE}/scripts/install", "python3-petsc4py", "python3-getfem",
                        "coinor-libipopt1v5"], check=True)
        tables["others"] = (["problem", "optimiser", "J", "above the least", "says", "s"], [
            [*map(cell, row[:3]), percent(row[3]), row[4], f"{row[5]:.2g}"]
            for row in others()])
    for name, table in tables.items():
        print("\n" + report.markdown(*table), flush=True)
        if options.doc:
            write_to_doc(name, *table)
    return 0
