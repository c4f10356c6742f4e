# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a study makes of its cases: tables, plots, failures, going on."""
import os
import pathlib
import signal
import subprocess
import time

import numpy

from common import DEBOND, SOURCE, near, study, table

from debond import plots
from debond import study as studies

HEAD = f"""subsection Study
  set Scene   = {SOURCE}/prm/benchmark-40x4.prm
  set Columns = status | unknowns | J | h | broken = /bond_states/broken
"""
SWEEPS = """end
subsection Sweep 1
  set Parameter = Mesh/Cells
  set Label     = cells
  set Values    = 10, 1 | 20, 2
end
subsection Sweep 2
  set Parameter = Contact law/Bond stiffness & Contact law/Bond threshold
  set Values    = 69 & 0.002 | 6.9 & 0.002
end
subsection Plots
  set Kinds = displacement | law | J over unknowns
end
"""
pathlib.Path("one.prm").write_text(
    HEAD + "  set Methods = majorise minimise\n" + SWEEPS)
study("one.prm")
found = table("output/one")
assert found["status"] == ["success"] * 4, found
# Unknowns of a crossed mesh: 2 for each node that is not clamped, less the
# tangential ones of the lower side.
for cells, unknowns, h in zip(found["cells"], found["unknowns"], found["h"]):
    n, m = map(int, cells.split(","))
    assert unknowns == 2 * (n * m + (n - 1) * (m + 1)) - (n - 1), unknowns
    near(h, 0.4 / n, 1e-12)
for plot in "displacement", "law", "J-over-unknowns":
    for ending in "png", "svg":
        assert os.path.getsize(f"output/one/plots/{plot}.{ending}") > 5000
law = pathlib.Path("output/one/plots/law.svg").read_text()
assert "a = 69, M = 0.002" in law and "a = 6.9, M = 0.002" in law
assert "J-over-unknowns.png" in open("output/one/index.md").read()

# The same again runs nothing; another value runs alone.
summary = pathlib.Path("output/one/cases").glob("*/summary.json")
times = {path: path.stat().st_mtime_ns for path in summary}
assert "cases done" not in study("one.prm")
more = study("one.prm", "--set", "Sweep 1/Values=10, 1 | 20, 2 | 30, 3")
assert "2 of 2 cases done" in more, more
assert all(path.stat().st_mtime_ns == time for path, time in times.items())

# J_min is that from rest; a lower one is told.
pathlib.Path("lower.prm").write_text(
    HEAD.replace("= status", "= J_min | error | status") +
    "  set Settings = Contact law/Bond stiffness=690\n"
    "  set Methods = majorise minimise | automatic\nend\n")
study("lower.prm")
assert abs(table("output/lower")["error"][0]) < 1e-9 and table("output/lower")["error"][1] < -1.
page = open("output/lower/index.md").read()
assert page.count("is lower than J_min") == 1 and "method = automatic is lower" in page, page

# A case that is refused leaves the others.
pathlib.Path("two.prm").write_text(HEAD + """end
subsection Cases
  set good  = Solver/Method=majorise minimise
  set wrong = Mesh/Cells=0, 1
  set 3D    = bar.prm | Solver/Method=majorise minimise
end
""")
pathlib.Path("bar.prm").write_text(f"include {SOURCE}/prm/bar-3d.prm\n")
said = study("two.prm", code=3)
found = table("output/two")
assert found["case"] == ["good", "wrong", "3D"], found
assert found["status"][0] == found["status"][2] == "success", found
assert "Cells" in found["status"][1] and "wrong" in said, (found, said)

# What is wrong with the study is said with file and line.
pathlib.Path("bad.prm").write_text(HEAD.replace("Columns", "Colums") + "end\n")
said = study("bad.prm", code=2)
assert "bad.prm:3: Study/Colums" in said and "Study/Columns?" in said, said
# also which columns there are, before and after the runs.
columns = "status | unknowns | J"
for entry, words in {
        "Plots/Kinds=force over M": ("Plots/Kinds", "no column 'force', but status, "
                                     "unknowns, J, h, broken", "TITLE = /POINTER"),
        "Plots/Kinds=J over cells": ("not all values of 'cells' are numbers",),
        "Plots/Kinds=forces": ("there is no plot 'forces'", "convergence"),
        "Study/Columns=/reactions/top/1": ("no case has /reactions/top/1, but left",),
        "Study/Columns=/reactions/left/2": ("but 0, 1",),
        "Study/Columns=J | largest J": ("no case has largest J",),
        "Sweep 2/Values=linear 1 2": ("Sweep 2/Values", "linear FIRST LAST COUNT"),
        "Plots/Powers=1, 2": ("Plots/Powers", "1, 2"),
}.items():
    said = study("one.prm", "--set", entry, code=2)
    assert all(word in said for word in words), said

# A column of a load path over a constant of the scene, with a curve for each value of
# the other sweep, though that is the last one. The block comes off as a column does:
# it pulls with at most a M on each unit of its length, 20.
pathlib.Path("path.prm").write_text(f"""include {SOURCE}/prm/cookbook/punch.prm
subsection Constants
  set w = 10
  set M = 0.01
  set a = 50
end
subsection Mesh
  set Lengths = 2 * w, w
end
subsection Contact law
  set Bond stiffness = a
  set Bond threshold = M
end
subsection Load path
  set Displacement factors = 0:1:30
end
""")
pathlib.Path("force.prm").write_text("""subsection Study
  set Scene   = path.prm
  set Columns = h | last force = /reactions/top/1 | force = largest reaction_top_y
end
subsection Sweep 1
  set Parameter = Constants/M
  set Label     = M in mm
  set Values    = linear 0.005 0.015 3
end
subsection Sweep 2
  set Parameter = Constants/a
  set Values    = 25 | 50
end
subsection Plots
  set Kinds = force over M in mm | last force over force log y | iterations log x
end
""")
study("force.prm")
found = table("output/force")
assert abs(found["last force"]).max() < 1e-9, found
assert set(found["h"]) == {20 / 8}, found
assert list(found["M in mm"][::2]) == [0.005, 0.01, 0.015], found
for M, a, force in zip(found["M in mm"], found["a"], found["force"]):
    assert 0.8 * 20 * a * M < force <= 20 * a * M * (1 + 1e-9), (M, a, force)
curves = pathlib.Path("output/force/plots/force-over-M-in-mm.svg").read_text()
assert "a = 25" in curves and "a = 50" in curves and "M in mm = " not in curves
mixed = studies.Study("force.prm", ["Sweep 1/Values=0.015 | 0.005 | 0.01"])
curves = studies.groups(mixed, [studies.Row(mixed, case) for case in mixed.cases],
                        mixed.sweeps[0])
assert [row.case.values[0] for row in curves["a = 50"]] == ["0.005", "0.01", "0.015"]
page = open("output/force/index.md").read()
assert "The plot last-force-over-force has no points" in page
assert "iterations.png" in page and "Best values" not in page

# A signal ends it, and it goes on.
pathlib.Path("long.prm").write_text(HEAD + SWEEPS.replace(
    "10, 1 | 20, 2", "10, 1 | 160, 16"))
process = subprocess.Popen([SOURCE / "scripts" / "study", "long.prm",
                            "--debond", DEBOND, "--jobs", "1"],
                           stdout=subprocess.PIPE, text=True)
assert "long" in process.stdout.readline()
assert "1 of 4" in process.stdout.readline()
process.send_signal(signal.SIGINT)
assert process.wait(60) == 4
said = study("long.prm", "--set", "Sweep 1/Values=10, 1 | 20, 2", "--set",
             "Sweep 2/Values=69 & 0.002")
assert "1 of 1 cases done" in said, said

# Fifty curves have a legend that can be read.
plot = plots.Plot("many", "", "x", "y")
for k in range(50):
    plot.add(f"case {k}", [0, 1], [k, k + 1])
plot.save(".")
assert len(plot.axes.get_legend().get_texts()) == 25

# Axes are linear unless asked, and logarithmic ones have more than three labels.
assert plots.Plot("a", "", "x", "y").axes.get_xscale() == "linear"
assert plots.parse("J over h log") == ("J over h", "xy")
assert plots.parse("iterations log x") == ("iterations", "x")
assert plots.parse("steps") == ("steps", "") and plots.parse("fit") == ("fit", "xy")
plot = plots.Plot("axes", "", "x", "y", "x")
axis = plot.axes.xaxis
for decades in numpy.linspace(0.05, 8, 100):
    for low in 1., 1.1, 2., 4., 7e-6:
        plot.axes.set_xlim(low, low * 10**decades)
        axis.set_major_locator(plots.ticker.LogLocator())
        plots.label_ticks(axis)
        shown = [tick for tick in axis.get_majorticklocs() if axis.major.formatter(tick)
                 and 0.999 * low < tick < 1.001 * low * 10**decades]
        assert 3 < len(shown) < 14, (low, decades, shown)
plots.plt.close(plot.figure)

# The rate of a power law is its exponent, in the window that belongs to it.
k = numpy.arange(1, 2001)
exponent, factor, first, last = studies.fit_rate(5. * k**-3., 1e-3, 1e-8)
near(exponent, -3., 1e-9)
near(factor, 5., 1e-9)
assert (first, last) == (18, 794), (first, last)

# All studies of the project can be read.
files = [path for folder in ("studies", "verification/studies", "benchmarks")
         for path in (SOURCE / "prm" / folder).glob("*.prm")]
assert len(files) > 20
for path in files:
    plots.check(studies.Study(str(path)))
