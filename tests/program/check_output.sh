#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_output.sh DEBOND: which files a run writes, and what it does if it
# cannot write one.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "10, 1"

# The default directory, with parents that do not exist.
"$debond" bar.prm >log
files=(body.vtu contact.vtu contact_profile.csv history.csv parameters.prm
  summary.json)
[ "$(ls output/bar)" = "$(printf '%s\n' "${files[@]}")" ] ||
  fail "output/bar has $(ls output/bar)"
for file in "${files[@]}"; do
  [ -s "output/bar/$file" ] || fail "$file is empty."
  grep -q "output/bar/$file" log || fail "The log does not name $file."
done
grep -q '"status": "success"' output/bar/summary.json || fail "no success"

# Scripts read the summary by its keys.
keys=$(sed -n 's/^ *"\([a-z][a-z0-9_ ]*\)":.*/\1/p' output/bar/summary.json |
  LC_ALL=C sort -u | tr '\n' ' ')
expected="applied_force assembly bond_states bonded broken build_type cells\
 clamped_reaction condition_estimate contact contact_nodes\
 contact_reaction deal_ii_version degree degrees_of_freedom degrees_of_freedom_paper\
 dimension equilibrium_residual force_imbalance functional\
 functional_from_start iterations kink largest_displacement\
 largest_displacement_gradient largest_qp_residual largest_von_mises\
 law_violation linear_iterations linear_solver long memory_estimate_bytes mesh\
 message method minimum notes null output peak_memory_bytes penetration\
 reactions relative_descent revision scene search_failures search_improvements search_nodes search_trials\
 short solve solve_parts state status stop_criterion tangential_reaction\
 timings_s total verification "
for key in $expected; do
  case " $keys" in
    *" $key "*) ;;
    *) fail "summary.json has no $key, but: $keys" ;;
  esac
done

# The effective parameters give the same result, in the same directory.
mv output/bar first
"$debond" first/parameters.prm >log
! grep "no effect" log || fail "The effective parameters have some without effect."
cmp first/history.csv output/bar/history.csv ||
  fail "The effective parameters give another result."

# The search finds a lower state than the one that the method led to: with J as
# it is known from an enumeration of bond states. The log, the summary and the
# history have both.
"$debond" bar.prm --set "Mesh/Cells=40, 4" \
  --set "Contact law/Bond stiffness=690" --set "Output/Directory=found" >log
grep -q "^  J  *-2.39731275..e-04$" log || fail "the least J: $(cat log)"
grep -q "^  J from start  *-7.35454955..e-05, " log ||
  fail "J of the state that was followed: $(cat log)"
grep -q '"functional_from_start": -7.35454955' found/summary.json ||
  fail "not in the summary"
[ "$(column found/history.csv functional | tail -n 2 |
  xargs printf '%.9e ')" = "-7.354549556e-05 -2.397312753e-04 " ] || fail "history: $(cat found/history.csv)"

# Switched off.
"$debond" bar.prm --set "Output/Directory=few" --set "Output/Body VTU=false" \
  --set "Output/Contact VTU=false" --set "Output/Contact profile=false" \
  --set "Output/History=false" >/dev/null
[ "$(ls few)" = "$(printf '%s\n' parameters.prm summary.json)" ] ||
  fail "few has $(ls few)"

# Files of an earlier run do not stay beside the new ones.
"$debond" bar.prm --set "Output/Body VTU=false" --set "Output/History=false" \
  >/dev/null
[ ! -e output/bar/body.vtu ] && [ ! -e output/bar/history.csv ] ||
  fail "Old files stayed: $(ls output/bar)"

# What lies under the names of files, or of files in the making, is replaced and
# not followed: links, also to nothing, hard links, pipes.
echo precious >victim
mkdir planted
cd planted
ln -s ../victim body.vtu
ln -s ../victim body.vtu.partial
ln -s ../missing contact.vtu.partial
ln ../victim contact_profile.csv.partial
mkfifo history.csv.partial parameters.prm.partial
ln -s /dev/zero summary.json.partial
cd ..
expect_code 0 timeout 120 "$debond" bar.prm --set "Output/Directory=planted"
[ "$(cat victim)" = precious ] && [ ! -e missing ] || fail "links were followed"
[ "$(ls planted)" = "$(printf '%s\n' "${files[@]}")" ] ||
  fail "planted has $(ls planted)"
for file in "${files[@]}"; do
  [ ! -L "planted/$file" ] && [ -s "planted/$file" ] || fail "$file: $(ls -l planted)"
done

# A file that cannot be written is named, and the exit code is 5.
mkdir -p blocked/contact_profile.csv
expect_code 5 "$debond" bar.prm --set "Output/Directory=blocked"
grep -q "blocked/contact_profile.csv" errors ||
  fail "The file that cannot be written is not named: $(cat errors)"
grep -q "status  *success" log || fail "The result is not in the log."

# Also if it is the first one, then before the solve.
mkdir -p closed/parameters.prm
expect_code 5 "$debond" bar.prm --set "Output/Directory=closed"
grep -q "closed/parameters.prm" errors || fail "not named: $(cat errors)"
[ ! -s log ] || fail "The scene was solved: $(cat log)"

# Names that are no UTF-8 do not spoil the summary.
echo "include bar.prm" >$'odd"\xff.prm'
"$debond" $'odd"\xff.prm' --set "Output/Directory=odd" >/dev/null
python3 -c 'import json; json.load(open("odd/summary.json"))' || fail "summary.json"
