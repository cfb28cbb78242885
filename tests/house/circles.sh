#!/bin/sh
# No circle of files: whoever calls somebody is not called back by them, not even around corners.
# What the object files define and what they need says who calls whom.
# circles.sh NM ROOT OBJECT...
#
# Nor may headers tie many files together. A header that holds types and the functions of several
# files makes all who want the types depend on all of those files: nobody can tell what a file
# needs. A file that includes a header, directly or not, depends on every file that implements some
# of it. At most MOST files may depend on each other in this way. A header without types is a list
# of doors: the files behind it do not depend on each other. The remedy is a header of types, and
# one for each file that does something.
set -eu
nm=$1 root=$2
shift 2
most=8
# Headers that still hold both; whoever splits one takes it out of this list.
tied="src/sim/bones.h src/sim/random/plan.h src/kernel/kernel.h
src/physics/grid/contact/contact.h src/physics/world_state.h src/surface/background/state.h
src/surface/depth/state.h src/surface/motion/state.h src/surface/normals/state.h
src/surface/stage.h src/surface/steps.h src/surface/thickness/state.h"
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT

# Lines "defines FILE SYMBOL" and "needs FILE SYMBOL"; a file as it is called below the root.
"$nm" -g -A "$@" | sed 's,CMakeFiles/[^/]*\.dir/,,' | awk '
    {
        match($0, /\.o(bj)?:/)
        count = split(substr($0, 1, RSTART - 1), part, "/")
        at = count
        while (at > 1 && part[at] != "src" && part[at] != "app") {
            at--
        }
        file = part[at]
        for (i = at + 1; i <= count; i++) {
            file = file "/" part[i]
        }
        print $(NF - 1) == "U" ? "needs" : "defines", file, $NF
    }' >"$work/symbols"
awk '
    $1 == "needs" { needs[$2, $3] = 1 }
    $1 == "defines" { owner[$3] = $2 }
    END {
        for (key in needs) {
            split(key, part, SUBSEP)
            if (part[2] in owner && owner[part[2]] != part[1]) {
                print part[1], owner[part[2]]
            }
        }
    }' "$work/symbols" | sort -u >"$work/calls"
if [ ! -s "$work/calls" ]; then
    echo "circles: no calls between files found in $# objects"
    exit 1
fi
if ! tsort "$work/calls" >/dev/null; then
    echo "circles: the files above call each other in a circle: move what both need to a file below"
    exit 1
fi

# Lines "includes FILE HEADER", "types HEADER" and "word HEADER NAME".
(cd "$root" && find src app -name '*.[ch]' -o -name '*.inl' | sort) 2>/dev/null >"$work/files"
while IFS= read -r file; do
    awk -v file="$file" '
        /^[ \t]*#[ \t]*include[ \t]*"/ && !/"relief\// {
            split($0, part, "\"")
            print "includes", file, substr(file, 1, 3) "/" part[2]
        }
        file ~ /\.h$/ {
            line = $0
            gsub(/\/\*([^*]|\*[^\/])*\*\//, " ", line)
            if (is_comment && line ~ /\*\//) {
                sub(/^.*\*\//, "", line)
                is_comment = 0
            }
            if (is_comment) { next }
            if (line ~ /\/\*/) {
                sub(/\/\*.*$/, "", line)
                is_comment = 1
            }
            if (line ~ /^typedef|^(struct|enum) .*\{/) { print "types", file }
            count = split(line, word, /[^A-Za-z0-9_]+/)
            for (i = 1; i <= count; i++) {
                if (word[i] != "") { print "word", file, word[i] }
            }
        }' "$root/$file"
done <"$work/files" | sort -u >"$work/headers"

awk -v most="$most" -v tied="$tied" '
    function look_into(file, header,    i, list, count) {
        count = split(includes[file], list, " ")
        for (i = 1; i <= count; i++) {
            if (!((header, list[i]) in is_seen)) {
                is_seen[header, list[i]] = 1
                seen[header] = seen[header] " " list[i]
                look_into(list[i], header)
            }
        }
    }
    # Tarjan 1972: files that depend on each other, in all ways.
    function visit(file,    i, list, count, next_file, group, size) {
        number[file] = low[file] = ++visited
        stack[++depth] = file
        is_open[file] = 1
        count = split(depends[file], list, " ")
        for (i = 1; i <= count; i++) {
            next_file = list[i]
            if (!(next_file in number)) {
                visit(next_file)
                low[file] = low[next_file] < low[file] ? low[next_file] : low[file]
            } else if (is_open[next_file] && number[next_file] < low[file]) {
                low[file] = number[next_file]
            }
        }
        if (low[file] != number[file]) { return }
        do {
            next_file = stack[depth--]
            is_open[next_file] = 0
            group = group "\n  " next_file
            size++
        } while (next_file != file)
        if (size > most) {
            print "circles: headers tie these " size " files together:" group
            is_bad = 1
        }
        largest = size > largest ? size : largest
    }
    BEGIN {
        count = split(tied, list, /[ \n]+/)
        for (i = 1; i <= count; i++) { is_tied[list[i]] = 1 }
    }
    $1 == "defines" { owner[$3] = $2; files[$2] = 1 }
    $1 == "includes" { includes[$2] = includes[$2] " " $3 }
    $1 == "types" { has_types[$2] = 1 }
    $1 == "word" && $3 in owner && !($2 in is_tied) && !(($2, owner[$3]) in is_behind) {
        is_behind[$2, owner[$3]] = 1
        behind[$2] = behind[$2] " " owner[$3]
    }
    END {
        for (file in files) { look_into(file, file) }
        for (file in files) {
            count = split(seen[file], headers, " ")
            for (i = 1; i <= count; i++) {
                header = headers[i]
                if (!(header in has_types) && (header, file) in is_behind) { continue }
                others = split(behind[header], other, " ")
                for (k = 1; k <= others; k++) {
                    if (other[k] != file && !((file, other[k]) in is_edge)) {
                        is_edge[file, other[k]] = 1
                        depends[file] = depends[file] " " other[k]
                    }
                }
            }
        }
        for (file in files) {
            if (!(file in number)) { visit(file) }
        }
        if (is_bad) {
            print "circles: put types into a header of their own, and what a file does into one each"
            exit 1
        }
        print "circles: headers tie at most " largest " files together"
    }' "$work/symbols" "$work/headers"
echo "circles: none; $# files, $(wc -l <"$work/calls") times one needs another"
