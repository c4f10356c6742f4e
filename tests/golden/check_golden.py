#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_golden.py DEBOND PRM_DIRECTORY [NAME...]: what scenes with every pair of features that go
together answered when their list, golden.tsv, was made; pairs with ranks that ranks/check_ranks.py
compares are left out. A change of structure keeps it: exit code, J, the word for the minimum, bond
states. A lower J, a stronger word and a scene that was refused and runs are printed as better and
are no failure. Without a name a third of them, with each scene and each entry; with "all" all; with
names only those, whose files stay in a folder that is printed."""
import concurrent.futures, json, os, re, shutil, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, ".."))
import msh
from run_scenes import scene_text

# Each version of Gmsh makes a mesh of its own of a geometry.
HAS_GMSH_OF_LIST = subprocess.run(["gmsh", "--version"], text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT).stdout.startswith("4.8.")
WORDS = ["", "stationary", "local minimum", "best known", "global"]


def few(rows):
    """Those that have a scene or an entry that none before them has, and every fourth."""
    seen, kept = set(), []
    for number, row in enumerate(rows):
        features = {row[1], *row[2].split(" | ")}
        if number % 4 == 0 or features - seen:
            kept.append(row)
        seen |= features
    return kept


def write_scenes(rows, prm, directory):
    """A copy of the scenes' folder with a scene for each row beside its own."""
    shutil.copytree(prm, os.path.join(directory, "prm"))
    mesh = os.path.join(directory, "tri.msh")
    with open(mesh, "w") as file:
        file.write(msh.triangles())
    for number, row in enumerate(rows):
        name, scene, settings = row[:3]
        folder, base = os.path.split(scene)
        settings = [s for s in settings.split(" | ") if s]
        row.append([s[1:] for s in settings if s.startswith("@")])
        settings = [s.replace("tri.msh", mesh)
                    for s in settings if not s.startswith("@")]
        results = os.path.join(directory, "results", str(number))
        settings += ["Output/Directory=" + results, "Output/Body VTU=false",
                     "Output/Contact VTU=false", "Output/Machine details=false"]
        file = os.path.join(folder, "golden-%d.prm" % number)
        with open(os.path.join(directory, file), "w") as text:
            text.write(scene_text(base, settings))
        row += [file, results]


def run(debond, rows, directory):
    """Exit codes of the rows, which have the same number of ranks."""
    ranks = rows[0][7]
    command = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n",
               ranks[0]] if ranks else []
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1",
                       OMPI_MCA_mpi_yield_when_idle="1")
    done = subprocess.run(command + [debond] + [row[8] for row in rows],
                          cwd=directory, env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if len(rows) == 1:
        return [(rows[0], done.returncode)]
    list = re.findall(r"^ +(\d+)  (\S+)$", done.stdout, re.MULTILINE)
    codes = {scene: int(code) for code, scene in list[-len(rows):]}
    return [(row, codes.get(row[8], -1)) for row in rows]


def difference(row, code):
    """'same', 'better' or 'worse', and what it is."""
    old_code, old_J, old_word, old_states = int(row[3]), row[4], row[5], row[6]
    if code != old_code:
        return ("better" if code == 0 else "worse",
                "exit code %d, was %d" % (code, old_code))
    try:
        with open(os.path.join(row[9], "summary.json")) as file:
            summary = json.load(file)
    except OSError:
        return "same", ""
    J = summary.get("functional")
    with open(os.path.join(row[9], "parameters.prm")) as file:
        geometry = not HAS_GMSH_OF_LIST and re.search(r"set File += \S+\.(geo|step)$", file.read(),
                                                      re.MULTILINE)
    if old_J and J is not None:
        old_J = float(old_J)
        tolerance = 2 * summary["estimated_error"] if geometry else 1e-9 * abs(old_J)
        if abs(J - old_J) > tolerance + 1e-18:
            # No minimum of the same problem is below the global one.
            return ("better" if J < old_J and old_word != "global" else "worse",
                    "J %.12e, was %.12e" % (J, old_J))
    word = (summary.get("minimum") or {}).get("state") or ""
    if word != old_word:
        return ("better" if WORDS.index(word) > WORDS.index(old_word) else "worse",
                "%s, was %s" % (word, old_word))
    states = " ".join("%s:%d" % (name, n) for name, n in
                      sorted((summary.get("bond_states") or {}).items()) if n)
    if states != old_states and not geometry:
        return "worse", "%s, was %s" % (states, old_states)
    return "same", ""


def main():
    debond, prm, *names = sys.argv[1:]
    with open(os.path.join(HERE, "golden.tsv")) as file:
        rows = [line.rstrip("\n").split("\t") for line in file if line[0] != "#"]
    if not names:
        rows = few(rows)
    elif names != ["all"]:
        rows = [row for row in rows if row[0] in names]
    directory = tempfile.mkdtemp()
    write_scenes(rows, prm, directory)
    lists = {}
    for number, row in enumerate(rows):
        # Few enough in each for the processors to end at the same time.
        lists.setdefault((tuple(row[7]), number % 6), []).append(row)
    counts = {"same": 0, "better": 0, "worse": 0}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for results in pool.map(lambda list: run(os.path.abspath(debond), list, directory),
                                lists.values()):
            for row, code in results:
                kind, what = difference(row, code)
                counts[kind] += 1
                if kind != "same":
                    print("%s: %s: %s" % (kind, row[0], what))
    print(", ".join("%d %s" % (n, kind) for kind, n in counts.items()))
    if names and names != ["all"]:
        print(directory)
    else:
        shutil.rmtree(directory)
    return 1 if counts["worse"] or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
