#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_failures.sh DEBOND: a case that fails says so in its row, the others
# are not touched by it, and the study does not return 0.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >bar.prm <<'SCENE'
subsection Mesh
  set Cells = 10, 1
end
subsection Solver
  set Method = euclidean bundle
  subsection Euclidean bundle
    set Proximal weight    = 0.01
    set Maximum iterations = 200
  end
end
SCENE
cat >study.prm <<'STUDY'
subsection Study
  set Scene   = bar.prm
  set Columns = status | iterations | J | error
end
subsection Sweep 1
  set Parameter = Loads/Traction top
  set Label     = load
  set Values    = 0; -0.1 | 0; if(x < 0.2, 1/0, 1) | 0; if(x < 0.2, 0.69, -0.345) | 0; 0
end
STUDY
expect_code 3 "$debond" --study study.prm
table=output/study/table.csv
sed -i 's/, / /g' $table
mapfile -t status < <(column $table status)
[ "${status[0]}" = success ] || fail "row 1: ${status[0]}"
[[ ${status[1]} == *"exit code 2: --set: Loads/Traction top: The traction on top is inf"* ]] ||
  fail "row 2: ${status[1]}"
[ "${status[2]}" = "iteration limit" ] || fail "row 3: ${status[2]}"
[ "${status[3]}" = success ] || fail "row 4: ${status[3]}"
mapfile -t J < <(column $table J)
[ "${J[1]}" = "" ] && [ "${J[3]}" = 0 ] || fail "J ${J[*]}"
mapfile -t iterations < <(column $table iterations)
[ "${iterations[2]}" = 200 ] || fail "iterations ${iterations[*]}"
grep -q "exit code 2" output/study/index.md || fail "not in index.md"
# The one with exit code 2 has no exact minimum either.
[ "$(grep -c '^debond: case load' errors)" -eq 3 ] || fail "$(cat errors)"

# A status that the study expects is no failure.
expect_code 0 "$debond" --study study.prm \
  --set "Sweep 1/Values=0; -0.1 | 0; if(x < 0.2, 0.69, -0.345)" \
  --set "Study/Accepted statuses=success | iteration limit"

# A case before the others, from which they start; none is run if it fails.
cat >prepared.prm <<'STUDY'
subsection Study
  set Scene    = bar.prm
  set Columns  = status | iterations | J
  set Settings = Loads/Traction top=0; -0.1 | Solver/Euclidean bundle/Start={preparation}/displacement.txt
end
subsection Preparation
  set Settings = Loads/Traction top=0; -0.1 | Output/Displacement=true
end
subsection Sweep 1
  set Parameter = Solver/Euclidean bundle/Proximal weight
  set Label     = u_k
  set Values    = 1e9
end
STUDY
expect_code 0 "$debond" --study prepared.prm
awk -v J="$(column output/prepared/table.csv J)" '
  /"functional"/ && !n { n = 1; if (!(J < 0 && J == $2 + 0)) exit 1 }' \
  output/prepared/preparation/summary.json &&
  [ "$(column output/prepared/table.csv iterations)" = 0 ] ||
  fail "not started there: $(cat output/prepared/table.csv)"
expect_code 0 "$debond" --study prepared.prm
grep -q "Cases run now: 0," log || fail "repeated: $(cat log)"
expect_code 3 "$debond" --study prepared.prm --set "Study/Output directory=bad" \
  --set "Preparation/Settings=Loads/Traction top=0; if(x < 0.2, 1/0, 1)"
[ "$(column bad/table.csv status)" = "not run" ] || fail "$(cat bad/table.csv)"
grep -q "^debond: case preparation: exit code 2: .* is inf" errors ||
  fail "$(cat errors)"

# A case that is killed; the next one is run all the same.
"$debond" --study study.prm --jobs 1 --set "Study/Output directory=killed" \
  --set "Sweep 1/Parameter=Solver/Euclidean bundle/Stop tolerance" \
  --set "Sweep 1/Label=epsilon" --set "Sweep 1/Values=1e-300 | 1e-13" \
  --set "Study/Settings=Loads/Traction top=0; 0.1*x | Solver/Euclidean bundle/Maximum iterations=100000000" \
  >log 2>errors &
study=$!
trap 'kill -KILL $study; rm -rf "$directory"' EXIT
for _ in $(seq 300); do
  grep -q '^ *100 ' killed/cases/epsilon=1e-300/log 2>/dev/null && break
  sleep 0.02
done
pkill -KILL -P $study
code=0
wait $study || code=$?
trap 'rm -rf "$directory"' EXIT
[ $code -eq 3 ] || fail "exit code $code in place of 3"
[ "$(column killed/table.csv status)" = "killed by signal 9 (Killed)
success" ] || fail "$(cat killed/table.csv)"
