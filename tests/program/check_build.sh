#!/usr/bin/env bash
# SPDX-License-Identifier: LGPL-2.1-or-later
# check_build.sh DEBOND: scripts/build in a tree that was copied with its build folder
# builds this tree and not the one that it was copied from, and after that configures
# no more. The trees have no source code, so nothing is compiled.
. "$(dirname "${BASH_SOURCE[0]}")/../common.sh"

# With options to hand on, each build configures.
unset DEBOND_CMAKE_OPTIONS DEBOND_TARGETS

mkdir -p first/scripts
cp "$tests/../scripts/build" "$tests/../scripts/install" first/scripts
cat >first/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(tree NONE)
add_custom_target(it ALL ${CMAKE_COMMAND} -E touch ${CMAKE_SOURCE_DIR}/built)
END

first/scripts/build 2>log || fail "no build: $(cat log)"
[ -f first/built ] || fail "nothing was built: $(cat log)"
rm first/built
cp -r first second
second/scripts/build 2>log || fail "no build of the copy: $(cat log)"
[ -f second/built ] || fail "the copy was not built: $(cat log)"
[ ! -f first/built ] || fail "the original was built in place of the copy"
grep -q "build/ was made for .*/first" log || fail "the reason is not said: $(cat log)"
second/scripts/build 2>log || fail "no second build: $(cat log)"
! grep -q Configuring log || fail "configured once more: $(cat log)"

# Through a link it is the same tree.
ln -s second third
third/scripts/build 2>log || fail "no build through a link: $(cat log)"
! grep -q Configuring log || fail "configured for a link: $(cat log)"
