#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_symmetry.sh DEBOND BENCHMARK.prm: the same scene twice gives the same
# files but for times and memory, with another number of threads it gives the
# same J, and the mirrored scene gives the mirrored answer.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2

functional() {
  sed -n 's/.*"functional": *\([^,]*\),*$/\1/p' "$1/summary.json"
}

# same_functional FIRST SECOND TOLERANCE: relative to J.
same_functional() {
  awk -v a="$(functional "$1")" -v b="$(functional "$2")" \
    -v tolerance="$3" 'BEGIN {
      d = (a - b) / a; if (d < 0) d = -d
      if (a == "" || b == "" || !(d <= tolerance)) {
        print "J is " a " and " b > "/dev/stderr"; exit 1 } }'
}

for method in "majorise minimise" "energy bundle" "euclidean bundle"; do
  run() {
    rm -rf out "$1"
    "$debond" "$scene" --set "Solver/Method=$method" \
      --set "Output/Directory=out" --set "Output/Displacement=true" \
      "${@:2}" >/dev/null
    sed -i '/"timings_s"/,/}/d; /"peak_memory/d; /"memory_estimate/d' out/summary.json
    mv out "$1"
  }
  run first
  run second
  diff -r first second || fail "$method: a second run gives other files."

  run mirrored --set "Loads/Traction top=0; if(x > 0.2, 0.69, -0.345)"
  # The paper's method ends at a distance that its stop tolerance allows, the
  # others are exact. Displacements are compared relative to M.
  tolerance=1e-12 distance=1e-9
  [ "$method" != "euclidean bundle" ] || tolerance=1e-9 distance=1e-3
  same_functional first mirrored $tolerance ||
    fail "$method: the mirrored scene gives another J."
  # The normal displacements from left to right are those from right to left.
  column() { awk -F, -v c="$2" 'NR > 1 { print $c }' "$1/contact_profile.csv"; }
  number=$(head -1 first/contact_profile.csv | tr ',' '\n' | grep -nx u_nu |
    cut -d: -f1)
  paste <(column first "$number") <(column mirrored "$number" | tac) |
    awk -v distance=$distance '{ d = $1 - $2; if (d < 0) d = -d
      if (d > distance * 0.002) exit 1 }' ||
    fail "$method: the mirrored scene gives another displacement."
done

# Large enough that the threads have something to do.
for method in "majorise minimise" "energy bundle"; do
  for threads in 1 2 4; do
    OPENBLAS_NUM_THREADS=$threads OMP_NUM_THREADS=$threads \
      DEAL_II_NUM_THREADS=$threads "$debond" "$scene" \
      --set "Solver/Method=$method" --set "Mesh/Cells=160, 16" \
      --set "Output/Directory=threads-$threads" >/dev/null
  done
  for threads in 2 4; do
    same_functional threads-1 threads-$threads 1e-12 ||
      fail "$method: $threads threads give another J than one."
  done
done
