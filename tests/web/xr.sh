#!/bin/sh
# A test of see-through in node: xr.sh ROOT SCRIPT. Skipped where there is no node or no module: `cmake --preset wasm &&
# cmake --build --preset wasm` takes minutes, so no test does it. What else is missing a script tells itself.
set -eu
root=$1
script=$2

skip() {
    echo "web $script: SKIPPED: $1"
    exit 77
}

command -v node >/dev/null 2>&1 || skip "no node on this machine"
folder=$root/build/wasm/web/relief
[ -f "$folder/xr.js" ] || skip "build/wasm has no xr.js: cmake --preset wasm && cmake --build --preset wasm"
exec node "$root/tests/web/$script" "$folder"
