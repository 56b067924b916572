#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Compares the files that meson installs with those in the Debian packages.
#   packaging.sh SOURCE BUILD VERSION
set -euo pipefail
debian=$1/examples/packaging/debian
build=$2
version=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
faults=0
fault() {
  echo "packaging.sh: $*" >&2
  faults=$((faults + 1))
}

# patterns FILE...: the listed files and folders, without comments.
patterns() {
  sed 's/#.*//' "$@" | grep -v '^ *$'
}

# Installs under /usr, as the packages do.
DESTDIR=$work/root meson install --no-rebuild --quiet -C "$build"
prefix=$(dirname "$(dirname "$(find "$work/root" -name ellipse-live -path '*/bin/*')")")
mv "$prefix" "$work/usr"
cd "$work"
if ! compgen -G 'usr/lib/*/libgstellipse-1.0.so' > /dev/null; then
  echo "packaging.sh: skipped, libraries are not where Debian keeps them"
  exit 77
fi

# Every file is in exactly one package or listed in not-installed.
for list in "$debian"/*.install; do
  for pattern in $(patterns "$list"); do
    find $pattern ! -type d > matched 2> /dev/null || true
    [ -s matched ] || fault "$(basename "$list") lists $pattern, which is not installed"
    cat matched >> packaged
  done
done
for pattern in $(patterns "$debian/not-installed"); do
  find $pattern ! -type d >> packaged 2> /dev/null || true
done
find usr ! -type d > installed
sort packaged | uniq -d > twice
sort installed | comm -23 - <(sort -u packaged) > forgotten
[ ! -s twice ] || fault "in two packages: $(cat twice)"
[ ! -s forgotten ] || fault "installed, but in no .install file nor in not-installed: $(cat forgotten)"

for program in usr/bin/*; do
  [ -s "usr/share/man/man1/$(basename "$program").1" ] || fault "$program has no manual page"
done

nm -D --defined-only usr/lib/*/libgstellipse-1.0.so | sed 's/.* //' | sort > exported
sed -n 's/^ \(.*\)@Base .*/\1/p' "$debian/libgstellipse-1.0-0.symbols" | sort > listed
diff listed exported > difference ||
  fault "libgstellipse-1.0-0.symbols (<) and the library (>) differ: $(cat difference)"

packaged_version=$(sed -n '1s/.*(\(.*\)).*/\1/p' "$debian/changelog")
[ "$packaged_version" = "$version" ] ||
  fault "meson.build has version $version, examples/packaging/debian/changelog $packaged_version"
[ "$faults" -eq 0 ]
