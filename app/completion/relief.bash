# Completion for bash. The command itself tells what can stand behind the cursor.
# shellcheck shell=bash

# The files that go on from $1, in $COMPREPLY; with endings behind it only such, and folders.
_relief_files()
{
    local file ending
    compopt -o filenames 2>/dev/null
    while IFS= read -r file; do
        if [ $# -eq 1 ] || [ -d "$file" ]; then
            COMPREPLY+=("$file")
            continue
        fi
        for ending in "${@:2}"; do
            [[ $file != *"$ending" ]] || COMPREPLY+=("$file")
        done
    done < <(compgen -f -- "$1")
}

_relief()
{
    local words current value candidate endings
    COMPREPLY=()
    # Not COMP_WORDS: bash breaks those at "=" and ":". The x keeps an empty last word.
    read -ra words <<<"${COMP_LINE:0:COMP_POINT}x"
    current=${words[-1]%x}
    words[-1]=$current
    value=$current
    [[ $current != --*=* ]] || value=${current#*=}
    while IFS=$'\t' read -r candidate _; do
        case $candidate in
        :folders)
            compopt -o filenames 2>/dev/null
            mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -d -- "$value")
            ;;
        :files*)
            read -ra endings <<<"${candidate#:files}"
            _relief_files "$value" "${endings[@]}"
            ;;
        "$current"*) COMPREPLY+=("${candidate#"${current%"${current##*[=:]}"}"}") ;;
        esac
    done < <("${words[0]}" help --complete "${words[@]:1}" 2>/dev/null)
    [[ ${#COMPREPLY[@]} -ne 1 || ${COMPREPLY[0]} != *[=,] ]] || compopt -o nospace 2>/dev/null
}

complete -F _relief relief
