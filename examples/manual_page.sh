#!/bin/sh
# SPDX-License-Identifier: MIT
# Writes the manual page of a program, from what it prints for --help.
#   manual_page.sh HELP2MAN PROGRAM VERSION
set -eu
help2man=$1
program=$2
version=$3
# The first line says what the program does; a page's NAME has no full stop.
purpose=$("$program" --help | sed '/./!d; s/\.$//; q')
page=$("$help2man" --no-info --section=1 --version-string="$version" --name="$purpose" "$program")
# CLI11 writes "-h,--help" without a space, so help2man does not see the long option.
printf '%s\n' "$page" | sed \
  -e 's/^\(\\fB\\-h\\fR\),\\-\\-help/\1, \\fB\\-\\-help\\fR/' \
  -e 's/^\.SS "\(Positionals\|POSITIONALS\):"/.SH ARGUMENTS/'
