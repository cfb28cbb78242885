#!/bin/sh
# What docs/window.md tells, as a user does it, with keys and the mouse, on a display that
# xvfb-run lends (1480 x 900): tests/gl/window_tasks.sh RELIEF WORK. Looks at the screen and at the
# files. Exit status 77: a tool is missing, and that is said.
set -eu

relief=$1
work=$2
for tool in xdotool import convert; do
    if ! command -v "$tool" >/dev/null 2>&1; then
        echo "window tasks: SKIPPED, no $tool here (xdotool, imagemagick)"
        exit 77
    fi
done
if [ -z "${DISPLAY:-}" ]; then
    echo "window tasks: SKIPPED, no display (xvfb)"
    exit 77
fi

rm -rf "$work"
mkdir -p "$work/state"
cd "$work"
export XDG_STATE_HOME="$work/state"
pid=
trap '[ -z "$pid" ] || kill "$pid" 2>/dev/null || true' EXIT

fail() {
    echo "window tasks: $1 (see $work)" >&2
    exit 1
}

# The whole screen, as NAME.ppm.
shot() {
    import -window root "$1.ppm"
}

# Pixels of exactly one colour in a part of a picture: count PICTURE WxH+X+Y COLOUR.
count() {
    convert "$1" -crop "$2" +repage -alpha off -fill black +opaque "$3" -fill white -opaque "$3" \
        -format '%[fx:int(mean*w*h+0.5)]' info:
}

# Pixels at the picture's upper left that are the text's: its strokes are smooth, so nearly its colour.
count_text() {
    convert "$1" -crop 600x60+0+0 +repage -alpha off -fuzz 12% -fill black +opaque "$letters" \
        -threshold 50% -format '%[fx:int(mean*w*h+0.5)]' info:
}

# Repeats a check for 20 seconds: until_true MESSAGE COMMAND...
until_true() {
    message=$1
    shift
    tries=0
    until "$@"; do
        tries=$((tries + 1))
        [ "$tries" -lt 80 ] || fail "$message"
        sleep 0.25
    done
}

letters='rgb(245,245,235)' # of text over the picture; that part of the room has nothing like it
picture=960x540+0+0        # of the window, whose corner is that of the screen

red='rgb(240,60,50)' # of the dot of a recording and the bar of an error, at the left
recordings() { find . -maxdepth 1 -name 'relief-*.mcap' -o -maxdepth 1 -name 'relief-2*' -type d | wc -l; }
is_recording() { shot look && [ "$(count look.ppm 20x300+0+0 "$red")" -gt 20 ]; }
is_not_recording() { ! is_recording; }
has_window() { xdotool search --name '^Relief$' >/dev/null 2>&1; }
has_text() { shot look && [ "$(count_text look.ppm)" -ge 10 ]; }
has_no_text() { shot look && [ "$(count_text look.ppm)" -eq 0 ]; }
is_bright() { shot look && [ "$(convert look.ppm -crop $1 +repage -format '%[fx:int(100*mean)]' info:)" -gt 20 ]; }
is_moving() {
    shot one
    sleep 0.3
    shot two
    ! cmp -s one.ppm two.ppm
}

start() {
    "$relief" run "$@" >run.log 2>&1 &
    pid=$!
    until_true "no window: $(cat run.log)" has_window
}

# quit KEY: ends by it, with status 0.
quit() {
    xdotool key "$1"
    status=0
    wait "$pid" || status=$?
    pid=
    [ "$status" -eq 0 ] || fail "exit status $status: $(cat run.log)"
}

# 1. The demo.
room='synthetic:room?color=480x270'
fast='--scale 4 --threads 1' # the tasks are the window's
# shellcheck disable=SC2086
start "$room" --log log --window end=loop $fast
until_true "the room is not there" has_text
is_bright "$picture" || fail "the picture is dark"
echo "1 the demo runs"

# 2. A ball.
xdotool key g mousemove 500 200 click 1
until_true "nothing moves" is_moving
echo "2 a ball is thrown"

# 3. Nothing over the picture.
xdotool key i
until_true "I leaves text" has_no_text
echo "3 the text is hidden"

# 4. A saved picture has no text, even while the window has.
xdotool key i
until_true "I brings no text back" has_text
xdotool key p
until_true "P saves no picture" sh -c 'ls relief-*.png >/dev/null 2>&1'
sleep 0.5
mv relief-*.png saved.png
convert saved.png -resize 960x540! saved.ppm
[ "$(count_text saved.ppm)" -eq 0 ] || fail "the saved picture has text"
echo "4 a picture is saved without text"

# 5. Gravity up, in the panel, where the build has one: its window is wider than the picture.
width=$(xdotool getwindowgeometry --shell "$(xdotool search --name '^Relief$' | head -1)" | sed -n 's/^WIDTH=//p')
has_panel=no
[ "$width" -gt 1000 ] && has_panel=yes
if [ "$has_panel" = yes ]; then
    xdotool mousemove 1163 471 sleep 0.3 mousedown 1 sleep 0.3 mouseup 1
    sleep 1
    echo "5 gravity is turned round in the panel"
fi

# 6. A recording: told while it lasts, whatever is hidden.
xdotool key i sleep 0.3 key e
until_true "a recording with the text hidden is not told" is_recording
xdotool key f
until_true "full screen is not full" is_bright 1200x500+140+200
until_true "a recording is not told in full screen" is_recording
xdotool key e
until_true "the recording does not end" is_not_recording
xdotool key f sleep 0.5 key i
until_true "I brings no text back" has_text
[ "$(recordings)" -eq 1 ] || fail "E made $(recordings) recordings, not 1"
echo "6 what the camera gives is recorded, and that is told"

# 7. Full screen, the picture alone. F and Escape leave it.
for key in f Escape; do
    xdotool key f
    until_true "full screen is not full" is_bright 1200x500+140+200
    until_true "full screen has text" has_no_text
    xdotool key $key
    until_true "$key does not come back from full screen" has_text
done
echo "7 full screen has the picture alone"

# 8. Why pixels are missing: the view and its legend.
xdotool key 0
has_legend() { shot look && [ "$(count look.ppm 300x250+650+240 "$letters")" -gt 200 ]; }
until_true "the view of reasons has no legend" has_legend
xdotool key 1
echo "8 the reasons of missing pixels are shown"

# 9. A scene with an error: told, and what was there goes on.
if [ "$has_panel" = yes ]; then
    echo '{"bodies": [{"shape": "cube"}]}' >bad.json
    xdotool mousemove 1180 124 click 1 sleep 0.3 type "$work/bad.json"
    sleep 0.3
    shot before
    xdotool key Return
    told() { convert "$1" -crop 330x105+965+535 +repage -alpha off -fuzz 20% -fill black +opaque 'rgb(255,128,102)' \
        -format '%[fx:int(mean*w*h+0.5)]' info:; }
    is_told() { shot bad && [ "$(told bad.ppm)" -gt 50 ]; }
    until_true "the panel does not tell the scene's error" is_told
    until_true "the room stopped at a bad scene" is_moving
    part() { convert "$1" -crop 100x16+1005+"$2" +repage -alpha off txt:- | tail -n +2; }
    for y in 220 411 489; do # the titles of the parts
        [ "$(part before.ppm $y)" = "$(part bad.ppm $y)" ] || fail "an error moves the controls"
    done
    one=$(told bad.ppm)
    sleep 9 # longer than over the picture
    is_told || fail "the panel forgets an error"
    xdotool mousemove 1180 332 click 1 sleep 0.3 type missing.obj
    xdotool sleep 0.3 key Return
    are_told() { shot bad && [ "$(told bad.ppm)" -gt $((one + 50)) ]; }
    until_true "the panel tells one error, not two" are_told
    xdotool mousemove 500 300
    echo "9 a scene with an error is told, the old one goes on"

    # Keys are the panel's where one of its controls has the focus: an open list, a field, a slider.
    xdotool mousemove 1180 254 sleep 0.3 click 1 sleep 0.5 type eqf
    xdotool sleep 0.3 key Escape sleep 0.5
    xdotool mousemove 1180 124 sleep 0.3 click 1 sleep 0.3 type eqf
    xdotool sleep 0.3 key Escape sleep 0.5
    xdotool mousemove 1180 445 sleep 0.3 mousedown 1 sleep 0.3 key e sleep 0.3 mouseup 1
    xdotool sleep 0.3 keydown ctrl click 1 keyup ctrl sleep 0.3 key e sleep 0.3 key Escape sleep 0.5
    xdotool mousemove 500 300
    kill -0 "$pid" 2>/dev/null || fail "keys in the panel ended the program"
    sleep 1
    [ "$(recordings)" -eq 1 ] || fail "a key in the panel records"
    # An open list is led by arrows and Enter: from ball to the next shape.
    xdotool mousemove 1180 254 sleep 0.3 click 1 sleep 0.5 key Down sleep 0.2 key Down sleep 0.2
    shot open
    xdotool key Return
    list() { convert "$1" -crop 170x70+1090+270 +repage txt:-; }
    is_closed() { shot closed && [ "$(list open.ppm)" != "$(list closed.ppm)" ]; }
    until_true "Enter leaves a list open" is_closed
    xdotool mousemove 500 300 sleep 0.3 key Tab sleep 0.3 key e # no field takes the E
    until_true "E beside the panel records nothing" is_recording
    xdotool key e
    echo "- keys in the panel are the panel's"
fi
quit Escape

bodies=$(awk -F, 'NR > 1 { names[$3] = 1 } END { n = 0; for (b in names) n++; print n }' log/bodies.csv)
[ "$bodies" -ge 3 ] || fail "$bodies bodies in the log: no ball was thrown"
if [ "$has_panel" = yes ]; then
    awk -F, 'NR > 1 && $12 < -2 { up = 1 } END { exit up ? 0 : 1 }' log/bodies.csv ||
        fail "no body fell up"
    grep -q '  panel ' run.log || fail "the summary does not tell what the panel costs"
    grep '  panel ' run.log
fi

# 10. A clip of one's own, which loops.
"$relief" record "$room" own/ --frames 20 --quiet
# shellcheck disable=SC2086
start own $fast
until_true "the clip is not there" has_text
sleep 2
until_true "the clip stops at its end" is_moving
quit q
[ -s state/relief/recent ] || fail "the clip is not among the recent ones"
echo "10 a clip of one's own plays and loops"

# The command alone shows the start page; the clip above is its second choice, a scene is below.
has_list() { # its letters are enlarged, over a grey ceiling
    shot look && [ "$(convert look.ppm -crop 320x16+66+42 +repage -threshold 75% \
        -format '%[fx:int(mean*w*h+0.5)]' info:)" -gt 150 ]
}
"$relief" >run.log 2>&1 &
pid=$!
until_true "no start page: $(cat run.log)" has_window
until_true "the start page has no list" has_list
xdotool key Escape
status=0
wait "$pid" || status=$?
pid=
[ "$status" -eq 0 ] || fail "Escape on the start page: status $status: $(cat run.log)"
"$relief" >run.log 2>&1 &
pid=$!
until_true "no start page: $(cat run.log)" has_window
until_true "the start page has no list" has_list
xdotool key 2
until_true "the start page opens no clip" has_text
until_true "the clip of the start page does not play" is_moving
quit q
grep -q "frames, in a window" run.log || fail "the start page runs nothing: $(cat run.log)"
echo "- the command alone shows the start page"
