#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_checkpoint.sh DEBOND: a run that goes on from a checkpoint ends with the
# same bits as one that was never interrupted, and no run goes on from a
# checkpoint that is not its own or not whole.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "10, 1"
cat >>bar.prm <<'SCENE'
subsection Solver
  set Method              = euclidean bundle
  set Checkpoint interval = 1e6
  subsection Euclidean bundle
    set Proximal weight = 0.05
    set Bundle size     = 20
  end
  subsection Energy bundle
    set Bundle size = 3
  end
end
SCENE

# run CODE ARGUMENTS...: with that exit code.
run() {
  expect_code "$1" "$debond" bar.prm "${@:2}"
}

# Without what a clock, the memory and the words about a restart decide.
same_end() {
  local file
  for file in history.csv contact_profile.csv displacement.txt; do
    cmp "$1/$file" "$2/$file" || fail "another $file"
  done
  for file in "$1" "$2"; do
    perl -0pe 's/"timings_s": \{.*?\{.*?\}\s*\},//s; s/.*"peak_memory.*\n//' \
      "$file/summary.json" >"$file.summary"
  done
  diff "$1.summary" "$2.summary" || fail "another summary"
  [ ! -e "$2/checkpoint" ] || fail "the checkpoint stayed after a success"
}

for method in "euclidean bundle" "energy bundle"; do
  section=${method^}
  settings=(--set "Solver/Method=$method" --set "Output/Displacement=true"
    --set "Solver/Search=none")
  # The energy bundle has few iterations on small meshes.
  [ "$method" != "energy bundle" ] || settings+=(--set "Mesh/Cells=40, 4")
  run 0 "${settings[@]}" --set "Output/Directory=whole"
  iterations=$(($(wc -l <whole/history.csv) - 1))
  [ $iterations -ge 5 ] || fail "$iterations iterations are too few to see"

  # At one iteration, and between two and the end: with and without an emptied
  # bundle, and twice in one run.
  for stop in 1 $((iterations / 3)) $((iterations - 2)); do
    run 3 "${settings[@]}" --set "Output/Directory=parts" \
      --set "Solver/$section/Maximum iterations=$stop"
    grep -q "parts/checkpoint" log || fail "The log does not name the file."
    if [ $stop -gt 1 ]; then
      run 3 "${settings[@]}" --set "Output/Directory=parts" --restart \
        --set "Solver/$section/Maximum iterations=$((stop + 1))"
    fi
    run 0 "${settings[@]}" --set "Output/Directory=parts" --restart
    grep -q "goes on after iteration" log || fail "no word of the restart"
    same_end whole parts
  done
done

# Killed at any time, and interrupted. The tolerance, which cannot be met, makes
# the run last.
long=(--set "Mesh/Cells=40, 4" --set "Output/Displacement=true"
  --set "Solver/Euclidean bundle/Stop tolerance=1e-300"
  --set "Solver/Euclidean bundle/Bundle size=100")
for signal in KILL INT TERM; do
  interval=1e6
  [ $signal != KILL ] || interval=1e-9
  rm -f log # of a run before, which has the line that is waited for
  signal_when $signal "grep -sqE '^ +100 ' log" \
    "$debond" bar.prm "${long[@]}" --set "Output/Directory=$signal" --set \
    "Solver/Checkpoint interval=$interval"
  [ -s $signal/checkpoint ] || fail "no checkpoint after SIG$signal"
  [ $signal = KILL ] || grep -q '"status": "interrupted"' $signal/summary.json ||
    fail "not marked as interrupted"
  first=$(perl -ne 'print $1 if /^Debond checkpoint, format (\d+),/' \
    $signal/checkpoint)
  [ "$first" = 1 ] || fail "The first line is not what the manual says."

  # Until an iteration that lies behind all that was done.
  cp -r $signal before
  run 3 "${long[@]}" --set "Output/Directory=before" --restart \
    --set "Solver/Euclidean bundle/Maximum iterations=1"
  reached=$(sed -n 's/.*"total": \([0-9]*\),.*/\1/p' before/summary.json)
  rm -r before
  limit=(--set "Solver/Euclidean bundle/Maximum iterations=$((reached + 50))")
  run 3 "${long[@]}" "${limit[@]}" --set "Output/Directory=$signal" --restart
  run 3 "${long[@]}" "${limit[@]}" --set "Output/Directory=uninterrupted"
  cmp $signal/history.csv uninterrupted/history.csv || fail "another history"
  cmp $signal/displacement.txt uninterrupted/displacement.txt ||
    fail "another displacement"
done

# refused WHY ARGUMENTS...: exit code 2 with that reason, and nothing is touched.
limit=(--set "Solver/Euclidean bundle/Maximum iterations=10")
run 3 "${limit[@]}"
mv output/bar whole-checkpoint
refused() {
  local why=$1
  shift
  (cd output/bar && find . -type f -exec md5sum {} + | sort) >before.sums
  run 2 --restart "$@"
  grep -qF -- "$why" errors || fail "refused, but not for '$why': $(cat errors)"
  (cd output/bar && find . -type f -exec md5sum {} + | sort) >after.sums
  cmp before.sums after.sums || fail "files were changed"
}
anew() {
  rm -rf output/bar
  cp -r whole-checkpoint output/bar
}
file=output/bar/checkpoint

anew
refused "is of another scene: Contact law/Bond stiffness is 69 there and 70 here" \
  --set "Contact law/Bond stiffness=70"
refused "is of another scene: the method is euclidean bundle there and energy bundle here" \
  --set "Solver/Method=energy bundle"
refused "majorise minimise has no checkpoints" \
  --set "Solver/Method=majorise minimise"
size=$(wc -c <$file)
for length in 0 10 60 90 $((size / 2)) $((size - 1)); do
  anew
  head -c "$length" whole-checkpoint/checkpoint >$file
  if [ "$length" -lt 80 ]; then
    refused "the checkpoint $file is"
  else
    refused "the checkpoint $file is truncated"
  fi
done
for at in $((size / 3)) $((size - 1)); do
  anew
  perl -e 'open F, "+<", $ARGV[0]; binmode F; seek F, $ARGV[1], 0; read F, $b, 1;
    seek F, $ARGV[1], 0; print F chr(ord($b) ^ 1)' $file "$at"
  refused "the checkpoint $file is damaged: its checksum is wrong"
done
anew
perl -pi -e 's/format 1,/format 7,/ if $. == 1' $file
refused "the checkpoint $file has format 7, this program reads format 1"
anew
cp bar.prm $file
refused "the checkpoint $file is no checkpoint of Debond"
rm $file
refused "the checkpoint $file cannot be read: No such file or directory"

# One that cannot be written does not end the run.
mkdir -p blocked/checkpoint
run 0 --set "Output/Directory=blocked" --set "Solver/Checkpoint interval=1e-9"
grep -q "blocked/checkpoint: Is a directory; the run goes on" errors ||
  fail "not told: $(cat errors)"
[ "$(wc -l <errors)" -eq 1 ] || fail "told more than once"
run 5 --set "Output/Directory=blocked" "${limit[@]}"
[ "$(ls blocked)" = "$(ls whole)" ] || [ ! -e blocked/checkpoint.partial ] ||
  fail "half a checkpoint stayed: $(ls blocked)"
