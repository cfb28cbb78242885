#!/bin/sh
# Somebody else's MCAP and ROS 2 readers, from npm, read what Relief records:
# test_mcap_reader.sh RELIEF FOLDER_OF_THE_READER WORK_FOLDER. Status 77 where there is no npm.
set -eu

relief=$1
reader=$2
work=$3

if ! command -v npm >/dev/null 2>&1 || ! command -v node >/dev/null 2>&1; then
    echo "SKIPPED: node and npm are not installed"
    exit 77
fi
rm -rf "$work"
mkdir -p "$work"
cp "$reader/package.json" "$reader/package-lock.json" "$reader/read.mjs" "$work"
cd "$work"
if ! npm ci --no-audit --no-fund --ignore-scripts --loglevel=error >npm.txt 2>&1; then
    echo "SKIPPED: npm cannot fetch the packages:"
    tail -n 3 npm.txt
    exit 77
fi

# check OPTIONS...: 40 frames of the room, as a file and as a folder.
check() {
    "$relief" record synthetic:room clip.mcap --frames 40 --quiet "$@"
    rm -rf folder
    "$relief" record clip.mcap folder/ --quiet
    node read.mjs clip.mcap folder
}
check
check --compression lz4 --codec png
check --compression none --lossless color
