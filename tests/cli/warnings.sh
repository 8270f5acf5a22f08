#!/bin/bash
# warnings.sh KEELER SOURCE_DIR: the warnings of `keeler check` and of a run; neither prints ratios of zeros.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"

# A restitution without an equilibrium, and a box of a few diameters.
small_scene
elastic=(--set 'collisions.restitution={ law = "constant", value = 0.9 }')
accepts "elastic" check "$work/scene.toml" "${elastic[@]}"
prints "elastic" "note: the coefficient of restitution is 0.9 even in fast impacts: above "
prints "elastic" "Goldreich & Tremaine 1978"
accepts "frost" check "$work/scene.toml"
grep -q "fast impacts" "$work/out" && fail "frost: $(cat "$work/out")"
accepts "lengths in km" check "$work/scene.toml" --set 'box.size=[0.06, 0.06]' --set 'particles.sizes={ law = "equal", radius = 1e-3 }'
prints "lengths in km" "m from its mid-plane, and a box of 0.06 m is far too narrow for it; check the sizes (in m)"
grep -q "from its mid-plane" <("$keeler" check "$work/scene.toml") && fail "a warning for lengths in m"
accepts "short waves" check "$work/scene.toml" --set 'gravity={ solver = "axisymmetric", shortest_wavelength = 0.1 }'
prints "short waves" "note: gravity.shortest_wavelength is 0.1 m: waves shorter than some tens of particle radii (here 1 m)"
accepts "a narrow box" check "$work/scene.toml" --set 'box.size=[8, 50]' --set particles.count=30
prints "a narrow box" "note: the box spans 4 diameters of its largest body"
runs 0 generate "$work/scene.toml" "${elastic[@]}" -o "$work/elastic.hdf"
prints "generate" "note: the coefficient of restitution is 0.9"
runs 0 generate "$work/scene.toml" "${elastic[@]}" -o "$work/elastic.hdf" --force --quiet
grep -q "note:" "$work/out" "$work/err" && fail "generate --quiet: $(cat "$work/out" "$work/err")"
runs 0 run "$work/scene.toml" "${elastic[@]}" --set time.end=0.01 -o "$work/elastic"
grep -q '^keeler: note: the coefficient of restitution is 0.9' "$work/err" || fail "a run: $(cat "$work/err")"

# A passage of a satellite that the sheared cell cannot represent. With `every` the fourth passage of Lewis & Stewart's
# ringlet is the first such one; in the runs below a single passage is far from the time when the cell is upright.
ringlet=$source_dir/examples/papers/lewis-stewart-2011/scene.toml
accepts "one passage" check "$ringlet"
grep -q "the satellite's passage" "$work/out" && fail "one passage: $(cat "$work/out")"
accepts "passages" check "$ringlet" --set satellite.every=40.2 --set time.end=325
prints "passages" "note: the satellite's passage at orbit 124.6 moves particles at 0."
accepts "passages that end in time" check "$ringlet" --set satellite.every=40.2 --set time.end=124
grep -q "the satellite's passage" "$work/out" && fail "passages that end in time: $(cat "$work/out")"
accepts "a satellite that does not come" check "$ringlet" --set satellite.passage=1e6 --set time.end=0.3
prints "a satellite that does not come" "note: the satellite first passes at orbit 1000000, after the end of the run at orbit 0.3"
accepts "nor comes back" check "$ringlet" --set satellite.passage=-3 --set satellite.every=40.2 --set time.end=30
prints "nor comes back" "note: the satellite first passes at orbit 37.2, after the end of the run at orbit 30"
accepts "one that comes back" check "$ringlet" --set satellite.passage=-3 --set satellite.every=40.2 --set time.end=40
grep -q "first passes" "$work/out" && fail "one that comes back: $(cat "$work/out")"
far=(run "$ringlet" --set particles.optical_depth=1e-3 --set satellite.passage=1.5 --set satellite.downstream_time=100)
runs 0 "${far[@]}" --set time.end=0.4 -o "$work/before"
[ "$(grep -c "satellite's passage" "$work/err" "$work/out")" = "$work/err:0
$work/out:0" ] || fail "before a passage: $(cat "$work/err" "$work/out")"
runs 0 "${far[@]}" --set time.end=2 -o "$work/passage"
[ "$(grep -c "^keeler: note: the satellite's passage at orbit 1.5 moves particles at 1.1 of the speed" "$work/err")" -eq 2 ] ||
  fail "a passage, at the start and when it comes: $(cat "$work/err")"
prints "a passage" "note: the satellite's passage at orbit 1.5"
/usr/bin/python3 - "$work" <<'END' || fail "a passage in the files"
import json, sys
work = sys.argv[1]
log = [json.loads(line) for line in open(f"{work}/passage/log.jsonl")]
passages = [line for line in log if line["event"] == "satellite passage"]
assert len(passages) == 1 and passages[0]["orbits"] == 1.5 and 1.0 < passages[0]["drag"] < 1.2, passages
notes = json.load(open(f"{work}/passage/summary.json"))["notes"]
assert len(notes) == 1 and notes[0].startswith("the satellite's passage at orbit 1.5"), notes
assert json.load(open(f"{work}/before/summary.json"))["notes"] == []
END

# One particle, and two that never collide: no 0/0, and no error estimate from rounding.
for count in 1 2; do
  few=("$work/scene.toml" --set "particles.count=$count" --set output.series_every=0.05 --set output.stress_every=0.05)
  for more in "gravity.solver=tree" "gravity.solver=fft" "gravity.solver=direct" "collisions.friction.tangential_restitution=0.5"; do
    name="few-$count-${more%%.*}-${more##*=}"
    runs 0 run "${few[@]}" --set "$more" -o "$work/$name"
    cp "$work/out" "$work/printed"
    runs 0 analyze "$work/$name"
    cat "$work/printed" "$work/out" >"$work/all"
    runs 0 report "$work/$name"
    ratios='[^a-z]-?(nan|inf)([^a-z]|$)|omitted by the gravity solver'
    [ "$count" -eq 1 ] && ratios+='|energy balance +[-0-9]|error of gravity +[0-9]' # of two it may be right
    grep -qE "$ratios" "$work/all" && fail "$name: $(cat "$work/all")"
    grep -qiE '>-?(nan|inf)<' "$work/$name"/report.html && fail "$name: the report"
    runs 0 analyze "$work/$name" --json
    /usr/bin/python3 - "$work/out" "$work/$name/summary.json" "$count" <<'END' || fail "$name: $(cat "$work/out")"
import json, sys
def no_constant(name):
    raise ValueError(name)
analysis, summary = (json.load(open(file), parse_constant=no_constant) for file in sys.argv[1:3])
if sys.argv[3] == "1":
    assert analysis["energy_balance"] is None and summary["energy_balance"] is None and summary["force_error"] is None
END
  done
done

report
