#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_multigrid.py DEBOND: contact by truncated multigrid on the coarser meshes of a box:
how many cycles it takes for contact and for A u = f, the same in all units, and that J,
contact and bonds are those of the factorisation."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from run_scenes import Scenes

scenes = Scenes(sys.argv[1])
solve, check, close = scenes.solve, scenes.check, scenes.close
METHOD = ["Traction top=0; if(x < 0.2, 0.69, -0.345)", "Search=none",
          "Method=majorise minimise", "Verification/Tolerance=1e-5"]
SOLID = ["Dimension=3", "Lengths=0.4, 0.04, 0.04", "Traction top=0; if(x < 0.2, 0.69, -0.345); 0"]
MULTIGRID = "Linear solver=multigrid"


def check_scene(linear, contact, cells, *settings):
    """Cycles for A u = f, for which the foundation is out of reach, if a number is given."""
    scene = [*METHOD, *settings, "Cells=" + cells]
    result, direct = solve(*scene, MULTIGRID), solve(*scene, "Linear solver=direct")
    check("success", result["status"] == direct["status"] == "success")
    check("cycles for contact", result["linear_iterations"] <= contact, result["linear_iterations"])
    if linear:
        cycles = solve(*scene, MULTIGRID, "Law=none", "Initial gap=1e3", "Quadrature=nodal",
                       "Verification/Tolerance=1")["linear_iterations"]
        check("cycles for A u = f", cycles <= linear, cycles)
    check("law", result["law_violation"] <= 1e-6, result["law_violation"])
    close("J of the direct path", result["functional"], direct["functional"], 1e-11)
    check("its contact and bonds", result["bond_states"] == direct["bond_states"])
    friction = [r.get("friction", {}) for r in (result, direct)]
    check("its friction", friction[0] == friction[1]
          and 0 not in friction[0].values(), friction)


def check_contrasts():
    """A layer, a million times as soft, whose edge is inside coarse cells, and stiff inclusions
    in what is nearly incompressible: multigrid does not converge, and the factorisation that
    takes its place gives J, also on a path."""
    plate = [METHOD[0], "Cells=160, 16", "Young modulus=69", "Clamped boundaries=left, right"]
    layer = ["Parts/upper=y > 0.0174", "Young modulus upper=6.9e-5"]
    inclusions = ["Parts/grains=sin(x * 628.3) * sin(y * 628.3) > 0.3", "Factors=1, 2",
                  "Young modulus grains=69e6", "Hypothesis=plane strain",
                  "Poisson ratio=0.4999", "Bonds heal=false"]
    for entries in layer, inclusions:
        result = solve(*plate, *entries, MULTIGRID)
        direct = solve(*plate, *entries, "Linear solver=direct")
        check("success", result["status"] == direct["status"] == "success", result["errors"])
        check("a note", any("did not converge" in note for note in result["notes"]))
        close("J of the factorisation", result["functional"], direct["functional"], 1e-11)
        check("its contact and bonds", result["bond_states"] == direct["bond_states"])


def check_units():
    cycles = [solve(*METHOD, MULTIGRID, "Cells=80, 8", *units)["linear_iterations"]
              for units in ([], ["Young modulus=69e9", "Bond stiffness=69e9",
                                 "Traction top=0; if(x < 0.2, 0.69e9, -0.345e9)"],
                            ["Lengths=400, 40", "Young modulus=69e3",
                             "Traction top=0; if(x < 200, 690, -345)", "Bond stiffness=69",
                             "Bond threshold=2"])]
    check("as many cycles", len(set(cycles)) == 1, cycles)


def bonds(a, M):
    return [f"Bond stiffness={a}", f"Bond threshold={M}"]


def friction(bound):
    return [f"Contact law/Friction bound={bound}"]


scenes.all_of(globals(), *((name, check_scene, *case) for name, *case in (
    ("2D", 16, 18, "80, 8"),
    ("2D, fine", 0, 18, "320, 32"),
    ("3D", 16, 18, "40, 4, 4", *SOLID),
    ("2D, a = 6.9", 0, 18, "80, 8", *bonds(6.9, 0.002)),
    ("2D, a = 6900", 0, 18, "80, 8", *bonds(6900, 0.002)),
    ("2D, a = 1e5", 0, 18, "80, 8", *bonds(1e5, 2e-4)),
    ("3D, a = 690", 0, 18, "20, 2, 2", *SOLID, *bonds(690, 0.002)),
    ("3D, a = 1e5", 0, 18, "20, 2, 2", *SOLID, *bonds(1e5, 2e-4)),
    ("2D, odd", 17, 19, "75, 7"),
    ("3D, odd", 19, 21, "37, 5, 3", *SOLID),
    ("2D, cells 4:1", 17, 19, "40, 16"),
    ("2D, cells 10:1", 17, 19, "40, 40"),
    ("3D, cells 4:1", 17, 19, "20, 8, 8", *SOLID),
    ("pad clamped on top", 16, 18, "80, 8", "Traction top=0; 0", "Clamped boundaries=top",
     "Body force=0; if(x < 0.2, 30, -15)"),
    ("clamped left, tangentially free", 20, 24, "80, 8", "Tangential displacement=free",
     "Clamped boundaries=left"),
    ("turned, bottom and top in contact", 16, 18, "80, 8", "Rotation=30",
     "Contact boundary=bottom, top", "Traction top=0; 0", "Body force=3; 10"),
    ("plate clamped at two sides", 18, 20, "24, 3, 24", *SOLID,
     "Traction top=0; if(x < 0.2, 0.1, -0.05); 0", "Lengths=0.4, 0.04, 0.4",
     "Clamped boundaries=left, back"),
    ("gauss 2", 0, 18, "80, 8", "Quadrature=gauss 2"),
    ("friction", 0, 30, "80, 8", *friction(0.2)),
    ("friction of a solid", 0, 60, "40, 4, 4", *SOLID, *friction(0.2)),
    ("off the foundation, pressed", 0, 22, "80, 8", "Initial gap=0.001"),
    *((f"plane strain, nu = {nu}", linear, contact, "80, 8", "Hypothesis=plane strain",
       f"Poisson ratio={nu}") for nu, linear, contact in ((0.45, 40, 50), (0.49, 90, 110))))))
