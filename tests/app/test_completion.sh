#!/bin/sh
# What bash, zsh and fish offer behind the cursor: test_completion.sh RELIEF FILES WORK bash|zsh|fish.
# Exit status 77: no such shell here.
set -eu

relief=$1
files=$2
work=$3
shell=$4
command -v "$shell" >/dev/null 2>&1 || {
    echo "completion: SKIPPED: no $shell on this machine"
    exit 77
}
rm -rf "$work"
mkdir -p "$work/folder"
cd "$work"
: >"one.json"
: >"one.txt"
PATH=$(dirname "$relief"):$PATH
export PATH FILES="$files" HOME="$work"

# offered LINE: what the shell offers behind it, one a line. zsh has its completion functions only in
# a terminal, so what the file calls of them prints here.
# shellcheck disable=SC2016 # expands in those shells
offered()
{
    case $shell in
    bash) bash --norc -c '. "$FILES/relief.bash"; COMP_LINE=$1 COMP_POINT=${#1}; _relief
            printf "%s\n" "${COMPREPLY[@]}"' bash "$1" ;;
    fish) fish --no-config -c 'source $FILES/relief.fish; complete -C "$argv[1]"' "$1" | cut -f 1 ;;
    zsh) zsh -f -c '_describe() { print -rl -- "${(@P)4}" }
            _files() { [[ $1 != -/ ]] && print -l -- *(N); print -l -- */(N) }
            words=("${(@s: :)1}"); CURRENT=$#words; PREFIX=$words[CURRENT]
            . $FILES/_relief' zsh "$1" |
        sed "s/\\\\:/$(printf '\001')/g; s/:.*//; s/$(printf '\001')/:/g" |
        grep -F -e "${1##* }" ;;
    esac
}

# offers LINE WORD...: each is offered; with "!" before it, it is not.
offers()
{
    line=$1
    shift
    offered "$line" >offered.txt || :
    for word in "$@"; do
        is_there=yes
        grep -qxF -e "${word#!}" offered.txt || is_there=no
        if [ "${word#!}" = "$word" ] && [ $is_there = no ] ||
            { [ "${word#!}" != "$word" ] && [ $is_there = yes ]; }; then
            echo "completion: $shell: '$line': not right with $word:" >&2
            cat offered.txt >&2
            exit 1
        fi
    done
}

folder=folder
[ "$shell" = bash ] || folder=folder/
offers "relief " run record list help
offers "relief ru" run '!record'
offers "relief help e" export '!run'
offers "relief run --pro" --profile '!--renderer'
offers "relief run --profile " live thesis
offers "relief run x --occlusion th" thesis '!soft'
offers "relief run --view depth,no" depth,normals
offers "relief run --window full,mir" full,mirror
offers "relief list sc" scenes
offers "relief run --scene ra" rain '!stack'
offers "relief export x --what true_d" true_depth
offers "relief info --jso" --json
offers "relief run --log fo" "$folder" '!one.txt'
if [ "$shell" = bash ]; then # which breaks words at ":" and "=" and wants the rest alone
    offers "relief run synthetic:cr" crossing
    offers "relief run --window full,end=ho" hold
    offers "relief run --set fill=" on off
    offers "relief run --set fil" fill=
    offers "relief run --scene one" one.json '!one.txt'
    offers "relief info on" one.json one.txt
else
    offers "relief run synthetic:cr" synthetic:crossing
    offers "relief run --window full,end=ho" full,end=hold
    offers "relief run --set fill=" fill=on fill=off
    offers "relief run --set fil" fill=
    offers "relief info on" one.json
fi
# The rooms are those that `relief list sources` names.
"$relief" list sources | sed -n 's/^    NAME: //p' | tr -d , | tr ' ' '\n' | sed 's/^/synthetic:/' | sort >rooms.txt
"$relief" help --complete run '' | cut -f 1 | grep '^synthetic:' | sort | cmp - rooms.txt
echo "completion: $shell: as the tables say"
