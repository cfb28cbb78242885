#!/bin/sh
# Hosts with a camera each and one that reads them, made of network namespaces and cables between
# them: ros2_hosts.sh BENCH [SECONDS [all]]. BENCH is bench_ros2. What is measured is printed; exit
# status 1 when a figure is worse than its bound, 77 (a skip) without root and namespaces. `all` adds
# a link of 940 Mbit/s with 1080p pictures, and more loss.
set -eu

bench=$1
seconds=${2:-3}
extent=${3:-some}
a=rlf_a_$$
b=rlf_b_$$
work=$(mktemp -d)
host=

skip() {
    echo "SKIPPED: $1"
    exit 77
}

# shellcheck disable=SC2317 # called by the trap
finish() {
    # shellcheck disable=SC2086 # one process each
    [ -z "$host" ] || kill -9 $host 2>/dev/null || true
    for name in "$b" "$a" "$a"_2 "$a"_3 "$a"_4; do
        ip netns del "$name" 2>/dev/null || true
    done
    rm -rf "$work"
}

# A camera host NAME of that number, plugged into the reader's switch.
plug_in() { # NAME NUMBER PORT
    ip netns add "$1" 2>/dev/null || skip "no network namespaces here"
    ip link add "ve_a$$" type veth peer name "ve_b$$" 2>/dev/null || skip "no veth here"
    ip link set "ve_a$$" netns "$1" name eth9
    ip link set "ve_b$$" netns "$b" name "$3"
    ip -n "$b" link set "$3" master switch up
    ip -n "$1" addr add "10.77.0.$2/24" dev eth9
    ip -n "$1" link set eth9 up
    ip -n "$1" link set lo up
}

[ "$(id -u)" = 0 ] || skip "needs root"
command -v ip >/dev/null || skip "needs iproute2"
trap finish EXIT INT TERM
ip netns add "$b" 2>/dev/null || skip "no network namespaces here"
ip -n "$b" link add switch type bridge 2>/dev/null || skip "no bridge here"
ip -n "$b" addr add 10.77.0.100/24 dev switch
ip -n "$b" link set switch up
ip -n "$b" link set lo up
plug_in "$a" 1 eth9

export ROS_DOMAIN_ID=7

start_host() { # OPTIONS
    ip netns exec "$a" "$bench" --host --profile lan "$@" &
    host=$!
}

stop_host() {
    kill -9 "$host"
    wait "$host" 2>/dev/null || true
    host=
}

read_frames() { # NAME OPTIONS
    name=$1
    shift
    ip netns exec "$b" "$bench" --read --profile lan --seconds "$seconds" "$@" >"$work/$name" 2>&1 ||
        { cat "$work/$name"; echo "ros2_hosts: $name: no frame came" >&2; exit 1; }
    echo "$name: $(cat "$work/$name")"
}

# At most so many lost of those that were sent, and no longer gap than that many milliseconds.
expect() { # NAME LOST GAP_MS
    awk -v name="$1" -v lost="$2" -v gap="$3" '
        { for (i = 1; i <= NF; i++) {
              if ($i == "of") { got = $(i - 1) }
              if ($i == "gap") { is = $(i + 1) }
          } }
        END { if (got + 0 > lost || is + 0 > gap) { print "ros2_hosts: " name ": more than " lost " lost or " gap " ms" ; exit 1 } }
    ' "$work/$1" >&2
}

lose() { # TENTHS OF A PERCENT
    ip netns exec "$b" nft -f - <<RULES
table netdev loss {
    chain in {
        type filter hook ingress device eth9 priority 0; policy accept;
        numgen random mod 1000 < $1 drop
    }
}
RULES
}

# ---- two hosts

start_host --color 640x480
read_frames two_hosts --color 640x480
expect two_hosts 3 400

# ---- one packet of a hundred is lost

if command -v nft >/dev/null && lose 10 2>"$work/nft"; then
    read_frames loss_1_percent --color 640x480
    expect loss_1_percent 5 1000
    ip netns exec "$b" nft delete table netdev loss
else
    echo "loss_1_percent: SKIPPED: no nftables here"
fi

# ---- the cable is pulled for a second and a half, and put in again

ip netns exec "$b" "$bench" --read --profile lan --seconds 4 --color 640x480 >"$work/cut" 2>&1 &
reader=$!
sleep 1
ip -n "$b" link set eth9 down
sleep 1.5
ip -n "$b" link set eth9 up
wait "$reader" || { cat "$work/cut"; exit 1; }
echo "cut: $(cat "$work/cut")"
# Frames came again before the end: the gap is no longer than the cut and a second.
expect cut 200 2900

# ---- the host is killed and started again

ip netns exec "$b" "$bench" --read --profile lan --seconds 4 --color 640x480 >"$work/killed" 2>&1 &
reader=$!
sleep 1
stop_host
start_host --color 640x480
wait "$reader" || { cat "$work/killed"; exit 1; }
echo "killed: $(cat "$work/killed")"
expect killed 100000 2000
stop_host

# ---- four hosts with a camera each, and one that reads them all

for k in 2 3 4; do
    plug_in "${a}_$k" $k "port$k"
done
for k in 1 2 3 4; do
    from=$a
    [ $k = 1 ] || from=${a}_$k
    ip netns exec "$from" "$bench" --host --profile lan --color 640x480 --name "/camera_$k" &
    host="$host $!"
done
readers=
for k in 1 2 3 4; do
    ip netns exec "$b" "$bench" --read --profile lan --seconds "$seconds" --color 640x480 --name "/camera_$k" \
        >"$work/four_$k" 2>&1 &
    readers="$readers $!"
done
# shellcheck disable=SC2086 # one process each
wait $readers
for k in 1 2 3 4; do
    echo "four_hosts, camera $k: $(cat "$work/four_$k")"
    expect "four_$k" 3 400
done
# shellcheck disable=SC2086
kill -9 $host
host=

[ "$extent" = all ] || exit 0

# ---- 940 Mbit/s

if ip netns exec "$a" tc qdisc add dev eth9 root tbf rate 940mbit burst 1mb latency 50ms 2>/dev/null; then
    start_host
    read_frames link_940_mbit
    for tenths in 1 10 20; do
        if lose "$tenths" 2>/dev/null; then
            read_frames "1080p_loss_of_${tenths}_in_1000"
            ip netns exec "$b" nft delete table netdev loss
        fi
    done
    stop_host
else
    echo "link_940_mbit: SKIPPED: no tbf here"
fi
