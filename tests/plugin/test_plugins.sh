#!/bin/sh
# The relief command with plug-ins: test_plugins.sh RELIEF GOOD_PLUGIN BAD_FOLDER WORK_FOLDER
set -u
relief=$1
good=$2
bad=$3
work=$4
rm -rf "$work"
mkdir -p "$work/found"
cd "$work" || exit 1
failures=0
# What OpenNI2's drivers leave behind when they are asked for devices is not Relief's to free.
export ASAN_OPTIONS=detect_leaks=0

fail()
{
    echo "FAIL: $*"
    failures=$((failures + 1))
}

# A plug-in by name.
"$relief" run plugin_camera: --plugin "$good" --headless --frames 5 >out.txt 2>err.txt ||
    fail "run --plugin: $(cat err.txt)"
grep -q "^5 frames" out.txt || fail "run --plugin: $(cat out.txt)"
"$relief" info 'plugin_camera:?fps=60' --plugin "$good" --seconds 1 >out.txt 2>err.txt ||
    fail "info --plugin: $(cat err.txt)"
grep -q "example of a plug-in" out.txt || fail "info: no device: $(cat out.txt)"
"$relief" run 'plugin_camera:?fsp=60' --plugin "$good" --headless --frames 1 2>err.txt &&
    fail "an unknown key is taken"
grep -q '"fps" may be meant' err.txt || fail "unknown key: $(cat err.txt)"

"$relief" record plugin_camera: clip/ --plugin "$good" --frames 3 --quiet 2>err.txt ||
    fail "record --plugin: $(cat err.txt)"
"$relief" export 'clip?start=1&count=1' --plugin "$good" --out arrays --what depth >out.txt 2>err.txt ||
    fail "export --plugin: $(cat err.txt)"
grep -q "^1 frame " out.txt || fail "export of a part: $(cat out.txt)"

# Without it there is no such source.
"$relief" info plugin_camera: 2>err.txt && fail "opened without the plug-in"
grep -q 'no kind of source "plugin_camera:"' err.txt || fail "$(cat err.txt)"

# What a plug-in folder holds is listed; one that cannot be used is one warning.
cp "$good" "$bad/unavailable.so" found/
echo "this is text" >found/garbage.so
RELIEF_PLUGIN_PATH=/no/such/folder:$work/found "$relief" list sources >out.txt 2>err.txt ||
    fail "sources: $(cat err.txt)"
[ "$(wc -l <err.txt)" -eq 1 ] || fail "sources: not one warning: $(cat err.txt)"
grep -q "garbage.so: cannot be loaded" err.txt || fail "sources: $(cat err.txt)"
grep -q "plugin_camera:  a ball before a wall" out.txt || fail "sources: no device: $(cat out.txt)"
grep -q "plug-in .*/plugin_camera.so" out.txt || fail "sources: no plug-in: $(cat out.txt)"
grep -q "NOT HERE: libnosuch.so is not installed" out.txt ||
    fail "sources: no reason: $(cat out.txt)"
RELIEF_PLUGIN_PATH=$work/found "$relief" info nosuch: >out.txt 2>err.txt && fail "opened nosuch:"
grep -q "apt install nosuch" err.txt || fail "nosuch: $(cat err.txt)"

# A bad one by name is an error: it was asked for.
"$relief" info synthetic:room --plugin /no/such.so >out.txt 2>err.txt && fail "info with no plug-in"
[ "$(wc -l <err.txt)" -eq 1 ] && grep -q "such.so: cannot be loaded" err.txt || fail "$(cat err.txt)"
"$relief" info synthetic:room --plugin "$bad/version.so" >out.txt 2>err.txt &&
    fail "info with a bad plug-in goes on"
grep -q "version.so: the plug-in is made for version 999" err.txt || fail "$(cat err.txt)"

[ "$failures" -eq 0 ] && echo "plug-ins: all as told"
exit "$failures"
