#!/bin/bash
# check.sh KEELER SOURCE_DIR: `keeler check` accepts the examples, and answers each bad scene with exit code 2 and exactly
# one line on stderr that contains the expected words.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"

good=$source_dir/examples/a-ring-wakes/scene.toml

# bad NAME WORDS SED-COMMAND: the good scene, changed by the command, is refused
bad() {
  local scene=$work/scene.toml
  sed "$3" "$good" >"$scene"
  cmp -s "$scene" "$good" && fail "$1: the change does nothing"
  refuses "$1" "$2" check "$scene"
}

for scene in "$source_dir"/examples/*/scene.toml; do
  accepts "$scene" check "$scene"
  prints "$scene" "steps"
  accepts "$scene as JSON" check "$scene" --json
  for key in particle_count optical_depth surface_density lambda_cr_m toomre_q hill_parameter midplane_filling box_m \
    steps step_orbits kick_interval_orbits resting_contacts memory_mb estimated_s estimate contacts_per_particle_orbit grains_in_piles start_s drift_s gravity_s output_s notices doubts costs; do
    prints "$scene as JSON" "\"$key\":"
  done
done
accepts "what dominates" check "$good" --set gravity.kick_every=50 --json
prints "what dominates" '"dominates": "drift"'
accepts "what dominates, as text" check "$good" --set gravity.solver=tree --set time.step=1e-3 --set gravity.kick_every=1
prints "what dominates, as text" "  most of it                       gravity"
accepts "overrides before and after" check --set particles.count=500 "$good" --set 'box.size=[100, 100]'
prints "overrides before and after" "particles                          500"
accepts "a box of 4 lambda_cr" check "$good"
prints "a box of 4 lambda_cr" "note: the box is 4 lambda_cr long along the orbit: the viscosity of wakes goes with this length"
accepts "a quality" check "$good" --set quality=strict
prints "a quality" "gravity                            fft, requested rms force error 0.001"
prints "a quality" "from kick to kick                  0.002 orbits"
accepts "a long box" check "$good" --set 'box.size=[10,10000]' --set gravity.solver=tree
prints "a long box" 'times more in this box of 1 : 1000'
accepts "a long box, by fft" check "$good" --set 'box.size=[10,10000]' --set gravity.solver=fft
grep -q "times more" "$work/out" && fail "a long box, by fft: $(cat "$work/out")"
accepts "no rebound" check "$source_dir/examples/equilibrium/scene.toml" --set 'collisions.restitution={law="constant",value=0}' --json
prints "no rebound" '"a restitution of 0 makes the drift cost about'
accepts "34 particles" check --set particles.count=34 --set 'box.size=[100, 100]' "$good" --json
prints "34 particles" "34 particles are few: one measurement of the velocity dispersion scatters by 12 %"
accepts "defaults" check --defaults
prints "defaults" "particles.velocity_dispersion"
accepts "version" --version
prints "version" "keeler "
accepts "help" --help
accepts "help of check" check --help

bad "unknown key" 'scene.toml:12:1: unknown key particles.densty (no scene has it); did you mean "density"?' 's/^density/densty/'
bad "unknown table" 'did you mean "gravity"?' 's/\[gravity\]/[gravty]/'
bad "wrong type" 'particles.optical_depth is a string' 's/optical_depth = 0.5/optical_depth = "half"/'
bad "negative radius" 'particles.sizes.radius is -1.0' 's/radius = 1.0/radius = -1.0/'
bad "small box" 'is smaller than a particle' 's/size_in_wavelengths = .*/size = [1.5, 100]/'
bad "too dense" 'too dense' 's/optical_depth = 0.5/optical_depth = 5/'
bad "missing section" '[time] is missing' '/^\[time\]/,/^end/d'
bad "missing key" 'particles.density is missing' '/^density/d'
bad "contradiction" 'cannot be combined with' 's/^optical_depth.*/&\ncount = 5/'
bad "not TOML" 'not TOML' 's/^\[box\]/[box/'
refuses "binary" "not TOML" check "$keeler"
refuses "no file" "cannot be read (No such file or directory)" check "$work/absent.toml"
refuses "a folder" "cannot be read (Is a directory)" check "$work"
if [ "$(id -u)" -ne 0 ]; then # root may read everything
  cp "$good" "$work/locked.toml"
  chmod 000 "$work/locked.toml"
  refuses "unreadable file" "cannot be read (Permission denied)" check "$work/locked.toml"
fi
refuses "bad override" "--set gravity.solver=quantum: gravity.solver" check "$good" --set gravity.solver=quantum
refuses "override without a value" "not an override" check "$good" --set gravity
refuses "no scene" "check needs a scene" check
refuses "unknown command" "did you mean 'check'?" chekc
refuses "unknown option" "--wibble" check --wibble
refuses "unknown command with an option" "did you mean 'check'?" chekc "$good" --json
refuses "unknown command with --help" "did you mean 'check'?" chekc --help
refuses "a command without its part" "'keeler bench' needs a subcommand: drift, gravity, step" bench
refuses "misspelt word of an option" "did you mean 'csv'?" convert "$good" --to cvs
refuses "a grid for a scene" 'keeler sweep' check <(printf 'scene = "a.toml"\n')
refuses_with 4 "a scene for a snapshot" "is no snapshot" info "$good"
refuses "misspelt option" "did you mean '--defaults'?" check --defautls
refuses "misspelt option, and a missing one" "did you mean '--output'?" run "$good" --ouput x
refuses "misspelt part" "did you mean 'finders'?" study finderz

report
