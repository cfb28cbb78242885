#!/bin/sh
# What a v4l2loopback device is given is what a Y4M file holds: test_v4l2.sh RELIEF MOCK WORK
set -eu

relief=$1
mock=$2
work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"

"$relief" run "synthetic:empty?color=320x180" --headless --quiet --frames 5 --video room.y4m
RELIEF_MOCK_V4L2=$work/device LD_PRELOAD=$mock \
    "$relief" run "synthetic:empty?color=320x180" --headless --quiet --frames 5 --video /dev/video9
size=$((320 * 180 * 3 / 2))
[ "$(wc -c <device)" -eq $((5 * size)) ] || {
    echo "v4l2: $(wc -c <device) bytes instead of 5 pictures" >&2
    exit 1
}
# A Y4M file is one line, and before each picture "FRAME" and a newline.
header=$(head -n 1 room.y4m | wc -c)
for index in 0 1 2 3 4; do
    tail -c +$((header + 1 + index * (size + 6) + 6)) room.y4m | head -c "$size" >>pictures
done
cmp pictures device

expect() {
    if "$@" 2>stderr.txt; then
        echo "v4l2: went through: $*" >&2
        exit 1
    fi
    grep -q "v4l2loopback" stderr.txt
    [ "$(wc -l <stderr.txt)" -eq 1 ]
}
export LD_PRELOAD="$mock"
expect "$relief" run synthetic:empty --headless --frames 1 --video /dev/video8
expect "$relief" run synthetic:empty --headless --frames 1 --video /dev/video7
