#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds the Debian packages of this tree, a git clone or an unpacked tarball, and checks them with
# lintian. Builds in a temporary folder and does not modify the tree.
#   examples/packaging/debian.sh [--out FOLDER]   default: out/packages
# DEB_BUILD_OPTIONS is passed to dpkg-buildpackage; default: noautodbgsym.
set -euo pipefail
project=$(cd "$(dirname "$0")/../.." && pwd)
debian=$project/examples/packaging/debian

usage() {
  echo "usage: debian.sh [--out FOLDER]" >&2
  exit 2
}

# The changelog, which dpkg reads, must have the version of meson.build.
check_version() {
  local project_version package_version
  project_version=$(sed -n "s/^  version: '\(.*\)',$/\1/p" "$project/meson.build")
  package_version=$(dpkg-parsechangelog -l "$debian/changelog" -S Version)
  [ "$project_version" = "$package_version" ] && return
  echo "debian.sh: meson.build has version $project_version, $debian/changelog has $package_version" >&2
  exit 1
}

# copy_tree FOLDER: copies all files with the changelog's date, so that packages are reproducible.
copy_tree() {
  local date
  date=$(dpkg-parsechangelog -l "$debian/changelog" -S Timestamp)
  mkdir "$1"
  "$project/examples/packaging/list_files.sh" | tar -C "$project" --null --files-from=- --mtime="@$date" -c | tar -C "$1" -x
  cp -a "$1/examples/packaging/debian" "$1/debian"
}

# Builds packages of debug symbols only on request.
export DEB_BUILD_OPTIONS=${DEB_BUILD_OPTIONS-noautodbgsym}
out=$PWD/out/packages
while [ $# -gt 0 ]; do
  case $1 in
    --out) [ $# -ge 2 ] || usage; out=$2; shift 2 ;;
    *) usage ;;
  esac
done
mkdir -p "$out"
out=$(cd "$out" && pwd)

"$project/setup.sh" --packaging
check_version
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
copy_tree "$work/gst-ellipse"
(cd "$work/gst-ellipse" && dpkg-buildpackage --build=binary --no-sign)
lintian --allow-root --fail-on=error "$work"/*.changes
cp "$work"/*.deb "$work"/*.buildinfo "$work"/*.changes "$out"
echo "debian.sh: the packages are in $out:"
(cd "$out" && ls -- *.deb)
