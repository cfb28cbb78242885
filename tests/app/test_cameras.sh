#!/bin/sh
# A list of cameras as a SOURCE: two that see the same are as one, and lists that are wrong are told.
# usage: test_cameras.sh RELIEF WORK_FOLDER
set -u
relief=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
failures=0

fail()
{
    echo "FAIL: $*"
    failures=$((failures + 1))
}

# expect_error TEXT JSON: status 1 or 2, and TEXT on stderr.
expect_error()
{
    printf '%s' "$2" >wrong.json
    if "$relief" run wrong.json --headless --frames 1 --quiet >stdout.txt 2>stderr.txt; then
        fail "accepted: $2"
    fi
    grep -q -- "$1" stderr.txt || fail "no '$1' for $2: $(cat stderr.txt)"
}

expect_error 'cameras must be a list of 1 to 8' '{}'
expect_error 'cameras must be a list of 1 to 8' '{ "cameras": [] }'
expect_error 'cameras\[0\].source is missing' '{ "cameras": [ {} ] }'
expect_error 'cameras\[0\].source' '{ "cameras": [ 7 ] }'
expect_error 'cameras\[1\].pose is no key of a camera' \
    '{ "cameras": [ { "source": "synthetic:empty" }, { "source": "synthetic:empty", "pose": 1 } ] }'
expect_error 'cameras\[0\].orientation has the length 0' \
    '{ "cameras": [ { "source": "synthetic:empty", "orientation": [0, 0, 0, 0] } ] }'
expect_error 'cameras\[0\].position' '{ "cameras": [ { "source": "synthetic:empty", "position": [0, 0] } ] }'
expect_error 'nowhere' '{ "cameras": [ { "source": "synthetic:empty" }, { "source": "nowhere" } ] }'
expect_error 'is no key of a list of cameras' '{ "camera": [] }'
expect_error 'calibration.*must be alone' \
    '{ "cameras": [ { "source": "synthetic:empty", "calibration": "a.json", "position": [0, 0, 0] } ] }'
expect_error 'no.json' '{ "cameras": [ { "source": "synthetic:empty", "calibration": "no.json" } ] }'
"$relief" run none.json --headless --quiet >stdout.txt 2>stderr.txt && fail "none.json was accepted"
grep -q 'none.json' stderr.txt || fail "none.json: $(cat stderr.txt)"

# ---- two that see the same are as one ----------------------------------------------------------------
one='{ "source": "synthetic:empty?color=96x54&noise=0&frames=45" }'
shorter='{ "source": "synthetic:empty?color=96x54&noise=0&frames=30" }'
echo "{ \"cameras\": [ $one ] }" >one.json
echo "{ \"cameras\": [ $one, $one ] }" >two.json
echo "{ \"cameras\": [ $one, $shorter ] }" >ends.json
lens='"width": 512, "height": 424, "fx": 365, "fy": 365, "cx": 256, "cy": 212'
same='"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "translation": [0, 0, 0]'
echo "{ \"depth\": { $lens, \"units_per_metre\": 1000 }, \"color\": { $lens }, \"depth_to_color\": { $same } }" >pair.json
echo "{ \"cameras\": [ $one, ${one% \}}, \"calibration\": \"pair.json\" } ] }" >pairs.json
for list in one two pairs ends; do
    "$relief" run $list.json --scene stack --headless --log $list >stdout.txt 2>stderr.txt ||
        fail "$list.json: $(cat stderr.txt)"
done
grep -q 'camera 2, .*no more frames: the others go on' stderr.txt || fail "an end that is not told: $(cat stderr.txt)"
last() { awk -F, '$1 == 44 { y += $5; n++ } END { if (n) printf "%.4f", y / n }' "$1/bodies.csv"; }
for list in two pairs ends; do
    awk "BEGIN { d = $(last one) - $(last $list); exit !(d * d < 1e-6) }" ||
        fail "bodies' mean height: $(last one) by one camera, $(last $list) by $list.json"
done
echo "mean height: $(last one) by one camera, $(last two) by two, $(last ends) by one that ends"
"$relief" run two.json --headless --quiet --frames 3 --view 'camera?camera=2' --pictures 'second?every=1' ||
    fail "the second camera's picture"
[ -s second/000002.png ] || fail "no picture of the second camera: $(ls second)"
"$relief" run two.json --headless --quiet --frames 3 --view 'camera?camera=3' 2>stderr.txt && fail "a third camera of two"
grep -q 'there is no camera 3: two.json has 2' stderr.txt || fail "camera 3: $(cat stderr.txt)"
"$relief" run two.json --camera moving --headless --frames 1 --quiet 2>stderr.txt && fail "cameras of a list moved"
grep -q 'leave out --camera' stderr.txt || fail "--camera moving: $(cat stderr.txt)"

# ---- one that is unplugged for a while ----------------------------------------------------------------
first='"source": "simulated:?of=synthetic:empty"'
second='"source": "simulated:?of=synthetic:empty&unplug_after=0.5&replug_after=0.5"'
echo "{ \"cameras\": [ { $first }, { $second } ] }" >unplugged.json
"$relief" run unplugged.json --headless --frames 60 >stdout.txt 2>stderr.txt || fail "unplugged: $(cat stderr.txt)"
grep -q '^60 frames' stdout.txt || fail "the others waited: $(cat stdout.txt)"

# ---- where they stand ---------------------------------------------------------------------------------
# Two views of a camera that goes about a point 2 m ahead (relief/synthetic.h, orbit), 2 m and 57 degrees apart; the second
# one's place in the list is wrong by some centimetres.
"$relief" record 'synthetic:empty?path=orbit&color=64x36&fps=0.4545&frames=4' orbit/ --quiet || fail "orbit"
# camera FRAME SECONDS WRONG_M WRONG_RAD
camera()
{
    awk -v frame="$1" -v t="$2" -v off="$3" -v turned="$4" 'BEGIN {
        pi = atan2(0, -1); a = 0.5 * sin(2 * pi * 0.11 * t)
        printf "{ \"source\": \"orbit?start=%d&count=1\", ", frame
        printf "\"position\": [%f, %f, %f], ", -2 * sin(a) + off, 0.05 * sin(2 * pi * 0.2 * t) - off, 2 * (1 - cos(a)) + off
        printf "\"orientation\": [0, %f, 0, %f] }", sin((a + turned) / 2), cos((a + turned) / 2) }'
}
first=$(camera 1 2.20022 0 0)
echo "{ \"cameras\": [ $first, $(camera 3 6.60066 0 0) ] }" >right.json
view='"source": "synthetic:empty?color=0&frames=20'
echo "{ \"cameras\": [ { $view\" }, { $view&path=opposite\", \"position\": [0, 0, 5], \"orientation\": [0, 1, 0, 0] } ] }" >opposite.json
# place LIST: of its second camera, on one line.
place() { tr -d ' \n' <"$1" | sed 's/.*"position":\[\([^]]*\).*/\1/'; }
# apart LIST LIST: millimetres between the places of their second cameras.
apart()
{
    printf '%s,%s\n' "$(place "$1")" "$(place "$2")" |
        awk -F, '{ printf "%.1f", 1000 * sqrt(($1 - $4) ^ 2 + ($2 - $5) ^ 2 + ($3 - $6) ^ 2) }'
}
for wrong in "0.025 0.02" "0.08 0.02" "0.06 -0.06"; do
    echo "{ \"cameras\": [ $first, $(camera 3 6.60066 "${wrong% *}" "${wrong#* }") ] }" >off.json
    "$relief" calibrate --check off.json --out mended.json >stdout.txt 2>stderr.txt && fail "$wrong: poses that are off hold"
    grep -q 'camera 1  off: by [0-9]*\.[0-9] mm and [13]\.[14][0-9] degrees' stdout.txt || fail "$wrong: $(cat stdout.txt stderr.txt)"
    echo "wrong by $(apart off.json right.json) mm before, by $(apart mended.json right.json) mm after the correction"
    awk -v d="$(apart mended.json right.json)" 'BEGIN { exit !(d < 3) }' || fail "$wrong: mended to $(place mended.json)"
done
"$relief" calibrate --check mended.json >stdout.txt 2>stderr.txt || fail "mended.json: $(cat stdout.txt stderr.txt)"
grep -q 'camera 1  holds: by [0-2]\.[0-9] mm and 0\.0[0-9] degrees' stdout.txt || fail "mended: $(cat stdout.txt)"
"$relief" calibrate --check right.json >stdout.txt 2>stderr.txt || fail "right.json: $(cat stdout.txt stderr.txt)"
grep -q 'camera 1  holds: by [0-3]\.[0-9] mm and 0\.[01][0-9] degrees' stdout.txt || fail "right: $(cat stdout.txt)"
cat stdout.txt
"$relief" calibrate --check opposite.json --out kept.json >stdout.txt 2>stderr.txt || fail "opposite: $(cat stderr.txt)"
grep -q 'camera 1  cannot be told' stdout.txt || fail "cameras that see too little of the same: $(cat stdout.txt)"
grep -A3 position kept.json | tr -d ' \n' | grep -q '0.0,0.0,5.0' || fail "kept.json: $(cat kept.json)"
echo "{ \"cameras\": [ $first, $(camera 3 6.60066 0.1 0.2) ] }" >far.json
"$relief" calibrate --check far.json --out far_kept.json >stdout.txt 2>stderr.txt && fail "a pose that is far off holds"
grep -q 'camera 1  off: no pose near' stdout.txt || fail "far: $(cat stdout.txt)"
[ "$(apart far.json far_kept.json)" = 0.0 ] ||
    fail "far_kept.json: $(place far_kept.json)"
"$relief" calibrate --check one.json 2>stderr.txt && fail "one camera was checked"
grep -q 'one.json: lists one camera' stderr.txt || fail "one camera: $(cat stderr.txt)"
"$relief" calibrate --check synthetic:empty --out no.json >stdout.txt 2>stderr.txt && fail "--out of one camera"

[ "$failures" -eq 0 ] || exit 1
echo "passed"
