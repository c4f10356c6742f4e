#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_start.sh DEBOND: a run starts where another one ended, and not from what
# does not fit its scene.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "10, 1"
cat >>bar.prm <<'SCENE'
subsection Solver
  set Method = euclidean bundle
  subsection Euclidean bundle
    set Proximal weight = 0.05
  end
end
SCENE
start="Solver/Euclidean bundle/Start=output/bar/displacement.txt"

"$debond" bar.prm --set "Output/Displacement=true" >/dev/null
# With such a weight no step is long enough to be taken.
"$debond" bar.prm --set "$start" --set "Output/Directory=again" \
  --set "Solver/Euclidean bundle/Proximal weight=1e9" >/dev/null
grep -q '"total": 0,' again/summary.json || fail "The end is not the start."
for entry in functional law_violation; do
  [ "$(grep -m1 "\"$entry\"" again/summary.json)" = \
    "$(grep -m1 "\"$entry\"" output/bar/summary.json)" ] || fail "another $entry"
done

# rejected WHY SETTING...: exit code 2, with that reason.
rejected() {
  expect_code 2 "$debond" bar.prm --set "$start" "${@:2}"
  grep -q "$1" errors || fail "$(cat errors)"
}
rejected "is not the displacement of a scene with" --set "Mesh/Cells=11, 1"
rejected "does not satisfy the scene's boundary conditions" \
  --set "Mesh/Lengths=0.4, 0.04" \
  --set "Loads/Traction top=" \
  --set "Boundary conditions/Clamped boundaries=left, right, top"
echo "0 0 x" >output/bar/displacement.txt
rejected "is not the displacement of a scene with"
rm output/bar/displacement.txt
rejected "is not the displacement of a scene with"
