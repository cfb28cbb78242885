#!/bin/sh
# script/thresholds counts right, and script/lines tells what has grown: tests/house/thresholds.sh
# ROOT WORK.
set -eu

root=$1
work=$2

rm -rf "$work"
mkdir -p "$work/sample"
cat >"$work/sample/sample.c" <<'END'
/* 1.7 is no constant here */
#define WIDEST 7 /* one */
#define SQUARE(x) ((x) * (x))
enum { KIND_A = 0, KIND_B = 5 };
enum { STEPS = 3, SIDE = 12 }; /* two */
typedef enum named { FIRST = 9 } named;
static const float low = 0.3f, high = 0.9f; /* two */
static const double table[2] = {0.1, 0.7}, one = 1.0; /* one */
static double f(double x)
{
    const double least = 0.02; /* one */
    const double half = 0.5 * x + 0.35; /* an expression with one inline */
    return x > 1.6 ? least : half + 1e-9 + 2.0; /* one inline */
}
END
counted=$("$root/script/thresholds" "$work/sample" | awk 'NR == 2 { print $3, $4 }')
if [ "$counted" != "7 2" ]; then
    echo "thresholds: counts '$counted' in the sample instead of '7 2'" >&2
    exit 1
fi
if "$root/script/thresholds" --most 1 "$work/sample" "$work/sample" >/dev/null; then
    echo "thresholds: a bound that is exceeded does not fail" >&2
    exit 1
fi

"$root/script/lines" --write "$work/sizes" >/dev/null
"$root/script/lines" --check "$work/sizes" >/dev/null
sed 's|^\(src/kernel [0-9]*\) .*|\1 3|' "$work/sizes" >"$work/fewer"
if "$root/script/lines" --check "$work/fewer" >"$work/said"; then
    echo "thresholds: script/lines lets a module have more constants than its list says" >&2
    exit 1
fi
grep -q 'src/kernel has .* the list says 3' "$work/said"
