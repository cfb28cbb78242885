#!/bin/sh
# The C program in README is the one that the examples build and run: readme_code.sh ROOT.
set -eu
root=$1
shown=$(awk '/^```c$/ { on = 1; next } /^```$/ { on = 0 } on' "$root/README.md")
if [ -z "$shown" ] || [ "$shown" != "$(cat "$root/examples/first_program.c")" ]; then
    echo "README.md: its C program is not examples/first_program.c: copy it there" >&2
    exit 1
fi
