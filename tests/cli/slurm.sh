#!/bin/bash
# slurm.sh KEELER SOURCE_DIR: the batch script of examples/slurm, with stand-ins for mpirun and Slurm: a run is stopped by its
# wall time, its task is requeued until it is finished, and the result is that of a run without a break.
# shellcheck source=tests/cli/helpers.sh
source "$(dirname "$0")/helpers.sh"
script=$source_dir/examples/slurm/runs.sh
cat >"$work/scene.toml" <<END
title = "A run of a job array"
[planet]
preset = "saturn-a-ring"
[box]
size = [50, 50] # m
[particles]
count = 400
density = 600.0
sizes = { law = "equal", radius = 1.0 }
[time]
step = 2e-3
end = 20.0
[output]
snapshot_every = 5.0
checkpoint_every = 0.5
END

mkdir "$work/bin"
# mpirun: notes its own options, and runs the program once. While there is a file `interrupts` the run is stopped at its next
# checkpoint, as by its wall time
cat >"$work/bin/mpirun" <<END
#!/bin/bash
echo "\$*" >>"$work/launched"
while [ "\$1" != keeler-mpi ]; do shift; done
shift
before=\$(ls "$work"/runs/*/checkpoint_* 2>/dev/null)
"$keeler" "\$@" &
while [ -e "$work/interrupts" ] && kill -0 \$! 2>/dev/null; do
  [ "\$(ls "$work"/runs/*/checkpoint_*.h5 2>/dev/null)" = "\$before" ] || { kill -USR1 \$!; break; }
  sleep 0.01
done
wait \$!
END
printf '#!/bin/bash\necho "$*" >>"%s/requeued"\n' "$work" >"$work/bin/scontrol"
chmod +x "$work/bin"/*

# task CODE: runs the script as Slurm does, from a copy elsewhere
task() {
  local code=0
  cp "$script" "$work/slurm_script"
  (cd "$work" && env PATH="$work/bin:$PATH" SLURM_JOB_ID=17 SLURM_ARRAY_TASK_ID=3 SLURM_NTASKS=2 SLURM_CPUS_PER_TASK=1 \
    bash slurm_script scene.toml runs >"$work/out" 2>"$work/err") || code=$?
  [ "$code" -eq "$1" ] || fail "exit $code instead of $1: $(tail -n 3 "$work/err")"
}

touch "$work/interrupts"
task 75
task 75
rm "$work/interrupts"
[ "$(wc -l <"$work/requeued")" -eq 2 ] || fail "requeued: $(cat "$work/requeued")"
grep -qx 'requeue 17' "$work/requeued" || fail "requeued: $(cat "$work/requeued")"
task 0
[ "$(wc -l <"$work/requeued")" -eq 2 ] || fail "a finished run was requeued"
grep -q '"finished": true' "$work/runs/seed-3/summary.json" || fail "not finished"
[ "$(grep -c 'keeler-mpi run' "$work/launched")-$(grep -c 'keeler-mpi resume' "$work/launched")" = 1-2 ] ||
  fail "launched: $(cat "$work/launched")"
grep -q -- '-n 2 --map-by slot:PE=1' "$work/launched" || fail "launched: $(cat "$work/launched")"
grep -q -- '--wall-time 42600$' "$work/launched" || fail "launched: $(cat "$work/launched")"
runs 0 run "$work/scene.toml" -o "$work/whole" --set particles.seed=3
same_state "a job array's run" "$work/whole" "$work/runs/seed-3"
same_series "a job array's run" "$work/whole" "$work/runs/seed-3"

# A node that failed before the first checkpoint left a folder; a scene that is wrong ends the task, and is not requeued.
rm "$work/requeued"
rm "$work/runs/seed-3"/checkpoint_*
touch "$work/interrupts"
task 75
rm "$work/requeued"
rm -r "$work/runs"
sed -i 's/count = 400/count = -1/' "$work/scene.toml"
task 2
[ ! -e "$work/requeued" ] || fail "a scene that is wrong was requeued"
report
