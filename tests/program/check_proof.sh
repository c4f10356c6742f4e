#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_proof.sh DEBOND SCENE.prm: a proof that is interrupted, or out of
# nodes, leaves a solution and a valid gap; threads change nothing; pictures
# only with gnuplot.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2

# value FILE KEY: of a number or word in a summary.
value() {
  sed -nE "s/^ *\"$2\": \"?([^\",]*)\"?,?$/\1/p" "$1/summary.json"
}

below() {
  awk -v a="$1" -v b="$2" 'BEGIN { exit !(a + 0 < b + 0) }'
}

# prove NAME OPTIONS: brittle bonds, which take some nodes.
prove() {
  local name=$1
  shift
  "$debond" "$scene" --set "Output/Directory=$name" \
    --set "Contact law/Bond stiffness=1e5" \
    --set "Contact law/Bond threshold=2e-4" \
    --set "Solver/Method=majorise minimise" --set Solver/Prove=true "$@" \
    >$name.log 2>&1
}

best=-4.4736793357e-05 # on 40x4
prove one --set Solver/Proof/Threads=1
prove two --set Solver/Proof/Threads=3
grep -q 'minimum *global' one.log || fail "not global"
for key in nodes lower_bound relative_gap functional; do
  [ "$(value one $key)" = "$(value two $key)" ] || fail "threads change $key"
done
[ "$(value one nodes)" -gt 8 ] || fail "one batch of nodes is too few to tell"
for plot in proof_time proof_nodes; do
  for ending in dat gp; do
    [ -s one/$plot.$ending ] || fail "no $plot.$ending"
  done
done

mkdir bin
for program in "$debond" $(command -v env); do ln -s "$program" bin; done
PATH=$directory/bin prove plain
[ -s plain/proof_time.gp ] || fail "no script without gnuplot"
[ ! -e plain/proof_time.png ] || fail "a picture without gnuplot"

prove nodes --set "Solver/Proof/Maximum nodes=9"
[ "$(value nodes nodes)" -eq 9 ] || fail "more than 9 nodes"
grep -q '"status": "node limit"' nodes/summary.json || fail "no node limit"

# Finer, so that it lasts.
set -m
prove signal --set "Mesh/Cells=320, 32" --set Solver/Search=none \
  --set Solver/Proof/Tolerance=1e-15 --set Solver/Proof/Threads=1 &
process=$!
set +m
for _ in $(seq 400); do
  grep -qE '^ +1 ' signal.log 2>/dev/null && break
  sleep 0.05
done
sleep 1
kill -s INT -- -$process
code=0
wait $process || code=$?
cat signal.log
[ $code -eq 4 ] || fail "exit code $code in place of 4"
grep -q '"status": "interrupted"' signal/summary.json || fail "not interrupted"
for file in body.vtu contact_profile.csv history.csv proof.csv; do
  [ -s signal/$file ] || fail "no $file"
done

# No bound is above the minimum.
below "$(value nodes lower_bound)" $best || fail "bound above the minimum"
below "$(value signal lower_bound)" -4.8228930051e-05 ||
  fail "bound above the minimum"

