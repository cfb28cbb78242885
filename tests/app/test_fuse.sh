#!/bin/sh
# `relief fuse`, and `relief run` with a map, as a user meets them: nothing is made of nothing.
# usage: test_fuse.sh RELIEF WORK_FOLDER
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
expect 0 '' fuse clip --out room.ply --voxel 12 --save room.map --picture room.png
grep -q '4 of 4 frames fused' stdout.txt || fail "frames: $(cat stdout.txt)"
grep -q 'source .*surface .*tracking .*map ' stdout.txt || fail "times: $(cat stdout.txt)"
grep -q ' [1-9][0-9]* triangles' stdout.txt || fail "an empty mesh: $(cat stdout.txt)"
expect 0 '' fuse clip --out one.obj --voxel 12 --frames 1
grep -q '1 of 1 frame fused' stdout.txt || fail "frames: $(cat stdout.txt)"
expect 1 '--min-weight 255: with [0-9][0-9]* or less' fuse clip --out none.glb --voxel 12 \
    --min-weight 255
expect_nothing none.glb
most=$(sed -n 's/.*with \([0-9]*\) or less.*/\1/p' stderr.txt)
expect 0 '' fuse clip --out most.ply --voxel 12 --min-weight "$most"
expect 1 'with [0-9][0-9]* or less' fuse clip --out none.ply --voxel 12 --min-weight $((most + 1))

# ---- nothing within the range ------------------------------------------------------------------------
mkdir near
cp -r clip/depth clip/depth.txt near/
for range in '0.01 0.02' '20.0 30.0'; do
    sed -e "s/\"depth_min_m\": *[0-9.]*/\"depth_min_m\": ${range% *}/" \
        -e "s/\"depth_max_m\": *[0-9.]*/\"depth_max_m\": ${range#* }/" clip/camera.json >near/camera.json
    grep -q "${range#* }" near/camera.json || fail "the range is not in camera.json"
    for option in --out=none.ply --save=none.map --picture=none.png; do
        expect 1 'no depth from .* m in 4 frames: .* % .*units_per_metre' fuse near "$option"
        expect_nothing "${option#*=}"
    done
done

# ---- poses of the source -----------------------------------------------------------------------------
expect 1 'none of 4 frames has a pose' fuse clip --poses source --out none.ply
expect_nothing none.ply
cp -r clip far
grep -v '^#' clip/depth.txt | awk '{ print $1, (NR - 1) * 1e5, 0, 0, 0, 0, 0, 1 }' >far/groundtruth.txt
for command in 'fuse far --out far.ply --voxel 12' 'run far --camera moving --headless --quiet --log far_log'; do
    # shellcheck disable=SC2086 # words
    expect 0 'frame 1: position 100000, 0, 0 m.* too far .*left out' $command --poses source
    [ "$(grep -c 'left out' stderr.txt)" -eq 1 ] || fail "$command: told more than once"
done

# ---- a map larger than what is usual ------------------------------------------------------------------
printf 'RLFMAP\r\n\002\000\000\000\372\176\152\274\164\223\170\077\100\102\017\000\000\000\000\000' >large.map
truncate -s 2200000000 large.map 2>/dev/null || dd if=/dev/zero of=large.map bs=1 count=1 seek=2200000000 \
    conv=notrunc 2>/dev/null
expect 1 'large.map: map: ' run clip --map large.map --frames 1 --headless --quiet
! grep -q 'memory' stderr.txt || fail "advice that a user cannot follow: $(cat stderr.txt)"
rm -f large.map

[ "$failures" -eq 0 ] || exit 1
echo "passed"
