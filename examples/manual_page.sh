#!/bin/sh
# SPDX-License-Identifier: MIT
# Generates the manual page of a program from its --help output.
#   manual_page.sh HELP2MAN PROGRAM VERSION
set -eu
help2man=$1
program=$2
version=$3
# The first line of the output becomes the page's NAME, which has no full stop.
purpose=$("$program" --help | sed '/./!d; s/\.$//; q')
page=$("$help2man" --no-info --section=1 --version-string="$version" --name="$purpose" "$program")
# help2man takes an option and its text for one if they are separated by a single space.
case $page in *"
.HP"*)
  echo "manual_page.sh: an option of $program has no column of its own: widen the column of --help" >&2
  exit 1
  ;;
esac
# CLI11 prints "-h,--help" without a space, so help2man does not recognise the long option.
printf '%s\n' "$page" | sed \
  -e 's/^\(\\fB\\-h\\fR\),\\-\\-help/\1, \\fB\\-\\-help\\fR/' \
  -e 's/^\.SS "\(Positionals\|POSITIONALS\):"/.SH ARGUMENTS/'
