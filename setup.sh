#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs what gst-ellipse is built, tested and run with. Debian 12 and its relatives; elsewhere it
# prints the list and stops. Touches no network when everything is there.
#   ./setup.sh                   all of it
#   ./setup.sh --without-tests   only what building and running takes
#   ./setup.sh --packaging       that, and what Debian packages are built with
set -euo pipefail

packages=(
  # build
  g++ meson ninja-build pkg-config
  help2man  # the programs' manual pages
  dpkg-dev  # tells meson where Debian keeps libraries
  libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev
  libgstreamer-plugins-bad1.0-dev  # GStreamer's analytics metadata, from 1.24 on
  libopencv-dev libeigen3-dev
  gobject-introspection libgirepository1.0-dev
  # examples
  libcli11-dev libjson-glib-dev libopencv-contrib-dev gnuplot-nox
  libapriltag-dev  # a peer of ellipse-landing; optional
  python3-gi gir1.2-gstreamer-1.0
  libsoup-3.0-dev libgstrtspserver-1.0-dev gstreamer1.0-plugins-ugly  # ellipse-live: its page, its RTSP; and the cook-book's
  # to run pipelines with cameras and files
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-libav
)
tests=(
  libgtest-dev libbenchmark-dev
  # what the metadata is sent through, and what carries the JSON lines
  gstreamer1.0-plugins-bad gstreamer1.0-x
  mosquitto mosquitto-clients  # where services are started, a broker on the loopback from here on
  locales  # numbers with a comma
  valgrind gcovr clang clang-tidy codespell
  abigail-tools  # compares libgstellipse-1.0 with its earlier version
  python3-matplotlib  # 04_live_plot.py: 83 MB to download, 500 MB on disk
  gi-docgen
  python3-yaml  # reads what 06_ros_yaml.py writes
  opencv-doc  # pictures: 96 MB to download, 281 MB on disk
  chromium  # the page of ellipse-live: 81 MB to download, 290 MB on disk
)
# For examples/mavlink and the page's tests. Where Node came from elsewhere it has its own npm, and
# excludes Debian's.
command -v npm > /dev/null || tests+=(nodejs npm)

case "${1:-}" in
  "") packages+=("${tests[@]}") ;;
  --without-tests) ;;
  --packaging) packages+=(debhelper lintian) ;;
  *)
    echo "usage: setup.sh [--without-tests | --packaging]" >&2
    exit 2
    ;;
esac

if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  echo "setup.sh: this is no Debian system. Install what corresponds to:" >&2
  printf '  %s\n' "${packages[@]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f '${Status}' "$package" 2> /dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "setup.sh: neither root nor sudo. As root, run: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "setup.sh: installing ${missing[*]}" >&2
"${as_root[@]}" apt-get update -q >&2
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -q -y --no-install-recommends "${missing[@]}" >&2
