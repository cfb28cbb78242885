#!/bin/sh
# Sentences are short: tests/docs/sentences.sh ROOT WORK. Exit status 1 when a document has longer
# ones than it may have, or when the count itself is wrong.
set -eu

root=$1
work=$2

rm -rf "$work"
mkdir -p "$work"
cat >"$work/sample.md" <<'END'
# A heading of many words does not count here

Five words are in this. The [second one](https://example.com/a) has `code --with words`: Then
comes one over two lines, e.g. of nine.

<!-- not run: a comment -->
```sh
echo this is code and not a sentence at all
```

* Two words
* an item that ends
| a cell of five words | 7 | another cell of six words (all) |
| --- | --- | --- |
END
counted=$("$root/script/sentences" "$work/sample.md" | awk 'NR == 2 { print $2, $3, $4 }')
if [ "$counted" != "6 5.7 9" ]; then
    echo "sentences: counts '$counted' in the sample instead of '6 5.7 9'" >&2
    exit 1
fi
for most in "5 9" "6 8"; do
    # shellcheck disable=SC2086 # two words
    if "$root/script/sentences" --most $most "$work/sample.md" >/dev/null; then
        echo "sentences: a bound that is exceeded does not fail" >&2
        exit 1
    fi
done
cd "$root"
exec script/sentences --most 18 45 README.md docs/guide.md docs/limits.md docs/formats.md \
    lab/measuring.md
