#!/bin/sh
# No circle of files: whoever calls somebody is not called back by them, not even around corners.
# What the object files define and what they need says who calls whom.
# circles.sh NM OBJECT...
set -eu
nm=$1
shift
pairs=$(mktemp)
trap 'rm -f "$pairs"' EXIT

"$nm" -g -A "$@" | sed 's,CMakeFiles/[^/]*\.dir/,,' | awk '
    {
        match($0, /\.o(bj)?:/)
        file = substr($0, 1, RSTART - 1)
        symbol = $NF
        if ($(NF - 1) == "U") {
            needs[file, symbol] = 1
        } else {
            owner[symbol] = file
        }
    }
    END {
        for (key in needs) {
            split(key, part, SUBSEP)
            if (part[2] in owner && owner[part[2]] != part[1]) {
                print part[1], owner[part[2]]
            }
        }
    }' | sort -u >"$pairs"
if [ ! -s "$pairs" ]; then
    echo "circles: no calls between files found in $# objects"
    exit 1
fi
if ! tsort "$pairs" >/dev/null; then
    echo "circles: the files above call each other in a circle: move what both need to a file below"
    exit 1
fi
echo "circles: none; $# files, $(wc -l <"$pairs") times one needs another"
