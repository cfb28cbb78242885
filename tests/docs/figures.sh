#!/bin/sh
# The documents tell the figures of docs/figures.csv, and a difference is found and mended:
# tests/docs/figures.sh ROOT WORK
set -eu

root=$1
work=$2

fail() {
    echo "figures: $1" >&2
    exit 1
}

rm -rf "$work"
mkdir -p "$work/docs" "$work/lab"
cd "$work"
export RELIEF_FIGURES_ROOT="$work"
cat >docs/figures.csv <<'END'
# a comment, with a comma
name,value,unit,command,from,date,commit,cpu
a.b,2.1,cm,relief-lab eval,,2026-01-01,abc,some
size,70,MB,script/bootstrap,,2026-01-01,abc,some
END
sample='| backs | <!--=a.b-->2.1<!--/--> cm and <!--=size-->70<!--/--> MB |'
echo "$sample" >docs/one.md
echo "no figure here" >README.md
cp README.md CHANGELOG.md
cp README.md lab/measuring.md
cp README.md CONTRIBUTING.md
"$root/script/figures" --check >/dev/null || fail "documents that are right are not accepted"

# expect WHAT SED: the document changed by SED is not accepted.
expect() {
    echo "$sample" | sed "$2" >docs/one.md
    if "$root/script/figures" --check >output 2>&1; then
        fail "$1 is not found"
    fi
    grep -q "$3" output || fail "$1 is not told: $(cat output)"
}
expect "another value" 's/2\.1/2.2/' 'one.md:1: a.b is told as "2.2"'
expect "a name that is not there" 's/=a\.b/=a.c/' 'there is no figure a.c'
expect "a figure that nobody tells" 's/<!--=size.*MB//' 'no document tells size'
expect "a mark without an end" 's,<!--/--> MB, MB,' 'has no <!--/-->'

echo "$sample" | sed 's/2\.1/2.2/' >docs/one.md
"$root/script/figures" --write >/dev/null
[ "$(cat docs/one.md)" = "$sample" ] || fail "--write gives: $(cat docs/one.md)"
"$root/script/figures" --set size 71 >/dev/null
grep -q '>71<' docs/one.md || fail "--set does not reach the document"
grep -q "^size,71,MB,script/bootstrap,,$(date +%F)," docs/figures.csv || fail "--set does not date the figure"

# Values of JSON files, where there is Python.
if command -v python3 >/dev/null 2>&1; then
    mkdir data
    sed -i 's/^a\.b,.*/a.b,2.1,cm,relief-lab eval,eval:room:back:live %.1f,2026-01-01,abc,some/' docs/figures.csv
    cat >data/eval.json <<'END'
{"machine": {"cpu": "C, 2", "date": "2026-02-03", "commit": "def"}, "seeds": [1],
 "figures": [{"scene": "room", "key": "back", "live": {"mean": 3.14159}, "thesis": null}]}
END
    "$root/script/figures" --measure data >/dev/null
    grep -q '^a.b,3.1,cm,.*,2026-02-03,def,C 2$' docs/figures.csv || fail "--measure gives: $(cat docs/figures.csv)"
    grep -q '>3.1<' docs/one.md || fail "--measure does not reach the document"
else
    echo "figures: no python3 here: --measure is SKIPPED"
fi

unset RELIEF_FIGURES_ROOT
cd "$root"
rm -rf "$work"
exec "$root/script/figures" --check
