#!/bin/sh
# The report page from small measurements: complete, self-contained, and shown by a browser.
# usage: test_report.sh RELIEF SOURCE_DIR SCRATCH
set -eu
relief=$1
source=$2
scratch=$3

fail() {
    echo "test_report: $1" >&2
    exit 1
}

rm -rf "$scratch"
mkdir -p "$scratch/pictures"
cd "$scratch"
"$relief" eval --scene planes --seeds 2 --json eval.json >/dev/null 2>&1
"$relief" bench --quick --frames 6 --json bench.json >/dev/null 2>&1
"$relief" measure "synthetic:thesis?frames=12" --json table.json >/dev/null
"$relief" measure synthetic:empty --noise --frames 2 --json noise_0.json >/dev/null
"$relief" run synthetic:room --headless --quiet --frames 8 --log log --pictures view --picture-every 7
mv view/000007.png pictures/camera.png
echo '{ "machine": "a test & its <machine>" }' >machine.json

PYTHONDONTWRITEBYTECODE=1 python3 "$source/bench/report/page.py" . --results results.md
grep -q "planes without noise" report.html || fail "no accuracy figure in the page"
grep -q "a test &amp; its &lt;machine&gt;" report.html || fail "the machine is not escaped"
grep -q "data:image/png;base64," report.html || fail "no picture in the page"
grep -q "<svg" report.html || fail "no chart in the page"
! grep -Eq '(src|href)="?https?:' report.html || fail "the page loads from the network"
grep -q "| planes |" results.md || fail "no accuracy figure in results.md"
grep -q "165.5" results.md || fail "the thesis's table is missing in results.md"

# Without any measurement the page says what is missing.
mkdir -p empty
PYTHONDONTWRITEBYTECODE=1 python3 "$source/bench/report/page.py" empty
grep -q "eval.json is missing" empty/report.html || fail "an empty folder is not told"
! PYTHONDONTWRITEBYTECODE=1 python3 "$source/bench/report/page.py" nowhere 2>error.txt || fail "a missing folder is accepted"
grep -q "is not a folder" error.txt || fail "a missing folder is not told"

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
    echo "test_report: SKIPPED the browser part: no chromium (apt-get install chromium)"
    exit 0
fi
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" \
    --window-size=1150,3000 --screenshot="$scratch/page.png" "file://$scratch/report.html" \
    >browser.txt 2>&1 || fail "the browser failed: $(tail -n 3 browser.txt)"
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$scratch/profile" \
    --dump-dom "file://$scratch/report.html" >dom.html 2>>browser.txt
grep -q "Is the simulator like a sensor?" dom.html || fail "the browser does not show the last section"
[ "$(wc -c <page.png)" -gt 50000 ] || fail "the browser's picture of the page is blank"
echo "test_report: shown by $browser"
