#!/bin/sh
# Runs the relief command with good and bad arguments and checks exit statuses, messages and files.
# usage: test_command.sh RELIEF WORK_FOLDER
set -u
relief=$1
work=$2
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
    "$relief" "$@" >stdout.txt 2>stderr.txt
    got=$?
    [ "$got" -eq "$status" ] || fail "relief $*: exit status $got, not $status"
    [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "relief $*: not one line: $(cat stderr.txt)"
    grep -q -- "$text" stderr.txt || fail "relief $*: no '$text' in: $(cat stderr.txt)"
}

expect_done()
{
    "$relief" "$@" >stdout.txt 2>stderr.txt || fail "relief $*: $? $(cat stderr.txt)"
}

# ---- help and usage ---------------------------------------------------------------------------------
for command in "" run record place export info list calibrate; do
    # shellcheck disable=SC2086 # the empty one must vanish
    "$relief" $command --help >stdout.txt 2>stderr.txt || fail "$command --help: status $?"
    grep -q "usage: relief" stdout.txt || fail "$command --help: no usage"
done
expect_done --version
cp stdout.txt version.txt
expect_done -V
cmp -s stdout.txt version.txt || fail "-V is not --version: $(cat stdout.txt)"
grep -q "^with: .*" stdout.txt || fail "--version does not tell what is built in: $(cat stdout.txt)"
grep "^without " stdout.txt | grep -v "then .cmake --preset release -DRELIEF_WITH_.*=ON. and build again" &&
    fail "--version does not tell how to get a part"
# Without a display: the usage. With one the start page comes up, which the window's tests open.
env -u DISPLAY -u WAYLAND_DISPLAY "$relief" >stdout.txt 2>stderr.txt
status=$?
[ "$status" -eq 2 ] && [ ! -s stdout.txt ] && grep -q "^usage: relief COMMAND" stderr.txt ||
    fail "relief alone: status $status, $(cat stdout.txt stderr.txt)"
for command in run record place export info list calibrate; do
    expect_done "$command" --help
    cp stdout.txt help.txt
    expect_done help "$command"
    cmp -s stdout.txt help.txt || fail "help $command: $(head -n 1 stdout.txt)"
done
expect_done help
grep -qE "eval|bench" stdout.txt && fail "help: the laboratory is among what users need: $(cat stdout.txt)"

# A wrong name: the near one, and what there is.
expect_error 2 "no command 'fly': there are help, run, " fly
expect_error 2 "no command 'rnu': did you mean 'run'" rnu
expect_error 2 "did you mean 'export'" help exprt
expect_error 2 "'--viw': did you mean '--view'" run synthetic:room --viw camera
expect_error 2 "'--sc' may be one of --scene --scale" run synthetic:room --sc here
expect_error 2 "'--pict': did you mean '--pictures'" run synthetic:room --pict here
expect_error 2 "has no 'evry': did you mean 'every'" run synthetic:room --pictures 'here?evry=3'
expect_error 2 "--pictures every '0': use a number from 1" run synthetic:room --pictures 'here?every=0'
expect_error 2 "--window end 'never': use loop, hold or stop" run synthetic:room --window full,end=never
expect_error 2 "--window has no 'ful': did you mean 'full'" run synthetic:room --window ful
expect_error 2 "--window full 'two': use a monitor's number" run synthetic:room --window full=two
expect_error 2 "the value is missing" run synthetic:room --window text

# A word of an earlier version is answered with today's.
expect_error 2 "^relief: 'sources' is now \`relief list sources\`" sources
expect_error 2 "^relief: 'fuse' is now \`relief run SOURCE --headless --mesh ROOM.ply\`" fuse clip --out room.ply
expect_error 2 "^relief run: --picture-every is now --pictures DIR?every=N" run synthetic:room --picture-every 5
expect_error 2 "^relief run: --no-match-light is now --light scene" run synthetic:room --no-match-light
expect_error 2 "^relief run: --legend is now --view" run synthetic:room --legend
expect_error 2 "^relief run: --poses is now --camera source" run synthetic:room --poses=source
[ "$("$relief" --help | grep -cE '^  (run|record|place|export|info|calibrate|list) ')" -eq 7 ] || fail "not seven commands"
[ "$("$relief" run --help | grep -cE '^ +--')" -le 28 ] || fail "run has more than 28 options"
expect_error 2 "unknown option '-x'" run -xyz
expect_error 2 "'--headles': did you mean '--headless'" run "$small" --headles --frames 1
expect_error 2 "'--frame': did you mean '--frames'" run "$small" --headless --frame=1
expect_error 2 "no option '--verson': did you mean '--version'" --verson
expect_error 2 "no option '--runn'" help --runn
expect_error 2 "'x' after help" help run x
expect_error 2 "unknown option '--bogus'" list settings --bogus
expect_error 2 "needs a value" run "$small" --headless --frames
expect_error 2 "takes one SOURCE only" run "$small" -- --headless --hash

# The ending of a name tells no lie.
expect_error 2 "end the name in .mp4 or .y4m" run "$small" --headless --video o.mcap
expect_error 2 "end the name in .mp4 or .y4m" run "$small" --headless --video o
expect_error 2 "ends in .map" run "$small" --headless --save-map o.ply
expect_error 2 "a folder, not" run "$small" --headless --log o.csv
expect_error 2 "a folder, not" run "$small" --headless --pictures o.png
expect_error 2 "in .ply, .obj or .glb" run "$small" --mesh o.stl
expect_error 2 "ends in .json" info "$small" --json o.csv
expect_error 2 "a folder, not" export "$small" --what depth --out o.npy
ls o o.* 2>/dev/null && fail "a name that lies was used"
expect_error 2 "headless takes no value" run "synthetic:room?color=96x54" --headless=1
expect_error 2 "did you mean 'normals'? there are camera, depth" run synthetic:room --view depth,noraml
expect_error 2 "views: there are camera, depth" run synthetic:room --view smell
expect_error 2 "did you mean 'fill'" run synthetic:room --set fil=on
expect_error 2 "of flying_removal, fill, " run synthetic:room --set smell=on
expect_error 2 "did you mean 'depth'" export synthetic:room --out o --what dept
expect_error 2 "there are .*matte, .*true_depth" export synthetic:room --out o --what smell
expect_error 2 "did you mean 'rain'? there are bounce, " run synthetic:room --scene rian
expect_error 1 "use room, empty, thesis" run synthetic:moon --headless
expect_error 1 'did you mean "realsense:"' run realsens
expect_error 1 'no kind of source "nope:". This build has synthetic ' run nope:

# Shipped scenes by name; a file goes first.
expect_done list scenes
grep -q "^rain  *synthetic:room  *all shapes rain" stdout.txt || fail "scenes: $(cat stdout.txt)"
grep -q "^thesis/arm  *synthetic:room  *a cube" stdout.txt || fail "scenes: $(cat stdout.txt)"
[ "$(awk '{ print (NF >= 4) }' stdout.txt | sort -u)" = 1 ] || fail "scenes: one line tells nothing: $(cat stdout.txt)"
expect_done run "$small" --scene stack --headless --frames 1 --quiet --log by_name
grep -c . by_name/bodies.csv | grep -qx 11 || fail "--scene stack: $(cat by_name/bodies.csv)"
expect_done run "$small" --scene thesis/arm --headless --frames 1 --quiet
echo '{"about":"mine","source":"synthetic:empty","bodies":[]}' >stack
expect_done run "$small" --scene stack --headless --frames 1 --quiet --log by_file
grep -c . by_file/bodies.csv | grep -qx 1 || fail "--scene stack, a file: $(cat by_file/bodies.csv)"
rm stack

# What is not kept is said to be, once, and not to those who want quiet.
expect_done run "$small" --headless --frames 1
[ "$(wc -l <stderr.txt)" -eq 1 ] && grep -q "nothing will be kept: add --video" stderr.txt ||
    fail "headless without output: $(cat stderr.txt)"
grep -q "^1 frame, renderer soft" stdout.txt || fail "one frame: $(cat stdout.txt)"
grep -q "^light: .* the default$" stdout.txt || fail "no light was given: $(cat stdout.txt)"
grep -q -- "-0\.0*[, )]" stdout.txt && fail "minus nothing: $(cat stdout.txt)"
for quiet in --quiet --hash "--log kept" "--pictures kept"; do
    # shellcheck disable=SC2086 # words
    expect_done run "$small" --headless --frames 1 $quiet
    [ -s stderr.txt ] && fail "headless with $quiet: $(cat stderr.txt)"
done
expect_done run "$small" --headless --frames 1 --light 0,1,0 --hash
grep -q "^light: .* given$" stdout.txt || fail "a light was given: $(cat stdout.txt)"

# A legend is in the picture that asked for one, and in no other.
expect_done run "synthetic:empty?color=480x270" --headless --frames 1 --quiet --view depth --pictures plain
expect_done run "synthetic:empty?color=480x270" --headless --frames 1 --quiet --view "depth?legend" --pictures legend
cmp -s plain/000000.png legend/000000.png && fail "the key legend draws nothing"
expect_error 2 "needs a SOURCE" run --headless
expect_error 2 "live or thesis" run synthetic:room --profile both
expect_error 2 "not a list of up to four views" run "synthetic:room?color=96x54" --headless --view smell
expect_error 2 "not a list of up to four views" run synthetic:room --view camera,depth,mesh,depth,camera
expect_error 2 "YAW,PITCH" run "synthetic:room?color=96x54" --headless --view points --orbit 30
expect_error 2 "YAW,PITCH" run "synthetic:room?color=96x54" --headless --view points --orbit 30,99
expect_error 2 "X,Y,Z" run "synthetic:room?color=96x54" --headless --light 0,0,0
expect_error 2 "use floor" run "synthetic:room?color=96x54" --headless --gravity down
expect_done run "synthetic:room?color=96x54" --headless --frames 2 --gravity floor
grep -q "^gravity:  -\\?0.0[0-9], 9.81, -\\?0.0[0-9]" stdout.txt || fail "run --gravity floor: $(cat stdout.txt)"
expect_error 2 "soft, hard, thesis or off" run "synthetic:room?color=96x54" --headless --occlusion maybe
expect_error 2 "frames" run "synthetic:room?color=96x54" --headless --frames 0
expect_error 1 "no picture of frame 2: the last one was 1" run "synthetic:room?color=96x54" --headless --frames 2 \
    --pictures 'late?at=1+2'
[ "$(ls late)" = 000001.png ] || fail "run --pictures late?at=1+2: $(ls late)"
expect_done run "synthetic:room?color=96x54" --headless --frames 3 --pictures 'last?at=0+last&shrink=2' --quiet
[ "$(ls last | tr '\n' ' ')" = "000000.png 000002.png " ] || fail "run --pictures last?at=0+last: $(ls last)"
expect_error 2 "frames" run "synthetic:room?color=96x54" --headless --frames ten
expect_error 2 "relief list settings" run synthetic:room --set smell=on
expect_error 2 "needs --left DIR" calibrate
expect_error 2 "COLUMNSxROWS" calibrate --left here --board 9
expect_error 2 "not both" calibrate --left here synthetic:room
expect_error 2 "needs --out" calibrate --convert camera.json
expect_error 2 "needs --out" calibrate --print-board 9x6
expect_error 2 "one SOURCE" calibrate --check here there
expect_error 1 "does not fit on A4" calibrate --print-board 9x6 --square 40 --out board.pdf
"$relief" record "synthetic:room?color=480x270" checked/ --frames 4 >stdout.txt 2>&1 || fail "record checked/"
"$relief" calibrate --convert checked/camera.json --out checked.yml >stdout.txt 2>&1 ||
    fail "calibrate --convert: $(cat stdout.txt)"
"$relief" calibrate --check "checked?camera=checked.yml" >stdout.txt 2>&1 ||
    fail "calibrate --check: $(cat stdout.txt)"
grep -q "1.30 m above the floor" stdout.txt || fail "calibrate --check: $(cat stdout.txt)"
sed '/^T:/,$s/data: \[[^,]*/data: [-0.02/' checked.yml >moved.yml
"$relief" calibrate --check "checked?camera=moved.yml" >stdout.txt 2>&1
[ $? -eq 1 ] || fail "calibrate --check of a moved camera: $(cat stdout.txt)"
grep -q "no longer fits" stdout.txt || fail "calibrate --check of a moved camera: $(cat stdout.txt)"
export RELIEF_OPENCV_LIBRARY=/nowhere
expect_error 1 "libopencv-calib3d-dev" calibrate synthetic:room
unset RELIEF_OPENCV_LIBRARY
expect_error 2 "off or on" run synthetic:room --set fill=maybe
expect_error 2 "a count" export synthetic:room --set min_region_points=1.5
expect_error 1 "depth_min_m is nan" run "synthetic:room?color=96x54" --headless --frames 1 --set depth_min_m=nan
expect_done list settings "synthetic:thesis?color=96x54"
[ "$(wc -l <stdout.txt)" -le 18 ] || fail "more settings than a user chooses: $(cat stdout.txt)"
expect_done list settings --all "synthetic:thesis?color=96x54"
grep -q "^steadying  *on  *off" stdout.txt || fail "settings: not listed"
expect_error 2 "needs one SOURCE" info
expect_error 2 "takes no 'synthetic:room'" list sources synthetic:room
expect_error 2 "use sources, scenes or settings" list
expect_error 2 "goes without" info synthetic:empty --up --noise
expect_error 1 "has no frames" info "synthetic:room?color=96x54&frames=0" --up
expect_error 1 "has no frames" info "synthetic:room?color=96x54&frames=0" --noise
expect_done info "$small" --up --frames 2
grep -q "looks down by 0.0 degrees" stdout.txt || fail "info --up: $(cat stdout.txt)"
expect_done info "$small" --noise --frames 2 --json noise.json
grep -q '"temporal_mm"' noise.json || fail "info --noise: noise.json"
expect_error 2 "from 1 to 3600" info synthetic:room --seconds 0
expect_error 1 "no/such/folder" info synthetic:room --json no/such/folder/info.json
expect_done info "synthetic:room?color=96x54" --frames 3 --json info.json
grep -q '"interval_s": 0.0333' info.json || fail "info --json: $(cat info.json)"
grep -q "^missing  *[0-9.]* % of the pixels" stdout.txt || fail "info: $(cat stdout.txt)"
# What OpenNI2's drivers leave behind when they are asked for devices is not Relief's to free.
ASAN_OPTIONS=detect_leaks=0 "$relief" list sources >stdout.txt 2>stderr.txt || fail "sources: $(cat stderr.txt)"
grep -q "^  FOLDER " stdout.txt || fail "sources: $(cat stdout.txt)"
expect_error 2 "needs a SOURCE" place --scene s.json
expect_error 2 "needs --scene" place synthetic:room
expect_error 2 "needs --object" place synthetic:room --scene s.json --pick ltn@1,2
expect_error 2 "2 picks" place synthetic:room --scene s.json --object a --pick ltn@1,2 --pick rtn@3,4
expect_error 2 "not an array" export synthetic:room --out o --what smell
expect_error 2 "needs --out" export synthetic:room
expect_error 2 "needs --scene" export synthetic:room --out o --what matte
expect_error 2 "unknown option '--fast'" run synthetic:room --fast
expect_error 2 "A:B" export synthetic:room --out o --what depth --frames 5:3

# ---- what the world can get wrong -----------------------------------------------------------------------
expect_error 1 "no_such_folder" run no_such_folder --headless
expect_error 1 "synthetic" run synthetic:moon --headless
expect_error 1 "seed" run "synthetic:room?seed=x" --headless
expect_error 1 "missing.json" run "synthetic:room?color=96x54" --headless --scene missing.json
printf '{"bodies": [{"shape": "box", "mass": NaN}]}' >nan.json
expect_error 1 "nan.json" run "synthetic:room?color=96x54" --headless --scene nan.json
printf '{"bodies": [{"shape": "box", "colour": [1, 0, 0]}]}' >unknown.json
expect_error 1 "colour" run "synthetic:room?color=96x54" --headless --scene unknown.json
printf '{"spawn": [{"body": {}, "pattern": "heap", "count": 3}]}' >heap.json
expect_error 1 "heap.json: spawn\[0\].pattern is \"heap\"" run "synthetic:room?color=96x54" --headless --scene heap.json
: >file
echo '{"known_objects":[{"name":"crate","shape":"box","size":[0.34,0.22,0.26]}]}' >known.json
room='synthetic:empty?color=480x270'
expect_error 1 "crte" place "$room" --scene known.json --object crte
expect_error 1 "no points" place "$room" --scene known.json --object crate
expect_error 1 "do not fit" place "$room" --scene known.json --object crate \
    --pick ltn@365,174 --pick rtn@410,177 --pick lbn@410,203
expect_error 1 "on a line" place "$room" --scene known.json --object crate \
    --pick ltn@365,174 --pick ctn@388,175.5 --pick rtn@410,177
expect_error 1 "outside the picture" place "$room" --scene known.json --object crate \
    --pick ltn@3650,174 --pick rtn@410,177 --pick lbn@365,200
expect_error 1 "a point that" place "$room" --scene known.json --object crate \
    --pick top@365,174 --pick rtn@410,177 --pick lbn@365,200
expect_done place "$room" --scene known.json --object crate --out placed.json --picture placed.png \
    --pick ltn@365,174 --pick rtn@410,177 --pick lbn@365,200 --pick rbn@410,203
grep -q "position     1.3[34]" stdout.txt || fail "place: the crate is elsewhere"
expect_done run "$room" --scene placed.json --headless --frames 3 --view known --quiet
expect_error 1 "profile live" run "$room" --scene placed.json --headless --frames 3 --profile thesis
expect_error 1 "file" run "synthetic:room?color=96x54" --headless --frames 3 --log file/log
expect_error 1 "file" run "synthetic:room?color=96x54" --headless --frames 3 --video file/video.y4m
expect_error 1 "file" export "synthetic:room?color=96x54" --frames 0:2 --out file/out --what depth
mkdir empty_folder
expect_error 1 "camera.json" run empty_folder --headless
expect_error 1 "frame 7" export "synthetic:room?color=96x54&frames=5" --frames 7:9 --out o --what depth
find . -name '*.part' | grep -q . && fail "a .part file was left behind"

# ---- what must come out ---------------------------------------------------------------------------------
for profile in live thesis; do
    expect_done run "synthetic:room?color=96x54&frames=12" --profile $profile --headless --video $profile.y4m \
        --pictures "pictures_$profile?every=5" --log log_$profile --hash
    [ -s $profile.y4m ] || fail "$profile: no video"
    [ "$(ls pictures_$profile)" = "000000.png
000005.png
000010.png" ] || fail "$profile: pictures: $(ls pictures_$profile)"
    head -n 1 log_$profile/frames.csv | grep -qx \
        "frame,time_s,valid,missing,foreground,regions,capture_ms,surface_ms,physics_ms,render_ms" ||
        fail "$profile: frames.csv header"
    [ "$(wc -l <log_$profile/frames.csv)" -eq 13 ] || fail "$profile: frames.csv rows"
    head -n 1 log_$profile/bodies.csv | grep -qx \
        "frame,time_s,body,px,py,pz,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz" ||
        fail "$profile: bodies.csv header"
    [ "$(wc -l <log_$profile/bodies.csv)" -eq 25 ] || fail "$profile: bodies.csv rows"
    head -n 1 log_$profile/contacts.csv | grep -qx \
        "frame,time_s,body,other,px,py,pz,nx,ny,nz,separation,impulse,surface_speed" ||
        fail "$profile: contacts.csv header"
done

# A scene may have more bodies than a world has room for by default.
awk 'BEGIN {
    printf "{\"bodies\":["
    for (i = 0; i < 1500; i++)
        printf "%s{\"size\":[0.02,0.02,0.02],\"position\":[%.2f,%.2f,2]}", i ? "," : "", i % 50 * 0.04 - 1, int(i / 50) * 0.04 - 1
    printf "]}"
}' >many.json
expect_done run "$small" --scene many.json --headless --frames 2 --quiet --log log_many
[ "$(wc -l <log_many/bodies.csv)" -eq 3001 ] || fail "1500 bodies: $(wc -l <log_many/bodies.csv) rows"
echo '{"spawn":[{"body":{"name":"n","size":[0.02,0.02,0.02],"position":[0,-0.4,2]},"pattern":"grid",
    "count":[50,30,1],"spacing":[0.04,0.04,0.04]}]}' >spawn.json
expect_done run "$small" --scene spawn.json --headless --frames 2 --quiet --log log_spawn
[ "$(grep -c '^[01],[^,]*,n_[0-9]*,' log_spawn/bodies.csv)" -eq 3000 ] || fail "spawn: $(tail -n 1 log_spawn/bodies.csv)"

# Without OpenGL, or a build without it, the soft renderer draws the same pictures and one line says so.
expect_done run "synthetic:room?color=96x54&frames=4" --headless --renderer soft --quiet --pictures 'soft?every=1'
__EGL_VENDOR_LIBRARY_DIRS=/nonexistent "$relief" run "synthetic:room?color=96x54&frames=4" --headless --renderer gl \
    --quiet --pictures 'no_gl?every=1' >stdout.txt 2>stderr.txt || fail "no OpenGL: status $?"
[ "$(wc -l <stderr.txt)" -eq 1 ] || fail "no OpenGL: not one line: $(cat stderr.txt)"
grep -q "going on with the soft" stderr.txt || fail "no OpenGL: $(cat stderr.txt)"
diff -r soft no_gl >stdout.txt || fail "no OpenGL: other pictures: $(cat stdout.txt)"

# Same input, same bits, whatever the number of threads.
"$relief" run "synthetic:room?color=96x54&frames=20" --headless --hash --threads 1 --quiet >hash1.txt
"$relief" run "synthetic:room?color=96x54&frames=20" --headless --hash --threads 3 --quiet >hash3.txt
grep -q "^hash [0-9a-f]\{16\}$" hash1.txt || fail "no hash: $(cat hash1.txt)"
cmp -s hash1.txt hash3.txt || fail "hashes differ: $(cat hash1.txt hash3.txt)"

printf '{"bodies": [{"name": "a", "shape": "sphere", "radius": 0.1, "position": [0, 0, 1.5]}]}' >one.json
expect_done export "synthetic:room?color=96x54&frames=8" --scene one.json --frames 6:8 --out arrays --what \
    depth,points,normals,labels,foreground,velocity,thickness,reason,color,matte,composite,mesh,regions,true_depth,true_normals,true_labels,true_foreground,true_thickness,true_velocity,true_background,true_poses
for name in depth points normals labels foreground velocity thickness reason color matte composite \
    true_depth true_normals true_labels true_foreground true_thickness true_velocity true_background; do
    [ -s arrays/$name/000006.npy ] && [ -s arrays/$name/000007.npy ] || fail "export: $name"
    [ -e arrays/$name/000005.npy ] && fail "export: frame 5 of $name was not asked for"
done
[ -s arrays/mesh/000006.ply ] || fail "export: mesh"
ls arrays/regions/000006_*.ply >/dev/null || fail "export: regions"
[ -s arrays/true_poses.csv ] || fail "export: true_poses.csv"

# A room that was seen is a known room for the next run; a camera that stands makes none.
moving='synthetic:room?path=handheld&color=96x54&frames=8'
expect_done run "$moving" --camera moving --headless --save-map room.map
expect_done run "$moving" --camera moving --headless --map room.map --log mapped
[ "$(wc -l <mapped/trajectory.txt)" -ge 8 ] || fail "--map: the camera is not found"
expect_error 1 "has not moved" run "$small&frames=2" --headless --camera fixed --save-map none.map
expect_error 1 "no/room.map: cannot be created" run "$moving" --camera moving --headless --save-map no/room.map
[ -e none.map ] && fail "--save-map: there is no map to be written"

# Ctrl-C ends a run with whole files.
"$relief" run "synthetic:room?color=96x54&frames=-1" --headless --video long.y4m --log long_log --quiet &
pid=$!
for wait in $(seq 100); do # until it is at work
    ls long.y4m.*.part >/dev/null 2>&1 && break
    sleep 0.1
done
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "interrupted run: status is not 130"
[ -s long.y4m ] || fail "interrupted run: no video"
ls ./*.part >/dev/null 2>&1 && fail "interrupted run: .part left"
tail -c 1 long_log/frames.csv | od -c | grep -q '\\n' || fail "interrupted run: log cut short"

# Before the first frame there is nothing to write, and what an earlier run wrote stays.
mkdir early && echo old >early/frames.csv
"$relief" run "simulated:?of=synthetic:empty&stall=60@0" --headless --video early.y4m --log early --hash \
    >stdout.txt 2>stderr.txt &
pid=$!
sleep 1
kill -INT $pid
wait $pid
[ $? -eq 130 ] || fail "interrupted before the first frame: status is not 130"
tail -n 1 stderr.txt | grep -q "nothing was written" || fail "interrupted before the first frame: $(cat stderr.txt)"
[ -s stdout.txt ] && fail "interrupted before the first frame: says $(cat stdout.txt)"
[ "$(cat early/frames.csv)" = old ] && [ ! -e early.y4m ] || fail "interrupted before the first frame: $(ls early)"

# A terminal that is closed ends a run as Ctrl-C does; nohup keeps it from that.
"$relief" run "synthetic:room?color=96x54&frames=-1" --headless --video hup.y4m --log hup_log --quiet &
pid=$!
for wait in $(seq 100); do
    ls hup.y4m.*.part >/dev/null 2>&1 && break
    sleep 0.1
done
kill -HUP $pid
wait $pid
[ $? -eq 129 ] || fail "SIGHUP: status is not 129"
[ -s hup.y4m ] && [ -s hup_log/frames.csv ] || fail "SIGHUP: files are missing"
ls ./*.part hup_log/*.part >/dev/null 2>&1 && fail "SIGHUP: .part left"

# A limit on the size of files is a full disk.
(ulimit -f 4 && exec "$relief" run "synthetic:room?color=96x54&frames=8" --headless --quiet --video limit.y4m) 2>stderr.txt
[ $? -eq 1 ] || fail "ulimit -f: status is not 1"
grep -q "File too large" stderr.txt || fail "ulimit -f: $(cat stderr.txt)"
ls ./*.part >/dev/null 2>&1 && fail "ulimit -f: .part left"

# What a caller closed is nobody's file.
"$relief" run "synthetic:room?color=96x54&frames=2" --headless --log closed --set smell=1 0<&- 1>&- 2>&-
"$relief" run "synthetic:room?color=96x54&frames=2" --headless --gravity floor --log closed 0<&- 1>&- 2>&- || fail "closed streams: status $?"
head -n 1 closed/frames.csv | grep -q "^frame," || fail "closed streams: $(head -n 1 closed/frames.csv)"
head -n 1 closed/contacts.csv | grep -q "^frame," || fail "closed streams: $(head -n 1 closed/contacts.csv)"

# A video on standard output is a video from its first byte to its last.
"$relief" run "synthetic:room?color=96x54&frames=2&color=64x36" --headless --video - --hash --record both/ >video.y4m 2>stderr.txt ||
    fail "video on stdout: status $?"
grep -q "^hash [0-9a-f]\{16\}$" stderr.txt || fail "video on stdout: no hash: $(cat stderr.txt)"
header=$(head -n 1 video.y4m | wc -c)
[ "$(wc -c <video.y4m)" -eq $((header + 2 * (6 + 64 * 36 * 3 / 2))) ] || fail "video on stdout: $(wc -c <video.y4m) bytes"

# Two runs into one folder: every log is one run's.
for run in 1 2 3; do
    "$relief" run "synthetic:room?color=96x54&frames=$((2 * run))" --headless --quiet --threads 1 --log shared --video shared.y4m &
    eval "pid$run=$!"
done
# shellcheck disable=SC2154 # set by eval
for pid in $pid1 $pid2 $pid3; do
    wait "$pid" || fail "one of three runs into one folder: status $?"
done
for log in frames bodies contacts hands; do
    [ "$(awk -F, '{ print NF }' shared/$log.csv | sort -u | wc -l)" -eq 1 ] || fail "three runs into one folder: $log.csv is ragged"
done
[ "$(ls shared | wc -l)" -eq 4 ] || fail "three runs into one folder: $(ls shared)"

if [ -e /dev/full ]; then
    for command in "run $small&frames=1 --headless --quiet --hash" "list settings" "info $small --frames 1" --help "run --help"; do
        # shellcheck disable=SC2086 # words
        "$relief" $command >/dev/full 2>stderr.txt
        [ $? -eq 1 ] || fail "$command >/dev/full: status is not 1"
        [ "$(wc -l <stderr.txt)" -eq 1 ] && grep -q "No space left" stderr.txt || fail "$command >/dev/full: $(cat stderr.txt)"
    done
    "$relief" run "synthetic:room?color=96x54&frames=8" --headless --quiet --video - >/dev/full 2>stderr.txt
    [ $? -eq 1 ] || fail "full disk: status is not 1"
    [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "full disk: $(cat stderr.txt)"
fi

echo "$failures failed"
[ "$failures" -eq 0 ]
