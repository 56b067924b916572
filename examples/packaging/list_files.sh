#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Names the files of this tree, each ended by a 0 byte: those that git tracks; without git all but what
# builds and programs leave.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ "$(git rev-parse --show-toplevel 2> /dev/null)" = "$PWD" ]; then
  git ls-files -z
else
  find . \( -path './build*' -o -path ./out -o -name .git -o -name node_modules -o -name __pycache__ \) \
    -prune -o \( -type f -o -type l \) -print0
fi
