#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_errors.sh DEBOND: what is wrong in a study is said before any case is
# run, with file, line and what would be right.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >bar.prm <<'SCENE'
subsection Mesh
  set Cells = 10, 1
end
SCENE
cat >study.prm <<'STUDY'
subsection Study
  set Scene   = bar.prm
  set Columns = iterations | itarations | J at 0
  set Settings = Mesh/Cell=3, 1
  set Sene = bar.prm
end
subsection Sweep 1
  set Parameter = Solver/Euclidean bundle/Proximal weigth
  set Values    = 1 | 2
end
subsection Sweep 2
  set Parameter = Material/Poisson ratio
  set Values    = geometric 1 2
end
subsection Plots
  set Kinds = histori | steps
end
STUDY
cat >expected <<'ERRORS'
debond: study.prm:5: unknown parameter Study/Sene; did you mean Study/Scene?
debond: study.prm:13: Sweep 2/Values = geometric 1 2: expected a | b | c (with blanks around the bars), or geometric FIRST LAST COUNT
debond: study.prm:4: Study/Settings: unknown parameter Mesh/Cell; did you mean Mesh/Cells?
debond: study.prm:9: Sweep 1/Values: unknown parameter Solver/Euclidean bundle/Proximal weigth; did you mean Solver/Euclidean bundle/Proximal weight?
ERRORS
expect_code 2 "$debond" --study study.prm
grep -vE "Columns|Kinds" errors | sort -u >others
sort -u expected | diff - others || fail "not the errors expected"
for words in "study.prm:3: Study/Columns: there is no column 'itarations'; known" \
  "study.prm:3: Study/Columns: there is no column 'J at 0'; known" \
  "study.prm:16: Plots/Kinds: there is no plot 'histori'; known"; do
  grep -q "^debond: $words" errors || fail "no '$words' in $(cat errors)"
done

expect_code 2 "$debond" --study
grep -q "no study is given" errors || fail "$(cat errors)"
expect_code 2 "$debond" --study nowhere.prm
grep -q "nowhere.prm: there is no such file" errors || fail "$(cat errors)"

cat >combination.prm <<'STUDY'
subsection Study
  set Scene = bar.prm
end
subsection Sweep 1
  set Parameter = Material/Poisson ratio
  set Label     = nu
  set Values    = 0.3 | 0.6
end
subsection Sweep 2
  set Parameter = Material/Hypothesis
  set Values    = plane stress | plane strain
end
STUDY
expect_code 2 "$debond" --study combination.prm
grep -q "combination.prm: case nu = 0.6, Material/Hypothesis = plane strain: " \
  errors || fail "$(cat errors)"
expect_code 2 "$debond" --study combination.prm --validate

sed -e 's/0.3 | 0.6/0.3/' combination.prm >plots.prm
printf 'subsection Plots\n set Kinds = best\nend\n' >>plots.prm
expect_code 2 "$debond" --study plots.prm
grep -q "plots.prm:14: Plots/Kinds: the plot best needs a second sweep over" \
  errors || fail "$(cat errors)"

# Parameters that vary together.
sed -e 's/ratio/ratio \& Mesh\/Cells/' -e 's/0.6/0.4 \& 3, 1/' \
  combination.prm >together.prm
expect_code 2 "$debond" --study together.prm
grep -q "together.prm:7: Sweep 1/Values = .*: '0.3' has not as many parts as" \
  errors || fail "$(cat errors)"
expect_code 0 "$debond" --study together.prm --validate \
  --set "Sweep 1/Values=0.3 & 2, 1 | 0.4 & 3, 1"
grep -q "valid, 4 cases" log || fail "$(cat log)"

# The parameters that are printed can be read.
"$debond" --study --print-parameters >all.prm
expect_code 2 "$debond" --study all.prm
grep -q "Study/Scene: there is no file" errors && [ "$(wc -l <errors)" -eq 1 ] ||
  fail "$(cat errors)"

! [ -e output ] || fail "Files were written."
