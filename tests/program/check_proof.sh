#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_proof.sh DEBOND SCENE.prm: a proof that is interrupted, or out of
# nodes, leaves a solution and a valid gap; threads change nothing; what is
# printed as a bound is one.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2

# value FILE KEY: of a number or word in a summary.
value() {
  sed -nE "s/^ *\"$2\": \"?([^\",]*)\"?,?$/\1/p" "$1/summary.json"
}

below() {
  awk -v a="$1" -v b="$2" 'BEGIN { exit !(a + 0 < b + 0) }'
}

# prove NAME OPTIONS: brittle bonds, which take some nodes.
prove() {
  local name=$1
  shift
  "$debond" "$scene" --set "Output/Directory=$name" \
    --set "Contact law/Bond stiffness=1e5" \
    --set "Contact law/Bond threshold=2e-4" \
    --set "Solver/Method=majorise minimise" --set Solver/Prove=true "$@" \
    >$name.log 2>&1
}

best=-4.4736793357e-05 # on 40x4
prove one --set Solver/Proof/Threads=1
prove two --set Solver/Proof/Threads=3
grep -q 'minimum *global' one.log || fail "not global"
for key in nodes lower_bound relative_gap functional; do
  [ "$(value one $key)" = "$(value two $key)" ] || fail "threads change $key"
done
[ "$(value one nodes)" -gt 8 ] || fail "one batch of nodes is too few to tell"

prove nodes --set "Solver/Proof/Maximum nodes=9"
[ "$(value nodes nodes)" -eq 9 ] || fail "more than 9 nodes"
grep -q '"status": "node limit"' nodes/summary.json || fail "no node limit"

# Finer, so that it lasts.
set -m
prove signal --set "Mesh/Cells=320, 32" --set Solver/Search=none \
  --set Solver/Proof/Tolerance=1e-15 --set Solver/Proof/Threads=1 &
process=$!
set +m
for _ in $(seq 400); do
  grep -qE '^ +1 ' signal.log 2>/dev/null && break
  sleep 0.05
done
sleep 1
kill -s INT -- -$process
code=0
wait $process || code=$?
cat signal.log
[ $code -eq 4 ] || fail "exit code $code in place of 4"
grep -q '"status": "interrupted"' signal/summary.json || fail "not interrupted"
for file in body.vtu contact_profile.csv history.csv proof.csv; do
  [ -s signal/$file ] || fail "no $file"
done

# No bound is above the minimum.
below "$(value nodes lower_bound)" $best || fail "bound above the minimum"
below "$(value signal lower_bound)" -4.8228930051e-05 ||
  fail "bound above the minimum"


# Bounds are bounds of the result as it is, in the summary and rounded in the log:
# of slender strips that are refined in extended precision, with a gap, lifted and
# loaded, in other units.
cat >strip.prm <<'SCENE'
subsection Mesh
  set Lengths = 150, 2
  set Cells   = 75, 1
end
subsection Material
  set Young modulus = 70000
  set Poisson ratio = 0.3
end
subsection Boundary conditions
  set Clamped boundaries = right
  set Contact boundary   = bottom
  set Displacement left  = free; 0.4
end
subsection Contact law
  set Tangential displacement = free
  set Bond stiffness = 25
  set Bond threshold = 0.006
end
subsection Solver
  set Method = majorise minimise
  set Prove  = true
end
SCENE
# not_above LOWER UPPER WHAT
not_above() {
  awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 <= b + 0) }' ||
    fail "$3: $1 above $2"
}
sed 's/Lengths = 150, 2/Lengths = 0.15, 0.002/; s/70000/7e10/; s/0.4$/4e-4/
  s/stiffness = 25/stiffness = 25e9/; s/0.006/6e-6/' strip.prm >pascal.prm
bounded() {
  local name=$1
  shift
  "$debond" $name.prm "$@" --set Output/Directory=bounds >bounds.log
  local J=$(value bounds functional) lower=$(value bounds lower_bound)
  local printed=$(sed -n 's/.*J >= //p' bounds.log)
  not_above "$lower" "$J" "$name $*: bound"
  not_above "$printed" "$lower" "$name $*: bound in the log"
  not_above "$printed" "$(sed -nE 's/^  J  +([-0-9])/\1/p' bounds.log)" "$name $*: log"
  not_above "$(value bounds relative_gap)" \
    "$(sed -nE 's/.* gap ([^ ]*) of what.*/\1/p' bounds.log)" "$name $*: gap"
  awk -F, 'NR > 1 && $3 > $4 { exit 1 }' bounds/proof.csv || fail "$(cat bounds/proof.csv)"
}
bounded strip
bounded strip --set "Material/Poisson ratio=0"
bounded strip --set "Mesh/Cells=60, 1"
bounded strip --set "Contact law/Initial gap=0.00002*x"
bounded pascal --set "Material/Poisson ratio=0"
bounded strip --set "Boundary conditions/Displacement left=" \
  --set "Loads/Traction top=0; if(x < 30, 0.02, -0.01)"

# So is an interval.
"$debond" "$scene" --set Certificate/Kind=global --set Output/Directory=interval \
  >interval.log
read -r lower upper < <(sed -nE 's/^  interval +([^ ]*) to ([^ ]*)$/\1 \2/p' interval.log)
not_above "$lower" "$(value interval lower)" "interval, lower end"
not_above "$(value interval upper)" "$upper" "interval, upper end"
not_above "$(value interval relative_width)" \
  "$(sed -nE 's/^  certified to +([^ ]*) of.*/\1/p' interval.log)" "width"
