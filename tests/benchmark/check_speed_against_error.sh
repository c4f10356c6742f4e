#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_speed_against_error.sh DEBOND SCRIPT: what the quick comparison writes, and
# errors beside those of independent codes.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
script=$2

"$script" --quick --debond "$debond" --output . 2>log || fail "$(cat log)"
[ "$(head -c 4 speed-against-error.png | tail -c 3)" = PNG ] || fail "no picture"
grep -q "^| paper's method | 40x4 | 671 |" speed_against_error.md || fail "no table"

python3 - <<'PYTHON' || fail "see above"
import csv, sys
rows = {(row["method"], row["mesh"]): {
    key: float(value) if key not in ("method", "mesh") and value else None
    for key, value in row.items()}
    for row in csv.DictReader(open("speed_against_error.csv"))}

def check(condition, what):
    if not condition:
        sys.exit(what)

# The J of an independent code on this mesh, and the limit that its refined meshes
# of quadratic elements go to.
paper = rows["paper's method", "40x4"]
exact = rows["P1 uniform", "40x4"]
check(abs(paper["J"] / -5.7771357506e-04 - 1) < 1e-8, "J of the paper's method")
check(abs(exact["J"] / -5.7771357506e-04 - 1) < 1e-10, "J on 40x4")
check(abs(exact["J_error"] - (1 - 5.7771357506e-04 / 5.9151112e-04)) < 1e-6,
      "error of J on 40x4")
# 2 (J_h - J) is at least the square of the distance in the energy norm, and not
# much more; |u|^2 is between the energies with and without contact.
for name, row in rows.items():
    square = row["energy_error"]**2
    check(0.8 * square < row["J_error"] < 1.25 * square, f"energy norm of {name}")
# From 40x4 to 80x8, corners make errors of J fall a little slower than by 4.
ratio = exact["J_error"] / rows["P1 uniform", "80x8"]["J_error"]
check(3 < ratio < 4, "the rate of J")
check(rows["P2 refined", "up to 3,000"]["J_error"] < 1e-4, "P2 refined")
check(rows["P1 refined", "up to 3,000"]["J_error"] *
      rows["P1 refined", "up to 3,000"]["unknowns"] < 10, "P1 refined")
check(paper["iterations"] > 900 and paper["useful_iterations"] < 400, "iterations")
PYTHON
