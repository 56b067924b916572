#!/bin/sh
# SPDX-License-Identifier: MIT
# run.sh FOLDER: tests the page in chromium. FOLDER receives npm's packages and the tests' files.
# Skips the tests if there is no browser or playwright-core cannot be installed.
skip() {
  echo "skipped: $1"
  exit 77
}
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1" && cd "$1" || exit 1
for tool in node npm setpriv gst-launch-1.0; do
  command -v $tool > /dev/null || skip "there is no $tool"
done
CHROMIUM=$(command -v chromium) || skip "there is no chromium"
if ! cmp -s "$here/package-lock.json" node_modules/.lock; then
  cp "$here/package.json" "$here/package-lock.json" .
  npm ci --no-audit --no-fund --fetch-retries=5 > npm.log 2>&1 || skip "npm ci failed, see $1/npm.log"
  cp package-lock.json node_modules/.lock
fi
# node searches for packages beside and above the importing file.
cp "$here"/*.mjs .
ELLIPSE_TEST_VIDEO=$PWD/approach.mkv
gst-launch-1.0 -q ellipsetestsrc scene=approach num-buffers=60 ! videoconvert ! jpegenc \
  ! matroskamux ! filesink location="$ELLIPSE_TEST_VIDEO" || exit 1
export CHROMIUM ELLIPSE_TEST_VIDEO
# One process, which ends with its parent; its browser and programs end with it.
exec setpriv --pdeathsig KILL node --test-reporter=spec page.test.mjs
