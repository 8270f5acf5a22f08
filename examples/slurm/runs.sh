#!/bin/bash
#SBATCH --job-name=keeler
#SBATCH --array=1-4          # a run per task: here the seeds 1 to 4
#SBATCH --ntasks=2           # ranks of a run
#SBATCH --cpus-per-task=8    # threads of a rank
#SBATCH --time=12:00:00
#SBATCH --requeue
#SBATCH --open-mode=append
# One run per task of a job array, each on several ranks. A run that does not end within --time stops with a checkpoint (exit
# code 75), and its task is put into the queue again; so is a task whose node fails. It then goes on where it was.
#   sbatch runs.sh SCENE FOLDER
set -u
scene=$1
folder=$2/seed-$SLURM_ARRAY_TASK_ID
wall_time=42600 # s: ten minutes less than --time

mkdir -p "$2"
if compgen -G "$folder/checkpoint_*.h5" >/dev/null; then
  command=(resume "$folder")
else # --force: of a run that ended before its first checkpoint
  command=(run "$scene" -o "$folder" --force --set "particles.seed=$SLURM_ARRAY_TASK_ID")
fi

# OpenMPI takes the nodes of the job from Slurm's variables. PE: processors of a rank, one per thread
export OMP_NUM_THREADS=$SLURM_CPUS_PER_TASK
code=0
mpirun -n "$SLURM_NTASKS" --map-by "slot:PE=$SLURM_CPUS_PER_TASK" -x OMP_NUM_THREADS \
  keeler-mpi "${command[@]}" --wall-time "$wall_time" || code=$?
if [ "$code" -eq 75 ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$code"
