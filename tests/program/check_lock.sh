#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_lock.sh DEBOND SCENE.prm: two runs do not write into one directory; a
# lock that a killed run left behind is no obstacle.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2
trap 'kill $(jobs -p) 2>/dev/null || true; rm -rf "$directory"' EXIT

long_run=("$debond" "$scene" --set "Output/Directory=out"
  --set "Solver/Euclidean bundle/Stop tolerance=1e-300"
  --set "Solver/Euclidean bundle/Maximum iterations=1000000000")
wait_for() {
  for _ in $(seq 400); do
    ! eval "$1" || return 0
    sleep 0.05
  done
  fail "no $1"
}

touch first
# The first run is neither disturbed nor its files removed.
"${long_run[@]}" >first 2>&1 &
process=$!
wait_for "grep -qE '^ +10 ' first"
expect_code 5 "$debond" "$scene" --set "Output/Directory=out"
grep -q "^debond: out is being written by process $process on $(uname -n)" \
  errors || fail "not the process: $(cat errors)"
[ -s out/parameters.prm ] || fail "The second run removed files of the first."
expect_code 0 "$debond" "$scene" --set "Output/Directory=other"

# A signal ends it, and the lock with it.
kill $process
code=0
wait $process || code=$?
[ $code -eq 4 ] || fail "exit code $code in place of 4"
[ ! -e out/.lock ] || fail "The lock is still there."
expect_code 0 "$debond" "$scene" --set "Output/Directory=out"
[ ! -e out/.lock ] || fail "The lock is still there."

# A killed run cannot remove the file.
"${long_run[@]}" >first 2>&1 &
process=$!
wait_for "grep -qE '^ +10 ' first"
kill -s KILL $process
wait $process || true
[ -e out/.lock ] || fail "The lock was not there."
expect_code 0 "$debond" "$scene" --set "Output/Directory=out"
[ ! -e out/.lock ] || fail "The lock is still there."

# What is no plain file of its own is no lock: nothing else is written.
echo precious >victim
while IFS=: read -r plant reason; do
  rm -rf planted
  mkdir planted
  (cd planted && $plant .lock)
  expect_code 5 timeout 120 "$debond" "$scene" --set "Output/Directory=planted"
  grep -q "^debond: Cannot write planted/.lock: $reason" errors ||
    fail "$plant: $(cat errors)"
  [ "$(cat victim)" = precious ] && [ ! -e missing ] || fail "$plant: followed"
  [ "$(ls -A planted)" = .lock ] || fail "$plant: $(ls -A planted)"
done <<'PLANTS'
ln -s ../victim:Too many levels of symbolic links
ln -s ../missing:Too many levels of symbolic links
ln ../victim:it is no plain file
mkfifo:it is no plain file
mkdir:Is a directory
PLANTS
