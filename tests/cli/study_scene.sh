#!/bin/bash
# study_scene.sh KEELER SOURCE_DIR: the tables of a study of a user's scene do not depend on kills and stops; an unsuitable
# scene is refused in one line, before anything is written.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
small_scene
sed -i 's/^size = .*/size = [30, 30]/; s/^count = .*/count = 150/' "$work/scene.toml" # the studies run it often
kicks=(study kicks "$work/scene.toml" --quick --grow 0.3 --orbits 1.5)

# without_cost FILE: prints the table without the columns of processor time and memory, which differ between runs
without_cost() {
  awk -F, 'NR == 1 { for (k = 1; k <= NF; ++k) keep[k] = $k !~ /^(cpu_s|peak_memory)/ }
    { line = ""; for (k = 1; k <= NF; ++k) if (keep[k]) line = line "," $k; print line }' "$1"
}
same_tables() {
  local name
  for name in study.csv settings.csv; do
    cmp <(without_cost "$work/whole/$name") <(without_cost "$2/$name") || fail "$1: $name differs"
  done
}
# column NAME ROW FILE: prints one cell of a table
column() {
  awk -F, -v name="$1" -v row="$2" 'NR == 1 { for (k = 1; k <= NF; ++k) if ($k == name) column = k }
    NR == row { print $column }' "$3"
}
# study_until PATTERN FOLDER: starts the study and waits for a file of this name; sets $study
study_until() {
  "$keeler" "${kicks[@]}" -o "$2" --jobs 2 >"$work/out" 2>"$work/err" &
  study=$!
  until compgen -G "$2/$1" >/dev/null || ! kill -0 "$study" 2>/dev/null; do sleep 0.01; done
}

# Two seeds, two states, three settings.
runs 0 "${kicks[@]}" -o "$work/whole" --jobs 2
no_controls "study"
for name in report.md report.html study.csv settings.csv figures; do
  prints "study" "$work/whole/$name"
  [ -e "$work/whole/$name" ] || fail "no $name"
done
[ "$(wc -l <"$work/whole/study.csv")" -eq 9 ] || fail "study.csv: $(cut -c 1-100 "$work/whole/study.csv")"
[ "$(wc -l <"$work/whole/settings.csv")" -eq 5 ] || fail "settings.csv: $(cut -c 1-100 "$work/whole/settings.csv")"
[ "$(column reference 2 "$work/whole/settings.csv")" = true ] || fail "the shortest interval is not the reference"
[ "$(column kick_interval_orbits 4 "$work/whole/settings.csv")" = 0.008 ] || fail "no interval of 8/1000"
for words in "**Verdict**" "could not detect" "Cost and health" "kick-auto" "vertical transmission"; do
  grep -qF "$words" "$work/whole/report.md" || fail "the report has no '$words'"
done
grep -q 'src="[^d]' "$work/whole/report.html" && fail "the page needs other files"
grep -qx "kick-auto" "$work/whole/figures/pareto.svg" || fail "pareto.svg does not name a setting"
name=kick-0.008_seed-1
runs 0 run "$work/whole/scenes/$name.toml" -o "$work/by_hand"
same_state "by hand" "$work/whole/runs/$name" "$work/by_hand"

# Killed among the settings, stopped while the common states evolve: the same command continues.
study_until "runs/kick-*/checkpoint_*.h5" "$work/killed"
kill -9 "$study"
wait "$study" 2>/dev/null
[ -e "$work/killed/report.md" ] && fail "the study had ended before it was killed"
runs 0 "${kicks[@]}" -o "$work/killed"
same_tables "killed" "$work/killed"
study_until "runs/grow*/checkpoint_*.h5" "$work/stopped"
kill -TERM "$study"
code=0
wait "$study" || code=$?
[ "$code" -eq 75 ] || fail "TERM: exit $code: $(tail -n 3 "$work/err")"
grep -q "the same command continues from here" "$work/err" || fail "a stopped study does not say how to continue"
runs 0 "${kicks[@]}" -o "$work/stopped"
same_tables "stopped" "$work/stopped"

# Another study, other settings, other content.
refuses "another study" 'another study ("kicks")' study step "$work/scene.toml" --quick -o "$work/whole"
refuses "other seeds" "another seeds (2)" "${kicks[@]}" --seeds 3 -o "$work/whole"
refuses "another scene" "was made with particles.density = 600" "${kicks[@]}" --set particles.density=610.0 -o "$work/whole"
mkdir "$work/full"
touch "$work/full/mine"
refuses "other content" "is not the folder of a study" "${kicks[@]}" -o "$work/full"
refuses_with 4 "no folder can be made" "cannot make the folder" "${kicks[@]}" -o "$work/scene.toml/below"
printf 'scene = "scene.toml"\n' >"$work/grid.toml"
refuses "a sweep in a study" "holds no sweep" sweep "$work/grid.toml" -o "$work/whole"

# Unsuitable scenes.
small_scene
sed '/^\[gravity\]/,/^solver/d' "$work/scene.toml" >"$work/plain.toml"
none=$work/none
refuses "kicks without gravity" 'no self-gravity, so it has no kick interval; add [gravity]' study kicks "$work/plain.toml" -o "$none"
refuses "solvers without gravity" "no solver to study" study mesh "$work/plain.toml" -o "$none"
refuses "one size" "one size, 1 m" study sizes "$work/scene.toml" -o "$none"
refuses "a snapshot" "starts from a snapshot" study step "$work/scene.toml" -o "$none" \
  --set "start.from=$work/by_hand/snap_000000.hdf"
refuses "one seed" "--seeds takes 2" study step "$work/scene.toml" -o "$none" --seeds 1
refuses "too short" "give 1.5 or more" study step "$work/scene.toml" -o "$none" --orbits 1
refuses "a wrong key" "unknown key" study step "$work/scene.toml" -o "$none" --set time.stop=1
[ -e "$none" ] && fail "a refused study wrote something"

# The smallest studies of the other kinds.
short=(--quick --grow 0.1 --orbits 1.5)
runs 0 study mesh "$work/scene.toml" -o "$work/mesh" "${short[@]}"
for number in force_error kick_ns_per_particle; do
  [ "$(column $number 2 "$work/mesh/settings.csv")" != "" ] || fail "no $number"
done
grep -qF "a kick (ns per particle)" "$work/mesh/report.md" || fail "the report does not tell what a kick costs"
grep -q kick_ns "$work/whole/study.csv" && fail "a study of kicks has the columns of a study of solvers"
runs 0 study step "$work/plain.toml" -o "$work/step" "${short[@]}"
damaged=("$work"/step/runs/step-*_seed-1)
sed -i 's/.*/x/' "${damaged[0]}/series.csv"
rm "$work/step/report.md" "$work/step/figures/pareto.png"
mkdir "$work/step/figures/pareto.png"
runs 4 study step "$work/plain.toml" -o "$work/step" "${short[@]}" -q
one_line "a figure that fails" "'$work/step/figures/pareto.png'"
rmdir "$work/step/figures/pareto.png"
[ -s "$work/step/report.md" ] || fail "a figure that fails: no report"
runs 1 study step "$work/plain.toml" -o "$work/step" "${short[@]}" -q
one_line "a damaged run" "a run is missing, the report has the reasons; remove the damaged files from '$work/step/runs'"
grep -q "^$(basename "${damaged[0]}"),.*,failed,.*series.csv" "$work/step/study.csv" || fail "a damaged run: $(cut -c 1-200 "$work/step/study.csv")"
runs 0 study box "$work/plain.toml" -o "$work/box" "${short[@]}"
grep -q "no common state" "$work/box/report.md" || fail "the report does not say that boxes have no common state"
runs 0 study sizes "$work/plain.toml" -o "$work/sizes" "${short[@]}" \
  --set 'particles.sizes={ law = "power", exponent = 3, min = 0.5, max = 2 }'
[ "$(column setting 4 "$work/sizes/settings.csv")" = equal ] || fail "sizes: $(cut -c 1-80 "$work/sizes/settings.csv")"

report
