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
  /usr/bin/python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' "$folder/figures/$name.svg" || fail "$name.svg"
  [ -s "$folder/figures/$name.png" ] || fail "no $name.png"
done
grep -qx "certified" "$folder/figures/figure4.svg" || fail "figure4.svg does not name the finders"
grep -q 'src="[^d]' "$folder/report.html" && fail "the page needs other files"

refuses "a study of earlier versions" 'keeler study mesh' study gravity --count 100 -o "$work/gravity"

report
