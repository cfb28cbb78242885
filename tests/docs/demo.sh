#!/bin/sh
# script/demo without a display, called from elsewhere, writes what it says: tests/docs/demo.sh ROOT
# WORK
set -eu

root=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"
env -u DISPLAY -u WAYLAND_DISPLAY RELIEF_DEMO_OUT="$work/out" "$root/script/demo"
for file in demo.mp4 log/frames.csv log/bodies.csv log/contacts.csv; do
    if [ ! -s "$work/out/$file" ]; then
        echo "demo: out/$file is missing or empty" >&2
        exit 1
    fi
done
ls "$work"/out/pictures/*.png >/dev/null

# On the real table all four bodies lie or roll: none has fallen through it.
env -u DISPLAY -u WAYLAND_DISPLAY RELIEF_DEMO_OUT="$work/real" "$root/script/demo" real --frames 165
awk -F, '$1 == 164 && $5 < 0.3 && $11 ^ 2 + $12 ^ 2 + $13 ^ 2 < 0.25 { count++ }
    END { if (count != 4) { print "demo real: " count + 0 " of 4 bodies are on the table"; exit 1 } }' \
    "$work/real/log/bodies.csv" >&2
rm -rf "$work"
