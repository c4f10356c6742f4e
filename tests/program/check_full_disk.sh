#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_full_disk.sh DEBOND: a file for which there is no space is named with the
# reason, the exit code is 5, and nothing half written stays.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

benchmark "20, 2"
cat >>bar.prm <<'SCENE'
subsection Output
  set Displacement = true
end
SCENE

# Files are written under another name first, which here cannot be created.
for file in parameters.prm body.vtu contact.vtu contact_profile.csv \
  history.csv displacement.txt summary.json; do
  rm -rf full
  mkdir -p full/$file.partial
  expect_code 5 "$debond" bar.prm --set "Output/Directory=full"
  grep -qx "debond: Cannot write full/$file.partial: File exists" errors ||
    fail "$file is not named with the reason: $(cat errors)"
  [ ! -e full/$file ] || fail "$file is there"
  [ ! -e full/summary.json ] || fail "The directory says that it is complete."
done

# A limit of the shell, in blocks of 1 kB: VTU files are larger, others are not.
(
  ulimit -f 8
  expect_code 5 "$debond" bar.prm --set "Mesh/Cells=60, 6" \
    --set "Output/Directory=limited"
)
grep -q "Cannot write limited/body.vtu: File too large" errors ||
  fail "limit: not named: $(cat errors)"
[ "$(ls limited)" = parameters.prm ] || fail "limit: $(ls limited)"

# The state for --restart likewise, by one rank for all; ranks that share memory
# would need files for it.
for launcher in "" "mpirun --allow-run-as-root --oversubscribe --mca btl self,tcp --mca btl_tcp_if_include lo -n 2"; do
  rm -rf state
  expect_code 5 timeout 120 $launcher bash -c 'ulimit -f 40; exec "$@"' bash \
    "$debond" bar.prm --set "Mesh/Cells=160, 16" --set "Output/Directory=state" \
    --set "Output/Body VTU=false" --set "Output/Contact VTU=false" \
    --set "Output/Displacement=false" --set "Load path/Factors=0.5, 1"
  [ "$(grep -c "Cannot write state/restart.state: File too large" errors)" -eq 1 ] ||
    fail "state, $launcher: not named: $(cat errors)"
  [ -s state/load_path.csv ] && [ ! -e state/restart.state ] ||
    fail "state, $launcher: $(ls state)"
done
