#!/bin/sh
# Another program sees Relief's pictures as a camera of the desktop, through a PipeWire daemon of the
# test's own: test_pipewire.sh RELIEF READER WORK. Status 77: there is no PipeWire here.
set -eu

relief=$1
reader=$2
work=$3
for program in pipewire pw-link; do
    command -v "$program" >/dev/null 2>&1 || {
        echo "pipewire: $program is not installed: SKIPPED"
        exit 77
    }
done
rm -rf "$work"
mkdir -p "$work/run"
chmod 700 "$work/run"
cd "$work"
export XDG_RUNTIME_DIR="$work/run" XDG_CONFIG_HOME="$work/run" PIPEWIRE_RUNTIME_DIR="$work/run"
unset DBUS_SESSION_BUS_ADDRESS DISPLAY

# Without a daemon: one line, not a wait without end.
if "$relief" run synthetic:empty --headless --frames 1 --video pipewire:Relief 2>stderr.txt; then
    echo "pipewire: went through without a daemon" >&2
    exit 1
fi
grep -q "is PipeWire running" stderr.txt
[ "$(wc -l <stderr.txt)" -eq 1 ]

pipewire >daemon.txt 2>&1 &
daemon=$!
trap 'kill $daemon 2>/dev/null || true; wait' EXIT INT TERM
tries=0
while [ ! -S "$work/run/pipewire-0" ] && [ $tries -lt 50 ]; do
    sleep 0.1
    tries=$((tries + 1))
done

# watch FILE VIEW [alpha]: what a reader gets of a view.
watch() {
    "$relief" run "synthetic:empty?color=320x180" --headless --quiet --frames 400 --scene float --view "$2" \
        --video pipewire:Relief &
    source=$!
    "$reader" 30 "$1" ${3:+"$3"} &
    reading=$!
    tries=0
    until pw-link Relief:capture_1 reader:input_1 >/dev/null 2>&1 ||
        pw-link Relief reader >/dev/null 2>&1 || [ $tries -ge 50 ]; do
        sleep 0.1
        tries=$((tries + 1))
    done
    wait $reading
    kill $source 2>/dev/null || true
    wait $source || true
}

watch last.bgrx camera
[ "$(wc -c <last.bgrx)" -eq $((320 * 180 * 4)) ]
# The empty room is not black, and the fourth byte of every pixel is 255.
LC_ALL=C od -An -v -t u1 -w4 last.bgrx |
    awk '{ sum += $1 + $2 + $3; if ($4 != 255) bad++ }
        END { if (bad || sum / NR < 60) { print "pipewire: no picture"; exit 1 } }'

# A mixer gets the bodies alone, with alpha, on nothing.
watch bodies.bgra bodies alpha
[ "$(wc -c <bodies.bgra)" -eq $((320 * 180 * 4)) ]
LC_ALL=C od -An -v -t u1 -w4 bodies.bgra |
    awk '$4 == 0 { none++; if ($1 + $2 + $3 > 0) bad++ } $4 == 255 { whole++ }
        END { if (bad || whole < 200 || none < NR / 2) { print "pipewire: alpha: " whole, none, bad; exit 1 } }'
