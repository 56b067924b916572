#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the tests of examples/mavlink in a folder with the packages of its lock file.
#   mavlink.sh SOURCE FOLDER
set -euo pipefail
skip() {
  echo "mavlink.sh: skipped, $1"
  exit 77
}
command -v npm > /dev/null || skip "there is no npm"
mkdir -p "$2"
cp "$1"/*.js "$1"/*.json "$2"
cd "$2"
# Installed packages are not downloaded again.
if ! cmp -s package-lock.json node_modules/.lock; then
  npm ci --no-audit --no-fund --loglevel=error --fetch-retries=5 > npm.log 2>&1 || skip "npm ci failed, see $2/npm.log"
  cp package-lock.json node_modules/.lock
fi
node --test
