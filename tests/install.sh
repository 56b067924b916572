#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs a build into a folder and follows the installation's instructions.
#   install.sh SOURCE BUILD
set -euo pipefail
source=$1
build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "install.sh: $*" >&2
  exit 1
}

# The output for one prefix and one variable whose default search path is in /usr.
paths_for() {
  MESON_INSTALL_PREFIX=$1 "$source/gst/print_paths.sh" "$1/lib" \
    GST_PLUGIN_PATH "$1/lib/gstreamer-1.0" /usr/lib/gstreamer-1.0
}
[ -z "$(paths_for /usr)" ] || fail "prints what nobody needs: $(paths_for /usr)"
paths_for /opt/a | grep -qF 'export GST_PLUGIN_PATH=/opt/a/lib/gstreamer-1.0${GST_PLUGIN_PATH:+:$GST_PLUGIN_PATH}' ||
  fail "does not name the plugin's folder: $(paths_for /opt/a)"
paths_for /opt/a | grep -qF 'export LD_LIBRARY_PATH=/opt/a/lib' || fail "does not name the libraries' folder"
[ -z "$(GST_PLUGIN_PATH=/x:/opt/a/lib/gstreamer-1.0 LD_LIBRARY_PATH=/opt/a/lib paths_for /opt/a)" ] ||
  fail "names what is set already"

# The tests' own environment would hide an error.
unset GST_PLUGIN_PATH GST_PRESET_PATH GI_TYPELIB_PATH LD_LIBRARY_PATH PKG_CONFIG_PATH
export GST_REGISTRY=$work/registry.bin
printed=$(DESTDIR=$work/root meson install --no-rebuild -C "$build")
[ -d "$work/root" ] || fail "DESTDIR has nothing in it"
# Prepends DESTDIR, where the files are.
lines=$(grep '^  export ' <<< "$printed" | sed "s|=/|=$work/root/|") || true
eval "$lines"
case "$printed" in
  *"sudo ldconfig"*) LD_LIBRARY_PATH=$(dirname "$(find "$work/root" -name 'libgstellipse-1.0.so')") ;;
esac
export LD_LIBRARY_PATH
if [ -z "$lines" ]; then
  echo "install.sh: skipped, the prefix is searched anyway"
  exit 77
fi
gst-inspect-1.0 ellipsetrack > "$work/inspected" || fail "the plugin is not found: $printed"
grep -qF "$work/root" "$work/inspected" || fail "another plugin is found: $(cat "$work/inspected")"
[ "$(gst-launch-1.0 -q ellipsetestsrc num-buffers=3 ! ellipsetrack ! ellipsejson ! fdsink | wc -l)" -eq 3 ] ||
  fail "the plugin does not run"
if [ -n "${ELLIPSE_PYTHON:-}" ]; then
  "$ELLIPSE_PYTHON" -c 'import gi; gi.require_version("GstEllipse", "1.0")
from gi.repository import GstEllipse; GstEllipse.EllipseRole.TARGET' || fail "the typelib is not found"
fi
if [ -n "${PKG_CONFIG_PATH:-}" ]; then
  pkg-config --exists gstellipse-1.0 || fail "the .pc file is not found"
  ! pkg-config --print-requires --print-requires-private gstellipse-1.0 ellipse-1.0 | grep -i opencv ||
    fail "a .pc file wants OpenCV"
fi

# Programs that read metadata load neither OpenCV nor the detector.
metadata=$(find "$work/root" -name libgstellipse-1.0.so)
ldd "$metadata" > "$work/loaded" || fail "libgstellipse-1.0 is not installed"
! grep -E 'opencv|libellipse|tbb|lapack' "$work/loaded" || fail "libgstellipse-1.0 loads more than it needs"
nm -DC --defined-only "$metadata" > "$work/defined"
grep -q gst_buffer_get_ellipse_meta "$work/defined" || fail "libgstellipse-1.0 has no metadata"
! grep 'ellipse::' "$work/defined" || fail "libgstellipse-1.0 exports what libellipse-1.0 has"

# The headers include installed headers only, and nothing of the scene renderer.
headers=$(find "$work/root" -type d -path '*/include/ellipse-1.0')
(cd "$headers" && find . -name '*.hpp' -printf '#include "%P"\n') > "$work/all.cpp"
c++ -std=c++20 -fsyntax-only -I"$headers" $(pkg-config --cflags eigen3) "$work/all.cpp" ||
  fail "the installed headers do not compile by themselves"
grep -q tracking/tracker.hpp "$work/all.cpp" || fail "the tracker's header is not installed"
! grep -q scene "$work/all.cpp" || fail "the renderer's headers are installed"
library=$(find "$work/root" -name libellipse-1.0.so)
nm -DC "$library" > "$work/symbols" || fail "libellipse-1.0 is not installed"
grep -q 'ellipse::Tracker::process' "$work/symbols" || fail "libellipse-1.0 has no tracker"
! grep -q SceneRenderer "$work/symbols" || fail "libellipse-1.0 has the renderer"
