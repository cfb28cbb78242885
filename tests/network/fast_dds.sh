#!/bin/sh
# Relief and a program with another maker's DDS, Fast DDS, read each other bit by bit:
# fast_dds.sh SOURCE_FOLDER WORK TEST_IO_ROS2 RELIEF. The program is built in WORK when it is not
# there yet, which takes a minute. Exit status 77 (a skip) where what builds it is absent.
set -eu

source=$1/tests/network/fast_dds
work=$2
test=$3
relief=$4
export ROS_DOMAIN_ID=$((220 + $$ % 10))

for tool in fastddsgen g++; do
    command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool here (Debian: fastddsgen, g++)"; exit 77; }
done
[ -f /usr/include/fastrtps/fastrtps_dll.h ] || { echo "SKIPPED: no libfastrtps-dev here"; exit 77; }

mkdir -p "$work"
if [ ! -x "$work/peer" ] || [ "$source/peer.cpp" -nt "$work/peer" ] || [ "$source/ros.idl" -nt "$work/peer" ]; then
    (cd "$work" && fastddsgen -replace "$source/ros.idl" >/dev/null)
    g++ -O1 -std=c++17 -I"$work" -o "$work/peer.new" "$source/peer.cpp" "$work/ros.cxx" "$work/rosPubSubTypes.cxx" \
        -lfastrtps -lfastcdr
    mv "$work/peer.new" "$work/peer"
fi

other=
finish() { [ -z "$other" ] || kill -9 "$other" 2>/dev/null || true; }
trap finish EXIT INT TERM
stop() { kill -9 "$other"; wait "$other" 2>/dev/null || true; other=; }

"$work/peer" camera & other=$!
"$test" peer
stop

"$test" host & other=$!
"$work/peer" read 30
stop

"$relief" run 'synthetic:room?frames=100000' --scene table --headless --quiet --publish ros2:/relief >/dev/null 2>&1 & other=$!
"$work/peer" look
stop
