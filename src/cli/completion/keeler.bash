# Completion of keeler for bash: "keeler complete" prints the candidates.
_keeler() {
  local cur words cword
  _get_comp_words_by_ref -n =: cur words cword
  local program=${words[0]/#\~/$HOME} answer line
  mapfile -t answer < <("$program" complete "${words[@]:0:cword+1}" 2>/dev/null)
  # bash completes only the text after the last word break, and '=' is one.
  local before=
  [[ $cur == *=* && $COMP_WORDBREAKS == *=* ]] && before=${cur%=*}=
  for line in "${answer[@]:1}"; do
    line=${line%%$'\t'*}
    [[ $line == *= ]] && compopt -o nospace
    COMPREPLY+=("${line#"$before"}")
  done
  case ${answer[0]-} in
  files) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- "${cur##*=}") ;;
  folders) mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- "${cur##*=}") ;;
  *) return ;;
  esac
  compopt -o filenames
}
complete -F _keeler keeler
