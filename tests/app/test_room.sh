#!/bin/sh
# `relief run` with --mesh, --save-map and --map as a user meets it: nothing is made of nothing.
# usage: test_room.sh RELIEF WORK_FOLDER
set -u
relief=$1
work=$2
desk=$(cd "$(dirname "$0")/../../clips/desk" && pwd)
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
failures=0

fail()
{
    echo "FAIL: $*"
    failures=$((failures + 1))
}

# expect STATUS TEXT ARGUMENTS...: the status, and TEXT on stderr.
expect()
{
    status=$1
    text=$2
    shift 2
    "$relief" "$@" >stdout.txt 2>stderr.txt
    got=$?
    [ "$got" -eq "$status" ] || fail "relief $*: exit status $got, not $status: $(cat stderr.txt)"
    [ -z "$text" ] || grep -q -- "$text" stderr.txt || fail "relief $*: no '$text' in: $(cat stderr.txt)"
    ! grep -qE 'rlf_|memory_mb|fence' stdout.txt stderr.txt ||
        fail "relief $*: words that only programs use: $(cat stderr.txt)"
}

# No file is left of a fusion that came to nothing.
expect_nothing()
{
    [ ! -e "$1" ] || fail "$1 was left"
    rm -f "$1"
}

"$relief" record 'synthetic:empty?color=0' clip/ --frames 4 >stdout.txt 2>stderr.txt ||
    fail "record: $(cat stderr.txt)"

# ---- a short clip has a mesh, unless it is asked for too much -----------------------------------------
expect 0 '' run clip --headless --mesh 'room.ply?voxel=12' --save-map room.map --log way \
    --view map --pictures 'pictures?at=last'
grep -q 'room: *4 of 4 frames, .* of 12 mm voxels' stdout.txt || fail "frames: $(cat stdout.txt)"
grep -q ' [1-9][0-9]* triangles' stdout.txt || fail "an empty mesh: $(cat stdout.txt)"
[ -s room.ply ] && [ -s room.map ] && [ -s pictures/000003.png ] || fail "files: $(ls . pictures)"
[ "$(grep -vc '^#' way/trajectory.txt)" -eq 4 ] || fail "trajectory: $(cat way/trajectory.txt)"
expect 0 '' run clip --headless --mesh 'one.obj?voxel=12' --frames 1
grep -q 'room: *1 of 1 frame,' stdout.txt || fail "frames: $(cat stdout.txt)"
expect 1 'weight=255: with [0-9][0-9]* or less' run clip --headless --mesh 'none.glb?voxel=12&weight=255'
expect_nothing none.glb
most=$(sed -n 's/.*with \([0-9]*\) or less.*/\1/p' stderr.txt)
expect 0 '' run clip --headless --mesh "most.ply?voxel=12&weight=$most"
expect 1 'with [0-9][0-9]* or less' run clip --headless --mesh "none.ply?voxel=12&weight=$((most + 1))"

# ---- nothing within the range ------------------------------------------------------------------------
mkdir near
cp -r clip/depth clip/depth.txt near/
for range in '0.01 0.02' '20.0 30.0'; do
    sed -e "s/\"depth_min_m\": *[0-9.]*/\"depth_min_m\": ${range% *}/" \
        -e "s/\"depth_max_m\": *[0-9.]*/\"depth_max_m\": ${range#* }/" clip/camera.json >near/camera.json
    grep -q "${range#* }" near/camera.json || fail "the range is not in camera.json"
    for option in --mesh=none.ply --save-map=none.map; do
        expect 1 'no depth from .* m in 4 frames: .* % .*units_per_metre' run near --headless "$option"
        expect_nothing "${option#*=}"
    done
done

# ---- poses of the source -----------------------------------------------------------------------------
expect 1 'none of 4 frames has a pose' run clip --headless --camera source --mesh none.ply
expect_nothing none.ply
cp -r clip far
grep -v '^#' clip/depth.txt | awk '{ print $1, (NR - 1) * 1e5, 0, 0, 0, 0, 0, 1 }' >far/groundtruth.txt
for option in --mesh=far.ply?voxel=12 --log=far_log; do
    expect 0 'frame 1: position 100000, 0, 0 m.* too far .*left out' run far --camera source --headless \
        --quiet "$option"
    [ "$(grep -c 'left out' stderr.txt)" -eq 1 ] || fail "$option: told more than once"
done

# ---- a map larger than what is usual ------------------------------------------------------------------
printf 'RLFMAP\r\n\002\000\000\000\372\176\152\274\164\223\170\077\100\102\017\000\000\000\000\000' >large.map
truncate -s 2200000000 large.map 2>/dev/null || dd if=/dev/zero of=large.map bs=1 count=1 seek=2200000000 \
    conv=notrunc 2>/dev/null
expect 1 'large.map: map: ' run clip --map large.map --frames 1 --headless --quiet
! grep -q 'memory' stderr.txt || fail "advice that a user cannot follow: $(cat stderr.txt)"
rm -f large.map

# ---- a real room -------------------------------------------------------------------------------------
# A real camera that moves: it is tracked, and what lies on the desk stays there while it looks away.
"$relief" run "$desk" --scene desk_crates --headless --log desk >stdout.txt 2>stderr.txt || fail "clips/desk: $(cat stderr.txt)"
grep -q 'tracked in 119 frames, lost in 0' stdout.txt || fail "clips/desk: $(grep camera: stdout.txt)"
for body in crate drum; do
    moved=$(awk -F, -v body=$body '$3 == body && $1 == 30 { x = $4; y = $5; z = $6 }
        $3 == body && $1 == 119 { print 1000 * sqrt(($4 - x) ^ 2 + ($5 - y) ^ 2 + ($6 - z) ^ 2) }' desk/bodies.csv)
    awk "BEGIN { exit !(\"$moved\" != \"\" && $moved + 0 < 20) }" || fail "clips/desk: $body moved by '$moved' mm"
    echo "clips/desk: $body moved by $moved mm while the camera turned"
done

[ "$failures" -eq 0 ] || exit 1
echo "passed"
