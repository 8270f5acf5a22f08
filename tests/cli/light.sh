#!/bin/bash
# light.sh KEELER SOURCE_DIR: photometry, occultation and render --lit from outside: tables, figures, bad input, stops. A Keeler
# without Embree says what is missing.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
runs 0 run "$work/scene.toml" -o "$work/run" --set time.end=0.02 --set output.snapshot_every=0.01
snap=$work/run/snap_000000.hdf

if "$keeler" photometry "$snap" --elevation 20 2>&1 | grep -q "without Embree"; then
  refuses_with 1 "photometry without Embree" "libembree-dev" photometry "$snap" --elevation 20
  refuses_with 1 "occultation without Embree" "libembree-dev" occultation "$snap" --elevation 20
  refuses_with 1 "a lit picture without Embree" "libembree-dev" render "$snap" --lit -o "$work/lit.png"
  report
  exit
fi

accepts "photometry" photometry "$work/run" --since 0 --elevation 20,-30 --sun-elevation 15 --phase 60 --azimuth 0,40 --rays 8192 --json --threads 1
cp "$work/out" "$work/one.json"
accepts "photometry on two threads" photometry "$work/run" --since 0 --elevation 20,-30 --sun-elevation 15 --phase 60 --azimuth 0,40 --rays 8192 --json --threads 2
cmp -s "$work/out" "$work/one.json" || fail "photometry: other numbers on two threads"
/usr/bin/python3 - "$work/one.json" <<'EOF' || fail "photometry: the JSON is not as it says"
import json, math, sys
found = json.load(open(sys.argv[1]))
assert found["law"] == "callisto" and found["snapshots"] == 3 and not found["stopped"]
assert [s["observer_elevation_degrees"] for s in found["sights"]] == [20, 20, -30, -30]
for s in found["sights"]:
    assert abs(s["phase_degrees"] - 60) < 1e-6 and s["rays"] == 8192
    assert abs(s["reflectance"] - s["single_scattering"] - s["multiple_scattering"]) < 1e-12
    assert 0 < s["reflectance_error"] < s["reflectance"] and 0 < s["transmission"] < 1
assert (found["since_orbit"], found["until_orbit"]) == (0, 0.02)
assert len(found["azimuthal_asymmetry"]) == 2 and found["azimuthal_asymmetry"][0]["asymmetry"] is None
EOF
accepts "a table" photometry "$snap" --elevation 20 --rays 8192 --csv "$work/table.csv" --figure "$work/figure.svg"
[ "$(wc -l <"$work/table.csv")" -eq 19 ] || fail "the table has not 18 rows"
head -1 "$work/table.csv" | grep -q "reflectance,.*reflectance_error" || fail "the table has other columns"
prints "asymmetry" "darkest at the longitudes"
grep -q "<svg" "$work/figure.svg" || fail "no figure"
accepts "an error" photometry "$snap" --elevation 20 --azimuth 0 --error 0.02 --law lambert --albedo 1 --json
printf 'elevation longitude sun_elevation phase\n10 250 10 6\n# a comment\n-20 90 20 60\n' >"$work/seen.txt"
accepts "observations" photometry "$snap" --observations "$work/seen.txt" --rays 100 --json
grep -q '"ring_longitude_degrees": 250' "$work/out" || fail "observations: not at longitude 250: $(cat "$work/out")"
accepts "a published geometry" photometry "$snap" --geometry hubble-tilt --azimuth 0 --rays 100
accepts "other laws" photometry "$snap" --elevation 20 --azimuth 0 --law henyey_greenstein=-0.3 --rays 100

accepts "a figure of one point" photometry "$snap" --elevation 20 --azimuth 0 --rays 100 --figure "$work/point.svg"
grep -q "<svg" "$work/point.svg" || fail "no figure of one point"
runs 0 photometry "$work/run" --since 0.01 --elevation 20 --azimuth 0,40 --rays 100 --law lambert -v
grep -qF "2 snapshots of the orbits 0.01 to 0.02 at 2 sights, law lambert, albedo 0.5: 100 rays per sight and snapshot" "$work/err" || fail "what it does: $(cat "$work/err")"
runs 0 occultation "$snap" --elevation 90 --tracks 4
grep -qF "an azimuth has no meaning" "$work/err" || fail "a star overhead: $(cat "$work/err")"
refuses_with 4 "photometry of a checkpoint" "is not a Keeler snapshot but a checkpoint" photometry "$(newest_checkpoint "$work/run")" --elevation 20
refuses "no sight" "give --elevation, --observations or --geometry" photometry "$snap"
refuses "a ray in the plane" "is not an elevation" photometry "$snap" --elevation 0
refuses "an impossible phase" "the phase angle is from 10 to 150 degrees, not 3" photometry "$snap" --elevation 20 --sun-elevation 10 --phase 3
refuses "another law" "did you mean 'lambert'?" photometry "$snap" --elevation 20 --law lambret
refuses "a law out of range" "give a number from" photometry "$snap" --elevation 20 --law henyey_greenstein=2
refuses "rays and an error" "excludes" photometry "$snap" --elevation 20 --rays 5 --error 0.1
printf 'elevation,longitude,sun_elevation,phase\n10,250,10,6\n10,250,30,6\n' >"$work/bad.csv"
refuses "an impossible observation" "bad.csv:3: with the observer" photometry "$snap" --observations "$work/bad.csv"
printf 'elevation,azimuth,longitude,sun_elevation,phase\n10,250,250,10,6\n' >"$work/bad.csv"
refuses "two directions" "bad.csv:1: of the columns 'azimuth' and 'longitude' each determines the other" photometry "$snap" --observations "$work/bad.csv"
refuses "two directions of a star" "bad.csv:1: of the columns 'azimuth' and 'longitude' each determines the other" occultation "$snap" --observations "$work/bad.csv"
printf 'elevation,azimuth,transmission,normal_optical_depth\n10,250,0.5,3\n' >"$work/bad.csv"
refuses "two depths" "bad.csv:1: of the columns 'transmission' and 'normal_optical_depth' each" occultation "$snap" --observations "$work/bad.csv"
printf 'elevation,phase\n10,6\n' >"$work/bad.csv"
refuses "a missing column" "bad.csv:1: there is no column 'sun_elevation'" photometry "$snap" --observations "$work/bad.csv"
refuses "a figure of another kind" "give it one of these endings" photometry "$snap" --elevation 20 --figure "$work/a.jpg"

accepts "occultation" occultation "$work/run" --since 0 --elevation 10,30 --azimuth 0,60,120 --tracks 20 --json
/usr/bin/python3 - "$work/out" <<'EOF' || fail "occultation: the JSON is not as it says"
import json, sys
found = json.load(open(sys.argv[1]))
assert len(found["lines_of_sight"]) == 6 and not found["stopped"]
assert (found["snapshots"], found["since_orbit"], found["until_orbit"]) == (3, 0, 0.02)
for s in found["lines_of_sight"]:
    assert len(s["autocovariance"]) == 33 and abs(s["autocovariance"][0] - s["excess_variance"]) < 1e-15
    assert 0 < s["transmission"] < 1 and s["effective_radius_m"] > 0
assert found["wake_model"]["gap_to_width"] > 0
EOF
printf 'elevation,longitude,normal_optical_depth\n10,0,0.4\n30,60,0.5\n20,100,0.45\n40,10,0.5\n60,50,0.5\n' >"$work/uvis.csv"
cp -r "$work/run" "$work/cut"
truncate -s 1000 "$work/cut/snap_000000.hdf"
accepts "a part behind a damaged snapshot" occultation "$work/cut" --since 0.01 --elevation 30 --azimuth 60 --tracks 5 --json
refuses_with 4 "a part with a damaged snapshot" "snap_000000.hdf" occultation "$work/cut" --since 0 --elevation 30 --azimuth 60 --tracks 5 --json
accepts "occultations beside observed ones" occultation "$snap" --observations "$work/uvis.csv" --section ellipse --tracks 20
prints "the observed wakes" "wakes observed: H/W"
refuses "no line of sight" "give --elevation or --observations" occultation "$snap"
printf 'elevation,longitude,transmission\n10,0,1.4\n' >"$work/bad.csv"
refuses "a transmission above 1" "bad.csv:2: the transmission 1.4 is not from 0 to 1" occultation "$snap" --observations "$work/bad.csv"

accepts "a lit picture" render "$snap" --lit --width 300 --samples 1 -o "$work/lit.png"
accepts "the unlit face" render "$snap" --lit --elevation -20 --sun-elevation 20 --width 300 --samples 1 --law callisto -o "$work/dark.png"
cmp -s "$work/lit.png" "$work/dark.png" && fail "both faces look alike"
accepts "a lit movie" render "$work/run" --lit --width 300 --samples 1 --movie -o "$work/lit.mp4"
refuses "light without --lit" "equires" render "$snap" --phase 20 -o "$work/b.png"
refuses "a lit density" "excludes" render "$snap" --lit --colour density -o "$work/b.png"

# A stop gives what is done.
"$keeler" photometry "$snap" --elevation 20 --azimuth 0,1,2,3 --rays 1000000000 --json >"$work/out" 2>"$work/err" &
child=$!
sleep 1.5
kill -INT $child
code=0
wait $child || code=$?
[ "$code" -eq 75 ] || fail "a stop: exit $code"
grep -q '"stopped": true' "$work/out" || fail "a stop: $(cat "$work/out")"
grep -q "stopped (on request) with 1 of 4 sights" "$work/err" || fail "a stop: $(cat "$work/err")"
"$keeler" occultation "$snap" --elevation 20 --azimuth 0,1,2,3 --tracks 300 --samples 100000 --json >"$work/out" 2>"$work/err" &
child=$!
sleep 1.5
kill -INT $child
code=0
wait $child || code=$?
if [ "$code" -eq 75 ]; then
  grep -q '"stopped": true' "$work/out" || fail "a stop of an occultation: $(cat "$work/out")"
else # where not one line was done
  [ "$code" -eq 1 ] || fail "a stop of an occultation: exit $code"
  grep -q "stopped before a line of sight was traced" "$work/err" || fail "a stop of an occultation: $(cat "$work/err")"
fi

runs 0 bench light --count 2400 --state uniform --repeats 1 --elevation 40
prints "bench light" "Embree alone, packets of 16"
runs 0 bench light --from "$snap" --repeats 1 --json
/usr/bin/python3 - "$work/out" <<'EOF' || fail "bench light: the JSON is not as it says"
import json, sys
found = json.load(open(sys.argv[1]))
assert found["paths_per_s"] > 0 and found["count"] > 0 and found["one_percent_s"] > 0 and "snap_000000" in found["from"]
EOF
refuses "a state for a snapshot" "--state" bench light --state uniform --from "$snap"
report
