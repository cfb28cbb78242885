#!/bin/sh
# The core needs a C compiler and nothing else, and its bits do not depend on which: builds it without
# pkg-config and with every option off by another compiler than this build's (by the same one where
# there is no other), and runs an example and the short golden replays.
# other_compiler.sh ROOT WORK CC GENERATOR
set -eu

root=$1 work=$2 cc=$3 generator=$4
case $("$cc" --version) in
*clang*) other=gcc ;;
*) other=clang ;;
esac
if ! command -v "$other" >/dev/null 2>&1; then
    echo "other_compiler: no $other on this machine: only the build without anything else is tested"
    other=$cc
fi
cmake -S "$root" -B "$work" -G "$generator" --log-level=WARNING -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_C_COMPILER="$other" -DPKG_CONFIG_EXECUTABLE=PKG_CONFIG_EXECUTABLE-NOTFOUND \
    -DRELIEF_WITH_IO=OFF -DRELIEF_WITH_VIDEO=OFF -DRELIEF_WITH_GL=OFF -DRELIEF_WITH_VIEWER=OFF \
    -DRELIEF_BUILD_APP=OFF -DRELIEF_BUILD_BENCH=OFF -DRELIEF_BUILD_TESTS=OFF
cmake --build "$work"
"$work/examples/hello_bounce"
"$other" -std=c17 -O1 -I"$root/include" -I"$root/src" -I"$root/tests/support" \
    "$root/tests/golden/test_build_hash.c" "$work/src/librelief.a" -lcmocka -lm -pthread -o "$work/build_hash"
"$work/build_hash"
rm -rf "$work"
