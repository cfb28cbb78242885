#!/bin/sh
# Writes the pages of the manual, relief(1) and one for each command, from what --help prints:
# pages.sh RELIEF PAGE.AWK FOLDER VERSION DATE.
set -eu

relief=$1
awk=$2
folder=$3
version=$4
date=$5

# page COMMAND SUMMARY: "" is the command itself.
page() {
    text=$("$relief" ${1:+"$1"} --help)
    echo "$text" | LC_ALL=C awk -v command="$1" -v summary="$2" -v version="$version" -v date="$date" \
        -f "$awk" >"$folder/relief${1:+-$1}.1"
}

mkdir -p "$folder"
commands=$("$relief" --help | sed '/^examples:/,$d' | sed -n 's/^  \([a-z]\)/\1/p')
echo "$commands" | while read -r command summary; do
    page "$command" "$summary"
done
page "" "virtual things touch the real world that a depth camera sees"
