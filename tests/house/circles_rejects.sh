#!/bin/sh
# The check against circles of files must see one, also around a third file, and nothing else; and
# see files that a header ties together.
# circles_rejects.sh CHECK WORK CC NM
set -eu
check=$1 work=$2 cc=$3 nm=$4
rm -rf "$work"
mkdir -p "$work/src"
cd "$work"

# compile NAME TEXT
compile() {
    printf '%b' "$2" >"src/$1.c"
    "$cc" -Isrc -c "src/$1.c" -o "src/$1.c.o"
}

# passes WHAT OBJECT...
passes() {
    what=$1
    shift
    if ! "$check" "$nm" . "$@"; then
        echo "rejected: $what"
        exit 1
    fi
}

# fails WHAT SAYS OBJECT...
fails() {
    what=$1 says=$2
    shift 2
    if output=$("$check" "$nm" . "$@" 2>&1); then
        echo "not seen: $what"
        exit 1
    fi
    case $output in
    *"$says"*) ;;
    *)
        echo "expected '$says' for $what, got: $output"
        exit 1
        ;;
    esac
}

compile a 'int b(void); int a(void); int a(void) { return b(); }'
compile b 'int c(void); int b(void); int b(void) { return c(); }'
compile c 'int c(void); int c(void) { return 1; }'
passes "a tree of files" src/a.c.o src/b.c.o src/c.c.o
compile c 'int a(void); int c(void); int c(void) { return a(); }'
fails "a circle of three files" "in a circle" src/a.c.o src/b.c.o src/c.c.o
fails "one file alone, which says nothing" "no calls" src/c.c.o

# Nine files that each need a type, from a header that has the functions of all of them.
objects=
doors=
for i in 1 2 3 4 5 6 7 8 9; do
    doors="${doors}int part_$i(item *i);\\n"
    objects="$objects src/part_$i.c.o"
done
printf 'typedef struct item { int n; } item;\n%b' "$doors" >src/all.h
for i in 1 2 3 4 5 6 7 8 9; do
    compile "part_$i" "#include \"all.h\"\nint part_$i(item *i) { return i->n; }\n"
done
compile main '#include "all.h"\nint main(void) { item i = {0}; return part_1(&i); }\n'
# shellcheck disable=SC2086
fails "types and doors in one header" "tie these 9 files" src/main.c.o $objects
# The types apart: what is left is a list of doors.
printf 'typedef struct item { int n; } item;\n' >src/item.h
printf '#include "item.h"\n%b' "$doors" >src/all.h
# shellcheck disable=SC2086
passes "a header of types and one of doors" src/main.c.o $objects
rm -rf "$work"
