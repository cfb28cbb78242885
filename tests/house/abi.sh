#!/bin/sh
# Compares what a shared library shows with the list that Debian's packages are made with:
# abi.sh NM LIBRARY.so LIST. A name too many or too few fails, with the line to change.
set -eu

nm=$1
library=$2
list=$3
name=$(basename "$library")
version=$(sed -n 's/^lib[^ ]* [^ ]* #MINVER#$/&/p' "$list")
[ -n "$version" ] || {
    echo "abi: $list has no line 'lib... PACKAGE #MINVER#'" >&2
    exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
LC_ALL=C
export LC_ALL
"$nm" -D -P -g --defined-only "$library" | awk '{ print $1 }' | sort -u >"$work/shown"
sed -n 's/^ \([^@ ]*\)@Base .*/\1/p' "$list" | sort -u >"$work/listed"

soname=$(readelf -d "$library" | sed -n 's/.*SONAME.*\[\(.*\)\].*/\1/p')
failed=0
if [ "${version%% *}" != "$soname" ]; then
    echo "abi: $name is $soname, but the first line of $list says ${version%% *}:" \
        "rename the package and its files in debian/" >&2
    failed=1
fi
for symbol in $(comm -23 "$work/shown" "$work/listed"); do
    echo "abi: $name shows $symbol, which $list lacks: add the line" >&2
    echo " $symbol@Base NEXT_VERSION" >&2
    failed=1
done
for symbol in $(comm -13 "$work/shown" "$work/listed"); do
    echo "abi: $name no longer shows $symbol: programs that use it stop working." >&2
    echo "abi: bring it back, or raise the soname (docs/library.md) and take its line out of $list" >&2
    failed=1
done
[ $failed -eq 0 ] || exit 1
echo "abi: $name: $(wc -l <"$work/shown") names, as listed"
