# SPDX-License-Identifier: LGPL-2.1-or-later
"""Fits of a block on bonds, which bears F = width d / (H/E + 1/a) for a lift d."""
import json
import os
import pathlib
import subprocess
import sys

import numpy

from common import DEBOND, SOURCE, near

import debond

assert not {"matplotlib", "scipy"} & set(sys.modules)

STIFFNESS, MODULUS = "Constants/a", "Constants/E"
WIDTH, HEIGHT = 20., 10.
pathlib.Path("block.prm").write_text(f"""include {SOURCE}/prm/cookbook/punch.prm
subsection Constants
  set a = 20
  set E = 1000
end
subsection Mesh
  set Cells = 2, 1
end
subsection Material
  set Young modulus = E
end
subsection Contact law
  set Bond stiffness = a
end
subsection Load path
  set Displacement factors = 0:2:10
end
""")
lift = numpy.linspace(0.5, 9.5, 10)  # micrometres
CURVE = "reaction_top_y over displacement_factor"


def force(a, E=1000.):
    return WIDTH * 1e-3 * lift / (HEIGHT / E + 1. / a)


def fit(parameters, y, **options):
    return debond.fit("block.prm", (lift, y), parameters, program=str(DEBOND),
                      **{"curve": CURVE, "directory": "fit", **options})


def thrown(code, *words, parameters=None, **options):
    try:
        fit(parameters or {STIFFNESS: (5, 500)}, force(50.), **options)
    except debond.Error as error:
        assert error.code == code, (error.code, error)
        assert all(word in str(error) for word in words), error
        return
    raise AssertionError(f"no exit code {code}")


# Without noise the stiffness comes back, by its logarithm and on a range with zero.
exact = force(50.)
for bounds in (-10, 200, 45), (5, 500):
    found = fit({STIFFNESS: bounds}, exact)
    assert found.converged and found.names == [STIFFNESS] and not found.warnings, found
    near(found.values[0], 50., 1e-3)
    assert found.rms < 1e-3 * exact.max() and found.correlation.tolist() == [[1.]]
    near(found.curve[1][-1], exact[-1], 1e-3)
# d F / d ln a is F / (1 + a H / E), to what differences of 5 % do.
near(found.sensitivities[-1, 0], exact[-1] / (1. + 50. * HEIGHT / 1000.), 0.03)
# The information grows as d^2: the last five of ten points have 80 % of it.
assert numpy.allclose(found.known[0], (lift[5], lift[9])), found.known

# With noise it comes back within three standard errors, which are those of the linear
# model, and spread as they say. The default curve is that of the support's force.
noise = 0.02
rate = exact / 50. / (1. + 50. * HEIGHT / 1000.)
expected = noise / numpy.sqrt((rate**2).sum())
off = []
for seed in range(3):
    y = exact + noise * numpy.random.default_rng(seed).normal(size=len(lift))
    noisy = fit({STIFFNESS: (5, 500, 48)}, y, noise=noise,
                curve="unit_displacement_work / 0.001 over displacement_factor")
    near(noisy.standard_errors[0], expected, 0.05)
    off.append((noisy.values[0] - 50.) / noisy.standard_errors[0])
assert max(map(abs, off)) < 3 and numpy.ptp(off) > 0.3, off
own = fit({STIFFNESS: (5, 500, 48)}, y).standard_errors[0]
near(own, noisy.standard_errors[0] * numpy.sqrt(10 / 9) * noisy.rms / noise, 1e-3)

# Only H/E + 1/a can be known: this is said, and so is a value that nothing depends on,
# one at its bound, and noise that is smaller than what is left.
said = fit({STIFFNESS: (5, 500, 45), MODULUS: (200, 5000, 1100)}, exact).warnings
assert any("tells Constants/a from Constants/E" in line for line in said), said
idle = fit({"Contact law/Bond threshold": (0.05, 0.1)}, force(20.) + 0.01)
assert any("no measured point depends on Contact law" in line
           for line in idle.warnings), idle.warnings
assert idle.standard_errors[0] == numpy.inf
said = fit({STIFFNESS: (5, 40, 38)}, exact, noise=noise).warnings
assert any("at its bound 40" in line for line in said), said
assert any("more than twice the noise" in line for line in said), said
# Measured noise that is a wave is none.
wave = fit({STIFFNESS: (5, 500, 49)}, exact + 0.1 * numpy.sin(lift))
assert any("neighbouring points" in line for line in wave.warnings), wave.warnings

# At 14.8 the bonds break, at M (1 + a H / E), if they are 5 % softer: the standard
# error is that of the slope, not of this jump.
long = numpy.append(lift, 14.8)
jump = debond.fit("block.prm", (long, long * exact[0] / lift[0]), {
    STIFFNESS: (5, 500, 50)}, CURVE, noise=noise, directory="jump", program=str(DEBOND),
    settings={"Load path/Displacement factors": "0:2:14, 14.8"})
assert any("jumps at 1 of the points" in line for line in jump.warnings), jump.warnings
near(jump.standard_errors[0], noise / numpy.sqrt((numpy.append(
    rate, rate[0] * 14.8 / lift[0])**2).sum()), 0.05)

# What is wrong is said with its name.
thrown(2, "block.prm has no constant b", parameters={"Constants/b": (1, 2)})
thrown(2, "Bond stiffnes", parameters={"Contact law/Bond stiffnes": (1, 2)})
thrown(2, "a needs LOW,HIGH", parameters={STIFFNESS: (1,)})
thrown(2, "a: 7 is not between 1 and 5", parameters={STIFFNESS: (1, 5, 7)})
thrown(2, "no column 'reaction_left_z'", "reaction_left_x",
       curve="reaction_left_z over displacement_factor")
thrown(2, "'status' are numbers", curve="status over displacement_factor")
thrown(2, "no sum of numbers", curve="reaction_top_y.sum() over displacement_factor")
thrown(2, "x from 0 to 9", "at 0.5 to 9.5", settings={
    "Load path/Displacement factors": "0:3:9"})
thrown(2, "no load path", settings={"Load path/Displacement factors": ""})
thrown(3, "a = 20: the run is not verified: ", settings={
    "Verification/Tolerance": 1e-18})


# The command, with the units of a measured table.
def run(*options, code=0):
    done = subprocess.run(
        [SOURCE / "scripts" / "fit", "block.prm", "--debond", DEBOND, "--directory",
         "command", *options], capture_output=True, text=True)
    assert done.returncode == code, (done.returncode, done.stdout, done.stderr)
    return done.stdout + done.stderr


pathlib.Path("measured.csv").write_text("lift in mm,lever,force in kN\n" + "".join(
    f"{x / 1e3:.6g},2,{y / 1e3:.8g}\n" for x, y in zip(lift, exact)))
KILO = "0.001*reaction_top_y over displacement_factor/1000"
BOUNDS = "--fit", "Constants/a=5,500,48"
said = run(*BOUNDS, "--measured", "measured.csv", "--columns",
           "force in kN over lift in mm", "--curve", KILO)
assert "Constants/a = 50" in said and "converged" in said, said
stored = json.loads(pathlib.Path("command/fit.json").read_text())
near(stored["parameters"]["Constants/a"]["value"], 50., 1e-3)
assert stored["converged"] and stored["points"] == 10
rows = debond.runs.read_csv("command/fit.csv")
assert numpy.allclose(rows["measured"], exact / 1e3) and len(rows) == 4
for ending in "png", "svg":
    assert os.path.getsize(f"command/fit.{ending}") > 5000
assert "NOT CONVERGED" in run(
    "--fit", "Constants/a=5,500", "--measured", "measured.csv", "--columns",
    "force in kN over lift in mm", "--curve", KILO, "--evaluations", "1", code=3)
assert "there is no file none.csv" in run(*BOUNDS, "--measured", "none.csv", code=2)
assert "no column 'force'" in run(*BOUNDS, "--measured", "measured.csv", "--columns",
                                  "force over lever", code=2)
pathlib.Path("bare.csv").write_text("0,1\n1,2\n2,3\n")
assert "line with titles" in run(*BOUNDS, "--measured", "bare.csv", code=2)
assert "no such file" in subprocess.run(
    [SOURCE / "scripts" / "fit", "none.prm", "--measured", "bare.csv", *BOUNDS,
     "--debond", DEBOND], capture_output=True, text=True).stderr.lower()
