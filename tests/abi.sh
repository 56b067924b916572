#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Checks the binary interface of libgstellipse-1.0 against an earlier version: a program built
# against that version must run with this one. Prints the changes.
#   abi.sh SOURCE BASELINE           fails if a change is incompatible
#   abi.sh --write SOURCE BASELINE   writes the baseline, as for a release
set -euo pipefail
is_writing=false
if [ "${1:-}" = --write ]; then
  is_writing=true
  shift
fi
source=$1
baseline=$2
if ! command -v abidiff > /dev/null; then
  echo "abi.sh: skipped, abidiff is not installed"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Builds the library with debug information, which abidiff needs and a release lacks.
echo '{ global: gst_*; local: *; };' > "$work/symbols.map"
needs=(gstreamer-1.0 gstreamer-video-1.0 eigen3)
c++ -std=c++20 -g -O1 -fPIC -shared -I"$source" "$source"/gst/ellipse/*.cpp \
  "$source/core/geometry/ellipse.cpp" $(pkg-config --cflags --libs "${needs[@]}") \
  -Wl,--version-script="$work/symbols.map" -Wl,-soname,libgstellipse-1.0.so.0 -o "$work/new.so"
if $is_writing; then
  abidw --headers-dir "$source/gst/ellipse" --drop-private-types --drop-undefined-syms \
    --no-show-locs --no-corpus-path --no-comp-dir-path "$work/new.so" | gzip -9n > "$baseline"
  exit 0
fi

gunzip -c "$baseline" > "$work/old.abi"
# GStreamer's own structures may differ: the baseline may come from an older GStreamer.
printf '[suppress_type]\n  name_regexp = ^_?GstMeta(Info)?$\n' > "$work/suppressions"
status=0
abidiff --suppressions "$work/suppressions" "$work/old.abi" "$work/new.so" > "$work/report" || status=$?
cat "$work/report"
[ $((status & 3)) -eq 0 ] || { echo "abi.sh: abidiff failed" >&2; exit 1; }
# abidiff reports only removed symbols as incompatible. Structures may grow at the end, because the
# library allocates them.
! grep -E '[1-9][0-9]* Removed|(data member|enumerator) (deletion|change)s?( \(.* filtered\))?:' "$work/report" ||
  { echo "abi.sh: the change is incompatible" >&2; exit 1; }
