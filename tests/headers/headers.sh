#!/bin/sh
# Every public header compiles alone, twice in a row, as C11, C17 and C++17 without a warning:
# tests/headers/headers.sh INCLUDE_FOLDER CC [CXX]. Prints how much comment stands beside the code.
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

# A line that holds any comment counts as comment, one that holds any code counts as code.
awk '
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
        if (code ~ /[^ \t]/) { lines++ }
    }
    END { printf "headers: %d comment lines, %d code lines, ratio %.2f\n", comments, lines,
          comments / lines }
' "$include"/relief/*.h
if [ "$failed" = yes ]; then
    exit 1
fi
echo "headers: $count compile alone"
