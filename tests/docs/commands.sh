#!/bin/sh
# Runs every ```sh block of README.md, docs/*.md and lab/*.md in a scratch folder that looks like the
# repository: tests/docs/commands.sh ROOT BUILD WORK. A block with <!-- not run: why --> on the line
# above is left out, and counted.
set -eu

root=$1
build=$2
work=$3

rm -rf "$work"
mkdir -p "$work/blocks" "$work/here/build"
ln -s "$build" "$work/here/build/release"
for entry in "$root"/*; do
    name=$(basename "$entry")
    case $name in
    build | out) ;;
    *) ln -s "$entry" "$work/here/$name" ;;
    esac
done

# Cuts the blocks out: one file each, whose name tells document and line.
for document in "$root"/README.md "$root"/docs/*.md "$root"/lab/*.md; do
    awk -v folder="$work/blocks" -v name="$(basename "$document")" '
        /^```sh$/ {
            inside = 1
            skipped = before ~ /^<!-- not run: .+ -->$/
            file = sprintf("%s/%s:%d%s", folder, name, FNR, skipped ? ".skipped" : ".sh")
            printf "" >file
            next
        }
        /^```/ { inside = 0 }
        inside { print >file }
        { before = $0 }
    ' "$document"
done

run=0
skipped=0
for block in "$work"/blocks/*; do
    case $block in
    *.skipped)
        skipped=$((skipped + 1))
        continue
        ;;
    esac
    if ! (cd "$work/here" && env -u DISPLAY -u WAYLAND_DISPLAY sh -eu "$block") \
        >"$work/output" 2>&1; then
        echo "commands: $(basename "$block" .sh) fails:" >&2
        cat "$block" "$work/output" >&2
        exit 1
    fi
    run=$((run + 1))
done
# What the pages promise to be in a file is there.
for csv in out/hands/hands.csv out/grab/hands.csv; do
    if [ "$(wc -l <"$work/here/$csv")" -lt 2 ]; then
        echo "commands: docs/hands.md: $csv has no hand" >&2
        exit 1
    fi
done
echo "commands: $run blocks run, $skipped left out with a reason"
[ "$run" -gt 0 ]
