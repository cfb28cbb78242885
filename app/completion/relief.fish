# Completion for fish. The command itself tells what can stand behind the cursor.
function __relief_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    set -l relief $words[1]
    set -e words[1]
    for line in ($relief help --complete $words "$current" 2>/dev/null)
        switch $line
            case ':folders*'
                __fish_complete_directories $current
            case ':files*'
                __fish_complete_path $current
            case '*'
                echo $line
        end
    end
end
complete -c relief -f -a '(__relief_complete)'
