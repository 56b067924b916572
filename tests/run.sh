#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Sets up, builds and runs tests:
#   ./tests/run.sh                     all tests of the shipped configuration
#   ./tests/run.sh --sanitize          all under AddressSanitizer and UBSan
#   ./tests/run.sh --sanitize=thread   pipelines under ThreadSanitizer
#   ./tests/run.sh --coverage          all; at least 90 % line coverage of core/ and gst/
#   ./tests/run.sh --long              300,000 frames; with gcc, with clang, without the plugin; lint; spelling
# Each accepts --werror in front, which turns compiler warnings into errors, as .ci/run does.
# Ends with the failures and a line "N passed, N failed, N skipped".
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
min_coverage=90
passed=0
failed=0
skipped=0
failures=()
werror=false

# build FOLDER OPTION...: configures and builds. Reconfigures an existing folder, because packages
# may have been installed since: demo.sh needs fewer.
build() {
  local folder="$project/$1"
  shift
  if [ -e "$folder/build.ninja" ]; then
    meson setup --reconfigure "$folder" "$project" -Dwerror=$werror "$@" || return
  else
    meson setup "$folder" "$project" -Dwerror=$werror "$@" || return
  fi
  ninja -C "$folder"
}

# Sums one attribute over the reports of all suites in a folder.
count() {
  cat "$1"/*.xml 2> /dev/null | grep -E '^<testsuites ' | grep -oE " $2=\"[0-9]+\"" |
    grep -oE '[0-9]+' | awk '{ sum += $1 } END { print sum + 0 }' || true
}

# run FOLDER ARGUMENT...: runs and counts tests.
run() {
  local folder="$project/$1"
  shift
  local status=0
  rm -f "$folder"/*.xml
  meson test -C "$folder" --print-errorlogs "$@" || status=$?
  local total bad idle
  total=$(($(count "$folder" tests) - $(count "$folder" disabled)))  # disabled: run by others
  bad=$(($(count "$folder" failures) + $(count "$folder" errors)))
  idle=$(cat "$folder"/*.xml 2> /dev/null | grep -c 'result="skipped"' || true)
  # A suite that crashed has no report; it counts as a failure.
  if [ "$status" -ne 0 ]; then
    failures+=("$("$project/tests/failures.py" "$folder")")
    if [ "$bad" -eq 0 ]; then bad=1; fi
  fi
  if [ "$total" -eq 0 ]; then bad=1; fi
  local good=$((total - bad - idle))
  passed=$((passed + (good > 0 ? good : 0)))
  failed=$((failed + bad))
  skipped=$((skipped + idle))
}

# check COMMAND...: runs a command that counts as one test.
check() {
  echo "run.sh: $*"
  if "$@"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    failures+=("FAILED $*")
  fi
}

if [ "${1:-}" = --werror ]; then
  werror=true
  shift
fi
"$project/setup.sh"
case "${1:-}" in
  "")
    build build
    run build --no-suite long
    ;;
  --sanitize | --sanitize=address)
    export ASAN_OPTIONS=detect_leaks=1:fast_unwind_on_malloc=0
    export LSAN_OPTIONS=suppressions="$project/tests/lsan.supp":print_suppressions=0
    export UBSAN_OPTIONS=halt_on_error=1:print_stacktrace=1
    # The sanitizers cause false gcc warnings inside the standard library.
    build build-sanitize -Dbuildtype=debugoptimized -Db_sanitize=address,undefined -Db_lundef=false \
      -Dcpp_args=-Wno-maybe-uninitialized
    run build-sanitize --timeout-multiplier 3 --no-suite long
    ;;
  --sanitize=thread)
    # GLib, GStreamer and OpenCV are not instrumented: their own accesses are ignored.
    # ThreadSanitizer recognises reused memory through malloc only.
    export G_SLICE=always-malloc
    export TSAN_OPTIONS=ignore_noninstrumented_modules=1:suppressions="$project/tests/tsan.supp"
    build build-thread -Dbuildtype=debugoptimized -Db_sanitize=thread -Db_lundef=false \
      -Dexamples=disabled
    run build-thread --timeout-multiplier 3 gst
    ;;
  --coverage)
    # Coverage makes gcc warn of uninitialised values in Eigen. Without atomic updates, concurrent
    # threads would leave negative counts.
    build build-coverage -Dbuildtype=debug -Doptimization=1 -Db_coverage=true -Dwerror=false \
      -Dexamples=disabled -Dcpp_args=-fprofile-update=atomic
    find "$project/build-coverage" -name '*.gcda' -delete
    run build-coverage --no-suite long
    check gcovr --root "$project" --object-directory "$project/build-coverage" \
      --filter "$project/core/" --filter "$project/gst/" --fail-under-line "$min_coverage"
    ;;
  --long)
    check build build
    export CC=clang CXX=clang++  # for the first configuration of the folder
    check build build-clang
    unset CC CXX
    run build-clang core gst
    check build build-core -Dplugin=disabled
    check env --chdir "$project" codespell
    check run-clang-tidy -quiet -p "$project/build" "^$project/(core|gst)/.*\.cpp$"
    run build-core --no-suite long
    run build --suite long --verbose
    ;;
  *)
    echo "usage: run.sh [--werror] [--sanitize[=address|=thread] | --coverage | --long]" >&2
    exit 2
    ;;
esac
# Repeated at the end, because the logs above are long and may be truncated.
[ ${#failures[@]} -eq 0 ] || printf '%s\n' "${failures[@]}"
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
