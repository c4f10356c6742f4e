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
