#!/bin/sh
# The bits do not depend on the compiler: builds the library and its short golden replays with
# another one than this build's, and runs them.
# other_compiler.sh ROOT WORK CC GENERATOR; exit status 77: there is no other compiler
set -eu

root=$1 work=$2 cc=$3 generator=$4
case $("$cc" --version) in
*clang*) other=gcc ;;
*) other=clang ;;
esac
if ! command -v "$other" >/dev/null 2>&1; then
    echo "other_compiler: no $other on this machine"
    exit 77
fi
cmake -S "$root" -B "$work" -G "$generator" --log-level=WARNING -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_C_COMPILER="$other" -DRELIEF_WITH_IO=OFF -DRELIEF_WITH_VIDEO=OFF -DRELIEF_WITH_GL=OFF \
    -DRELIEF_WITH_VIEWER=OFF -DRELIEF_BUILD_APP=OFF -DRELIEF_BUILD_BENCH=OFF
cmake --build "$work" --target test_build_hash
"$work/tests/test_build_hash"
rm -rf "$work"
