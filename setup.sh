#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages that gst-ellipse needs, on Debian 12 and later and on derived distributions.
# On other systems it prints the list and stops. Does not use the network if nothing is missing.
#   ./setup.sh                   all packages
#   ./setup.sh --without-tests   those needed to build and run
#   ./setup.sh --packaging       the same, and those needed to build Debian packages
set -euo pipefail

packages=(
  # build
  g++ meson ninja-build pkg-config
  help2man  # the programs' manual pages
  dpkg-dev  # gives meson Debian's library folder
  libgstreamer1.0-dev libgstreamer-plugins-base1.0-dev
  libgstreamer-plugins-bad1.0-dev  # GStreamer's analytics metadata, from 1.24 on
  libopencv-dev libeigen3-dev
  gobject-introspection libgirepository1.0-dev
  # examples
  libcli11-dev libjson-glib-dev libopencv-contrib-dev gnuplot-nox
  libapriltag-dev  # a peer of ellipse-landing; optional
  python3-gi gir1.2-gstreamer-1.0
  libsoup-3.0-dev libgstrtspserver-1.0-dev gstreamer1.0-plugins-ugly  # ellipse-live and the cookbook
  # pipelines with cameras and files
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good gstreamer1.0-libav
)
tests=(
  libgtest-dev libbenchmark-dev
  # elements that pass the metadata on, and transports of the JSON lines
  gstreamer1.0-plugins-bad gstreamer1.0-x
  mosquitto mosquitto-clients  # installing it may start a broker on the loopback interface
  locales  # numbers with a comma
  valgrind gcovr clang clang-tidy codespell
  abigail-tools  # compares libgstellipse-1.0 with an earlier version
  python3-matplotlib  # 04_live_plot.py: 83 MB to download, 500 MB on disk
  gi-docgen
  python3-yaml  # reads the output of 06_ros_yaml.py
  opencv-doc  # pictures: 96 MB to download, 281 MB on disk
  chromium  # the page of ellipse-live: 81 MB to download, 290 MB on disk
)
# For examples/mavlink and the tests of the page. A Node from another source has its own npm and
# conflicts with Debian's.
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
  echo "setup.sh: this is not a Debian system. Install the equivalents of:" >&2
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
