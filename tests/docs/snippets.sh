#!/bin/sh
# Every C block of the documents compiles against the public headers: snippets.sh ROOT WORK CC. A
# block without a function of its own becomes the body of one. The README's is an example, and runs.
set -eu

root=$1
work=$2
cc=$3

rm -rf "$work"
mkdir -p "$work"
for document in "$root"/docs/*.md; do
    awk -v folder="$work" -v name="$(basename "$document" .md)" '
        /^```c$/ {
            inside = 1
            has_function = 0
            text = ""
            line = FNR + 1
            next
        }
        /^```/ && inside {
            inside = 0
            file = folder "/" name "_" line ".c"
            printf "#include \"relief/io.h\"\n#include \"relief/query.h\"\n#include <stdio.h>\n" >file
            printf "%s#line %d \"%s.md\"\n%s%s",
                has_function ? "" : "void body(void);\nvoid body(void)\n{\n",
                line, name, text, has_function ? "" : "}\n" >file
            close(file)
        }
        inside && /^\{$/ { has_function = 1 }
        inside { text = text $0 "\n" }
    ' "$document"
done
count=0
for file in "$work"/*.c; do
    [ -e "$file" ] || break
    "$cc" -std=c17 -Wall -Wextra -Werror -fsyntax-only -I"$root/include" "$file"
    count=$((count + 1))
done
echo "snippets: $count compile"
[ "$count" -gt 0 ]
