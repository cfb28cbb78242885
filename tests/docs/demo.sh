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
rm -rf "$work"
