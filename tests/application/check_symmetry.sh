#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_symmetry.sh DEBOND BENCHMARK.prm: the same scene twice gives the same
# files but for times and memory, and the mirrored scene gives the mirrored
# answer.
set -euo pipefail
export LC_ALL=C

debond=$1
scene=$2
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
cd "$directory"

fail() {
  echo "$1" >&2
  exit 1
}

functional() {
  sed -n 's/.*"functional": *\([^,]*\),*$/\1/p' "$1/summary.json"
}

for method in "majorise minimise" "energy bundle" "euclidean bundle"; do
  run() {
    rm -rf out "$1"
    "$debond" "$scene" --set "Solver/Method=$method" \
      --set "Output/Directory=out" --set "Output/Displacement=true" \
      "${@:2}" >/dev/null
    sed -i '/"timings_s"/,/}/d; /"peak_memory/d' out/summary.json
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
  awk -v a="$(functional first)" -v b="$(functional mirrored)" \
    -v tolerance=$tolerance 'BEGIN {
      d = (a - b) / a; if (d < 0) d = -d
      if (a == "" || b == "" || !(d <= tolerance)) {
        print "J is " a ", mirrored " b > "/dev/stderr"; exit 1 } }' ||
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
