#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_benchmarks.sh BENCHMARK_PROGRAM PRM_DIRECTORY: the quick benchmarks, what they
# write, and the figures that are the same on all machines.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
prm=$2
export OMP_THREAD_LIMIT=1

"$debond" "$prm/benchmarks/quick.json" >log || fail "$(cat log)"
cd output/benchmarks-quick
files=(contact_solve growth meshes methods speed_against_error start_up)
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

# Minima of independent codes, and what they extrapolate to.
minima=(-5.7774619651e-04 -5.8733246888e-04 -5.9020538380e-04)
J=$(printf '%s\n' "${minima[@]}" | awk '{ J[NR] = $1 } END {
  d = J[3] - J[2]; q = d / (J[2] - J[1])
  printf "%.12e", J[3] + d * (q + q^2 + q^3 / (1 - q)) }')
k=0
for mesh in 40x4 80x8 160x16; do
  is "$(column meshes J_min $mesh)" "${minima[k]}" 2e-11 "J_min on $mesh"
  error=$(awk -v a="${minima[k]}" -v b="$J" 'BEGIN { printf "%.12e", a - b }')
  is "$(column meshes J_discretisation_error $mesh)" "$error" 1e-6 \
    "the discretisation error on $mesh"
  for method in "energy bundle" "majorise minimise"; do
    row=("$mesh" "$method")
    [ "$(column methods status "${row[@]}")" = success ] || fail "${row[*]}"
    at_most "$(column methods iterations "${row[@]}")" 10 "iterations, ${row[*]}"
    at_most "$(column methods J_optimisation_error "${row[@]}")" 6e-15 \
      "J - J_min, ${row[*]}"
    at_most "$(column methods energy_optimisation_error "${row[@]}")" 1e-10 \
      "the distance to the minimum, ${row[*]}"
    at_most "$(column methods law_violation "${row[@]}")" 1e-9 \
      "the law violation, ${row[*]}"
  done
  k=$((k + 1))
done

# Errors in the energy norm fall as those of J, of which they are the square
# root: 2 (J_min - J_ref) is at least about |u_min - u_ref|^2, and not much more.
# |u_min|^2 is between the energies with and without contact.
for mesh in 40x4 80x8; do
  is "$(column meshes J_min $mesh | awk -v r="${minima[2]}" \
    '{ print sqrt(2 * ($1 - r)) }')" \
    "$(column meshes energy_discretisation_error $mesh | awk -v r="${minima[2]}" \
      '{ print $1 * sqrt(-2 * r) }')" 0.1 "the energy error on $mesh"
done
[ -z "$(column meshes energy_discretisation_error 160x16)" ] ||
  fail "The reference has an error against itself."

# The paper's method is not exact: twice J - J_min is at least the square of
# the distance in the energy norm. It is good enough long before it ends.
row=(40x4 "euclidean bundle")
[ "$(column methods status "${row[@]}")" = success ] || fail "${row[*]}"
is "$(column methods iterations "${row[@]}")" 914 0.05 "iterations, ${row[*]}"
at_most "$(column methods J_optimisation_error "${row[@]}")" 1e-14 "J - J_min"
at_most "$(column methods energy_optimisation_error "${row[@]}")" 1e-5 "distance"
useful=$(column methods iteration_good_enough "${row[@]}")
at_most "$useful" 400 "the iteration that is good enough"
last=
while IFS=, read -r _ _ iteration _ distance; do
  [ "$iteration" -lt "$useful" ] || break
  last=$distance
done < <(grep '^40x4,euclidean bundle,' convergence.csv)
at_most "$(column meshes J_discretisation_error 40x4)" \
  "$(awk -v a="$last" 'BEGIN { print 10 * a }')" "the error before it, times 10,"

# The energy of the body without contact, from an independent code, and the
# same unknowns for all.
for solver in cholesky multigrid; do
  is "$(column contact_solve ${solver}_energy 40x4)" 6.2397134244e-04 2e-8 \
    "the energy without contact by $solver"
  is "$(column contact_solve ${solver}_energy 80x8)" 6.337629715e-04 2e-8 \
    "the energy without contact by $solver"
done
for scene in 20x2 40x4 80x8; do
  at_most "$(column contact_solve multigrid_iterations $scene)" 20 "CG steps"
  at_most "$(column contact_solve iterations $scene)" 8 "iterations"
  [ "$(column contact_solve status $scene)" = success ] || fail "$scene"
  # Memory does not depend on the machine's speed.
  at_most "$(column contact_solve memory_over_cholesky $scene)" 2 "memory"
done
# The multigrid path finds the same minimum, at the cost of a few linear solves.
[ "$(column contact_solve status 20x2x2)" = success ] || fail 20x2x2
is "$(column contact_solve J "80x8 multigrid")" "${minima[1]}" 1e-9 "J"
for scene in "80x8 multigrid" 20x2x2; do
  at_most "$(column contact_solve cg_steps "$scene")" 200 "CG steps"
  at_most "$(column contact_solve multigrid_iterations "$scene")" 36 "CG steps"
done
is "$(column contact_solve unknowns 40x4)" 671 0 "unknowns"
is "$(column contact_solve J 40x4)" "${minima[0]}" 2e-11 "J"

# A file that cannot be used.
for text in '{' '{"output": "x", "repetitions": 1}'; do
  echo "$text" >bad.json
  code=0
  "$debond" bad.json >/dev/null 2>errors || code=$?
  [ $code -eq 2 ] || fail "exit code $code in place of 2"
  grep -q "bad.json" errors || fail "the file is not named: $(cat errors)"
done
