#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_vtu.sh DEBOND: the fields of the VTU files are where ParaView looks for
# them, and agree with the other files.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >bar.prm <<'SCENE'
subsection Mesh
  set Cells = 10, 2
end
subsection Material
  set Hypothesis = plane strain
end
subsection Loads
  set Traction top = 0.1; if(x < 0.2, 0.69, -0.345)
end
SCENE
cat >solid.prm <<'SCENE'
set Dimension = 3
subsection Mesh
  set Lengths = 0.4, 0.04, 0.08
  set Cells   = 8, 1, 2
end
subsection Loads
  set Traction top = 0.1; if(x < 0.2, 0.69, -0.345); 0.05
end
SCENE
"$debond" bar.prm >/dev/null
"$debond" solid.prm >/dev/null

cat >check.py <<'SCRIPT'
import csv, json, math, sys
sys.path.insert(0, sys.argv[2])
from vtu import Piece

directory, tests = sys.argv[1], sys.argv[2]
n_cells, n_vertices, n_faces = map(int, sys.argv[3:])
dim = 3 if directory.endswith("solid") else 2


def near(a, b, scale=1.):
    assert abs(a - b) <= 1e-5 * abs(b) + 1e-6 * abs(scale), (a, b)


summary = json.load(open(directory + "/summary.json"))
profile = list(csv.DictReader(open(directory + "/contact_profile.csv")))

body = Piece(directory + "/body.vtu")
at_points, at_cells = body.at_points, body.in_cells
assert body.n_cells == n_cells == summary["cells"], body.n_cells
assert body.n_points == n_vertices, body.n_points
near(max(at_cells["von_mises"]), summary["largest_von_mises"])
u = at_points["displacement"]
near(max(math.hypot(*u[3 * i:3 * i + 3]) for i in range(len(u) // 3)),
     summary["largest_displacement"])
if dim == 2:
    for xx, yy, xy, zz, mises in zip(*(at_cells[name] for name in (
            "stress_xx", "stress_yy", "stress_xy", "stress_zz", "von_mises"))):
        near(zz, 0.33 * (xx + yy), mises)
        near(mises, math.sqrt(((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2) / 2
                              + 3 * xy**2))

contact = Piece(directory + "/contact.vtu")
n, points = contact.n_cells, contact.points
at_points, at_cells = contact.at_points, contact.in_cells
assert n == dim * n_faces, n
assert {*at_points} == {
    "displacement", "tangential_force_density", "u_nu", "gap", "normal_force_density",
    "law_violation", "bond_stiffness", "bond_threshold", "damage", "initial_gap"}, at_points
assert {*at_cells} == {"bond_state"} and {*body.at_points} == {"displacement"}
assert {"strain_energy_density", "error_density"} <= {*body.in_cells}
states = ["contact", "bonded", "kink", "broken", "free", "held"]
state_at = {tuple(round(float(row[x]), 6) for x in "xyz"[:dim]):
            states.index(row["state"]) for row in profile}
force_at = {tuple(round(float(row[x]), 6) for x in "xyz"[:dim]): row
            for row in profile}
n_held = 0
corners = 2 * (dim - 1)
for cell in range(n):
    i = corners * cell  # the vertex that the share belongs to
    at = tuple(round(points[3 * i + d], 6) for d in range(dim))
    expected = state_at.get(at, states.index("held"))
    assert at_cells["bond_state"][cell] == expected, (at, expected)
    near(at_points["u_nu"][i],
         float(force_at[at]["u_nu"]) if at in force_at else 0., 1e-3)
    if at in force_at:
        near(at_points["normal_force_density"][i],
             float(force_at[at]["normal_force_density"]), 1.)
        assert not any(math.isnan(x) for x in at_points[
            "normal_force_density"][i:i + corners])
    else:
        n_held += 1
        assert math.isnan(at_points["normal_force_density"][i])
        assert at[0] in (0, 0.4), at
assert n_held > 0

# The foundation's tangential forces, node by node, are its resultant.
for d in range(dim):
    near(sum(float(row["tangential_force_" + "xyz"[d]]) for row in profile),
         summary["tangential_reaction"][d], 0.01)
assert abs(summary["tangential_reaction"][0]) > 1e-3
near(summary["tangential_reaction"][1], 0., 0.01)
SCRIPT
python3 check.py output/bar "$tests" 80 53 10
# Fields of more than one block.
"$debond" bar.prm --set "Mesh/Cells=320, 32" --set Output/Directory=fine >/dev/null
python3 check.py fine "$tests" 40960 20833 320
python3 check.py output/solid "$tests" 384 144 64

# A body that may slide has no such forces.
"$debond" bar.prm --set "Contact law/Tangential displacement=free" \
  --set "Output/Directory=sliding" >/dev/null
[ "$(column sliding/contact_profile.csv tangential_force_x | sort -u |
  sed 's/^-//')" = 0 ] || fail "tangential forces"
