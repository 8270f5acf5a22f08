#!/bin/bash
# former_names.sh KEELER SOURCE_DIR: scenes, overrides and grids may use the former name of a key, with one note each; what
# the program writes has the present name.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
cp "$work/scene.toml" "$work/present.toml"
printf '[collisions]\nelastic_below_speed = 0.02\n' >>"$work/present.toml"
printf '[collisions]\nelastic_below = 0.02\n' >>"$work/scene.toml"
line=$(grep -n elastic_below "$work/scene.toml" | cut -d : -f 1)
renamed="'collisions.elastic_below' is now called 'collisions.elastic_below_speed'"

# noted NAME LOCATION: the last command's only note on a former name has this location
noted() {
  [ "$(grep -c 'is now called' "$work/err")" -eq 1 ] || fail "$1: not one note: $(cat "$work/err")"
  grep -qF "note: $2: $renamed" "$work/err" || fail "$1: $(cat "$work/err")"
}

runs 0 run "$work/present.toml" -o "$work/present" --set time.end=0.02
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.02
noted "a scene" "$work/scene.toml:$line:1"
grep -qx 'elastic_below_speed = 0.02' "$work/run/scene.toml" || fail "the resolved scene: $(cat "$work/run/scene.toml")"
[ "$(state_hash "$work/run")" = "$(state_hash "$work/present")" ] || fail "another state by the former name"
accepts "the resolved scene" check "$work/run/scene.toml"
runs 0 run "$work/present.toml" -o "$work/set" --set time.end=0.02 --set collisions.elastic_below=0.02
noted "an override" "--set collisions.elastic_below=0.02"

# A stored scene with former names, which no user can change.
sed -i 's/^elastic_below_speed/elastic_below/' "$work/run/scene.toml"
runs 0 resume "$work/run" --until 0.04
grep -q 'is now called' "$work/err" && fail "a stored scene: $(cat "$work/err")"

cp "$work/scene.toml" "$work/both.toml"
echo 'elastic_below_speed = 0.03' >>"$work/both.toml"
refuses "both names" "$work/both.toml:$((line + 1)):1: collisions.elastic_below cannot be combined with" check "$work/both.toml"

cat >"$work/grid.toml" <<'END'
scene = "present.toml"
[set]
"time.end" = 0.02
[[axis]]
key = "collisions.elastic_below"
values = [0.01, 0.02]
END
runs 0 sweep "$work/grid.toml" -o "$work/sweep"
noted "a grid" "$work/grid.toml:5:7"
sed -i 's/^"time.end".*/&\ncollisions.elastic_below_speed = 0.1/' "$work/grid.toml"
refuses "both names in a grid" "collisions.elastic_below is given twice" sweep "$work/grid.toml" -o "$work/none"

"$keeler" check --defaults >"$work/out"
grep -q 'elastic_below_speed' "$work/out" || fail "no present name: $(cat "$work/out")"
grep -qE 'elastic_below |upright_after' "$work/out" && fail "a former name: $(cat "$work/out")"

report
