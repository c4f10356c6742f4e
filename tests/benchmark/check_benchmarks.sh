#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_benchmarks.sh BENCHMARK_PROGRAM PRM_DIRECTORY: the quick benchmarks, what they
# write, and the figures that are the same on all machines.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
prm=$2
export OMP_THREAD_LIMIT=1

"$debond" results "$prm"/benchmarks/quick-{direct,multigrid,multigrid-3d,body-pad,certificate}.prm \
  >log || fail "$(cat log)"
cd results
files=(contact_solve growth start_up certificates)
for file in "${files[@]}"; do
  [ -s "$file.csv" ] && [ -s "$file.md" ] || fail "no $file"
  grep -q "^Debond .*CHOLMOD.*BLAS" "$file.md" || fail "no heading in $file.md"
done

# column FILE NAME ROW...: a value in the row whose first columns are ROW.
column() {
  local file=$1 name=$2
  shift 2
  awk -F , -v name="$name" -v row="$(IFS=,; echo "$*")" '
    NR == 1 { for (k = 1; k <= NF; ++k) if ($k == name) c = k }
    index($0, row ",") == 1 && c { print $c; found = 1; exit }
    END { if (!found) print "absent" }' "$file.csv"
}

# is VALUE EXPECTED TOLERANCE WHAT, with a relative tolerance.
is() {
  awk -v a="$1" -v b="$2" -v t="$3" 'BEGIN {
    e = a - b; if (e < 0) e = -e; if (b < 0) b = -b
    exit !(a != "absent" && a != "" && e <= t * b) }' ||
    fail "$4 is $1 in place of $2"
}

at_most() {
  awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "absent" && a != "" && a <= b) }' ||
    fail "$3 is $1, at most $2 was expected"
}

# J of independent codes.
minima=(-5.7774619651e-04 -5.8733246888e-04)

# The energy of the body without contact, from an independent code, and the
# same unknowns for all.
is "$(column contact_solve cholesky_energy "direct 40x4")" 6.2397134244e-04 2e-8 \
  "the energy without contact by CHOLMOD"
for solver in cholesky ml hypre levels; do
  is "$(column contact_solve ${solver}_energy "multigrid 80x8")" 6.337629715e-04 2e-8 \
    "the energy without contact by $solver"
done
for cells in 20x2 40x4 80x8; do
  scene="direct $cells"
  at_most "$(column contact_solve iterations "$scene")" 8 "iterations"
  [ "$(column contact_solve status "$scene")" = success ] || fail "$scene"
  # Memory does not depend on the machine's speed.
  at_most "$(column contact_solve memory_over_cholesky "$scene")" 2 "memory"
done
# Intervals of one mesh, the wider one where bonds may break anywhere.
at_most "$(column certificates width "benchmark fixed state")" 0.0265 "the width"
at_most "$(column certificates width "benchmark global")" 0.028 "the width"
at_most "$(column certificates stress_unknowns "benchmark global")" 1344 "unknowns"
# The multigrid path finds the same minimum, with hardly more cycles than A u = f.
is "$(column contact_solve J "multigrid 80x8")" "${minima[1]}" 1e-9 "J"
for scene in "multigrid 80x8" "multigrid 20x2x2" "pad 40x10"; do
  [ "$(column contact_solve status "$scene")" = success ] || fail "$scene"
  at_most "$(column contact_solve ml_iterations "$scene")" 36 "CG steps"
  at_most "$(column contact_solve levels_iterations "$scene")" 16 "cycles of A u = f"
done
# Of Cartesian components; with the normal first at contact nodes it takes 54.
for scene in "multigrid 80x8" "multigrid 20x2x2"; do
  at_most "$(column contact_solve hypre_iterations "$scene")" 25 "hypre's CG steps"
done
for scene in "multigrid 80x8" "pad 40x10"; do
  at_most "$(column contact_solve cycles_over_levels "$scene")" 1.15 "cycles of $scene"
done
# Fronts are moved there, and what is found is minimised once more.
at_most "$(column contact_solve cycles_over_levels "multigrid 20x2x2")" 2.2 "cycles"
is "$(column contact_solve unknowns "direct 40x4")" 671 0 "unknowns"
is "$(column contact_solve J "direct 40x4")" "${minima[0]}" 2e-11 "J"

# A study that cannot be used.
for text in "subsection Benchmark" "subsection Study
  set Scene = $prm/benchmark-40x4.prm
end
subsection Benchmark
  set Linear solvers = gauss
end"; do
  echo "$text" >bad.prm
  code=0
  "$debond" bad bad.prm >/dev/null 2>errors || code=$?
  [ $code -eq 2 ] || fail "exit code $code in place of 2"
  grep -q "bad.prm:" errors || fail "the file is not named: $(cat errors)"
  [ ! -e bad ] || fail "something was written"
done

# A scene that fails is said and counted, and the others are measured.
cat >some.prm <<EOF
subsection Study
  set Title = pressed
  set Scene = $prm/benchmark-40x4.prm
  set Settings = Solver/Method=automatic
end
subsection Sweep 1
  set Parameter = Mesh/Cells & Solver/Memory limit
  set Values    = 20, 2 & available | 40, 4 & 1e-3
end
subsection Benchmark
  set Linear solvers = hypre
  set Repetitions    = 1
end
EOF
code=0
"$debond" some some.prm >log 2>errors || code=$?
[ $code -eq 3 ] || fail "exit code $code in place of 3: $(cat log errors)"
grep -q "FAILED: pressed 40x4" errors || fail "no word of the failure: $(cat errors)"
grep -q "^1 of 2 scenes failed" log || fail "not counted: $(cat log)"
grep -q "^pressed 20x2 & available,direct 2D,.*success" some/contact_solve.csv ||
  fail "$(cat some/contact_solve.csv)"
