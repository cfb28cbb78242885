#!/bin/sh
# Every public header compiles alone, twice in a row, as C11, C17 and C++17 without a warning, and
# has nearly as many lines of comment as of code: tests/headers/headers.sh INCLUDE_FOLDER CC [CXX].
set -eu

include=$1
cc=$2
cxx=${3:-}
warnings="-Wall -Wextra -Wpedantic -Wshadow -Werror"
failed=no

# compile HEADER COMPILER LANGUAGE STANDARD
compile() {
    # shellcheck disable=SC2086
    printf '#include "relief/%s"\n#include "relief/%s"\n' "$1" "$1" |
        "$2" -x "$3" "-std=$4" $warnings -fsyntax-only -I"$include" - || {
        echo "headers: relief/$1 does not compile alone as $4" >&2
        failed=yes
    }
}

if [ -z "$cxx" ]; then
    echo "headers: no C++ compiler here: C++17 is SKIPPED"
fi
count=0
for path in "$include"/relief/*.h; do
    header=$(basename "$path")
    count=$((count + 1))
    compile "$header" "$cc" c c11
    compile "$header" "$cc" c c17
    if [ -n "$cxx" ]; then
        compile "$header" "$cxx" c++ c++17
    fi
done

# How much a header tells: a line that holds any comment counts as comment, one that holds any code
# counts as code; the body of an inline function is no part of the contract and counts as one line.
measure() {
    awk -v name="$1" '
    {
        rest = $0
        has_comment = inside
        code = ""
        while (rest != "") {
            if (inside) {
                end = index(rest, "*/")
                if (!end) { rest = ""; break }
                rest = substr(rest, end + 2)
                inside = 0
            } else {
                begin = index(rest, "/*")
                if (!begin) { code = code rest; rest = ""; break }
                has_comment = 1
                code = code substr(rest, 1, begin - 1)
                rest = substr(rest, begin + 2)
                inside = 1
            }
        }
        if (has_comment) { comments++ }
        if (code ~ /[^ \t]/) {
            if (!in_body) { lines++ }
            if (code ~ /^\{/ && is_inline) { in_body = 1 }
            if (code ~ /^\}/) { in_body = 0 }
            if (code ~ /^static inline/) { is_inline = 1 } else if (code !~ /^[ {]/) { is_inline = 0 }
        }
    }
    END { printf "%s %d %d %.2f\n", name, comments, lines, comments / lines }' "$1"
}
least=0.90
comments=0
code=0
for path in "$include"/relief/*.h; do
    result=$(measure "$path")
    ratio=${result##* }
    rest=${result#* }
    comments=$((comments + ${rest%% *}))
    rest=${rest#* }
    code=$((code + ${rest%% *}))
    if awk "BEGIN { exit !($ratio < $least) }"; then
        echo "headers: $(basename "$path"): comment : code is $ratio, at least $least is asked for" >&2
        failed=yes
    fi
done
if [ "$failed" = yes ]; then
    exit 1
fi
echo "headers: $count compile alone; $comments lines of comment for $code of code"
