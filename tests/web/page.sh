#!/bin/sh
# The page in headless Chromium: page.sh ROOT RELIEF. Skipped where something of it is missing.
set -eu
root=$1
relief=$2

command -v node >/dev/null 2>&1 || {
    echo "web page: SKIPPED: no node on this machine"
    exit 77
}
exec node "$root/tests/web/page.mjs" "$root/build/wasm/web" "$relief" "$root"
