#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_fuzz.py DEBOND PRM_DIRECTORY [N]: N mutations of the shipped scenes and of small
ones with all kinds of bodies, parts, supports and bonds, half of them with more entries:
each is rejected with the entry or the line named and nothing written, or read; what is
small is also solved, a part of it by multigrid. The same of mutated mesh files, a sixth
as many. A case that crashes, hangs or fails is printed."""
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import msh

SECONDS_FOR_A_CASE = 60
LARGEST_TO_SOLVE = 1500  # unknowns
BATCH = 60               # scenes of one process

HOSTILE = """|0|-0|1|-1|2|3|1e-300|1e300|1e308|-1e308|1e-12|1e12|nan|inf|-inf|1e|0x10|1,5
1, 1|2, 1|3, 2, 1|1, 1, 1|1e-9, 1e9|999999999999|4294967296|0.5|0.4999999|-0.999|left
right, right|bottom|bottom, top|left, right, bottom, top|front|free|fixed|none|winkler
exact|midpoint|gauss 1|gauss 99|gauss 100|gauss -1|plane strain|true|automatic
energy bundle|majorise minimise|multigrid|direct|0; 0|0; 1/x|0; 1/(x-0.2)|0; log(-1)
0; sqrt(x-0.2)|0; rint(1e9*x)|0; x|0; 0; 0|0; 1e300|0; sin(1e6*x)|0; if(x<0.2,1,|0; y z|;
0;|a=1|a=1, a=2|x=1|pi=3|a=nan|{scene}|/|\\|#|end|0; rand()|0; rand_seed(1)|0; x=1
0; 0.69*(x^-1)|..|x|69*x|0.1-x|1/(x-0.1)|if(x>0.1,0,69)|0.001*y|free; 0.001|free; free
free; -0.001|free; 1e-5*t|free; free; free|glued|glued, top|core|all|bottom: x > 0.05
bottom: x > 9|bottom: |nowhere: x > 0.05|glued: x < 0.1|y > 0.02|x ? 1 : 0|0:0.25:1
bottom: x > 0.05 && x < 0.07|0.5, 1, 0.5, 0|0:0:1|1:-0.5:-1|0, nan|mean bottom
force glued|force core|mean|0.1, 0.02|9, 9|box|file|generator|plane.msh|solid.msh
missing.msh|hyper_L|-1 : 1 : true|subdivided_hyper_rectangle|traction, body force|top
symmetry""".replace("\n", "|").split("|") + ["9" * 5000, "0; " + "(" * 2000]

# Entries that are added to scenes, with a value that fits.
MORE = """Parts/glued=bottom: x > 0.05|Parts/core=y > 0.02|Parts/bottom=y > 0.02|Parts/=x > 0
Material/Young modulus core=7|Material/Poisson ratio core=0.2
Material/Poisson ratio upper=0.2|Material/Thermal expansion core=1e-5
Material/Thermal expansion=1e-5|Material/Young modulus nowhere=7
Boundary conditions/Roller boundaries=right
Boundary conditions/Clamped boundaries=|Boundary conditions/Contact boundary=bottom, top
Boundary conditions/Displacement right=free; 0.0001
Boundary conditions/Displacement top=free; 0.0001
Boundary conditions/Displacement bottom=0.0001; free
Boundary conditions/Displacement glued=0; free|Contact law/Bond stiffness=69*x
Contact law/Bond threshold=0.001*(1+x)|Contact law/Bond strength=0.1
Contact law/Fracture energy=1e-4|Contact law/Initial gap=0.0001*x
Contact law/Bond stiffness glued=7|Contact law/Bond stiffness bottom=7
Contact law/Bond stiffness top=0|Contact law/Bond threshold glued=0.0001
Contact law/Bond threshold nowhere=0.0001|Contact law/Bond strength glued=0.1
Contact law/Fracture energy glued=1e-4|Contact law/Initial gap glued=0.0001
Contact law/Initial gap bottom=0.0001*x|Contact law/Tangential displacement glued=free
Contact law/Tangential displacement bottom=free|Contact law/Tangential displacement=free
Contact law/Quadrature=exact|Contact law/Law=curve|Contact law/Law=bilinear|Contact law/Curve=0:0, 1e-4:0.01, 2e-4:0|Contact law/Traction factor=x|Load path/Factors=0.5, 1, 0.5, 0
Load path/Displacement factors=0:0.25:1|Load path/Dead loads=body force
Load path/Bonds heal=false|Loads/Temperature change=20*y|Loads/Traction glued=0; -0.01
Loads/Traction top=0; 0.01|Loads/Body force=0; 0.01|Probes/tip=0.1, 0.02
Probes/grip=force bottom|Probes/all=mean core|Mesh/Source=box|Mesh/File=plane.msh
Mesh/Scale=0.1|Mesh/Generator=hyper_L|Mesh/Arguments=-1 : 1 : true|Mesh/Refinements=1
Mesh/Degree=2|Mesh/Cells=6, 2|Solver/Method=automatic|Solver/Prove=true
Certificate/Kind=global|Accuracy/Maximum unknowns=300""".replace("\n", "|").split("|")

# Small scenes with bodies of all kinds.
SMALL = ["""Mesh/Lengths=0.2, 0.04|Mesh/Cells=10, 2|Parts/glued=bottom: x > 0.05
Parts/core=y > 0.02|Material/Young modulus core=7|Material/Thermal expansion=1e-5
Boundary conditions/Clamped boundaries=left|Boundary conditions/Roller boundaries=right
Boundary conditions/Contact boundary=bottom, top|Contact law/Bond stiffness=if(x>0.1,0,69)
Contact law/Bond threshold glued=0.001|Contact law/Bond stiffness top=7
Contact law/Initial gap top=0.0001*x|Contact law/Tangential displacement top=free
Loads/Body force=0; 0.01|Loads/Temperature change=20*y|Probes/tip=0.2, 0.02
Probes/grip=force glued""",
         """Mesh/Source=file|Mesh/File=plane.msh|Mesh/Scale=0.1
Boundary conditions/Clamped boundaries=|Boundary conditions/Roller boundaries=left
Boundary conditions/Contact boundary=bottom|Boundary conditions/Displacement top=free; 1e-4
Material/Young modulus upper=7|Material/Poisson ratio upper=0.2
Contact law/Bond strength bottom=0.1|Contact law/Fracture energy bottom=1e-4
Load path/Displacement factors=0:0.5:2|Load path/Bonds heal=false""",
         """Mesh/Source=generator|Mesh/Generator=hyper_L|Mesh/Arguments=-1 : 1 : true
Boundary conditions/Clamped boundaries=0|Boundary conditions/Contact boundary=1, 2
Contact law/Bond stiffness 1=10|Contact law/Bond strength 2=0.1
Contact law/Bond threshold 2=0.01|Contact law/Quadrature=gauss 2
Loads/Traction 5=0; 0.1""",
         """Dimension=3|Mesh/Source=file|Mesh/File=solid.msh
Boundary conditions/Clamped boundaries=|Boundary conditions/Contact boundary=bottom, top
Contact law/Bond stiffness bottom=10|Contact law/Bond threshold top=0.01*(1+x)
Contact law/Initial gap top=0.001|Loads/Body force=0; 0.1; 0|Loads/Pressure top=0.01
Load path/Factors=0.5, 1, 0
Load path/Dead loads=body force"""]
ODD = ["-1", "0", "1e300", "nan", "x", "9" * 20, "4294967297", "2", "7", "", '"', "0.5",
       "4.1 1 8"]

# Where a rejection says that the mistake is: the line, an entry, or the load and the
# point; of a mesh, whatever is wrong with it or with names that it has lost.
PLACE = re.compile(r"debond: case\d+\.prm:\d+: |Dimension|[A-Z][A-Za-z ]*/[A-Z][a-z]+|"
                   "traction|body force|Boundary conditions|clamped|contact boundary")
MESH_PLACE = re.compile(r"debond: case\d+\.prm:\d+: .*(case\d+\.msh|the body has no|"
                        "has no (face|cell)|Boundary conditions|rigid motion)", re.S)


def scene(entries):
    lines = []
    for entry in entries:
        path, value = entry.split("=", 1)
        section, _, name = path.rpartition("/")
        lines += ["subsection " + section] * bool(section)
        lines += [f"  set {name} = {value}"] + ["end"] * bool(section)
    return lines


def mutated(draw, lines, is_mesh):
    lines = list(lines)
    for _ in range(draw.randint(1, 3)):
        at = draw.randrange(len(lines))
        line = lines[at]
        place = draw.randint(0, len(line))
        kind = draw.randrange(8 if is_mesh else 12)
        if kind == 0 and len(lines) > 1:
            del lines[at]
        elif kind == 1:
            lines.insert(at, draw.choice(lines))
        elif kind == 2:
            lines[at] = line[:place] + line[place + 1:]
        elif kind == 3:
            lines[at] = line[:place] + chr(draw.randint(1, 255)) + line[place:]
        elif kind == 4:
            lines[at] = line[:place]
        elif kind == 5:
            other = draw.randrange(len(lines))
            lines[at], lines[other] = lines[other], line
        elif is_mesh:
            words = line.split(" ")
            words[draw.randrange(len(words))] = draw.choice(ODD)
            lines[at] = " ".join(words)
        elif "=" in line:
            lines[at] = line[:line.index("=") + 2] + draw.choice(HOSTILE)
    return lines


def is_small(lines):
    """As far as the text says."""
    text = "\n".join(lines)
    size = 6 if re.search(r"Dimension *= *3", text) else 4
    size *= 4 if re.search(r"Degree *= *2", text) else 1
    for cells in re.findall(r"Cells *= *(.*)", text)[-1:]:
        for n in re.findall(r"\d+", cells):
            size *= int(n) + 1
    return size <= 2 * LARGEST_TO_SOLVE


def run(debond, cases, options):
    """The exit code and what is printed of each; 'crash' or 'hang' for a code."""
    results = {}
    while len(results) < len(cases):
        rest = cases[len(results):]
        with open("log", "wb") as log:
            try:
                code = subprocess.run(
                    [debond, *(case + ".prm" for case in rest), *options], stdout=log,
                    stderr=log, timeout=SECONDS_FOR_A_CASE + 5 * len(rest)).returncode
            except subprocess.TimeoutExpired:
                code = None
        text = pathlib.Path("log").read_text(errors="replace")
        if len(rest) == 1:
            text = f"== {rest[0]}.prm\n{text}\n\nexit code  scene\n {code} {rest[0]}.prm"
        _, *logs = re.split(r"^== .*\n|\nexit code  scene\n", text, flags=re.M)
        if code is None or code < 0 or len(logs) <= len(rest):
            # The one it was at; those before ended.
            done = logs[:-1]
            codes = ["?"] * len(done) + ["hang" if code is None else "crash"]
        else:
            done, codes = logs[:-1], [line.split()[0]
                                      for line in logs[-1].strip().split("\n")]
        for case, own, said in zip(rest, codes, logs):
            results[case] = (own, said)
    return results


def check(debond, cases, counts, is_mesh):
    """Cases by their lines: how each ends."""
    small = [name for name, lines in cases.items() if is_mesh or is_small(lines)]
    large = [name for name in cases if name not in small]
    few = ["--set=Solver/%s bundle/Maximum iterations=50" % name
           for name in ("Euclidean", "Energy")]
    multigrid = ["--set=Solver/Method=majorise minimise", "--set=Solver/Prove=false",
                 "--set=Solver/Linear solver=multigrid"]
    fourth = len(small) // 4
    for names, options in ((large, ["--validate"]), (small[fourth:], few),
                           (small[:fourth], few + multigrid)):
        for name, (code, said) in run(debond, names, options).items():
            faults = []
            counts[code] = counts.get(code, 0) + 1
            if code == "2":
                messages = [line for line in re.split("^(?=debond: )", said, flags=re.M)
                            if line.startswith("debond: ")]
                faults += ["no entry is named: " + line for line in messages
                           if not (MESH_PLACE.match(line) if is_mesh else
                                   PLACE.search(line))] or (
                                       [] if messages else ["no message"])
                if os.path.exists("output/" + name):
                    faults.append("rejected, but files are written")
            elif code not in ("0", "3", "?"):
                faults.append(f"{code}: {said}")
            for fault in faults:
                counts["failures"] = counts.get("failures", 0) + 1
                print(f"{name}: {fault}\n" + "\n".join(cases[name]))
    shutil.rmtree("output", ignore_errors=True)


def main(debond, prm, n):
    draw = random.Random(20260702)
    bases = [pathlib.Path(file).read_text().split("\n")
             for folder in ("", "cookbook")
             for file in sorted((prm / folder).glob("*.prm"))]
    bases += [scene(text.replace("\n", "|").split("|")) for text in SMALL] * 6
    bodies = [(msh.box((4, 2), (2., 1.)), version, odd) for version, odd in
              (("2.2", True), ("4.1", False))]
    bodies += [(msh.box((4, 2), (2., 1.), True), "2.2", True),
               (msh.box((2, 1, 1), (2., 1., 1.)), "2.2", True),
               (msh.box((2, 1, 1), (2., 1., 1.)), "4.1", True)]
    meshes = [msh.text(*body, version=version, is_odd=odd)
              for body, version, odd in bodies]
    for name, text in (("plane", meshes[0]), ("ring", meshes[1]), ("solid", meshes[3])):
        pathlib.Path(name + ".msh").write_text(text)

    totals = []
    for is_mesh, size in ((False, n), (True, n // 6)):
        counts = {}
        for first in range(0, size, BATCH):
            cases = {}
            for number in range(first, min(first + BATCH, size)):
                name = f"case{number}"
                if is_mesh:
                    which = number % len(meshes)
                    changed = "\n".join(mutated(draw, meshes[which].split("\n"), True))
                    if draw.random() < 0.1:
                        changed = changed[:draw.randrange(len(changed))]
                    pathlib.Path(name + ".msh").write_text(changed)
                    solid = ["Dimension=3"] if which > 2 else []
                    lines = scene(solid + [
                        "Mesh/Source=file", f"Mesh/File={name}.msh",
                        "Boundary conditions/Clamped boundaries=left",
                        "Boundary conditions/Contact boundary=bottom, top",
                        "Material/Young modulus upper=7", "Contact law/Bond stiffness top=7",
                        "Loads/Traction right=0; 0.1" + "; 0" * len(solid)])
                else:
                    lines = mutated(draw, draw.choice(bases), False)
                    if draw.random() < 0.5:
                        for _ in range(draw.randint(1, 3)):
                            entry = draw.choice(MORE)
                            if draw.random() < 1. / 3.:
                                entry = entry.split("=")[0] + "=" + draw.choice(HOSTILE)
                            lines += scene([entry])
                pathlib.Path(name + ".prm").write_text("\n".join(lines) + "\n")
                cases[name] = lines
            check(debond, cases, counts, is_mesh)
        print("mesh files:" if is_mesh else "scenes:", counts)
        totals.append(counts)
    return any("failures" in counts or not {"0", "2"} <= counts.keys()
               for counts in totals)


if __name__ == "__main__":
    program, scenes = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        sys.exit(main(program, scenes, int(sys.argv[3]) if len(sys.argv) > 3 else 500))
