#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_install.sh DEBOND BUILD_DIRECTORY CMAKE: what is installed into an empty
# directory runs there, also from Python, its pages find each other, and one has all
# parameters; a program of its own is built with the library; the Debian package has
# the same program.
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
cat >runs.py <<END
import debond
print(debond.run("$prefix/share/debond/prm/benchmark-40x4.prm").summary["status"])
END
env -u DEBOND PATH="$prefix/bin:/usr/bin:/bin" \
  PYTHONPATH="$prefix/lib/python3/dist-packages" /usr/bin/python3 runs.py >log 2>&1 ||
  fail "no run from Python: $(cat log)"
grep -qx success log || fail "no success from Python: $(cat log)"
"$tests/program/check_links.py" "$prefix/share/doc/debond"
[ -s "$prefix/share/doc/debond/LICENSE" ] || fail "no licence"
page=$(find "$prefix" -name parameters.md)
"$debond" --print-parameters | grep "^subsection" >sections
while read -r section; do
  grep -qx "$section" "$page" || fail "parameters.md has no $section"
done <sections

# Sanitizers are options of whoever links.
if ! grep -q "DEBOND_SANITIZE:BOOL=ON" "$build/CMakeCache.txt"; then
  type=$(sed -n 's/^CMAKE_BUILD_TYPE:[A-Z]*=//p' "$build/CMakeCache.txt")
  "$cmake" -S "$tests/../doc/develop/own-law" -B own -DCMAKE_BUILD_TYPE="$type" \
    -DCMAKE_PREFIX_PATH="$prefix" >log 2>&1 &&
    "$cmake" --build own >>log 2>&1 || fail "own_law is not built: $(cat log)"
  own/own_law >log || fail "own_law: $(cat log)"
fi

"$(dirname "$cmake")/cpack" --config "$build/CPackConfig.cmake" -B deb >log 2>&1 ||
  fail "no Debian package: $(cat log)"
dpkg-deb -x deb/debond_*.deb root
[ -s root/usr/lib/python3/dist-packages/debond/__init__.py ] || fail "no Python"
root/usr/bin/debond --version >log || fail "the packaged program fails: $(cat log)"
dpkg-deb -f deb/debond_*.deb Depends | grep -q "libdeal.ii" ||
  fail "the package does not depend on deal.II"

# What the scripts install removes nothing: apt-get is told so.
mkdir stub
printf '#!/bin/sh\necho "$@" >>"%s/apt"\n' "$PWD" >stub/apt-get
chmod +x stub/apt-get
PATH=$PWD/stub:$PATH "$tests/../scripts/install" debond-no-such-package 2>/dev/null ||
  true
grep "install.*debond-no-such-package" apt >asked || fail "no package was asked for"
grep -q -- "--no-remove" asked || fail "packages may be removed: $(cat asked)"
