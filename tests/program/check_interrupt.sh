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
