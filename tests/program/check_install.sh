#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_install.sh DEBOND BUILD_DIRECTORY CMAKE: what is installed into an empty
# directory runs there, and its pages find each other.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"
build=$2
cmake=$3
prefix=$directory/prefix

"$cmake" --install "$build" --prefix "$prefix" >log
mkdir work
cd work
"$prefix/bin/debond" "$prefix/share/debond/prm/benchmark-40x4.prm" >log ||
  fail "The installed program fails: $(cat log)"
grep -Eq "status +success" log || fail "no success: $(cat log)"
"$tests/program/check_links.py" "$prefix/share/doc/debond"
[ -s "$prefix/share/doc/debond/LICENSE" ] || fail "no licence"

# What the scripts install removes nothing: apt-get is told so.
mkdir stub
printf '#!/bin/sh\necho "$@" >>"%s/apt"\n' "$PWD" >stub/apt-get
chmod +x stub/apt-get
PATH=$PWD/stub:$PATH "$tests/../scripts/install" debond-no-such-package 2>/dev/null ||
  true
grep "install.*debond-no-such-package" apt >asked || fail "no package was asked for"
grep -q -- "--no-remove" asked || fail "packages may be removed: $(cat asked)"
