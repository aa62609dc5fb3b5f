#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
#
# Runs every test on Blender 5.2 and 4.5: on both at once, since most tests keep one core busy, and
# then those that take times, one version after the other. Tests for which one version is enough
# (marked `once`) are shared among both.
#
#   tools/test_all.sh [FILE OR FOLDER] [PYTEST'S OPTIONS]
#
# Shows 5.2's output as it comes and 4.5's when it is done (build/test-4.5.log). Fails if any does.
set -u
cd "$(dirname "$0")/.." || exit 1
newer=$(tools/environment.sh 5.2) && older=$(tools/environment.sh 4.5) || exit 1
mkdir -p build
log=build/test-4.5.log
status=0

# $1 is pytest's exit status; 5 says that nothing was selected, as where only times are asked for.
note() { [ "$1" -eq 0 ] || [ "$1" -eq 5 ] || status=1; }

echo "== Tests on Blender 5.2 (those on 4.5 run beside them, into $log)"
"$older" -m pytest "$@" -m "not timing" --half 1 >"$log" 2>&1 &
other=$!
trap 'kill "$other" 2>/dev/null; exit 130' INT TERM
"$newer" -m pytest "$@" -m "not timing" --half 2
note $?
wait "$other"
note $?
trap - INT TERM
echo "== Tests on Blender 4.5"
cat "$log"

echo "== Times on Blender 5.2"
"$newer" -m pytest "$@" -m timing
note $?
echo "== Times on Blender 4.5"
"$older" -m pytest "$@" -m timing
note $?
exit "$status"
