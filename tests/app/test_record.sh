#!/bin/sh
# `relief record` and `relief run --record` as a user meets them: test_record.sh RELIEF WORK_FOLDER.
set -eu

relief=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work"

fail() {
    echo "FAILED: $1" >&2
    exit 1
}

# expect STATUS WORDS COMMAND...: exit status, and words somewhere in what it prints.
expect() {
    wanted=$1
    words=$2
    shift 2
    status=0
    "$@" >out.txt 2>&1 || status=$?
    [ "$status" = "$wanted" ] || fail "exit status $status, not $wanted: $* : $(cat out.txt)"
    grep -q -- "$words" out.txt || fail "no \"$words\" in: $(cat out.txt)"
}

# One line of error and no more.
expect_one_line() {
    [ "$(wc -l <out.txt)" = 1 ] || fail "more than one line: $(cat out.txt)"
}

expect 0 'usage: relief record' "$relief" record --help
expect 2 'needs a SOURCE' "$relief" record synthetic:room
expect 2 'use rvl or png' "$relief" record synthetic:room a.mcap --codec nothing
expect 1 'cannot be created' "$relief" record synthetic:room no/such/a.mcap
expect_one_line

# Playing a recording is what was recorded: the same surface, and so the same physics.
direct=$("$relief" run synthetic:room --headless --frames 12 --hash --quiet \
    --record 'run.mcap?bodies&lossless=color')
expect 0 '8 frames' "$relief" record synthetic:room all.mcap --frames 8 --lossless color
again=$("$relief" run run.mcap --headless --hash --quiet)
[ "$direct" = "$again" ] || fail "$again is not $direct"
for source in 'synthetic:random?seed=7&color=96x54' 'synthetic:room?path=orbit&color=96x54'; do
    direct=$("$relief" run "$source" --headless --frames 4 --hash --quiet)
    "$relief" record "$source" rooms.mcap --frames 4 --lossless color --quiet
    "$relief" record rooms.mcap rooms/ --quiet
    for copy in rooms.mcap rooms; do
        again=$("$relief" run $copy --headless --hash --quiet)
        [ "$direct" = "$again" ] || fail "$source as $copy: $again is not $direct"
    done
done

# What is read is never written to, whatever it is called.
cp all.mcap same.mcap
ln -s all.mcap link.mcap
ln all.mcap hard.mcap
"$relief" record all.mcap clip/ --frames 3 --quiet
cp -r clip same_clip
ln -s clip way
for source in all.mcap mcap:all.mcap 'mcap:all.mcap?start=1' ./all.mcap hard.mcap 'simulated:?of=all.mcap'; do
    expect 2 'give another name' "$relief" record "$source" all.mcap
    expect 2 'give another name' "$relief" record "$source" link.mcap
done
run_one="run --headless --frames 1 --quiet"
# shellcheck disable=SC2086 # words
{
    expect 1 'give another name' "$relief" $run_one link.mcap --record hard.mcap
    expect 1 'give another name' "$relief" $run_one clip --record clip/
    expect 1 'give another name' "$relief" $run_one way --record clip
    expect 1 'give another name' "$relief" $run_one clip --record clip/depth/
    expect 1 'give another name' "$relief" $run_one clip --log way
    expect 1 'give another name' "$relief" $run_one clip --pictures clip/rgb
}
expect 1 'give another name' "$relief" export clip --out clip --what depth
cp all.mcap room.ply
expect 1 'give another name' "$relief" run mcap:room.ply --headless --mesh room.ply
expect 1 'give another name' "$relief" info clip --json clip/camera.json
cmp all.mcap same.mcap || fail "a file that was read has changed"
diff -r clip same_clip || fail "a folder that was read has changed"

# A name says what is in the file.
for name in a.mp4 a.bag a.mcap.txt a; do
    expect 2 'end the name in .mcap' "$relief" record synthetic:room $name
    expect 2 'end the name in .mcap' "$relief" run synthetic:room --headless --record $name
    [ ! -e $name ] || fail "$name was made"
done

# Seconds, and a folder and back.
expect 0 '31 frames' "$relief" record synthetic:room second.mcap --seconds 1
expect 0 '8 frames' "$relief" record all.mcap folder/
[ -f folder/camera.json ] && [ -f folder/depth/000007.png ] && [ -f folder/rgb/000007.png ] ||
    fail "the folder is not whole"
expect 0 '8 frames' "$relief" record folder back.mcap --lossless color --compression lz4
"$relief" run all.mcap --headless --hash --quiet >one.txt
"$relief" run back.mcap --headless --hash --quiet >two.txt
cmp one.txt two.txt || fail "a clip changed on its way through a folder"

# A disk that is full, for which a limit on the size of files stands.
status=0
(ulimit -f 2000 && exec "$relief" record 'synthetic:room?frames=-1' full.mcap --quiet) \
    >out.txt 2>&1 || status=$?
[ "$status" = 1 ] || fail "a full disk gives exit status $status: $(cat out.txt)"
expect_one_line
grep -q 'free some space' out.txt || fail "a full disk says: $(cat out.txt)"
expect 0 'frame' "$relief" record full.mcap again.mcap
grep -q warning out.txt && fail "the file of a full disk was not closed: $(cat out.txt)"

# `timeout` sends its signal to the command and once more to its group: that is one signal.
for after in 0.9 1.2 1.5 1.8; do
    status=0
    timeout $after "$relief" record 'synthetic:empty?frames=-1&color=0' timeout.mcap --quiet 2>out.txt || status=$?
    [ "$status" = 124 ] || fail "timeout $after: exit status $status"
    grep -q "before the first frame" out.txt && continue # a busy machine
    "$relief" info timeout.mcap --frames 1 >out.txt 2>&1 || fail "timeout $after: $(cat out.txt)"
    grep -q warning out.txt && fail "timeout $after: not closed: $(cat out.txt)"
done

# A camera that hangs keeps nobody, also when every frame of it counts.
"$relief" record 'simulated:?direct=1&hang=2&of=synthetic:empty?color=0' hang.mcap --quiet 2>out.txt &
child=$!
sleep 3
start=$(date +%s%N)
kill -s INT "$child"
wait "$child" || true
took=$((($(date +%s%N) - start) / 1000000))
[ $took -lt 4000 ] || fail "a camera that hangs: Ctrl-C took $took ms" # twice as long as it should

# Ctrl-C closes the file; kill -9 leaves one that is repaired by reading.
for signal in INT KILL; do
    "$relief" record 'synthetic:room?frames=-1' "$signal.mcap" --quiet &
    child=$!
    while ! [ -s "$signal.mcap" ]; do sleep 0.1; done
    sleep 1
    kill -s "$signal" "$child"
    status=0
    wait "$child" 2>/dev/null || status=$?
    [ "$signal" = KILL ] || [ "$status" = 0 ] || fail "Ctrl-C gives exit status $status"
    expect 0 'frame' "$relief" record "$signal.mcap" again.mcap
    warnings=$(grep -c warning out.txt || true)
    [ "$signal" = INT ] && [ "$warnings" = 0 ] || [ "$signal" = KILL ] && [ "$warnings" -le 1 ] ||
        fail "$signal: $(cat out.txt)"
done
echo "recordings are as they should be"
