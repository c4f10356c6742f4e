#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_claims.sh DEBOND: what Section 6 of the paper says about the parameters
# of its method, on a coarse mesh of its benchmark.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

bundle="Solver/Euclidean bundle"
benchmark "40, 4"
cat >>bar.prm <<'SCENE'
subsection Solver
  set Method = euclidean bundle
  subsection Euclidean bundle
    set Proximal weight = 0.00085
  end
end
SCENE

# sweep NAME "VALUES": the table output/NAME/table.csv for a parameter of the
# bundle method. The errors are relative to the exact minimum.
sweep() {
  cat >study.prm <<STUDY
subsection Study
  set Scene    = bar.prm
  set Columns  = status | iterations | long | short | error
  set Output directory = output/$1
  set Accepted statuses = success | iteration limit
  set Settings = $bundle/Maximum iterations=6000
end
subsection Sweep 1
  set Parameter = $bundle/$1
  set Values    = $2
end
STUDY
  expect_code 0 "$debond" --study study.prm
  table="output/$1/table.csv"
}

# All converge to the same J.
same_J() {
  [ "$(column "$table" status | sort -u)" = success ] ||
    fail "not all converge: $(cat "$table")"
  column "$table" error | awk '$1 > 1e-8 || $1 < -1e-8 { exit 1 }' ||
    fail "another J: $(cat "$table")"
}

sweep "Long step threshold" "0.3 | 0.0003 | 3e-21"
same_J
mapfile -t long < <(column "$table" long)
mapfile -t short < <(column "$table" short)
[ "${long[0]}" -lt "${short[0]}" ] && [ "${short[2]}" -eq 0 ] &&
  [ "${long[2]}" -gt 0 ] || fail "t_bar does not decide long or short"

sweep "Descent fraction" "0.3 | 1e-33"
same_J
sweep "Slope fraction" "0.999 | 0.002"
same_J
sweep "Distance weight" "0.99999 | 0.5"
same_J

# The best u_k is between those that are too small and those that are too large.
sweep "Proximal weight" "0.5 | 0.0008 | 0.00005"
mapfile -t iterations < <(column "$table" iterations)
[ "${iterations[1]}" -lt $((iterations[0] / 2)) ] &&
  [ "${iterations[1]}" -lt $((iterations[2] / 2)) ] ||
  fail "iterations ${iterations[*]}"
