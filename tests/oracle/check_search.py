#!/usr/bin/python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_search.py DEBOND [COUNT [FIRST]]: what the default search misses on random scenes
with many patches (bars, strips clamped at one end, pads clamped on the far side, plates),
beside branch and bound: at most 1 of 100 scenes, where it has proved the minimum or found a
lower one; and on a pad whose least J is far below that of its plain stationary point, what
searches and proofs of all lengths say. Small scenes are beside enumeration in
check_shapes.py."""
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from random_scenes import Draw, patched_scene
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])


def check_word(name, result, least):
    """Global is what is proved to be, and then it is the least."""
    word, proof = result["minimum"]["state"], result.get("proof") or {}
    scenes.check(f"{name}, global without a proof",
                 (word == "global") == (proof.get("status") == "proved"), (word, proof))
    scenes.check(f"{name}, global above the least",
                 word != "global" or result["functional"] <= least + 1e-9 * abs(least), word)


def check_pad():
    """Pulled off in five waves: bonds hold all of it, or let some go. Bonds at Gauss points have
    no proof."""
    pad = ["Lengths=1.7, 0.11", "Young modulus=1", "Poisson ratio=0.1", "Clamped boundaries=top",
           "Method=automatic", "Traction bottom=0; 0.95*sin(16.8*x + 5.65) + 0.35", "Cells=60, 1",
           "Bond stiffness=1400", "Bond threshold=0.007"]
    few = [["Method=majorise minimise", "Prove=true",
            f"Solver/Proof/Maximum nodes={nodes}"] for nodes in (1, 10, 100)]
    gauss = [["Quadrature=gauss 2", "Cells=" + cells, "Search=" + search]
             for cells in ("60, 1", "124, 1") for search in ("automatic", "full")]
    proved, plain, *results = scenes.solve_all([pad + added for added in (
        ["Prove=true"], ["Search=none"], [], ["Search=full"], *few, *gauss)])
    least = proved["functional"]
    scenes.check("proved", proved["minimum"]["state"] == "global"
                 and abs(proved["proof"]["lower_bound"] - least) <= 1e-8 * abs(least))
    scenes.check("a plain minimum far above the least", plain["functional"] > 0.5 * least)
    for result in (plain, *results[:-len(gauss)]):
        check_word("pad", result, least)
        scenes.check("no J is below a bound", result["functional"] >= least - 1e-9 * abs(least))
    for result in results[-len(gauss):]:
        scenes.check("global without a proof", result["minimum"]["search_trials"] > 0
                     and result["minimum"]["state"] != "global", result["minimum"])


def check_many_points():
    """A curve of 201 measured points, with moves for each of them at each node: a proof of few
    nodes comes first, and leaves nothing to search for."""
    points = [(4e-5 * k, .3 * math.sin(math.pi * k / 200)**2 * (1 + .1 * math.sin(k)))
              for k in range(200)] + [(8e-3, 0.)]
    result = scenes.solve("Lengths=0.4, 0.04", "Cells=40, 4", "Clamped boundaries=left",
                          "Contact boundary=bottom", "Traction right=0; 0.1", "Law=curve",
                          "Curve=" + ", ".join(f"{s:.8g}:{t:.8g}" for s, t in points))
    scenes.check("many points", result["minimum"]["state"] == "global"
                 and result["minimum"]["search_trials"] == 0, result["minimum"])


def main(count=5, first=0):
    """Laws of which some bonds break; on every second one bonds have to bridge a gap."""
    missed = tried = number = 0
    while tried < count:
        draw = Draw(first + number)
        number += 1
        scene, height = patched_scene(draw)
        opening = scenes.solve(*scene, "Law=none")["largest_opening"]
        if not opening:
            continue
        tried += 1
        threshold = opening * draw.magnitude(-2., -0.1)
        scene += [f"Bond threshold={threshold}",
                  f"Bond stiffness={draw.magnitude(-2.5, 1.) / height}"]
        if draw.chance(0.5):
            scene.append(f"Initial gap={threshold * draw.uniform(0.1, 1.6)}"
                         f"*(1-cos({draw.uniform(2., 12.)}*x))/2")
        found = scenes.solve(*scene)
        proved = scenes.solve(*scene, "Prove=true", "Solver/Proof/Maximum nodes=1000")
        scenes.check(f"scene {first + number - 1}",
                     found["status"] == proved["status"] == "success", found["errors"])
        check_word(f"scene {first + number - 1}", found, proved["functional"])
        above = found["functional"] - proved["functional"]
        if above > 1e-9 * abs(proved["functional"]):
            missed += 1
            print(f"scene {first + number - 1}: above the minimum by {above} of "
                  f"{proved['functional']}, {found['minimum']['state']}", *scene, sep="\n  ")
    scenes.check("the minimum in 99 of 100", 100 * missed <= count, missed)
    scenes.end()


check_pad()
check_many_points()
main(*map(int, sys.argv[2:]))
