#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds gst-ellipse if necessary and runs ellipse-demo:
#   ./examples/demo.sh                  a rendered landing
#   ./examples/demo.sh video.mp4        a file
#   ./examples/demo.sh frame%04d.jpg    pictures
#   ./examples/demo.sh /dev/video0      a camera
#   ./examples/demo.sh rtsp://...       any URI
# Options: --out DIR, --frames N.
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)

"$project/setup.sh" --without-tests
build="$project/build"
[ -e "$build/build.ninja" ] || meson setup "$build" "$project" > /dev/null
ninja -C "$build" examples/ellipse-demo gst/libgstellipsetrack.so > "$build/demo-build.log" 2>&1 ||
  { cat "$build/demo-build.log" >&2; exit 1; }

export GST_PLUGIN_PATH="$build/gst${GST_PLUGIN_PATH:+:$GST_PLUGIN_PATH}"
export GST_REGISTRY="$build/registry.bin"
exec "$build/examples/ellipse-demo" "$@"
