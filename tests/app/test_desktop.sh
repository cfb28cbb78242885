#!/bin/sh
# What a desktop shows of Relief fits together and is valid: test_desktop.sh FOLDER. Exit status 77: a
# tool that says so is not here.
set -eu

cd "$1"
fail()
{
    echo "desktop: $*" >&2
    exit 1
}

id=$(sed -n 's,.*<id>\(.*\)</id>.*,\1,p' ./*.metainfo.xml)
[ -f "$id.metainfo.xml" ] || fail "the component is $id, but its file is not called so"
[ -f "$id.desktop" ] || fail "no $id.desktop"
grep -qF ">$id.desktop<" "$id.metainfo.xml" || fail "$id.metainfo.xml does not start $id.desktop"
icon=$(sed -n 's/^Icon=//p' "$id.desktop")
[ -f "$icon.svg" ] || fail "no $icon.svg"
for tool in desktop-file-validate appstreamcli; do
    command -v $tool >/dev/null 2>&1 || {
        echo "desktop: SKIPPED: no $tool on this machine"
        exit 77
    }
done
found=$(desktop-file-validate "$id.desktop" 2>&1) || fail "$found"
[ -z "$found" ] || fail "$found"
appstreamcli validate --no-net "$id.metainfo.xml" || fail "appstreamcli (above)"
