#!/bin/sh
# `relief run` with a camera that fails: what it says, that it goes on, that Ctrl-C ends it in time.
# usage: test_live.sh RELIEF WORK_FOLDER
set -u
relief=$1
work=$2
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
failures=0
played="of=synthetic:empty?color=0"

fail()
{
    echo "FAIL: $*"
    cat stdout.txt stderr.txt
    failures=$((failures + 1))
}

# await TEXT: until stderr has it.
await()
{
    for _ in $(seq 300); do
        grep -q -- "$1" stderr.txt && return
        sleep 0.1
    done
    fail "no '$1'"
}

# Ctrl-C while the driver hangs: the summary and status 130 within two seconds; a busy machine gets
# twice as long.
"$relief" run "simulated:?$played&hang=1" --headless >stdout.txt 2>stderr.txt &
run=$!
await "camera simulated:.*: no frame for 1 s: is it unplugged? trying again"
start=$(date +%s%N)
kill -INT $run
wait $run
status=$?
took=$((($(date +%s%N) - start) / 1000000))
[ $status -eq 130 ] || fail "hang: status $status"
[ $took -lt 4000 ] || fail "hang: Ctrl-C took $took ms"
grep -q "frames\{0,1\}, renderer soft" stdout.txt || fail "hang: no summary"
grep -q "latency" stdout.txt || fail "hang: no latency"
grep -q "its driver does not come back: left alone" stderr.txt || fail "hang: not told"

# Pulled out and put back: one line each, frames go on, lost ones are counted.
"$relief" run "simulated:?$played&unplug_after=1&replug_after=1&drop=5" --headless --frames 60 \
    >stdout.txt 2>stderr.txt || fail "unplugged: status $?"
[ "$(grep -c "trying again" stderr.txt)" -eq 1 ] || fail "unplugged: not told once"
[ "$(grep -c "frames are back" stderr.txt)" -eq 1 ] || fail "unplugged: not found again"
grep -q "^60 frames" stdout.txt || fail "unplugged: not 60 frames"
grep -q "^source:   [0-9]* lost" stdout.txt || fail "unplugged: lost frames are not told"

# No SOURCE and no window: wrong usage.
env -u DISPLAY -u WAYLAND_DISPLAY "$relief" run >stdout.txt 2>stderr.txt
[ $? -eq 2 ] || fail "no SOURCE: status"
grep -q "needs a SOURCE" stderr.txt || fail "no SOURCE: not told"

[ "$failures" -eq 0 ]
