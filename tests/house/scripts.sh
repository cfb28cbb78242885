#!/bin/sh
# Every script parses as POSIX sh, tells its usage with --help, and refuses an option it does not
# know with status 2: tests/house/scripts.sh ROOT. Run from elsewhere, as a user might.
set -eu

root=$1
cd /
for script in "$root"/script/* "$root"/.ci/run "$root"/tests/house/*.sh; do
    sh -n "$script"
    [ -x "$script" ] || {
        echo "$script: not executable" >&2
        exit 1
    }
done
for name in bootstrap demo deb docs bare test bench portable peers report format lines silhouettes thresholds sentences figures web film; do
    "$root/script/$name" --help | grep -q '^usage: script/'"$name" || {
        echo "script/$name --help: no usage line" >&2
        exit 1
    }
done
for name in bootstrap deb bare bench portable docs peers report format lines silhouettes thresholds sentences figures web film; do
    status=0
    "$root/script/$name" --no-such-option >/dev/null 2>&1 || status=$?
    if [ "$status" -ne 2 ]; then
        echo "script/$name --no-such-option: status $status instead of 2" >&2
        exit 1
    fi
done
"$root/script/bootstrap" --list | grep -qx cmake
"$root/script/bootstrap" --list | grep -qx libglfw3-dev
"$root/script/bootstrap" --list | grep -qx libimgui-dev # the panel is in the default window
"$root/script/bootstrap" --small --list | grep -qx libpng-dev
"$root/script/bootstrap" --packages --list | grep -qx debhelper
"$root/script/bootstrap" --web --list | grep -qx wasi-libc
if "$root/script/bootstrap" --small --list | grep -q 'gl\|av\|cmocka\|++'; then
    echo "scripts: bootstrap --small installs what a window, MP4, models or tests need" >&2
    exit 1
fi
if command -v shellcheck >/dev/null 2>&1; then
    shellcheck "$root"/script/* "$root"/.ci/run "$root"/tests/house/*.sh "$root"/app/man/pages.sh \
        "$root"/app/completion/relief.bash
else
    echo "scripts: shellcheck is not here: only parsed"
fi
echo "scripts: clean"
