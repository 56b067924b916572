#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Lists the files of this tree, each terminated by a null byte: those tracked by git, or without git
# all except the output of builds and programs.
set -euo pipefail
cd "$(dirname "$0")/../.."
if [ "$(git rev-parse --show-toplevel 2> /dev/null)" = "$PWD" ]; then
  git ls-files -z
else
  find . \( -path './build*' -o -path ./out -o -name .git -o -name node_modules -o -name __pycache__ \) \
    -prune -o \( -type f -o -type l \) -print0
fi
