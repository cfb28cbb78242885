#!/bin/sh
# `relief run --publish` as other programs meet it: test_publish.sh RELIEF ROOT WORK_FOLDER. What
# needs a program that is not installed is left out, and told by exit status 77.
set -eu

relief=$1
root=$2
work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work"
skipped=

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

run="run synthetic:room?frames=1000000 --headless"
# shellcheck disable=SC2086 # words
{
    expect 2 'give ws:PORT' "$relief" $run --publish tcp:80
    expect 2 'has no .evrey.' "$relief" $run --publish 'ws:0?evrey=2'
    expect 2 'of osc alone' "$relief" $run --publish 'ws:0?listen=1'
}
"$relief" --version >version.txt

# start OPTIONS...: a run in the background; its lines are in told.txt.
start() {
    : >told.txt
    # shellcheck disable=SC2086 # words
    "$relief" $run --hash "$@" >run.txt 2>told.txt &
    pid=$!
    tries=0
    until grep -q events told.txt; do
        kill -0 "$pid" 2>/dev/null || fail "the run ended: $(cat told.txt)"
        tries=$((tries + 1))
        [ "$tries" -lt 600 ] || fail "no line with an address: $(cat told.txt)"
        sleep 0.1
    done
}

# A run whose client has the last word: it is stopped like a user does.
stop() {
    kill -INT "$pid"
    status=0
    wait "$pid" || status=$?
    [ "$status" = 130 ] || fail "exit status $status after Ctrl-C: $(cat told.txt)"
}

# The two of one build part tell it where they are missing.
if ! grep -q '^with:.*WebSocket' version.txt; then
    # shellcheck disable=SC2086 # words
    expect 1 'this build has no WebSocket' "$relief" $run --publish ws:0
    skipped="$skipped WebSocket"
else
    python=
    for candidate in python3 /usr/bin/python3; do
        if "$candidate" -c 'import websockets' 2>/dev/null; then python=$candidate; fi
    done
    if [ -z "$python" ]; then
        skipped="$skipped python3-websockets"
    else
        start --publish ws:0
        port=$(sed -n 's|.*ws://127.0.0.1:||p' told.txt)
        # A port that is taken is told, with what to do.
        # shellcheck disable=SC2086 # words
        expect 1 'another program has the port' "$relief" $run --publish "ws:$port"
        # The example of docs/events.md.
        "$python" "$root/examples/events/listen.py" "ws://127.0.0.1:$port" >example.txt 2>&1 &
        example=$!
        "$python" "$root/tests/app/publish_client.py" "$port" || fail "the client: $(cat told.txt)"
        tries=0
        until grep -q 'ball meets' example.txt; do
            tries=$((tries + 1))
            [ "$tries" -lt 600 ] || fail "listen.py tells no touch of its ball: $(cat example.txt)"
            sleep 0.1
        done
        stop
        wait "$example" || fail "listen.py did not end well: $(cat example.txt)"
        grep -q 'AddressSanitizer' told.txt && fail "$(cat told.txt)"

        # Who never reads loses frames, and delays none: all come, and the bodies are the same.
        start --frames 120 --publish ws:0
        port=$(sed -n 's|.*ws://127.0.0.1:||p' told.txt)
        "$python" "$root/tests/app/publish_client.py" "$port" slow &
        slow=$!
        wait "$pid" || fail "the run beside a slow client: $(cat told.txt)"
        wait "$slow" || fail "the slow client"
        grep -q '^120 frames' run.txt || fail "not all frames: $(cat run.txt)"
        # shellcheck disable=SC2086 # words
        "$relief" $run --frames 120 --hash >alone.txt 2>/dev/null
        [ "$(grep ^hash run.txt)" = "$(grep ^hash alone.txt)" ] || fail "other bodies"
    fi
fi

if ! grep -q '^with:.*OSC' version.txt; then
    # shellcheck disable=SC2086 # words
    expect 1 'this build has no OSC' "$relief" $run --publish osc:9000
    skipped="$skipped OSC"
elif ! command -v oscdump >/dev/null || ! command -v oscsend >/dev/null; then
    skipped="$skipped liblo-tools"
else
    # A free port of the system's; nobody else takes it in the meantime, or the test fails aloud.
    heard=$((20000 + $$ % 20000))
    oscdump -L "$heard" >heard.txt 2>&1 &
    dump=$!
    start --publish "osc:$heard?listen=0"
    port=$(sed -n 's|.*commands at osc://127.0.0.1:||p' told.txt)
    tries=0
    # A datagram may be lost, so it is sent until it is answered.
    until grep -q '/relief/body.*"red ball"' heard.txt; do
        oscsend 127.0.0.1 "$port" /relief/spawn sffffs sphere 0.2 0 0 1.5 'red ball'
        oscsend 127.0.0.1 "$port" /relief/spawn s hostile
        tries=$((tries + 1))
        [ "$tries" -lt 60 ] || fail "no red ball: $(tail -n 20 heard.txt)"
        sleep 1
    done
    tries=0
    until grep -q '/relief/contact.*"begin" "red ball" "background"' heard.txt; do
        tries=$((tries + 1))
        [ "$tries" -lt 600 ] || fail "the red ball meets nothing: $(tail -n 20 heard.txt)"
        sleep 0.1
    done
    stop
    kill "$dump"
    for words in '/relief/frame' '/relief/region' '/relief/done s "spawn"' \
        '/relief/error s "spawn takes'; do
        grep -q "$words" heard.txt || fail "no $words in: $(head -n 20 heard.txt)"
    done
fi

if [ -n "$skipped" ]; then
    echo "publish: SKIPPED in part, not installed:$skipped"
    exit 77
fi
