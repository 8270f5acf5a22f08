#!/bin/bash
# new.sh KEELER SOURCE_DIR: shipped examples by name, copied to files and run directly.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
examples=$source_dir/examples
cd "$work" || exit 1

# Every folder with a scene is listed with its name and its first line.
accepts "list" new --list
cp "$work/out" "$work/list"
for folder in "$examples"/*/; do
  [ -e "$folder/scene.toml" ] || continue
  grep -qF "$(basename "$folder") " "$work/list" || fail "$(basename "$folder") is not listed"
  grep -qF "$(head -n 1 "$folder/scene.toml" | sed 's/^# *//')" "$work/list" || fail "$(basename "$folder") is not described"
done
[ "$(wc -l <"$work/list")" -eq "$(find "$examples" -mindepth 2 -maxdepth 2 -name scene.toml | wc -l)" ] || fail "the list: $(cat "$work/list")"
accepts "no name" new
cmp -s "$work/out" "$work/list" || fail "without a name: $(cat "$work/out")"

# The written files equal the shipped ones, tables included, and pass keeler check.
while read -r name _; do
  rm -rf own
  mkdir own
  accepts "$name" new "$name" -o "own/$name.toml"
  cmp -s "own/$name.toml" "$examples/$name/scene.toml" || fail "$name: another scene"
  for table in "$examples/$name"/*.csv; do
    [ -e "$table" ] || continue
    cmp -s "own/$(basename "$table")" "$table" || fail "$name: another $(basename "$table")"
  done
  [ "$(find own -type f | wc -l)" -eq "$(wc -l <out)" ] || fail "$name: printed $(cat out)"
done <"$work/list"

accepts "the default name" new two-body
for file in two-body.toml prograde.csv retrograde.csv; do
  [ -e "$file" ] || fail "two-body: no $file"
done
echo "mine" >prograde.csv
rm two-body.toml
refuses "a table that is there" "prograde.csv" new two-body
[ -e two-body.toml ] && fail "a refused example left its scene"
[ "$(cat prograde.csv)" = mine ] || fail "a table was replaced"
accepts "a table replaced" new two-body --force
cmp -s prograde.csv "$examples/two-body/prograde.csv" || fail "the table was not replaced"
refuses "a misspelt example" "did you mean 'moonlet'?" new monlet
refuses "no such example" "keeler new --list" new zzzzzz
refuses "list and a name" "excludes" new moonlet --list

# Scenes by name; a file with this name takes precedence.
short=(--set particles.count=60 --set 'box.size=[30,30]' --set time.end=0.002)
runs 0 check equilibrium
runs 0 run equilibrium "${short[@]}" -o by-name
runs 0 run "$examples/equilibrium/scene.toml" "${short[@]}" -o by-path
[ "$(state_hash by-name)" = "$(state_hash by-path)" ] || fail "the example by its name is another scene"
mkdir maxwell-string # as a run of the example may be named
runs 0 check maxwell-string
refuses "a misspelt scene" "did you mean 'equilibrium'?" check equilibrum
cp "$examples/quaoar/scene.toml" equilibrium
runs 0 check equilibrium --json
grep -qF "$(sed -nE 's/^title = (.*)/\1/p' equilibrium)" out || fail "the file did not come first: $(cat out)"
report
