#!/bin/sh
# The command as Windows' users meet it, in wine: names with blanks, backslashes and other alphabets,
# exit statuses, the same bits as here. test_windows.sh RELIEF.EXE FOLDER [RELIEF of this machine]
set -eu

exe=$1
folder=$2
native=${3:-}
wine=/usr/lib/wine/wine64
[ -x $wine ] || {
    echo "SKIPPED: no wine64"
    exit 77
}
rm -rf "$folder"
mkdir -p "$folder"
# wine has file names as the locale has them, and drives and a registry of its own in WINEPREFIX.
LC_ALL=C.UTF-8
WINEDEBUG=-all
WINEPREFIX=${WINEPREFIX:-$(cd "$folder" && pwd)/wine}
export LC_ALL WINEDEBUG WINEPREFIX
exe=$(cd "$(dirname "$exe")" && pwd)/$(basename "$exe")
cd "$folder"

fail() {
    echo "FAILED: $1" >&2
    exit 1
}

relief() {
    $wine "$exe" "$@"
}

# expect STATUS TEXT COMMAND...: its exit status, and what it says on either stream.
expect() {
    wanted=$1
    text=$2
    shift 2
    status=0
    "$@" >said 2>&1 || status=$?
    [ $status -eq "$wanted" ] || {
        cat said >&2
        fail "$*: exit status $status, not $wanted"
    }
    grep -q -- "$text" said || {
        cat said >&2
        fail "$*: does not say '$text'"
    }
}

expect 0 'usage: relief' relief --help
expect 0 'relief 0' relief --version
expect 2 "there is no command 'runn'" relief runn
expect 1 'nothing here' relief info 'nothing here\at all'
if grep -q "$(printf '\r')" said; then fail "lines end in carriage returns"; fi

# The picture of the room, its physics and its logs.
expect 0 '' relief run synthetic:room --headless --frames 100 --threads 2 --log 'my logs\Zoë 雪'
[ "$(wc -l <'my logs/Zoë 雪/frames.csv')" -eq 101 ] || fail "frames.csv has not 100 frames"
expect 0 '' relief run synthetic:room --scene rain --headless --frames 3

# A folder of pictures, written and read again.
expect 0 '' relief record synthetic:room 'a clip\of mine/' --frames 4
[ -f 'a clip/of mine/camera.json' ] || fail "no clip in 'a clip/of mine'"
expect 0 '' relief info 'a clip\of mine'
expect 0 '' relief run 'a clip\of mine' --headless --log 'logs of the clip'
expect 2 'cannot be written while it is read' relief record 'a clip\of mine' 'a clip\of mine/'

# Arrays; a file that is there is replaced.
for i in 1 2; do
    expect 0 '' relief export synthetic:room --out 'arrays\日本' --what depth,normals --frames 0:2
    [ -f 'arrays/日本/depth/000001.npy' ] || fail "round $i: no arrays"
done
expect 0 '' relief-lab-sections eval physics --profile live

# The same numbers as here: of 100 frames of physics, and of the planes.
if [ -n "$native" ]; then
    "$native" run synthetic:room --headless --frames 100 --log native >/dev/null 2>&1
    "$native" export synthetic:room --out native --what depth,normals --frames 0:2 >/dev/null 2>&1
    cmp native/bodies.csv 'my logs/Zoë 雪/bodies.csv' || fail "other bodies than on this machine"
    cmp native/contacts.csv 'my logs/Zoë 雪/contacts.csv' || fail "other contacts"
    for array in depth/000001 normals/000001; do
        cmp "native/$array.npy" "arrays/日本/$array.npy" || fail "other $array"
    done
fi
echo "relief.exe: passed"
