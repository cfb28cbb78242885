#!/bin/sh
# The WebAssembly module in node: core.sh ROOT RELIEF. Skipped where it is not built or there is no
# node: `cmake --preset wasm && cmake --build --preset wasm` takes minutes, so no test does it.
set -eu
root=$1
relief=$2

skip() {
    echo "web core: SKIPPED: $1"
    exit 77
}

command -v node >/dev/null 2>&1 || skip "no node on this machine"
folder=$root/build/wasm/web/relief
[ -f "$folder/relief.wasm" ] || skip "build/wasm has no relief.wasm: cmake --preset wasm && cmake --build --preset wasm"
exec node "$root/tests/web/core.mjs" "$folder" "$relief"
