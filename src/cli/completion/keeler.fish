# Completion of keeler for fish: "keeler complete" prints the candidates.
function __keeler_complete
    set -l words (commandline --tokenize --cut-at-cursor --current-process) (commandline --current-token --cut-at-cursor)
    set -l answer ($words[1] complete $words 2>/dev/null)
    for line in $answer[2..-1]
        echo $line
    end
    switch $answer[1]
        case files
            __fish_complete_path $words[-1]
        case folders
            __fish_complete_directories $words[-1] ''
    end
end
complete --command keeler --no-files --arguments '(__keeler_complete)'
