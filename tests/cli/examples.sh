#!/bin/bash
# examples.sh KEELER SOURCE_DIR: the commands in the READMEs of the examples, in the gallery, and the sweeps of
# examples/papers work. Runs are shortened to two steps, pictures have one sample a pixel, and clumped states are replaced by
# initial ones (clumped.sh tests clumping).
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
shopt -s extglob
ln -s "$source_dir/examples" "$work/examples"
cd "$work" || exit 1
# follow PAGE: runs the commands in its indented lines, except sweeps
follow() {
  local count=0 program command
  while read -r program command; do
    [ "$program" = keeler ] || { fail "$1: not a command of keeler: $program $command"; continue; }
    [[ $command == sweep* ]] && continue
    [[ $command == *--lit* ]] && "$keeler" occultation nothing --elevation 20 2>&1 | grep -q "without Embree" && continue
    [[ $command == run* ]] && command+=" --set time.end=0.002"
    command=${command/ --clumped/}
    command=${command/ --samples +([0-9])/ --samples 1}
    # shellcheck disable=SC2086 # several words
    runs 0 $command
    count=$((count + 1))
  done < <(sed -n 's/^    //p' "$1")
  [ "$count" -ge 2 ] || fail "$1: $count commands"
}
for scene in examples/*/scene.toml; do
  follow "${scene%/*}/README.md"
done
rm -r runs # the gallery has other runs of these names
follow "$source_dir/docs/gallery.md"

# The papers' sweeps: one seed, a few steps.
cp -r "$source_dir/examples" "$work/short"
for grid in "$work"/short/papers/*/grid.toml; do
  name=$(basename "${grid%/*}")
  sed -i '/^"time.end"/d; s/^seeds.*/seeds = [1]/; s/^since.*//' "$grid"
  if grep -q '^\[set\]' "$grid"; then
    sed -i 's/^\[set\].*/&\n"time.end" = 0.005/' "$grid"
  else
    printf '\n[set]\n"time.end" = 0.005\n' >>"$grid"
  fi
  runs 0 sweep "$grid" -o "$work/sweep-$name"
  grep -q "^## $name\$" "$source_dir/examples/papers/README.md" || fail "$name: no section in examples/papers/README.md"
done
for scene in "$work"/short/papers/*/scene.toml; do
  name=$(basename "${scene%/*}")
  runs 0 run "$scene" -o "$work/run-$name" --set time.end=0.004
  grep -q "^## $name\$" "$source_dir/examples/papers/README.md" || fail "$name: no section in examples/papers/README.md"
done
report
