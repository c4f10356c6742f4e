#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_start.sh DEBOND: a run starts where another one ended, and not from what
# does not fit its scene.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >bar.prm <<'SCENE'
subsection Mesh
  set Cells = 10, 1
end
subsection Loads
  set Traction top = 0; if(x < 0.2, 0.69, -0.345)
end
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
  local why=$1 code=0
  shift
  "$debond" bar.prm --set "$start" "$@" >/dev/null 2>errors || code=$?
  [ $code -eq 2 ] && grep -q "$why" errors || fail "$code: $(cat errors)"
}
rejected "is not the displacement of a scene with" --set "Mesh/Cells=11, 1"
rejected "does not satisfy the scene's boundary conditions" \
  --set "Mesh/Lengths=0.4, 0.04" \
  --set "Boundary conditions/Clamped boundaries=left, right, top"
echo "0 0 x" >output/bar/displacement.txt
rejected "is not the displacement of a scene with"
rm output/bar/displacement.txt
rejected "is not the displacement of a scene with"
