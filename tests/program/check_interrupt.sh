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
