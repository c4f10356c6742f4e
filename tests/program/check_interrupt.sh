#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_interrupt.sh DEBOND SCENE.prm: an interrupted solve keeps its last
# iterate and says so, for both signals.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2

for signal in INT TERM; do
  # Without a stop tolerance that can be met the solve would take hours.
  # In a script background jobs ignore SIGINT, unless job control is on.
  set -m
  "$debond" "$scene" --set "Output/Directory=$signal" \
    --set "Solver/Euclidean bundle/Stop tolerance=1e-300" \
    --set "Solver/Euclidean bundle/Maximum iterations=1000000000" \
    >log 2>errors &
  process=$!
  set +m
  for _ in $(seq 200); do
    grep -qE '^ +100 ' log && break
    sleep 0.05
  done
  kill -s $signal $process
  code=0
  wait $process || code=$?
  cat log errors
  [ $code -eq 4 ] || { echo "exit code $code in place of 4"; exit 1; }
  grep -q '"status": "interrupted"' $signal/summary.json
  for file in body.vtu contact.vtu contact_profile.csv history.csv; do
    [ -s $signal/$file ] || { echo "no $file"; exit 1; }
  done
done

# On refined meshes the result is that of the last mesh that was finished.
set -m
"$debond" "$scene" --set "Output/Directory=refined" \
  --set "Solver/Method=automatic" --set "Accuracy/Target=1e-7" >log 2>errors &
process=$!
set +m
for _ in $(seq 600); do
  grep -q " mesh 3 " log && break
  sleep 0.05
done
# While the next one is solved, unless the machine is slow.
sleep 0.6
kill -s INT $process
code=0
wait $process || code=$?
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
