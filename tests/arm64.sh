#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Cross-builds the project for arm64 on x86-64 Debian and runs it under qemu-user. tests/machines.sh
# runs this script in a chroot, because the arm64 libraries replace some of the host's packages.
#   tests/arm64.sh build          installs the dependencies and builds into build-arm64
#   tests/arm64.sh test SUITE...  runs meson test suites
#   tests/arm64.sh neon           fails if a hot loop has no NEON instruction
#   tests/arm64.sh cost           prints the instruction count per frame
set -euo pipefail
project=$(cd "$(dirname "$0")/.." && pwd)
folder=$project/build-arm64
qemu=qemu-aarch64-static

install_packages() {
  dpkg --add-architecture arm64
  apt-get update -q
  DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends \
    crossbuild-essential-arm64 meson ninja-build pkg-config dpkg-dev qemu-user-static libeigen3-dev \
    libgstreamer1.0-dev:arm64 libgstreamer-plugins-base1.0-dev:arm64 libopencv-dev:arm64 \
    libgtest-dev:arm64 libjson-glib-dev:arm64 \
    gstreamer1.0-{tools,plugins-base,plugins-good,plugins-bad}:arm64
}

build() {
  install_packages
  mkdir -p "$folder"
  meson env2mfile --cross --debarch arm64 -o "$folder/arm64.ini"
  printf "[binaries]\nexe_wrapper = '%s'\n" "$qemu" > "$folder/qemu.ini"
  [ -e "$folder/build.ninja" ] ||
    meson setup "$folder" "$project" --cross-file "$folder/arm64.ini" --cross-file "$folder/qemu.ini" \
      -Dexamples=disabled -Dintrospection=disabled -Ddocs=disabled
  ninja -C "$folder"
}

# Vectorised loops, by the function that the compiler inlines them into.
hot_loops=(
  'filter_columns(' 'filter_rows(' 'mark_maxima(' 'Scaler::reduce(' 'distort_baseline('
  'add_line_'  # two versions, one of which may jump to the other
)

neon() {
  local library count status=0
  library=$(find "$folder/core" -maxdepth 1 -type f -name 'libellipse-1.0.so.*.*.*')
  aarch64-linux-gnu-objdump --demangle --disassemble --no-show-raw-insn "$library" > "$folder/code"
  for loop in "${hot_loops[@]}"; do
    count=$(awk -v name="$loop" '
      /^[0-9a-f]+ </ { inside = index($0, name) }
      inside && /v[0-9]+\.(16b|8h|4s|8b|4h)/ { ++count }
      END { print count + 0 }' "$folder/code")
    echo "${loop%[(_]}: $count NEON instructions"
    [ "$count" -ge 20 ] || status=1
  done
  return $status
}

# Cost per frame in millions of instructions: 40 frames minus the start.
cost_of() {
  local counts=()
  for frames in 0 40; do
    # The log has one line per instruction.
    counts+=("$($qemu -singlestep -d exec,nochain -D /dev/stdout "$folder/tests/frame-cost" \
      "$1" "$2" "$3" $frames | wc -l)")
  done
  awk -v zero="${counts[0]}" -v all="${counts[1]}" 'BEGIN { printf "%.2f", (all - zero) / 40e6 }'
}

cost() {
  echo "millions of instructions a frame on arm64, 640x360: tracking=none $(cost_of none 640 360)," \
    "tracking=edges $(cost_of edges 640 360)"
}

case "${1:-}" in
  build) build ;;
  test)
    shift
    rm -f "$folder"/*.xml
    meson test -C "$folder" --no-rebuild --print-errorlogs --timeout-multiplier 20 \
      --num-processes 2 "$@"
    awk -F '"' '/^<testsuites / { tests += $2 } END { print tests " tests passed" }' "$folder"/*.xml
    ;;
  neon) neon ;;
  cost) cost ;;
  *)
    sed -n 's/^#   //p' "$0" >&2
    exit 2
    ;;
esac
