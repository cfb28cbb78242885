#!/bin/sh
# The pages of the manual: one for each command, each option of --help in it, and no complaint of groff
# or mandoc: test_man.sh RELIEF FOLDER. Exit status 77: neither is here.
set -eu

relief=$1
folder=$2
fail()
{
    echo "man: $*" >&2
    exit 1
}

checkers=
for checker in groff mandoc; do
    ! command -v $checker >/dev/null 2>&1 || checkers="$checkers $checker"
done
[ -n "$checkers" ] || {
    echo "man: SKIPPED: neither groff nor mandoc on this machine"
    exit 77
}
count=0
for command in "" $("$relief" help --complete '' | cut -f 1 | grep -v '^-' | grep -vx help); do
    page=$folder/relief${command:+-$command}.1
    [ -s "$page" ] || fail "no page $page"
    for checker in $checkers; do
        case $checker in
        groff) found=$(groff -man -ww -Tutf8 -z "$page" 2>&1) || fail "groff: $page" ;;
        mandoc) found=$(mandoc -T lint "$page") || fail "mandoc: $found" ;;
        esac
        [ -z "$found" ] || fail "$checker: $found"
    done
    [ -z "$command" ] || "$relief" help "$command" | grep -o '^  --[a-z-]*' | while read -r option; do
        # Nothing but a part of it: troff writes each dash as "\-".
        grep -qF -- "\\fB$(echo "$option" | sed 's/-/\\-/g')\\fR" "$page" || fail "$page lacks $option"
    done
    count=$((count + 1))
done
[ $count -ge 8 ] || fail "only $count pages"
echo "man: $count pages, clean by$checkers"
