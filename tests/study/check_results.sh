#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_results.sh DEBOND: a study whose outcome is known: without contact and
# bonds J goes with the square of the load and with 1/E. Its files, and what
# is repeated when something changes.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >bar.prm <<'SCENE'
subsection Mesh
  set Cells = 10, 1
end
subsection Loads
  set Constants    = q=1
  set Traction top = 0; 0.1*q
end
subsection Contact law
  set Law = none
end
SCENE
cat >printed.csv <<'REFERENCE'
# For the test.
E,law,J
30,none,-1e-3
60,none,
60,winkler,-5
REFERENCE
cat >study.prm <<'STUDY'
subsection Study
  set Title   = The load
  set Scene   = bar.prm
  set Methods = energy bundle | majorise minimise
  set Columns = status | J | J_min | error | broken = /bond_states/broken
  set Fields  = true
end
subsection Sweep 1
  set Parameter = Material/Young modulus
  set Label     = E
  set Values    = geometric 30 60 2
end
subsection Sweep 2
  set Parameter = Loads/Constants
  set Label     = load
  set Values    = q=1 | q=3
end
subsection Plots
  set Kinds = convergence | iterations | displacement | force | law
end
subsection Reference
  set File    = printed.csv
  set Label   = paper
  set Rows    = law=none
  set Key     = E
  set Columns = J=J
end
STUDY

expect_code 0 "$debond" --study study.prm --jobs 2
grep -q "Cases run now: 12," log || fail "not 12 cases: $(cat log)"
results=output/study
[ "$(column $results/table.csv E | tr '\n' ' ')" = \
  "30 30 30 30 60 60 60 60 " ] || fail "not these E"
[ "$(column $results/table.csv status | sort -u)" = success ] || fail "status"
column $results/table.csv J | awk '
  { J[NR] = $1 }
  END {
    for (i = 1; i <= 8; ++i) {
      E = 30 * 2 ^ int((i - 1) / 4); q = (i - 1) % 4 < 2 ? 1 : 3
      expected = J[1] * q * q * 30 / E
      if ((J[i] / expected - 1) ^ 2 > 1e-22) { print i, J[i], expected; exit 1 }
    }
    if (!(J[1] < 0)) exit 1
  }' || fail "J does not scale"
column $results/table.csv error | awk '$1 > 1e-12 || $1 < -1e-12 { exit 1 }' ||
  fail "not the minimum"
# Beside ours only what the reference has in the rows asked for.
[ "$(column $results/table.csv "J (paper)" | tr '\n' ' ')" = \
  "-0.001 -0.001 -0.001 -0.001     " ] || fail "not the reference"
[ "$(head -1 $results/table.csv)" = \
  "E,load,method,status,J,J (paper),J_min,error,broken" ] ||
  fail "titles $(head -1 $results/table.csv)"

for file in index.md table.csv table.md table.tex fields.pvd contact.pvd \
  plots/{convergence,iterations,displacement,force,law}.{png,svg,dat,gp}; do
  [ -s "$results/$file" ] || fail "no $file: $(cat errors)"
done
for link in $(grep -o '](\([^)]*\))' $results/index.md | tr -d '()]'); do
  [ -s "$results/$link" ] || fail "index.md links to $link, which is not there"
done
for file in $(grep -o 'file="[^"]*"' $results/fields.pvd | cut -d'"' -f2); do
  [ -s "$results/$file" ] || fail "fields.pvd names $file"
done

# Nothing is repeated, unless it is new, changed or damaged.
expect_code 0 "$debond" --study study.prm
grep -q "Cases run now: 0," log || fail "repeated: $(cat log)"
cp $results/table.csv first.csv
expect_code 0 "$debond" --study study.prm --set "Sweep 1/Values=30" \
  --set "Sweep 2/Values=q=1 | q=4"
grep -q "Cases run now: 3," log || fail "not the 3 new ones: $(cat log)"
case=$(find $results/cases -name 'E=30,load=q=1,*energy*')
rm "$case/summary.json"
expect_code 0 "$debond" --study study.prm
grep -q "Cases run now: 1," log || fail "not the one without summary: $(cat log)"
cmp first.csv $results/table.csv || fail "another table"
sed -i 's/0\.1\*q/0.2*q/' bar.prm
expect_code 0 "$debond" --study study.prm --set "Sweep 1/Values=30" \
  --set "Sweep 2/Values=q=1"
grep -q "Cases run now: 3," log || fail "a changed scene: $(cat log)"
[ "$(column $results/table.csv J | head -1)" != "$(column first.csv J | head -1)" ] ||
  fail "the same J"

# Without gnuplot there are tables, and a message.
PATH=/nonexistent expect_code 5 "$debond" --study study.prm \
  --set "Sweep 1/Values=30" --set "Sweep 2/Values=q=1"
grep -q "gnuplot is not installed" errors || fail "not said: $(cat errors)"
[ -s $results/plots/law.gp ] && [ ! -e $results/plots/law.png ] ||
  fail "old pictures beside new data"
