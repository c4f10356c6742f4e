#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_quadratic_files.sh DEBOND: the files of quadratic displacements. body.vtu has
# quadratic cells, whose displacements in the middles of edges on the contact
# boundary are what the coefficients in contact_profile.csv say.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >plane.prm <<'SCENE'
subsection Mesh
  set Cells  = 10, 2
  set Degree = 2
end
subsection Loads
  set Traction top = 0; if(x < 0.2, 0.69, -0.345)
end
subsection Contact law
  set Quadrature = gauss 8
end
SCENE
cat >solid.prm <<'SCENE'
set Dimension = 3
subsection Mesh
  set Lengths = 0.4, 0.04, 0.08
  set Cells   = 6, 1, 2
  set Degree  = 2
end
subsection Loads
  set Traction top = 0; if(x < 0.2, 0.69, -0.345); 0
end
subsection Contact law
  set Quadrature = gauss 4
end
SCENE

cat >check.py <<'SCRIPT'
import csv, sys
sys.path.insert(0, sys.argv[4])
from vtu import Piece

directory, cell_type, n_corners = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
dim = n_corners - 1
edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)][:3 if dim == 2 else 6]


body = Piece(directory + "/body.vtu")
types, connectivity = body.cells["types"], body.cells["connectivity"]
assert set(types) == {cell_type}, set(types)
n_nodes = n_corners + len(edges)
assert body.n_points == int(sys.argv[5]), body.n_points
assert body.cells["offsets"][0] == n_nodes
points, displacement = body.points, body.at_points["displacement"]
at = lambda field, i: field[3 * i:3 * i + 3]

key = lambda position: tuple(round(x, 6) for x in position)
coefficients = {}
for row in csv.DictReader(open(directory + "/contact_profile.csv")):
    position = [float(row[c]) for c in "xyz"[:dim]] + [0.] * (3 - dim)
    coefficients[key(position)] = float(row["u_nu"])

n_found = largest = 0
for cell in range(len(types)):
    nodes = connectivity[n_nodes * cell:n_nodes * (cell + 1)]
    for k, (a, b) in enumerate(edges):
        middle, ends = nodes[n_corners + k], (nodes[a], nodes[b])
        for x, y, z in zip(at(points, middle), *(at(points, e) for e in ends)):
            assert abs(x - (y + z) / 2) < 1e-7
        if max(points[3 * i + 1] for i in ends) > 0:
            continue
        u = [coefficients.get(key(at(points, i)), 0.) for i in ends]
        if key(at(points, middle)) in coefficients:
            value = (sum(u) / 4 + coefficients[key(at(points, middle))] / 2)
            # The normal points down.
            assert abs(value + displacement[3 * middle + 1]) < 1e-8, (
                value, displacement[3 * middle + 1])
            n_found += 1
            largest = max(largest, abs(value))
assert n_found >= 10 and largest > 1e-4, (n_found, largest)
SCRIPT

"$debond" plane.prm >log
grep -q "^  mesh  *80 triangles, 0.4 x 0.04, quadratic displacements$" log ||
  fail "the log does not say it: $(cat log)"
python3 check.py output/plane 22 3 "$tests" 185
"$debond" solid.prm >/dev/null
python3 check.py output/solid 24 4 "$tests" 587
