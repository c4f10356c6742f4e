#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_plots.sh DEBOND: plots along a contact boundary of any direction, the law
# of each case, more curves than gnuplot has colours, exact minima only where a
# column needs them, and numbers that no summary has.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

cat >pad.prm <<'SCENE'
subsection Mesh
  set Lengths = 1, 2
  set Cells   = 2, 6
end
subsection Boundary conditions
  set Clamped boundaries = right
  set Contact boundary   = left
end
subsection Loads
  set Traction top = if(x < 0.5, 0.02, -0.01); 0
end
SCENE
cat >study.prm <<'STUDY'
subsection Study
  set Scene   = pad.prm
  set Columns = status | J
end
subsection Sweep 1
  set Parameter = Contact law/Law
  set Label     = law
  set Values    = winkler | none
end
subsection Plots
  set Kinds = displacement | force | law
end
STUDY
plots=output/study/plots

# The vertical side is drawn over y, in its order.
expect_code 0 "$debond" --study study.prm
grep -q "cases 2, exact minima 0" log || fail "minima: $(cat log)"
grep -q "xlabel 'y'" $plots/displacement.gp || fail "not over y"
awk '/^# / || /^nan/ { last = -1 } /^[0-9]/ { if ($1 <= last) exit 1; last = $1; ++n }
  END { if (n < 14) exit 1 }' $plots/displacement.dat || fail "not in order"

# Each case on its own law: without adhesion no force where it is lifted off.
grep -q "^# law of law = winkler" $plots/law.dat || fail "no law of winkler"
awk '/^# / { none = $0 == "# law of law = none" }
  none && /^[-0-9]/ && $1 < 0 { if ($2 != 0) exit 1; ++n }
  END { if (!n) exit 1 }' $plots/law.dat || fail "a force without adhesion"
awk '/^# / { winkler = $0 == "# law of law = winkler" }
  winkler && /^[-0-9]/ && $2 < -0.1379 && $2 > -0.1381 { ++n }
  END { if (!n) exit 1 }' $plots/law.dat || fail "no force a M"

# Bonds that vary, by a threshold or on a part, are on no one graph: said so.
for bonds in "Contact law/Bond threshold=0.002 + y/1000" \
  "Parts/low=left: y < 1 | Contact law/Bond stiffness low=7"; do
  rm -rf output
  expect_code 0 "$debond" --study study.prm \
    --set "Sweep 1/Values=winkler" --set "Study/Settings=$bonds"
  [ ! -e $plots/law.dat ] || fail "a law of bonds that vary"
  for file in errors output/study/index.md; do
    grep -q "plot law has no points; of bonds that vary there is no" $file ||
      fail "no word in $file: $(cat errors)"
  done
done

# Along an inclined side, and in 3D, where several nodes have the same place.
expect_code 0 "$debond" --study study.prm --set "Study/Settings=Mesh/Rotation=30"
grep -q "xlabel 'length along the contact boundary'" $plots/force.gp ||
  fail "not along the inclined side"
awk '/^[0-9]/ && $1 > longest { longest = $1 }
  END { exit !(longest > 1.999 && longest < 2.001) }' $plots/force.dat ||
  fail "not its length"
expect_code 0 "$debond" --study study.prm \
  --set "Study/Settings=Dimension=3 | Mesh/Lengths=1, 2, 3 | Mesh/Cells=1, 2, 3 | Loads/Traction top=0.01; 0; 0"
grep -q "xlabel 'z'" $plots/displacement.gp || fail "not over z"
grep -q "with points" $plots/displacement.gp || fail "a zigzag in 3D"

# Ten curves have ten colours.
expect_code 0 "$debond" --study study.prm \
  --set "Sweep 1/Parameter=Contact law/Bond stiffness" \
  --set "Sweep 1/Values=geometric 1 512 10"
[ "$(grep -o 'palette frac [0-9.e-]*' $plots/displacement.gp | sort -u | wc -l)" \
  -eq 10 ] || fail "not ten colours"

# A minimum if a column or a plot needs it.
expect_code 0 "$debond" --study study.prm --set "Study/Columns=J | error"
grep -q "exact minima 2" log || fail "no minima for the error"
expect_code 0 "$debond" --study study.prm --set "Plots/Kinds=convergence"
grep -q "exact minima 2" log || fail "no minima for the plot"

expect_code 5 "$debond" --study study.prm \
  --set "Study/Columns=J | broken = /bond_states/brokn"
grep -q "no case has a number /bond_states/brokn" errors ||
  fail "the key is not named: $(cat errors)"
