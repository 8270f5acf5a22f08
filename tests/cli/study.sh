#!/bin/bash
# study.sh KEELER SOURCE_DIR: studies from start to report; the finder study is interrupted and continued.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
folder=$work/study

# Stopped once in the middle, then continued.
"$keeler" study finders --quick --count 100 -o "$folder" >"$work/out" 2>"$work/err" &
process=$!
until grep -q '"job":"audit' "$folder/measurements.jsonl" 2>/dev/null || ! kill -0 "$process" 2>/dev/null; do
  sleep 0.05
done
kill -TERM "$process"
code=0
wait "$process" || code=$?
[ "$code" -eq 75 ] || fail "a stopped study: exit $code: $(tail -n 3 "$work/err")"
grep -q "the same command continues from here" "$work/err" || fail "a stopped study does not say how to continue"
head -n 3 "$folder/measurements.jsonl" >"$work/kept"
refuses "another count" "another count (100)" study finders --quick --count 101 -o "$folder"
runs 0 study finders --quick --count 100 -o "$folder"
head -n 3 "$folder/measurements.jsonl" | cmp - "$work/kept" || fail "a continued study does measurements again"
for name in report.md report.html finders.csv finders.json figures; do
  prints "study" "$folder/$name"
  [ -e "$folder/$name" ] || fail "study: no $name"
done
mkdir "$work/full"
touch "$work/full/mine"
refuses "a folder with other things" "is not the folder of a study" study finders --quick -o "$work/full"

# Twelve finders, four states, three steps, two repeats.
expected=state,step_orbits,finder,repeat,cpu_s,calls,hits,missed,false_hits,late,misordered,evaluations,ns_per_call
[ "$(head -n 1 "$folder/finders.csv")" = "$expected" ] || fail "finders.csv begins: $(head -n 1 "$folder/finders.csv")"
[ "$(wc -l <"$folder/finders.csv")" -eq $((1 + 12 * 4 * 3 * 2)) ] || fail "rows: $(wc -l <"$folder/finders.csv")"
awk -F, '$3 == "certified" && $8 + $9 + $10 + $11 != 0 { wrong = 1 } END { exit wrong }' "$folder/finders.csv" ||
  fail "the certified finder missed something, or called something false or late"
awk -F, 'NR > 1 && !($5 > 0 && $6 > 0 && $13 > 0) { wrong = 1 } END { exit wrong }' "$folder/finders.csv" ||
  fail "a row without time or calls"
grep -q '"rows"' "$folder/finders.json" || fail "finders.json has no rows"
for words in "The paper's claims" "Errors of each finder" "Figure 4" "Does it pay to store the cubics?" \
  "Where is the best step" "Particles at different local times" "A conservative rejection" "Straight paths drift"; do
  grep -qF "$words" "$folder/report.md" || fail "the report has no '$words'"
done
grep -q "0 found by the scan alone, 0 by the certified finder alone" "$folder/report.md" ||
  fail "the truth is in doubt: $(grep 'dense scan' "$folder/report.md")"
for name in figure1 figure2 figure4 figure5 figure6 local-times; do
  python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' "$folder/figures/$name.svg" || fail "$name.svg"
  [ -s "$folder/figures/$name.png" ] || fail "no $name.png"
done
grep -qx "certified" "$folder/figures/figure4.svg" || fail "figure4.svg does not name the finders"
grep -q 'src="[^d]' "$folder/report.html" && fail "the page needs other files"

# The smallest gravity study.
folder=$work/gravity
small=(study gravity --count 100 --repeats 1 --orbits 0.01 --seeds 2 -o "$folder")
runs 0 "${small[@]}"
for name in report.md report.html gravity.csv gravity_runs.csv gravity.json; do
  prints "study gravity" "$folder/$name"
  [ -e "$folder/$name" ] || fail "study gravity: no $name"
done
expected=solver,settings,parameter,value,error_rms,error_p999,error_x,error_y,error_z,error_edge,edge_pull,net_force,ns_per_particle
[ "$(head -n 1 "$folder/gravity.csv")" = "$expected" ] || fail "gravity.csv begins: $(head -n 1 "$folder/gravity.csv")"
awk -F, 'NR > 1 && !($5 >= 0 && $5 < ($1 == "mesh" ? 1 : 0.1) && $13 > 0) { wrong = 1 } END { exit wrong || NR < 10 }' "$folder/gravity.csv" ||
  fail "gravity.csv: $(cat "$folder/gravity.csv")"
expected=solver,settings,kick_every,seed,dispersion_r_omega,collisions_per_particle_orbit,dissipation_r2_omega2
expected+=,wake_amplitude,wake_spacing,wake_pitch_degrees,energy_residual
[ "$(head -n 1 "$folder/gravity_runs.csv")" = "$expected" ] ||
  fail "gravity_runs.csv begins: $(head -n 1 "$folder/gravity_runs.csv")"
[ "$(wc -l <"$folder/gravity_runs.csv")" -eq $((1 + 7 * 2)) ] || fail "runs: $(cat "$folder/gravity_runs.csv")"
for words in "Error against cost" "The same physics" "Verdict" "Convergence" "Every setting" "opening_angle 0.6"; do
  grep -qF "$words" "$folder/report.md" || fail "the gravity report has no '$words'"
done
cp "$folder/measurements.jsonl" "$work/kept"
runs 0 "${small[@]}"
cmp "$work/kept" "$folder/measurements.jsonl" || fail "a finished gravity study does measurements again"
refuses "other repeats" "another repeats" study gravity --count 100 --repeats 2 --orbits 0.01 --seeds 2 -o "$folder"
refuses "one seed" "--seeds takes 2" study gravity --seeds 1 -o "$work/one"

report
