#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_error.sh DEBOND NAME.prm: runs debond on the scene, with the arguments
# in NAME.args if there is such a file, one a line, in an empty directory, and
# compares what it prints on stderr and its exit code with NAME.expected. With
# exit code 2 nothing may have been written.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
scene=$2
expected=${scene%.prm}.expected
arguments=()
if [ -f "${scene%.prm}.args" ]; then
  mapfile -t arguments <"${scene%.prm}.args"
fi
cp "$scene" .

code=0
"$debond" "$(basename "$scene")" "${arguments[@]}" \
  2>"$directory/.stderr" >"$directory/.stdout" || code=$?
echo "exit code $code" >>"$directory/.stderr"
diff "$expected" "$directory/.stderr"

if [ $code -eq 2 ] && [ "$(ls "$directory")" != "$(basename "$scene")" ]; then
  echo "Files were written:"
  ls -R "$directory"
  exit 1
fi
