#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Builds and tests on bare machines:
#   tests/machines.sh [--into FOLDER] [bookworm|trixie|arm64]...   all three without a name
# bookworm, trixie: debootstrap; both commands of the README; builds the packages and tries them in
# a second bare system. arm64: cross-build on bookworm; the suites core and gst under qemu-user; the
# instructions in hot loops; the cost per frame.
# Needs root and debootstrap, 6 GB and half an hour for each machine. Each machine is a chroot in
# its own namespaces, without /dev/pts. FOLDER keeps the machines and their logs, and a later run
# reuses them. Without it they are in a temporary folder, which is kept only after a failure.
# Ends with a table and a line "N passed, N failed, N skipped".
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
folder=
failed=0
rows=()

usage() {
  echo "usage: machines.sh [--into FOLDER] [bookworm|trixie|arm64]..." >&2
  exit 2
}

# inside MACHINE COMMAND...: runs a command as root in the machine's copy of the project.
inside() {
  root=$folder/$1
  shift
  local variables=(HOME=/root TERM=dumb LANG=C.UTF-8 PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin)
  # Adds the certificate authorities that npm trusts on this machine.
  if [ -n "${NODE_EXTRA_CA_CERTS:-}" ]; then
    cp "$NODE_EXTRA_CA_CERTS" "$root/root/authorities.pem"
    variables+=(NODE_EXTRA_CA_CERTS=/root/authorities.pem)
  fi
  root=$root unshare --pid --fork --kill-child --mount --propagation private bash -c '
    mount -t proc proc "$root/proc" &&
      exec env -i "${@:2:$1}" chroot "$root" bash -c '\''cd /root/gst-ellipse && exec "$@"'\'' - "${@:$1+2}"
  ' - "${#variables[@]}" "${variables[@]}" "$@"
}

# step MACHINE NAME COMMAND...: runs a command and adds a row to the table.
step() {
  local machine=$1 name=$2 begin=$SECONDS result=passed
  shift 2
  local log=$folder/$machine-$name.log
  echo "machines.sh: $machine: $name" >&2
  # Not in a condition: set -e would have no effect there.
  set +e
  (set -e; "$@") > "$log" 2>&1
  local status=$?
  set -e
  if [ $status -ne 0 ]; then
    result=FAILED
    failed=$((failed + 1))
    tail -n 30 "$log" >&2
  fi
  rows+=("$(printf '%-9s %-9s %-7s %4d s   %s' "$machine" "$name" "$result" \
    $((SECONDS - begin)) "$(tail -n 1 "$log" | cut -c 1-80)")")
  return $status
}

# base MACHINE SUITE: a bare Debian with a copy of the project.
base() {
  local root=$folder/$1
  [ -e "$root/etc/debian_version" ] || debootstrap --variant=minbase "$2" "$root" ${MIRROR:+"$MIRROR"}
  mkdir -p "$root/root/gst-ellipse"
  "$project/examples/packaging/list_files.sh" | tar -C "$project" --null -T - -c | tar -C "$root/root/gst-ellipse" -x --touch
  echo "Debian $(cat "$root/etc/debian_version")"
}

packages_work() {
  rm -rf "$folder/$1-user/root/packages"
  cp -r "$folder/$1/root/packages" "$folder/$1-user/root/packages"
  inside "$1-user" examples/packaging/check.sh /root/packages
}

native() {
  step "$1" base base "$1" "$1" || return 0
  step "$1" demo inside "$1" ./examples/demo.sh || true
  step "$1" tests inside "$1" ./tests/run.sh || true
  step "$1" packages inside "$1" examples/packaging/debian.sh --out /root/packages || return 0
  step "$1-user" base base "$1-user" "$1" || return 0
  step "$1-user" install packages_work "$1" || true
}

arm64() {
  step arm64 base base arm64 bookworm || return 0
  step arm64 build inside arm64 tests/arm64.sh build || return 0
  step arm64 core inside arm64 tests/arm64.sh test core allocations fuzz || true
  step arm64 gst inside arm64 tests/arm64.sh test gst || true
  step arm64 neon inside arm64 tests/arm64.sh neon || true
  step arm64 cost inside arm64 tests/arm64.sh cost || true
}

keep=false
if [ "${1:-}" = --into ]; then
  [ -n "${2:-}" ] || usage
  mkdir -p "$2"
  folder=$(cd "$2" && pwd)
  keep=true
  shift 2
fi
for machine in "$@"; do
  case "$machine" in
    bookworm | trixie | arm64) ;;
    *) usage ;;
  esac
done
[ $# -gt 0 ] || set -- bookworm trixie arm64
for tool in debootstrap unshare; do
  command -v $tool > /dev/null || { echo "machines.sh: $tool is not installed" >&2; exit 2; }
done
[ "$(id -u)" -eq 0 ] || { echo "machines.sh: debootstrap and chroot need root" >&2; exit 2; }
[ -n "$folder" ] || folder=$(mktemp -d /var/tmp/ellipse-machines.XXXXXX)

for machine in "$@"; do
  if [ "$machine" = arm64 ]; then arm64; else native "$machine"; fi
done
$keep || [ $failed -gt 0 ] || rm -rf "$folder"
[ $failed -eq 0 ] || echo "machines.sh: the logs are in $folder"
printf '%s\n' "${rows[@]}"
echo "$((${#rows[@]} - failed)) passed, $failed failed, 0 skipped"
[ $failed -eq 0 ]
