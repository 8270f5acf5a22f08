#!/bin/bash
# demo.sh KEELER SOURCE_DIR DEMO_KEELER: the demo's program lists the commands of the whole one; those that it has do what
# they do there, and the others say in one line how to build it.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
whole=$keeler
keeler=$3
small_scene
sed -i 's/^end .*/end = 0.25/' "$work/scene.toml"

"$whole" --help >"$work/help" || fail "no help"
commands_in "$work/help" >"$work/expected"
accepts "help" --help
commands_in "$work/out" | diff "$work/expected" - || fail "the demo's program lists other commands"

sed -nE "s/^  ([a-z]+) +not in the demo's program$/\1/p" "$work/out" >"$work/left_out"
[ "$(wc -l <"$work/left_out")" -ge 8 ] || fail "left out is no more than $(cat "$work/left_out")"
while read -r command; do
  for words in "" "--help" "$work/scene.toml --seeds 3 -o $work/none"; do
    # shellcheck disable=SC2086 # several words
    refuses "$command" "'keeler $command' is not in the demo's program; the whole program, build/default/keeler, is made by" \
      "$command" $words
  done
  accepts "help $command" help "$command"
  prints "help $command" "not in the demo's program"
done <"$work/left_out"

"$whole" run "$work/scene.toml" -o "$work/a" >/dev/null || fail "no run"
accepts "run" run "$work/scene.toml" -o "$work/b" -q
same_bytes "run" /PartType1 "$work/a/snap_000001.hdf" "$work/b/snap_000001.hdf"
for command in analyze "render" "report" "help"; do
  grep -qxF "$command" "$work/left_out" && fail "the demo runs $command"
done
accepts "analyze" analyze "$work/b"
cp "$work/out" "$work/numbers"
"$whole" analyze "$work/a" | diff - "$work/numbers" || fail "analyze: other numbers"
accepts "a number" help toomre_q
prints "a number" "keeler analyze"
accepts "a label" help Toomre Q
prints "a label" "  toomre_q "
accepts "a part of a name" help viscosity
prints "a part of a name" "  collisional_viscosity_m2_s"
accepts "a key" help gravity.resting_contacts
prints "a key" "keys of a scene"
prints "a key" "gravity.resting_contacts "
accepts "a table" help collisions.friction
prints "a table" "collisions.friction.coefficient "
accepts "a word of keys and numbers" help density
prints "a word of keys and numbers" "particles.density "
prints "a word of keys and numbers" "  surface_density"
refuses "a key and more" "has no command 'gravity.solver'; \"keeler help\" lists" help gravity.solver x
refuses "nearly a table" "did you mean 'collisions.friction'?" help collisions.frictoin
refuses "nearly a key" "has no command 'gravity.resting_contact'; did you mean 'gravity.resting_contacts'?" help gravity.resting_contact
refuses "no number" "has no command 'viscos_ty'" help viscos_ty
refuses "no command" "has no command 'sweeep'; did you mean 'sweep'?" sweeep
report
