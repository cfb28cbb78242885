#!/bin/sh
# The report page from small measurements: complete, self-contained, honest about what is short of its
# goal or missing, and shown by a browser, wide and narrow.
# usage: test_report.sh RELIEF_LAB RELIEF SOURCE_DIR SCRATCH
set -eu
lab=$1
relief=$2
source=$3
scratch=$4
export PYTHONDONTWRITEBYTECODE=1

fail() {
    echo "test_report: $1" >&2
    exit 1
}

has() {
    grep -q -- "$1" "${2:-report.html}" || fail "no '$1' in ${2:-report.html}"
}

rm -rf "$scratch"
mkdir -p "$scratch/data/strips"
cd "$scratch"
cat >peers.txt <<'END'
opencv B_normals_FALS_w5 512 424 1 900 900 900 30
Q opencv B_normals_FALS_w5 512 424 1 interior_wrong_over30deg_pct 15.5
END
"$lab" eval --scene planes --seeds 2 --json data/eval.json >/dev/null 2>&1
"$lab" bench --source "synthetic:room?color=96x54" --quick --frames 6 --peers peers.txt --json data/bench.json >/dev/null 2>&1
"$lab" measure "synthetic:thesis?frames=12" --json data/table.json >/dev/null
"$relief" info synthetic:empty --noise --frames 2 --json data/noise_0.json >/dev/null
"$relief" run synthetic:room --headless --quiet --frames 16 --log data/log \
    --pictures 'data/views?at=7&shrink=4'
mv data/views/000007.png data/views/camera.png
for profile in thesis live; do
    "$relief" run synthetic:room --headless --quiet --frames 5 \
        --profile $profile --pictures "data/strips/hand/$profile?at=1+2+3+4&shrink=4"
done
echo "hand synthetic:room 1,2,3,4 a cube & a <hand>" >data/strips/strips.txt

python3 "$source/lab/report/page.py" data --page report.html --results results.md
has "planes without noise"
has "a cube &amp; a &lt;hand&gt;"
has "data:image/png;base64,"
has "<svg"
has "opencv normals_FALS_w5"
has "histogram of from frame to picture"
has "AMD\|Intel\|ARM\|<td class=\"text\">" # the machine
has "SHORT of the goal\|reached"
! grep -Eq '(src|href)="?https?:' report.html || fail "the page loads from the network"
! ls ./*.part >/dev/null 2>&1 || fail "a .part file is left"
has "planes without noise" results.md
has "165.5" results.md
has "opencv normals_FALS_w5" results.md

# No figure looks better than it is.
PYTHONPATH=$source/lab/report python3 - <<'END'
from judge import spread, status
def row(mean, ci, goal=1.0, bound=1.0):
    return {"live": {"mean": mean, "ci95": ci}, "goal": goal, "bound": bound, "relation": "<="}
assert status(row(0.5, 0.1)).text == "reached"
assert status(row(0.5, 0.6)).text == "reached; within its spread"
assert status(row(0.5, None, bound=2.0)).text.startswith("reached; guarded only to")
assert status(row(1.5, 0.1, bound=2.0)).text == "SHORT of the goal"
assert status(row(1.5, 0.6, bound=2.0)).text == "SHORT of the goal; within its spread"
assert status(row(1.5, 0.6, goal=None)).text == "no goal"
assert status({"goal": 1.0, "relation": "<="}).text == "not measured"
assert spread({"mean": 1e9, "ci95": None}) == "never"
assert spread({"mean": 2.0, "ci95": None}) == "2 (one run)"
END

# Without any measurement the page says what is missing; without a folder there is no page.
mkdir -p empty
python3 "$source/lab/report/page.py" empty
for missing in eval.json bench.json table.json noise_0.json "ABSENT: no results of other libraries"; do
    has "$missing" empty/report.html
done
! python3 "$source/lab/report/page.py" nowhere 2>error.txt || fail "a missing folder is accepted"
has "is not a folder" error.txt
echo '{"figures": [' >empty/eval.json
! python3 "$source/lab/report/page.py" empty 2>error.txt || fail "a damaged file is accepted"
[ "$(wc -l <error.txt)" -eq 1 ] || fail "a damaged file is not told in one line"

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
    echo "test_report: SKIPPED the browser part: no chromium (apt-get install chromium)"
    exit 0
fi
browse() {
    "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" "$@" 2>>browser.txt ||
        fail "the browser failed: $(tail -n 3 browser.txt)"
}
browse --window-size=1150,3000 --screenshot="$scratch/page.png" "file://$scratch/report.html" >/dev/null
[ "$(wc -c <page.png)" -gt 50000 ] || fail "the browser's picture of the page is blank"

# In a frame as wide as a telephone and in a wide one: nothing sticks out, every picture is there.
cat >frames.html <<'END'
<body><iframe id="narrow" width="390" height="800" src="report.html"></iframe>
<iframe id="wide" width="1200" height="800" src="report.html"></iframe><script>
onload = () => { for (const frame of document.querySelectorAll("iframe")) {
    const page = frame.contentDocument, images = [...page.images];
    const text = [frame.id, page.documentElement.scrollWidth <= frame.clientWidth ? "fits" : "sticks out",
                  images.length, "pictures", images.every(i => i.naturalWidth > 0) ? "whole" : "broken",
                  page.querySelectorAll("h2").length, "sections"].join(" ");
    document.body.append(Object.assign(document.createElement("p"), {textContent: text})); } };
</script></body>
END
browse --allow-file-access-from-files --virtual-time-budget=5000 --dump-dom "file://$scratch/frames.html" >dom.html
for width in narrow wide; do
    has "$width fits 9 pictures whole 11 sections" dom.html
done
echo "test_report: shown by $browser"
