#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, builds and runs all tests:
#   ./tests/run.sh              as it is shipped, warnings as errors
#   ./tests/run.sh --sanitize   under AddressSanitizer and UBSan
# Closes with a line "N passed, N failed, N skipped".
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)

"$project/setup.sh"
build="$project/build"
options=(-Dwerror=true)
if [ "${1:-}" = "--sanitize" ]; then
  build="$project/build-sanitize"
  options+=(-Dbuildtype=debugoptimized -Db_sanitize=address,undefined -Db_lundef=false)
  export ASAN_OPTIONS=detect_leaks=1:fast_unwind_on_malloc=0
  export LSAN_OPTIONS=suppressions="$project/tests/lsan.supp":print_suppressions=0
  export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
fi
if [ -e "$build/build.ninja" ]; then
  meson configure "$build" "${options[@]}"
else
  meson setup "$build" "$project" "${options[@]}"
fi
ninja -C "$build"

# Each suite writes how many of its tests ran, failed and were skipped.
rm -f "$build"/*.xml
status=0
meson test -C "$build" --print-errorlogs || status=$?
count() {
  cat "$build"/*.xml 2> /dev/null | grep -E '^<testsuites ' | grep -oE " $1=\"[0-9]+\"" |
    grep -oE '[0-9]+' | awk '{ sum += $1 } END { print sum + 0 }' || true
}
total=$(count tests)
failed=$(($(count failures) + $(count errors)))
skipped=$(cat "$build"/*.xml 2> /dev/null | grep -c 'result="skipped"' || true)
# A suite that died wrote nothing: that is a failure too.
if [ "$status" -ne 0 ] && [ "$failed" -eq 0 ]; then failed=1; fi
if [ "$total" -eq 0 ]; then status=1; failed=1; fi
passed=$((total - failed - skipped))
[ "$passed" -ge 0 ] || passed=0
echo "$passed passed, $failed failed, $skipped skipped"
exit "$status"
