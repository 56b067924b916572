#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages that debian.sh has built, runs their smoke tests and purges them. Fails if a
# test fails or a file remains. Modifies the system: run it as root in a chroot or a container.
#   examples/packaging/check.sh PACKAGES_FOLDER
set -euo pipefail
[ $# -eq 1 ] || { echo "usage: check.sh PACKAGES_FOLDER" >&2; exit 2; }
[ "$(id -u)" -eq 0 ] || { echo "check.sh: must run as root" >&2; exit 2; }
tests=$(cd "$(dirname "$0")/debian/tests" && pwd)
mapfile -t packages < <(find "$(cd "$1" && pwd)" -maxdepth 1 -name '*.deb' ! -name '*-dbgsym_*' | sort)
[ ${#packages[@]} -gt 0 ] || { echo "check.sh: no package in $1" >&2; exit 2; }
export DEBIAN_FRONTEND=noninteractive
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

install() {
  apt-get install -q -y --no-install-recommends "$@"
}

package_names() {
  for package in "${packages[@]}"; do dpkg-deb --field "$package" Package; done
}

# The packages in the tests' field Depends, without those under test.
test_dependencies() {
  sed -n 's/^Depends: //p' "$tests/control" | tr -d ' ' | tr ',' '\n' | sort -u |
    grep -vxFf <(package_names)
}

# Installs all dependencies first, so that new files belong to the packages under test.
install_dependencies() {
  mapfile -t others < <(test_dependencies)
  install "${others[@]}"
  mapfile -t others < <(apt-get install -s -q --no-install-recommends "${packages[@]}" |
    sed -n 's/^Inst \([^ ]*\) .*/\1/p' | grep -vxFf <(package_names))
  [ ${#others[@]} -eq 0 ] || install "${others[@]}"
}

# All files except virtual and temporary ones, and the state and logs of dpkg and apt.
list_files() {
  find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /run -o -path /tmp \
    -o -path /var/lib/dpkg -o -path /var/lib/apt -o -path /var/cache/apt -o -path /var/log \
    -o -path "$work" \) -prune -o -print | sort
}

run_test() {
  echo "check.sh: $1"
  mkdir "$work/$1"
  AUTOPKGTEST_TMP=$work/$1 HOME=$work/$1 "$tests/$1"
}

apt-get update -q
install_dependencies
list_files > "$work/before"
install "${packages[@]}"
for name in $(sed -n 's/^Tests: //p' "$tests/control"); do run_test "$name"; done
mapfile -t names < <(package_names)
apt-get purge -q -y "${names[@]}"
list_files > "$work/after"
diff "$work/before" "$work/after" || { echo "check.sh: the files after purging differ from those before the installation" >&2; exit 1; }
echo "check.sh: ${names[*]}: installed, tested and purged; no file remains"
