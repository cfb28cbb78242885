#!/bin/sh
# Runs relief-lab with good and bad arguments and checks exit statuses, messages and files.
# usage: test_command.sh RELIEF_LAB RELIEF WORK_FOLDER
set -u
lab=$1
relief=$2
work=$3
rm -rf "$work"
mkdir -p "$work"
cd "$work" || exit 1
failures=0
small='synthetic:empty?color=96x54' # small pictures are made soon

fail()
{
    echo "FAIL: $*"
    failures=$((failures + 1))
}

# expect STATUS TEXT ARGUMENTS...: the status, exactly one line on stderr, and TEXT in it.
expect_error()
{
    status=$1
    text=$2
    shift 2
    "$lab" "$@" >stdout.txt 2>stderr.txt
    got=$?
    [ "$got" -eq "$status" ] || fail "relief-lab $*: exit status $got, not $status"
    [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "relief-lab $*: not one line: $(cat stderr.txt)"
    grep -q -- "$text" stderr.txt || fail "relief-lab $*: no '$text' in: $(cat stderr.txt)"
}

expect_done()
{
    "$lab" "$@" >stdout.txt 2>stderr.txt || fail "relief-lab $*: $? $(cat stderr.txt)"
}

for command in eval measure bench; do
    expect_done "$command" --help
    grep -q "usage: relief-lab $command" stdout.txt || fail "$command --help: no usage"
    cp stdout.txt help.txt
    expect_done help "$command"
    cmp -s stdout.txt help.txt || fail "help $command: $(head -n 1 stdout.txt)"
    # The old word tells the new one.
    "$relief" "$command" >stdout.txt 2>stderr.txt
    [ $? -eq 2 ] && grep -q "is now .relief-lab $command." stderr.txt || fail "relief $command: $(cat stderr.txt)"
done
expect_error 2 "did you mean 'eval'" evil
expect_done --version

expect_error 2 "ends in .csv" measure "$small" --csv o.json
expect_error 2 "there are room, empty, " eval --scene xyzzy
expect_error 2 "off or average or adaptive" measure synthetic:room --set background_method=lucky
expect_error 2 "a number" eval --set depth_max_m=far
expect_error 2 "--json needs a value" eval --json

# Table 5.1 of any source.
expect_error 2 "--scale" measure synthetic:thesis --scale 8,zero
expect_error 1 "has no end" measure "synthetic:thesis?color=96x54&frames=-1"
expect_error 1 "too few frames" measure "synthetic:thesis?color=96x54&frames=4"
expect_error 1 "no/table.json" measure synthetic:thesis --json no/table.json
expect_error 1 "no/table.csv" measure synthetic:thesis --csv no/table.csv
expect_done measure "synthetic:thesis?color=96x54&frames=12" --csv table.csv --json table.json
[ "$(wc -l <table.csv)" -eq 9 ] || fail "measure: table.csv rows"
grep -q '"cpu"' table.json || fail "measure: table.json names no machine"
grep -q '"counted_bad_percent"' table.json || fail "measure: table.json"
grep -q "3392" stdout.txt || fail "measure: no full 64x53 grid"
grep -q "2632" stdout.txt || fail "measure: no 56x47 centre"
expect_error 2 "use 6 or more" measure synthetic:thesis --frames 5

# Accuracy.
expect_error 2 "not one of them" eval --scene moon
expect_error 2 "live, thesis or both" eval --profile ours
expect_error 2 "--seeds" eval --seeds 0
expect_error 1 "no/eval.json" eval --json no/eval.json
expect_error 1 "no_such_frames" eval --normals no_such_frames
expect_done eval --real no_such_clips --json real.json
grep -q "SKIPPED, there is no folder no_such_clips" stdout.txt || fail "eval: $(cat stdout.txt)"
grep -q '"real": \[\]' real.json || fail "eval: real.json"
expect_done eval --scene plate --profile live --seeds 2 --json eval.json
grep -q "0 outside it" stdout.txt || fail "eval: $(cat stdout.txt)"
grep -q '"commit"' eval.json || fail "eval: eval.json names no machine"
grep -q '"ci95"' eval.json || fail "eval: eval.json"
expect_done eval --scene empty --profile thesis --seeds 1 --frames 20 --threads 1
grep -q "normals, interior" stdout.txt || fail "eval --scene empty: $(cat stdout.txt)"

# Time and memory.
expect_error 2 "--frames" bench --frames 0
expect_error 2 "no argument" bench synthetic:room
expect_error 1 "no/bench.json" bench --json no/bench.json
expect_error 1 "no_such.json" bench --compare no_such.json
printf '{"rows": [{"group": "live_1", "na' >cut.json
expect_error 1 "cut.json: is damaged" bench --compare cut.json
expect_error 1 "peers.txt" bench --peers peers.txt
expect_done bench --source "synthetic:room?color=96x54" --frames 2 --quick --json bench.json
grep -q "surface / floor" stdout.txt || fail "bench: $(cat stdout.txt)"
grep -q '"isa"' bench.json || fail "bench: bench.json names no machine"
grep -q '"surface/background"' bench.json || fail "bench: bench.json"
expect_done bench --source "synthetic:room?color=96x54" --frames 1 --quick --compare bench.json
grep -q "memory/whole .* 1.00$" stdout.txt || fail "bench --compare: $(cat stdout.txt)"

expect_error 1 "no/clip.raw" bench --peer-clip no/clip.raw
expect_done bench --peer-clip clip.raw
head -n 1 clip.raw | head -c 11 | grep -q "512 424 60 " || fail "bench --peer-clip: $(head -n 1 clip.raw)"
rm -f clip.raw clip.raw.gt

# Which picture looks real? A scene of its own folder, so that there is little to copy.
mkdir scenes
cat >scenes/ball.json <<'TEXT'
{"bodies": [{"shape": "sphere", "radius": 0.2, "mass": 1, "position": [0.2, 0.3, 1.6], "release_time": 60}]}
TEXT
expect_error 2 "belong together" pairs --at 3
expect_error 1 "no_such_clip" pairs pages --source no_such_clip --scene scenes/ball.json --at 3
expect_error 1 "no picture of frame 7" pairs pages --source "synthetic:room?color=192x108&frames=4" --scene scenes/ball.json --at 3,7
expect_done pairs pages --source "synthetic:room?color=192x108&frames=4" --scene scenes/ball.json --at 3
grep -q "index.html: [3-5] pairs of" stdout.txt || fail "pairs: $(cat stdout.txt)"
grep -q '"part": "shadow", "with": "0' pages/index.html || fail "pairs: index.html"

# Half a measurement is none: no file, and an earlier one stays.
echo "{}" >kept.json
for command in "eval --scene room" "bench --frames 100000" "measure synthetic:room?frames=-1 --frames 100000"; do
    # shellcheck disable=SC2086 # words
    "$lab" $command --json kept.json >stdout.txt 2>stderr.txt &
    pid=$!
    # A signal that comes before the program listens is lost; two end it without a word.
    for _ in $(seq 600); do
        grep -Eqs '^SigCgt:.*[2367abef]$' /proc/$pid/status && break # 2 is SIGINT's bit
        sleep 0.1
    done
    sleep 1
    kill -INT $pid
    wait $pid
    status=$?
    [ $status -eq 130 ] || fail "interrupted $command: status is not 130"
    tail -n 1 stderr.txt | grep -q "nothing was written" || fail "interrupted $command: $(cat stderr.txt)"
    [ "$(cat kept.json)" = "{}" ] && ! ls ./*.part >/dev/null 2>&1 || fail "interrupted $command: kept.json"
done

[ "$failures" -eq 0 ] || exit 1
echo "relief-lab: all is as it should be"
