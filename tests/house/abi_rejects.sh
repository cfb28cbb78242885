#!/bin/sh
# The check of the symbol list must see a name too many, one too few and another soname:
# abi_rejects.sh ABI.SH WORK CC NM.
set -eu

check=$1
work=$2
cc=$3
nm=$4
rm -rf "$work"
mkdir -p "$work"
cd "$work"

# make SONAME TEXT: libown.so of this C code.
make() {
    echo "$2" >own.c
    "$cc" -shared -fPIC "-Wl,-soname,$1" own.c -o libown.so
}

# expect STATUS TEXT: of the check, and what it says.
expect() {
    status=0
    "$check" "$nm" libown.so list >output 2>&1 || status=$?
    if [ $status -ne "$1" ] || ! grep -q -- "$2" output; then
        echo "abi_rejects: expected status $1 and '$2', got $status and:" >&2
        cat output >&2
        exit 1
    fi
}

printf 'libown.so.1 libown1 #MINVER#\n rlf_a@Base 0.1.0\n rlf_b@Base 0.2.0\n' >list
make libown.so.1 'int rlf_a(void) { return 0; } int rlf_b(void) { return 0; }'
expect 0 '2 names, as listed'
make libown.so.1 'int rlf_a(void) { return 0; } int rlf_b(void) { return 0; } int rlf_c;'
expect 1 '^ rlf_c@Base '
make libown.so.1 'int rlf_a(void) { return 0; }'
expect 1 'no longer shows rlf_b'
make libown.so.2 'int rlf_a(void) { return 0; } int rlf_b(void) { return 0; }'
expect 1 'is libown.so.2, but'
rm -rf "$work"
