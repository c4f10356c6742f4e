#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_cookbook.py DEBOND DIRECTORY: the scenes of the cookbook on three meshes
against closed forms (doc/cookbook/): the error on the finest mesh is within a
bound, and that on each mesh less than on the one before.
"""

import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile


def run(debond, scene, settings):
    """The summary and the last row of the contact profile."""
    arguments = [f"--set={entry}" for entry in
                 ["Output/Body VTU=false", "Output/Contact VTU=false",
                  "Output/Directory=output"] + settings]
    subprocess.run([debond, scene] + arguments, check=True,
                   stdout=subprocess.DEVNULL)
    summary = json.loads(pathlib.Path("output/summary.json").read_text())
    names, *rows = pathlib.Path("output/contact_profile.csv").read_text().split()
    last = dict(zip(names.split(","), rows[-1].split(",")))
    return summary, last


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


def double_cantilever():
    """The force at the end: a cantilever whose end is a beam that bonds hold
    where they are stretched, and that lies on the foundation beyond."""
    E, h, a, k, lift = 70000., 2., 60., 200., 0.5
    EI = E * h**3 / 12.
    rate = (k / (4. * EI))**0.25
    low, high = 0.5 * math.pi, math.pi

    def curvature(t):
        return math.cos(t) * math.sinh(t) + math.sin(t) * math.cosh(t)

    def mismatch(t):
        return 2. * rate * a * math.cos(t) * math.cosh(t) + curvature(t)

    for _ in range(100):  # bisection
        t = 0.5 * (low + high)
        if mismatch(low) * mismatch(t) <= 0.:
            high = t
        else:
            low = t
    C = a / (2. * EI * rate**2 * curvature(t))
    w = C * (math.sin(t) * math.cosh(t) - math.cos(t) * math.sinh(t))
    slope = 2. * C * rate * math.sin(t) * math.sinh(t)
    return lift / (w + slope * a + a**3 / (3. * EI))


def bimaterial():
    """Minus the opening at the free end, by Timoshenko's curvature."""
    E1, E2, t1, t2, difference, length, k = 2e5, 7e4, 1., 1., 2e-4, 40., 1000.
    m, n, h = t1 / t2, E1 / E2, t1 + t2
    curvature = 6. * difference * (1. + m)**2 / (
        h * (3. * (1. + m)**2 + (1. + m * n) * (m * m + 1. / (m * n))))
    y1, y2 = 0.5 * t1, t1 + 0.5 * t2
    y0 = (E1 * t1 * y1 + E2 * t2 * y2) / (E1 * t1 + E2 * t2)
    EI = (E1 * t1 * (t1**2 / 12. + (y1 - y0)**2) +
          E2 * t2 * (t2**2 / 12. + (y2 - y0)**2))
    rate = (k / (4. * EI))**0.25
    return -curvature * (0.5 * length**2 +
                         math.tanh(0.5 * math.pi) * length / rate +
                         0.5 / rate**2)


def path_rows():
    """Of the load path of the last run, by the titles of the columns; of fronts x of
    the first one."""
    with open("output/load_path.csv") as table:
        return [{title: float(value.split()[0]) for title, value in row.items()
                 if title not in ("status", "minimum") and value}
                for row in csv.DictReader(table)]


def crack_couple():
    """The moment at which a beam of the cookbook's strips comes off."""
    E, h, k, M = 70000., 2., 200., 0.02
    return math.sqrt(k * M**2 * E * h**3 / 12.)


def main(debond, directory):
    failures = []

    def compare(name, exact, values, bound):
        errors = [abs(value / exact - 1.) for value in values]
        print(f"{name}: {exact:.6g}, computed " +
              ", ".join(f"{value:.6g}" for value in values) + ", errors " +
              ", ".join(f"{100. * error:.2g} %" for error in errors))
        if errors[-1] > bound or errors != sorted(errors, reverse=True):
            failures.append(name)

    for n in 8, 16, 32:
        subprocess.run(["gmsh", "-2", "-format", "msh41", "-setnumber", "n",
                        str(n), directory + "/ring.geo", "-o",
                        os.path.abspath(f"ring-{n}.msh")],
                       check=True, stdout=subprocess.DEVNULL)
    compare("ring, J", ring(),
            [run(debond, directory + "/ring.prm",
                 ["Mesh/File=" + os.path.abspath(f"ring-{n}.msh")]
                 )[0]["functional"] for n in (8, 16, 32)], 5e-4)
    compare("double cantilever, force", double_cantilever(),
            [run(debond, directory + "/double-cantilever.prm",
                 ["Mesh/Cells=" + cells, "Solver/Search=none"]
                 )[0]["reactions"]["left"][1]
             for cells in ("160, 2", "320, 4", "640, 8")], 0.02)
    compare("bimaterial strip, opening", bimaterial(),
            [float(run(debond, directory + "/bimaterial-strip.prm",
                       ["Mesh/Cells=" + cells, "Solver/Search=none"]
                       )[1]["u_nu"])
             for cells in ("100, 2", "200, 4", "400, 8")], 0.02)
    # The moment is the work on what is prescribed, by the angle. Not the growth
    # of J: bonds that snap set energy free.
    peel = directory + "/peel.prm"
    plateau, energies = [], []
    for cells in "160, 2", "320, 4", "640, 8":
        run(debond, peel, ["Mesh/Cells=" + cells])
        rows = path_rows()
        half = rows[len(rows) // 2:]
        first, last = half[0], half[-1]
        moments = [1e3 * row["unit_displacement_work"] for row in half]
        print("peel, moment from", min(moments), "to", max(moments))
        plateau.append(sum(moments) / len(moments))
        # What is stored is a parabola in the angle while no bond breaks.
        for row, moment in zip(half, moments):
            stored = row["J"] - row["dissipated_energy"]
            angle = 1e-3 * row["displacement_factor"]
            if abs(2. * stored / angle / moment - 1.) > 1e-8:
                failures.append("peel, moment and energy")
        growth = (last["J"] - first["J"]) / (1e-3 * (
            last["displacement_factor"] - first["displacement_factor"]))
        if growth > min(moments):
            failures.append("peel, energy of snaps")
        energies.append((last["dissipated_energy"] -
                         first["dissipated_energy"]) /
                        (last["broken_zone"] - first["broken_zone"]))
    compare("peel, moment", crack_couple(), plateau, 0.05)
    print("peel, energy by crack length:", energies)
    if any(abs(energy / 0.04 - 1.) > 0.05 for energy in energies):
        failures.append("peel, energy")

    tack = directory + "/tack.prm"
    openings, ends = [], []
    for cells in "8, 4", "16, 8", "32, 16":
        summary = run(debond, tack, ["Mesh/Cells=" + cells])[0]
        if summary["status"] != "comes off":
            failures.append("tack, status")
        openings.append(path_rows()[9]["largest_gap"])
        ends.append(summary["load_path"]["comes_off_at"])
    compare("tack, opening of the edge at p = 0.05", 0.05 * 1.5, openings, 2e-3)
    print("tack, comes off at:", ends)
    if any(end != 1.4 for end in ends):
        failures.append("tack, end")

    # Stiffer bonds of the same energy: the limit of linear fracture mechanics.
    products = []
    for cells in "160, 2", "320, 4", "640, 8":
        run(debond, directory + "/double-cantilever.prm",
            ["Mesh/Cells=" + cells,
             "Contact law/Bond stiffness=if(x < 60, 0, 2000)",
             "Contact law/Bond threshold=0.0063246",
             "Boundary conditions/Displacement left=free; 1",
             "Load path/Displacement factors=0.8:0.8:2.4, 1.6:-0.8:0",
             "Load path/Bonds heal=false"])
        rows = path_rows()
        products.append(rows[2]["reaction_left_y"] * rows[2]["broken_zone"])
        # The crack closes, and its tip stays.
        tips = [row["fronts"] for row in rows[2:]]
        size = 160. / int(cells.split(",")[0])
        if max(tips) > min(tips) or rows[-1]["broken_zone"] > 0. or (
                abs(tips[0] - rows[2]["broken_zone"]) > size):
            failures.append(f"double cantilever, tip at {tips}")
    compare("double cantilever, force times crack length", crack_couple(),
            products, 0.06)

    for failure in failures:
        print("FAILED:", failure)
    return 1 if failures else 0


with tempfile.TemporaryDirectory() as work:
    program, scenes = (str(pathlib.Path(path).resolve())
                       for path in sys.argv[1:])
    os.chdir(work)
    sys.exit(main(program, scenes))
