#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs at the end of `meson install`. Prints the variables that programs need to find the installed
# files; prints nothing if all folders are searched by default.
#   print_paths.sh LIBRARIES [VARIABLE INSTALLED SEARCHED]...
# LIBRARIES and INSTALLED are folders below the prefix, even if DESTDIR moves the files. SEARCHED is a
# list separated by colons.

contains() {
  case ":$1:" in *":$2:"*) true ;; *) false ;; esac
}

linker_folders() {
  cat /etc/ld.so.conf /etc/ld.so.conf.d/*.conf 2> /dev/null | grep '^/' | tr '\n' ':'
  printf '/lib:/lib64:/usr/lib:/usr/lib64'
}

lines=
add_line() {
  lines="$lines  $1
"
}
# add_variable NAME FOLDER: unless the variable contains the folder already.
add_variable() {
  eval "current=\${$1:-}"
  contains "$current" "$2" || add_line "export $1=$2\${$1:+:\$$1}"
}

libraries=$1
shift
if ! contains "$(linker_folders)" "$libraries"; then
  add_variable LD_LIBRARY_PATH "$libraries"
else
  case "$libraries" in
    /lib* | /usr/lib*) ;;  # searched even if they are not in the cache
    *) add_line "sudo ldconfig" ;;
  esac
fi
while [ $# -ge 3 ]; do
  contains "$3" "$2" || add_variable "$1" "$2"
  shift 3
done
[ -n "$lines" ] && [ -z "${MESON_INSTALL_QUIET:-}" ] || exit 0

# Meson 1.0 discards the output of install scripts, so this writes to meson's own output; not if that
# is a file, because meson would overwrite the text.
out=/dev/stdout
if [ -n "${MESON_BUILD_ROOT:-}" ] && [ -w "/proc/$PPID/fd/1" ]; then
  out=/proc/$PPID/fd/1
  [ ! -f "$out" ] || out=/proc/$PPID/fd/2
fi
printf '\nSo that programs find gst-ellipse in %s:\n%s' "${MESON_INSTALL_PREFIX:-its prefix}" \
  "$lines" >> "$out"
