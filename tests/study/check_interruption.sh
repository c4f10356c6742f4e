#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_interruption.sh DEBOND: an interrupted study stops its cases, and goes
# on later with those that are not finished; the end is the same.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "10, 1"
cat >study.prm <<'STUDY'
subsection Study
  set Scene   = bar.prm
  set Methods = euclidean bundle
  set Columns = status | iterations | J
end
subsection Sweep 1
  set Parameter = Solver/Euclidean bundle/Proximal weight
  set Label     = u_k
  set Values    = 0.05 | 0.01 | 0.1 | 0.5
end
STUDY

expect_code 0 "$debond" --study study.prm
cp output/study/table.csv uninterrupted.csv

for signal in INT TERM; do
  rm -rf output
  signal_when $signal '[ -e "output/study/cases/u_k=0.05/summary.json" ]' \
    "$debond" --study study.prm --jobs 1
  [ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat log errors)"
  ! pgrep -P $process >/dev/null || fail "a case is still running"
  ! [ -e output/study/index.md ] || fail "a report was written"
  cp -p "output/study/cases/u_k=0.05/summary.json" finished.json

  expect_code 0 "$debond" --study study.prm --jobs 2
  run=$(sed -n 's/^Cases run now: \([0-9]*\),.*/\1/p' log)
  [ "$run" -ge 1 ] && [ "$run" -le 3 ] || fail "$run cases were run again"
  [ ! "output/study/cases/u_k=0.05/summary.json" -nt finished.json ] ||
    fail "the finished case was repeated"
  cmp uninterrupted.csv output/study/table.csv || fail "not the same end"
done

# A case with checkpoints goes on where it was.
cat >long.prm <<'STUDY'
subsection Study
  set Scene             = bar.prm
  set Methods           = euclidean bundle
  set Columns           = status | iterations | J
  set Settings          = Mesh/Cells = 40, 4 | Solver/Checkpoint interval = 1e6 | Solver/Euclidean bundle/Stop tolerance = 1e-300 | Solver/Euclidean bundle/Maximum iterations = 1500
  set Accepted statuses = iteration limit
end
subsection Sweep 1
  set Parameter = Solver/Euclidean bundle/Proximal weight
  set Label     = u_k
  set Values    = 0.05
end
STUDY
case=output/long/cases/u_k=0.05
signal_when INT "grep -sqE '^ +100 ' \$case/log" \
  "$debond" --study long.prm
[ $code -eq 4 ] || fail "exit code $code in place of 4: $(cat log errors)"
[ -s $case/checkpoint ] || fail "no checkpoint"
expect_code 0 "$debond" --study long.prm
grep -q "goes on after iteration" $case/log || fail "not from the checkpoint"
cp $case/history.csv continued.csv
rm -r output/long
expect_code 0 "$debond" --study long.prm
! grep -q "goes on after iteration" $case/log || fail "not from the beginning"
cmp continued.csv $case/history.csv || fail "another history"
