#!/bin/sh
# Installs Relief's packages on a bare Debian, uses each of them, and removes them without a trace:
# try_packages.sh FOLDER, as root. It changes the machine: script/bare --deb runs it in a new one.
set -eu

folder=$1
cd /tmp
export DEBIAN_FRONTEND=noninteractive MANPAGER='cat'
names=$(for package in "$folder"/*.deb; do
    dpkg-deb -f "$package" Package
done)

say() {
    echo "try_packages: $1"
}

apt() {
    apt-get -q -y -o DPkg::Lock::Timeout=120 "$@" >apt.log 2>&1 || {
        tail -n 30 apt.log
        say "FAILED: apt-get $*"
        exit 1
    }
}

apt update
apt install --no-install-recommends man-db gcc libc6-dev pkg-config
apt install "$folder"/*.deb # with what they recommend
say "installed: $(echo "$names" | tr '\n' ' ')"

relief --version
relief --version | grep '^with: ' | grep -q 'window, panel, OpenGL'
relief run synthetic:room --headless --frames 30 --scene rain --pictures pictures
[ -s pictures/000000.png ]
relief run synthetic:room --headless --frames 2 --quiet --renderer gl --pictures gl
[ -s gl/000000.png ]
say "relief run: two renderers"
for page in relief relief-run relief-bench; do
    man $page | grep -q SYNOPSIS
done
say "man: $(man relief-run | wc -l) lines of relief-run(1)"
[ -f /usr/share/applications/io.github.relief_authors.relief.desktop ]
python3 -c 'import relief; s = relief.Pipeline("synthetic:room"); print("import relief:", relief.__version__)'

cp -r /root/relief/tests/house/consumer .
flags=$(pkg-config --cflags --libs relief_gl relief_io relief)
# shellcheck disable=SC2086 # words
cc -DWITH_IO -DWITH_GL consumer/consumer.c -o shared $flags
./shared
flags=$(pkg-config --static --cflags --libs relief)
# shellcheck disable=SC2086 # words
cc -static consumer/consumer.c -o static $flags
./static
say "a program in C, with shared libraries and with the archive"

# shellcheck disable=SC2086 # words
dpkg -L $names | sort -u >files
# shellcheck disable=SC2086 # words
apt purge $names
while read -r file; do
    [ ! -f "$file" ] || {
        say "FAILED: $file is left"
        exit 1
    }
done <files
# /var/cache/man is man-db's: pages that root has read.
left=$(find / -xdev -name '*relief*' -not -path '/root/*' -not -path '/tmp/*' -not -path '/proc/*' \
    -not -path '/var/cache/man/*')
[ -z "$left" ] || {
    echo "$left"
    say "FAILED: these are left"
    exit 1
}
say "removed: nothing is left of $(wc -l <files) files and folders"
