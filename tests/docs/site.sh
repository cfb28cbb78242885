#!/bin/sh
# The site of the documents can be made, and what is wrong with it is noticed: tests/docs/site.sh
# ROOT WORK. Exit status 77, and a line that says so, without doxygen or python3-markdown.
set -eu

root=$1
work=$2

if ! command -v doxygen >/dev/null || ! /usr/bin/python3 -c "import markdown" 2>/dev/null; then
    echo "site: SKIPPED: needs doxygen and python3-markdown"
    exit 77
fi
rm -rf "$work"
mkdir -p "$work"
"$root/script/docs" --out "$work/site"
for page in index.html guide.html python.html reference/structrlf__hand.html examples/cast_ray.c.html index.js; do
    [ -s "$work/site/$page" ] || {
        echo "site: no $page" >&2
        exit 1
    }
done
if grep -rlE '(href|src)="(/|file:|https?://[^"]*\.(js|css))' "$work/site" --include='*.html' | grep .; then
    echo "site: these pages need a server or a network" >&2
    exit 1
fi

# A copy with a link and an anchor that lead nowhere, a page without a place, and a member that says
# nothing.
mkdir "$work/broken"
for entry in "$root"/*; do
    case $(basename "$entry") in
    build | docs | include | script) ;;
    *) ln -s "$entry" "$work/broken/" ;;
    esac
done
cp -R "$root/docs" "$root/include" "$root/script" "$work/broken/"
printf '\n[a](nowhere.md) [b](python.md#no-such-heading)\n' >>"$work/broken/docs/hands.md"
echo '# Lost' >"$work/broken/docs/lost.md"
sed -i 's|^#ifdef __cplusplus$|int rlf_says_nothing(int what);\n&|' "$work/broken/include/relief/hands.h"
if "$work/broken/script/docs" --out "$work/broken_site" >"$work/output" 2>&1; then
    echo "site: a broken copy was not noticed" >&2
    exit 1
fi
for words in "hands.html: nowhere.md leads nowhere" "docs/lost.md: no place" "rlf_says_nothing" \
    "hands.html: python.html#no-such-heading leads nowhere"; do
    grep -q "$words" "$work/output" || {
        cat "$work/output" >&2
        echo "site: does not say: $words" >&2
        exit 1
    }
done
