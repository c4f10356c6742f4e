#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_parameters.sh DEBOND SOURCE_DIRECTORY: doc/reference/parameters.md is what the
# program says.
set -euo pipefail

debond=$1
source_dir=$2
if ! "$source_dir/scripts/parameters" "$debond" |
  diff "$source_dir/doc/reference/parameters.md" -; then
  echo "Please run: scripts/parameters build/debond > doc/reference/parameters.md" >&2
  exit 1
fi
