#!/bin/sh
# The check against circles of files must see one, also around a third file, and nothing else.
# circles_rejects.sh CHECK WORK CC NM
set -eu
check=$1 work=$2 cc=$3 nm=$4
rm -rf "$work"
mkdir -p "$work"
cd "$work"

# compile NAME TEXT
compile() {
    echo "$2" >"$1.c"
    "$cc" -c "$1.c" -o "$1.o"
}

compile a 'int b(void); int a(void); int a(void) { return b(); }'
compile b 'int c(void); int b(void); int b(void) { return c(); }'
compile c 'int c(void); int c(void) { return 1; }'
if ! "$check" "$nm" a.o b.o c.o; then
    echo "a tree of files was rejected"
    exit 1
fi
compile c 'int a(void); int c(void); int c(void) { return a(); }'
if "$check" "$nm" a.o b.o c.o; then
    echo "a circle of three files was not seen"
    exit 1
fi
if "$check" "$nm" c.o; then
    echo "one file alone says nothing and passed"
    exit 1
fi
