# SPDX-License-Identifier: LGPL-2.1-or-later
# For the checks of the program: an empty directory, and how to look at tables.
set -euo pipefail
export LC_ALL=C

debond=$1
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
cd "$directory"

fail() {
  echo "$*" >&2
  exit 1
}

# benchmark CELLS: the paper's with other cells, as bar.prm.
benchmark() {
  cat >bar.prm <<END
subsection Mesh
  set Cells = $1
end
subsection Loads
  set Traction top = 0; if(x < 0.2, 0.69, -0.345)
end
END
}

# column TABLE.csv TITLE: the cells of a column, a line each.
column() {
  awk -F, -v title="$2" '
    NR == 1 { for (i = 1; i <= NF; ++i) if ($i == title) n = i
              if (!n) { print "no column " title > "/dev/stderr"; exit 1 } }
    NR > 1 { print $n }' "$1"
}

# expect_code CODE COMMAND...: runs it, with its output in the files log and
# errors.
expect_code() {
  local expected=$1 code=0
  shift
  "$@" >log 2>errors || code=$?
  [ $code -eq "$expected" ] ||
    fail "exit code $code in place of $expected: $(cat log errors)"
}

# signal_when SIGNAL CONDITION COMMAND...: runs it with its output in the files log
# and errors, sends the signal when the condition, a command, holds, and leaves the
# exit code in $code. With job control, for else SIGINT is ignored in the background.
signal_when() {
  local signal=$1 condition=$2
  shift 2
  : >log # of an earlier command
  set -m
  "$@" >log 2>errors &
  process=$!
  set +m
  local held=
  for _ in $(seq 6000); do
    eval "$condition" && held=yes && break
    sleep 0.02
  done
  kill -s "$signal" $process 2>/dev/null || true # it may have ended
  code=0
  wait $process 2>/dev/null || code=$?
  [ -n "$held" ] || fail "never: $condition; $(cat log errors)"
}
