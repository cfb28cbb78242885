#!/bin/sh
# The style check must see each of its faults: tests/house/style_rejects.sh STYLE_SH WORK_FOLDER.
set -eu

style=$1
work=$2

# expect WHY: the file in the work folder is rejected for WHY.
expect() {
    if output=$("$style" "$work" 2>&1); then
        echo "accepted, although: $1" >&2
        exit 1
    fi
    case $output in
    *"$1"*) ;;
    *)
        echo "expected '$1', got: $output" >&2
        exit 1
        ;;
    esac
}

rm -rf "$work"
mkdir -p "$work/src"
file=$work/src/a.c
printf 'int a;\n' >"$file"
"$style" "$work"
printf '\tint a;\n' >"$file"
expect "src/a.c:1: tab"
printf 'int a; \n' >"$file"
expect "blank at the end"
printf '#include "a.h"\n' >"$file"
expect 'include it as "module/file.h"'
printf 'int a;' >"$file"
expect "no newline at the end"
printf '/* %s: later */\n' "TO""DO" >"$file"
expect "mark of unfinished work"
awk 'BEGIN { for (i = 0; i < 101; i++) { printf "/" } print "" }' >"$file"
expect "longer than 100 columns"
awk 'BEGIN { print "void long_one(void)\n{"; for (i = 0; i < 79; i++) { print ";" } print "}" }' \
    >"$file"
expect "function of 82 lines"
awk 'BEGIN { for (i = 0; i < 601; i++) { print "/**/" } }' >"$file"
expect "file of 601 lines"
rm -rf "$work"
