#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_interrupt.sh DEBOND SCENE.prm: an interrupted solve keeps its last
# iterate and says so, for both signals.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2

for signal in INT TERM; do
  # Without a stop tolerance that can be met the solve would take hours.
  signal_when $signal "grep -qE '^ +100 ' log" \
    "$debond" "$scene" --set "Output/Directory=$signal" \
    --set "Solver/Euclidean bundle/Stop tolerance=1e-300" \
    --set "Solver/Euclidean bundle/Maximum iterations=1000000000"
  cat log errors
  [ $code -eq 4 ] || fail "exit code $code in place of 4"
  grep -q '"status": "interrupted"' $signal/summary.json
  for file in body.vtu contact.vtu contact_profile.csv history.csv; do
    [ -s $signal/$file ] || fail "no $file"
  done
done

# Libraries that the first cycle starts leave the signals as they are.
signal_when TERM "[ -e levels/load_path.csv ]" \
  "$debond" "$scene" --set "Output/Directory=levels" \
  --set "Solver/Method=majorise minimise" \
  --set "Solver/Linear solver=multigrid" \
  --set "Load path/Factors=0:0.0002:1"
[ $code -eq 4 ] || fail "by levels: exit code $code: $(cat log errors)"
grep -q '"status": "interrupted"' levels/summary.json || fail "by levels"

# On refined meshes the result is that of the last mesh that was finished.
# While the next one is solved, unless the machine is slow.
signal_when INT 'grep -q " mesh 3 " log && sleep 0.6' \
  "$debond" "$scene" --set "Output/Directory=refined" \
  --set "Solver/Method=automatic" --set "Accuracy/Target=1e-7"
[ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat log errors)"
# A mesh whose solve had only its search to end counts.
if ! grep -q "the result is what it had found" errors; then
  grep -q "that of the last mesh that was finished" errors ||
    fail "$(cat errors)"
  unknowns=$(grep -E " mesh [0-9]+ .* contact nodes" log | tail -1 |
    sed -E 's/.* ([0-9]+) unknowns.*/\1/')
  grep -q "\"degrees_of_freedom\": $unknowns," refined/summary.json ||
    fail "The files are not of the last mesh, with $unknowns unknowns."
fi
[ -s refined/body.vtu ] || fail "no body.vtu"

# Wherever it comes: a run ends with its results, or without any and says so.
# Half-written files and locks stay in no case.
block=("Dimension=3" "Mesh/Lengths=3, 1, 2" "Mesh/Cells=24, 9, 16"
  "Boundary conditions/Clamped boundaries=left" "Boundary conditions/Contact boundary=bottom"
  "Loads/Traction top=0; 0.02; 0" "Contact law/Bond stiffness=20"
  "Contact law/Bond threshold=2e-4" "Solver/Linear solver=direct" "Output/Directory=block")
: >empty.prm
has_begun='grep -q debond /proc/$process/comm &&
  grep -q "SigCgt:.*[4-7c-f]...$" /proc/$process/status' # it catches SIGTERM
for seconds in 0 0.1 0.3 1 2 4 8; do
  signal_when TERM "$has_begun && sleep $seconds" \
    "$debond" empty.prm "${block[@]/#/--set=}"
  [ $code -eq 0 ] && [ "$seconds" != 0 ] && break # it has ended before
  [ $code -eq 4 ] || fail "exit code $code after $seconds s: $(cat log errors)"
  if [ -e block/summary.json ]; then
    for file in body.vtu contact.vtu history.csv; do
      [ -s block/$file ] || fail "no $file after $seconds s"
    done
  else
    grep -q "interrupted before there was a result" errors ||
      fail "after $seconds s: $(cat errors)"
    [ -z "$(ls block 2>/dev/null | grep -v parameters.prm)" ] ||
      fail "after $seconds s: $(ls block)"
  fi
  [ -z "$(find . -name '*.partial' -o -name .lock)" ] ||
    fail "left after $seconds s: $(find .)"
  rm -rf block
done

# A search (on a finer mesh) and a proof that take minutes say that they run.
patches=("Mesh/Lengths=1.7, 0.11" "Mesh/Cells=170, 1" "Material/Young modulus=1"
  "Material/Poisson ratio=0.1" "Boundary conditions/Contact boundary=bottom"
  "Boundary conditions/Clamped boundaries=top" "Contact law/Tangential displacement=fixed"
  "Loads/Traction bottom=0; 0.95*sin(16.8*x + 5.65) + 0.35" "Contact law/Bond stiffness=1400"
  "Contact law/Bond threshold=0.007" "Solver/Prove=true" "Output/Directory=long")
for stage in "search for a lower minimum" proof; do
  settings="Solver/Search=none"
  [ "$stage" = proof ] || settings="Solver/Search=full --set Mesh/Cells=1000,1"
  signal_when INT "grep -q '^  $stage, 2 s' log" \
    "$debond" empty.prm "${patches[@]/#/--set=}" --set $settings
  [ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat log errors)"
  grep -q "the search or the proof was interrupted" errors ||
    fail "$(cat errors)"
  grep -q '"status": "success"' long/summary.json || fail "no result"
  [ "$stage" != proof ] || grep -q '"status": "interrupted"' long/summary.json ||
    fail "no status of the proof"
done

# Gmsh, which meshes in a process of its own, ends with the program.
cat >fine.geo <<'GEO'
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Physical Curve("left") = {4};
Physical Curve("bottom") = {1};
GEO
for signal in TERM KILL; do
  signal_when $signal 'gmsh=$(pgrep -P $process) && sleep 0.5' \
    "$debond" "$scene" --set Output/Directory=fine --set Mesh/Source=file \
    --set "Mesh/File=$PWD/fine.geo" --set Mesh/Size=0.001
  sleep 1
  state=$(ps -o stat= -p "$gmsh") || true
  [[ -z $state || $state == Z* ]] || fail "Gmsh goes on after SIG$signal: $state"
done
