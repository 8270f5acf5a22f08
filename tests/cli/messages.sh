#!/bin/bash
# messages.sh KEELER SOURCE_DIR: every fault gives one line in Keeler's words, without texts of libraries and without control
# characters.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
libraries='json\.exception|type_error|parse_error|std::|filesystem error|H5[A-Z]|HDF5-DIAG|bad byte|doesn.t exist|unable to|toml::|toml\+\+|pybind|CLI::|basic_string|bad_alloc|length_error|vector|map::|stod|stoi|FFTW|[Cc]airo|what\(\)|terminate|fmt::|\[\]'

controls=$'[\x01-\x08\x0b-\x1f\x7f]'

where=$work # the working folder
gone=false  # it is removed before the program starts
code=0      # speaks sets it to the exit code

# speaks NAME ARGUMENT...: the program ends by itself, with success or not, and prints only Keeler's messages
speaks() {
  local name=$1 content
  shift
  code=0
  [ -d "$where" ] || mkdir -p "$where"
  (cd "$where" && { ! $gone || rmdir "$where"; } && exec timeout 20 "$keeler" "$@") >"$work/out" 2>"$work/err" </dev/null || code=$?
  [ "$code" -le 4 ] || fail "$name: exit $code: $(tail -n 3 "$work/err")"
  local LC_ALL=C # from here on, so that a character is a byte
  content "$work/err" || fail "$name: a NUL on stderr"
  [[ $content =~ $libraries ]] && fail "$name: $content"
  [ "$code" -eq 0 ] || one_line "$name" ""
  [[ ! $content =~ $controls ]] || fail "$name: control characters: $(cat -v "$work/err")"
  content "$work/out" && [[ ! $content =~ $controls ]] || [[ $content == ?PNG* ]] || # a picture may hold all
    fail "$name: control characters: $(cat -v "$work/out")"
}

# refused CODE NAME WORDS ARGUMENT...: as speaks, and the program ends with this code and prints the words
refused() {
  local expected=$1 name=$2 words=$3 content
  shift 3
  speaks "$name" "$@"
  [ "$code" -eq "$expected" ] || fail "$name: exit $code instead of $expected: $(cat "$work/err")"
  content "$work/err" || true # speaks has looked
  [[ $content == *"$words"* ]] || fail "$name: no '$words' in: $content"
}

cat >"$work/scene.toml" <<'END'
title = "Red \u001B[31m and \u0007 a bell"
[planet]
preset = "saturn-a-ring"
[box]
size = [30, 30]
[particles]
count = 60
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 5e-3
end = 0.04
[output]
series_every = 0.01
snapshot_every = 0.02
END
scene=$work/scene.toml
speaks "a scene with escape sequences" check "$scene"
speaks "a scene with escape sequences" run "$scene" -o "$work/run"
snapshot=$work/run/snap_000000.hdf
speaks "plots" render "$work/run" --series -o "$work/plots.svg"
/usr/bin/python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' "$work/plots.svg" || fail "plots are no XML"

# Names that are not UTF-8: everything works, and JSON stays valid.
odd=$work/$'caf\xe9\x1b[31m'
accepts "a folder of any name" run "$scene" -o "$odd" -q
grep -aq '"finished"' "$odd/log.jsonl" || fail "a run in a folder of any name did not end"
for words in "info $odd" "info $odd --json" "info --verify $odd" "info --verify $odd --json" "watch $odd" "analyze $odd" "analyze $odd --json" \
  "report $odd" "render $odd" "convert $odd --to csv" "info $odd/snap_000000.hdf" "info $odd/snap_000000.hdf --json" "resume $odd" \
  "check $odd/scene.toml" "check $odd/scene.toml --json" "convert $odd/absent --to csv" "tune $odd" "run $odd" \
  "generate $scene -o $odd.hdf" "new a-ring-wakes -o $odd.toml" "new $odd" "check $scene --set $odd=1" "$odd" "run --$odd"; do
  read -ra arguments <<<"$words"
  speaks "$(cat -v <<<"$words")" "${arguments[@]}"
  [[ $words != *--json ]] || /usr/bin/python3 -c 'import json, sys; json.load(open(sys.argv[1], encoding="utf-8"))' "$work/out" ||
    fail "$(cat -v <<<"$words"): no JSON"
done

# A scene is TOML, which is UTF-8: other bytes in scenes are refused at once.
refuses "a title" "title is 'a?', which is not UTF-8, and a scene must be; write it in UTF-8" check "$scene" --set $'title=a\xff'
refuses "a state of any name" "start.from is '$work/caf??[31m/snap_000000.hdf', which is not UTF-8, and a scene must be; rename the file or the folder" \
  run "$scene" --from "$odd/snap_000000.hdf" -o "$work/never"
[ -e "$work/never" ] && fail "a state of any name: a folder was made"

# Unexpected types in the JSON files of a run.
cp -r "$work/run" "$work/kept"
for json in '[]' '5' '"text"' '{}' '{"split": 3}' '{"split": {"drift_s": "x"}, "wall_s": []}' '{"finished": "yes", "state_hash": 7, "split": {}}' \
  '{"ns_per_particle_step": {"drift": "slow"}, "split": {}}' '{"threads": -1, "cpu_s": "x", "split": {}}'; do
  echo "$json" >"$work/run/summary.json"
  for command in report "info --verify" resume; do
    read -ra words <<<"$command"
    speaks "summary.json is $json, $command" "${words[@]}" "$work/run"
  done
done
echo '{"split": 3}' >"$work/run/summary.json"
refused 4 "a summary of another type" "summary.json' holds something else than Keeler writes there" report "$work/run"
cp "$work/kept/summary.json" "$work/run/summary.json"
for json in '{"event": 5}' '{"event": "started", "end_orbits": "x", "orbits": [], "time": 3, "particles": -1.5}' '[]' '{"event": "started", "particles": "many"}'; do
  echo "$json" >>"$work/run/log.jsonl"
  for command in watch info "info --json"; do
    read -ra words <<<"$command"
    speaks "log.jsonl has $json, $command" "${words[@]}" "$work/run"
  done
  tail -n 1 "$work/run/log.jsonl" >>"$work/lines"
  cp "$work/kept/log.jsonl" "$work/run/log.jsonl"
done
cat "$work/lines" >>"$work/run/log.jsonl" # a page takes seconds, so one is drawn for all of them
speaks "log.jsonl has other things, report" report "$work/run"
cp "$work/kept/log.jsonl" "$work/run/log.jsonl"
mkdir "$work/study"
for json in '{"study": 5}' '[]' '{"study": "kicks", "command": 7}'; do
  echo "$json" >"$work/study/study.json"
  speaks "study.json is $json, info" info "$work/study"
  speaks "study.json is $json, study" study kicks "$scene" -o "$work/study"
done

# Names of files that cannot be opened.
long=$work/$(printf 'n%.0s' {1..300})
ln -s loop "$work/loop"
where=$work/here
for name in "" "$long" "$work/loop"; do
  for command in check run info watch resume analyze report render "render --movie" sweep "info --verify" "convert --to csv" tune \
    "generate -o $work/never.hdf" "run $scene --from" "generate $scene -o $work/never.hdf --from-table" "run $scene -o" "tile $snapshot 2 1 -o" \
    "convert $snapshot --to csv -o" "render $snapshot -o" "analyze $snapshot --csv" "analyze $snapshot --profile" "report $work/run -o" \
    "new a-ring-wakes -o" "sweep $scene -o" "study kicks $scene -o" "bench step --from" "check $scene --set particles.sizes.file="; do
    read -ra words <<<"$command"
    if [[ $command == *= ]]; then
      words[-1]+=$name
    else
      words+=("$name")
    fi
    [[ $command == run || $command == "run $scene --from" ]] && words+=(-o "$work/never")
    speaks "$command '${name:0:60}'" "${words[@]}"
    rm -rf "$work/never" "$where"
  done
done

# A removed working folder.
gone=true
for words in "check $scene" "check scene.toml" "run $scene -o a" "new a-ring-wakes" "info ." "sweep grid.toml -o a" "convert $snapshot --to csv -o a" \
  "render $snapshot -o a.png" "generate $scene -o a.hdf" "analyze $snapshot --csv a.csv" "study kicks $scene -o a"; do
  read -ra arguments <<<"$words"
  speaks "in a folder that is gone, $words" "${arguments[@]}"
done
gone=false

# Damaged structures without a seal, and invalid values of options.
head -c -64 "$snapshot" >"$work/unsealed.hdf"
size=$(stat -c %s "$work/unsealed.hdf")
for ((k = 0; k < 12; k++)); do
  cp "$work/unsealed.hdf" "$work/damaged.hdf"
  printf '\xa5\x5a\xff' | dd of="$work/damaged.hdf" bs=1 seek=$((k < 8 ? 8 + 8 * k : k * size / 12)) conv=notrunc status=none
  speaks "damage $k" info "$work/damaged.hdf"
  [[ $k -lt 4 ]] && speaks "damage $k" generate "$scene" --from-table "$work/damaged.hdf" -o "$work/never.hdf" --force
done
for words in "run $scene -o $work/never --threads x" "run $scene -o $work/never --wall-time" "analyze $work/run --bins 1e99 --profile a" "analyze $work/run --since x" \
  "tile $snapshot 1.5 1 -o a" "tile $snapshot 99999999999999999999 1 -o a" "bench drift --count x" "bench drift --count -1" "bench gravity --count 1e400" \
  "render $snapshot --width 1e99" "generate $scene -o a --most-orbits x" "run --force=maybe $scene -o a" "run $scene -o a -o b" "info" "check $scene --set" \
  "check $scene --set a" "check $scene --set =" "check $scene --set time.end=1979-05-27" "check $scene --set time.end=inf" "check $scene --set time.end=[" \
  "sweep $scene -o a --jobs x" "study" "study finders -o a --count x" "run $scene -o $work/never --until" "resume $work/run --until x" "help nothing"; do
  read -ra arguments <<<"$words"
  speaks "$words" "${arguments[@]}"
done
for text in 'a = [' 'a = 1979-05-27' '= 1' 'a = "\q"' $'a = "\xff"' '[a]' $'[a]\n[a]' 'a = 99999999999999999999' 'title = 5' '[[planet]]' 'a.b = 1'; do
  echo "$text" >"$work/bad.toml"
  speaks "the scene $text" check "$work/bad.toml"
done
for limit in 60000 90000 150000 250000; do # kB of memory: too little for the libraries, or for the work
  (ulimit -v "$limit" && exec "$keeler" run "$scene" -o "$work/never" --force -q) 2>"$work/err" >/dev/null
  grep -aqE "$libraries" "$work/err" && fail "little memory: $(cat "$work/err")"
done
report
