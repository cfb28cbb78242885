#!/bin/sh
# Style that a machine can see: tests/house/style.sh FOLDER. Tabs, blanks at line ends, a missing
# final newline, lines over 100 columns, functions over 80 lines, files over 600 lines, marks of
# unfinished work, and includes in src that are not "module/file.h". Prints file:line and the rule; exit status 1 when there is any.
set -eu

root=$1
cd "$root"

# The marks are put together here so that this file does not find itself.
marks="TO""DO|FIX""ME|XX""X|HA""CK"

list_files() {
    for folder in app examples include lab web src tests cmake script docs scenes .ci; do
        if [ -d "$folder" ]; then
            find "$folder" -name node_modules -prune -o -type f \( -name '*.[ch]' \
                -o -name '*.cmake' -o -name '*.txt' -o -name '*.sh' -o -name '*.md' -o -name '*.json' -o -name '*.glsl' \
                -o -path 'script/*' -o -path '.ci/*' \) -print
        fi
    done
    for file in README.md CHANGELOG.md CMakeLists.txt CMakePresets.json; do
        if [ -f "$file" ]; then echo "$file"; fi
    done
}

files=$(list_files | sort)
# One awk for all: a process for each of a thousand files would take longer than the look.
# shellcheck disable=SC2016 # awk's own $
problems=$(printf '%s\n' "$files" | tr '\n' '\0' | xargs -0 awk -v marks="$marks" '
        function say(text) { print FILENAME ":" FNR ": " text }
        FNR == 1 { end_file(); file = FILENAME; start = 0 }
        { last = FNR }
        /\t/ { say("tab") }
        /[ \t]$/ { say("blank at the end of the line") }
        $0 ~ "(^|[^A-Za-z_])(" marks ")([^A-Za-z_]|$)" { say("mark of unfinished work") }
        file ~ /\.[ch]$/ && length($0) > 100 { say("longer than 100 columns") }
        file ~ /^src\/.*\.[ch]$/ && /^[ \t]*#[ \t]*include[ \t]*("[^\/]*"|<relief\/)/ {
            say("include it as \"module/file.h\", from src/")
        }
        file ~ /\.c$/ && /^[A-Za-z_].*\)[ \t]*\{?$/ { name = $0; start = FNR }
        file ~ /\.c$/ && /^\}/ {
            if (start && FNR - start + 1 > 80) {
                sub(/\(.*/, "", name)
                print file ":" start ": function of " FNR - start + 1 " lines (limit 80): " name
            }
            start = 0
        }
        END { end_file() }
        function end_file() {
            if (file ~ /\.[ch]$/ && last > 600) { print file ":" last ": file of " last " lines (limit 600)" }
        }
    '
    printf '%s\n' "$files" | tr '\n' '\0' | xargs -0 grep -LzP '\n\z|\A\z' | sed 's/$/: no newline at the end/')
if [ -n "$problems" ]; then
    printf '%s\n' "$problems" >&2
    exit 1
fi
echo "style: $(printf '%s\n' "$files" | wc -l) files are clean"
