#!/bin/sh
# Every relative link and picture in README.md, CHANGELOG.md and docs/*.md leads to a file:
# tests/docs/links.sh ROOT
set -eu

cd "$1"
links=$(grep -oHE '\]\([^)]+\)' README.md CHANGELOG.md docs/*.md lab/*.md |
    sed -E 's/^([^:]+):\]\((.*)\)$/\1 \2/; s/#.*$//' | grep -vE ' (https?:.*)?$')
missing=$(printf '%s\n' "$links" | while read -r document link; do
    if [ ! -e "$(dirname "$document")/$link" ]; then
        echo "$document: $link leads nowhere"
    fi
done)
if [ -n "$missing" ]; then
    printf '%s\n' "$missing" >&2
    exit 1
fi
echo "links: $(printf '%s\n' "$links" | wc -l) lead somewhere"
