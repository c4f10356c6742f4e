# SPDX-License-Identifier: LGPL-2.1-or-later
"""Rates of convergence on coarse meshes, which are those of theory."""
import math

from common import SOURCE, near, study, table

D = 0.01  # of the scenes
SQUARES = "Sweep {}/Values=8, 8 | 16, 16 | 32, 32"
BARS = "Sweep {}/Values=40, 4 | 80, 8 | 160, 16"
RATES = {"L2": 2, "H1": 1, "energy norm": 1}


def run(name, meshes, *more):
    """The rows of a study, each of them a dictionary."""
    study(SOURCE / "prm" / "verification" / "studies" / f"{name}.prm", "--set",
          meshes, *more)
    found = table(f"output/{name}")
    return [dict(zip(found, cells)) for cells in zip(*found.values())]


def check_smooth(rows, exact):
    """Errors of a smooth displacement, J_h - J also by its exact value."""
    finest = rows[-1]
    for column, rate in RATES.items():
        assert abs(finest["order of " + column] - rate) < 0.15, finest
    errors = [(row["J"] - exact) / abs(exact) for row in rows[-2:]]
    assert abs(math.log2(errors[0] / errors[1]) - 2) < 0.15, errors
    return errors[1] / finest["energy norm"]**2


def clamped_corner(kappa):
    """The exponent alpha of u ~ r^alpha at a right angle between a clamped and a
    free side: the root of sin(alpha pi/2)^2 = (kappa+1)^2/(4 kappa) -
    alpha^2/kappa (Williams 1952)."""
    low, high = 0.5, 1.
    for _ in range(60):
        alpha = (low + high) / 2
        below = math.sin(alpha * math.pi / 2)**2 < \
            (kappa + 1)**2 / (4 * kappa) - alpha**2 / kappa
        low, high = (alpha, high) if below else (low, alpha)
    return low


def check_corner(rows, kappa):
    """J falls with h^(2 alpha) at least, and with h^2 at most."""
    J = [row["J"] for row in rows[-3:]]
    rate = math.log2((J[0] - J[1]) / (J[1] - J[2]))
    assert 2 * clamped_corner(kappa) - 0.05 <= rate <= 2.05, rate


# J_h - J is half of the squared energy norm of the error where there is no contact.
near(check_smooth(run("smooth-2d", SQUARES.format(1)), -2.0376990918007922e-04),
     1., 1e-3)
near(check_smooth(run("smooth-3d", "Sweep 1/Values=2, 2, 2 | 4, 4, 4 | 8, 8, 8"),
                  -7.5933375169020064e-05), 1., 2e-3)
check_smooth(run("contact-2d", SQUARES.format(1)), -1.6441953951719577e-05)
check_smooth(run("adhesion-2d", SQUARES.format(1)), -1.8932420208906975e-05)

rows = run("incompressible-2d", SQUARES.format(2), "--set",
           "Sweep 1/Values=0.3 | 0.4999")
for nu in 0.3, 0.4999:
    own = [row for row in rows if row["nu"] == nu]
    near(check_smooth(own, -800 / 49 * D**2 / (2 * (1 + nu))), 1., 1e-3)
# No locking: nearly incompressible, the error is at most twice as large.
for soft, stiff in zip(rows[:3], rows[3:]):
    assert stiff["H1"] <= 2 * soft["H1"], (soft, stiff)

for name in "signorini", "adhesion":
    check_corner(run(name, BARS.format(1)), (3 - 0.33) / (1 + 0.33))
rows = run("incompressible-benchmark", BARS.format(2), "--set",
           "Sweep 1/Values=0.3 | 0.4999")
for nu in 0.3, 0.4999:
    check_corner([row for row in rows if row["nu"] == nu], 3 - 4 * nu)
