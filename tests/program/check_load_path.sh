#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_load_path.sh DEBOND: which files a load path writes, and what becomes of
# them if it is interrupted or a file cannot be written.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "10, 1"
cat >>bar.prm <<'SCENE'
subsection Load path
  set Factors = 0:1:3, 3:-1:0
end
SCENE

rows() {
  awk 'END { print NR - 1 }' "$1/load_path.csv"
}

"$debond" bar.prm >log
[ "$(rows output/bar)" -eq 7 ] || fail "$(rows output/bar) steps in place of 7"
awk -F, 'NR == 1 { n = NF } NF != n { exit 1 }' output/bar/load_path.csv ||
  fail "The rows of load_path.csv have different lengths."
files=$(sed -n 's/.*file="\([^"]*\)".*/\1/p' output/bar/load_path_contact.pvd)
[ "$(echo "$files" | wc -l)" -eq 7 ] || fail "The record has $files"
for file in $files; do
  [ -s "output/bar/$file" ] || fail "no $file"
done
[ ! -e output/bar/load_path_body.pvd ] || fail "load_path_body.pvd is not wanted"
for entry in '"steps": 7' '"last_factor": 0.0' '"status": "success"'; do
  grep -q "$entry" output/bar/summary.json || fail "summary.json has no $entry"
done

# Broken bonds close where they heal, else only the nodes do.
for heal in true false; do
  "$debond" bar.prm --set "Load path/Bonds heal=$heal" \
    --set "Contact law/Bond stiffness=690" --set "Output/Directory=closing" >log
  closing=$(sed -n 's/^ *most \(.*\) close .* \(.* part\) .* to .*/\1, \2/p' log)
  [ "$heal $closing" = "true bonds, broken part" ] ||
    [ "$heal $closing" = "false nodes, open part" ] ||
    fail "Bonds heal = $heal: $closing close"
done

# A single run in the same directory leaves nothing of the path.
"$debond" bar.prm --set "Load path/Factors=" >/dev/null
[ -z "$(ls output/bar | grep load_path || true)" ] ||
  fail "Old files stayed: $(ls output/bar)"
! grep -q load_path output/bar/summary.json || fail "summary.json has a path"

# A file of a step that cannot be written ends no path, but is told.
mkdir -p blocked/load_path/contact-00002.vtu
expect_code 5 "$debond" bar.prm --set "Output/Directory=blocked"
grep -q "blocked/load_path/contact-00002.vtu" errors || fail "$(cat errors)"
[ "$(rows blocked)" -eq 7 ] || fail "The table is not complete."

# What varies is named: prescribed displacements, or they and the loads.
moved() {
  "$debond" bar.prm --set "Output/Directory=moved" \
    --set "Boundary conditions/Clamped boundaries=left" \
    --set "Boundary conditions/Displacement right=free; 2e-4" \
    --set "Load path/Displacement factors=$1" --set "Load path/Factors=$2" >log
  grep -q "factors  *3 of 3, to $3\$" log || fail "$(cat log)"
}
moved "0.5, 0.75, 2" "" "displacement factor 2"
[ "$(awk '/broken part  state/ { print $1, $2; for (k = 0; k < 3; ++k) {
  getline; print $1 } }' log | xargs)" = "displacement factor 0.5 0.75 2" ] ||
  fail "The rows have not the factors of the displacements: $(cat log)"
grep -q '"last_factor": 2.0' moved/summary.json || fail "last_factor is not 2"
moved "0.5, 0.75, 2" "3, 2, 4" "factor 4, displacement factor 2"
moved "0.75" "3, 2, 4" "factor 4, displacement factor 0.75"

# A signal ends the path after the current factor.
signal_when INT 'grep -q "local minimum" log' \
  "$debond" bar.prm --set "Output/Directory=interrupted" \
  --set "Load path/Factors=0:0.001:9" --set "Mesh/Cells=100, 10"
[ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat errors)"
steps=$(rows interrupted)
[ "$steps" -gt 0 ] && [ "$steps" -lt 9001 ] || fail "$steps steps"
grep -q "(interrupted): load path, step $steps, factor .*the path is not complete" errors ||
  fail "$(cat errors)"
[ "$(ls interrupted/load_path | wc -l)" -eq "$steps" ] ||
  fail "The files are not those of $steps steps."
grep -q '"status": "interrupted"' interrupted/summary.json || fail "no status"
grep -q "\"steps\": $steps," interrupted/summary.json || fail "no steps"

# On refined meshes it leaves the path on the last mesh that was finished.
signal_when INT 'grep -q "mesh 6" log' \
  "$debond" bar.prm --set "Output/Directory=refined" \
  --set "Load path/Factors=0:0.5:2, 1" --set "Load path/Global branch=none" \
  --set "Solver/Method=automatic" --set "Accuracy/Target=1e-7"
[ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat errors)"
grep -q "that of the last mesh that was finished" errors || fail "$(cat errors)"
[ "$(rows refined)" -eq 6 ] || fail "$(rows refined) factors in place of 6"
last=$(grep " mesh [0-9]" log | tail -1 | sed 's/.* J \([-0-9.e+]*\),.*/\1/')
column refined/load_path.csv J | awk -v last="$last" '
  ($1 - last)^2 < 1e-18 * last^2 { found = 1 } END { exit !found }' ||
  fail "No factor has the J of the last mesh, $last."
grep -q '"estimated_error": [0-9]' refined/summary.json || fail "no estimate"
