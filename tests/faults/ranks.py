"""Runs that are distributed over ranks: ranks killed and stopped, disks that fill up, other scenes on other ranks, hosts that
vanish. Each life of a run has another number of ranks; in the end nothing differs from one process without harm."""

import os
import signal
import subprocess
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from disks import MOUNTED, mounter
from program import Broken, Ended, Limits
from rows import Fault, Skipped
from scenes import CONTACTS, EQUAL, FRICTION, MOONLET, OVERRIDES, checkpoints, must_equal

BOUNCED = ["gravity.resting_contacts=bounced"]
FFT = EQUAL + ["gravity.solver=fft"] + BOUNCED
SCENES = {
    "ranks: fft, moonlet, contacts": FFT + MOONLET + CONTACTS,
    "ranks: mesh, friction": EQUAL + ["gravity.solver=mesh"] + BOUNCED + FRICTION,
    "ranks: no gravity, unequal sizes, contacts": ["particles.sizes={law='power',exponent=3.0,min=0.5,max=2.0}"] + CONTACTS,
    "ranks: fft, automatic steps": FFT + ["time.step=auto"],
}
OVERRIDES.update(SCENES)
RICH = next(iter(SCENES))
DEADLINE = 60.0     # s
LONGEST_LIFE = 2.5  # s: about what a whole run takes, with its start
# no files in memory, which a limit on the size of files would forbid
TRANSPORT = ["--oversubscribe", "--bind-to", "none", "--mca", "btl", "self,tcp"]
TWO_HOSTS = Path(__file__).parent.parent / "ranks" / "two_hosts.sh"
LAUNCHER = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "PMIX_MCA_gds": "hash"}


def processes_below(process):
    """The ids of the processes that a process has started, and of theirs."""
    try:
        below = [int(word) for word in Path(f"/proc/{process}/task/{process}/children").read_text().split()]
    except OSError:
        return []
    return below + [further for child in below for further in processes_below(child)]


def kill_all(processes, kind=signal.SIGKILL):
    for process in processes:
        try:
            os.kill(process, kind)
        except ProcessLookupError:
            pass


@dataclass
class Ranks:
    """The program with MPI, started by mpirun."""

    scenes: object
    program: str
    # A killed launcher leaves its folder behind, and another one may fail at it: so each has its own (Open MPI 4).
    sessions: object = field(default_factory=lambda: tempfile.TemporaryDirectory(ignore_cleanup_errors=True))

    def words(self, count, words):
        return ["mpirun", "-n", str(count), *TRANSPORT, self.program, *map(str, words)]

    def start(self, words, limits=None, env=None, **options):
        environment = {**os.environ, **LAUNCHER, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive",
                       "OMPI_MCA_orte_tmpdir_base": tempfile.mkdtemp(dir=self.sessions.name), **(env or {})}
        if limits is not None:
            options["preexec_fn"] = limits.set
        return subprocess.Popen(list(map(str, words)), env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, start_new_session=True, **options)

    def ended(self, process, words):
        """Waits for the launcher, and for its ranks. What is left after the deadline hangs."""
        below = set(processes_below(process.pid))
        try:
            out, err = process.communicate(timeout=DEADLINE)
        except subprocess.TimeoutExpired:
            kill_all(below | set(processes_below(process.pid)) | {process.pid})
            process.communicate()
            raise Broken("hangs", f"{' '.join(map(str, words))}: longer than {DEADLINE:.0f} s") from None
        return Ended(words, process.returncode, out, err)

    def ranks_of(self, process):
        """The ranks that are there, when there is one."""
        while process.poll() is None:
            found = [child for child in processes_below(process.pid) if _is_program(child, self.program)]
            if found:
                return found
            time.sleep(0.005)
        return []


def _is_program(process, program):
    try:
        return os.path.samefile(f"/proc/{process}/exe", program)
    except OSError:
        return False


def one_line(ended, *codes):
    """One of these codes, and one line of Keeler's beside the launcher's own words."""
    if ended.code not in codes:
        raise Broken("wrong", ended.described())
    if ended.code > 0:
        said = [line for line in ended.messages() if line.startswith(b"keeler: ")]
        if len(said) != 1:
            raise Broken("wrong", f"not one line: {said} {ended.described()}")
    return ended


def next_words(ranks, name, run):
    """The command that goes on with the run of the folder."""
    return ["resume", run, "-q"] if checkpoints(run) else ranks.scenes.words(name, run, "--force", "-q")


def finish(ranks, name, run, draw):
    """Brings the run to its end, on one process or on ranks, and compares it with one without harm."""
    count = draw.choice((1, 2, 3))
    words = next_words(ranks, name, run)
    if count == 1:
        ranks.scenes.program.run(*words).must_be(0)
    else:
        words = ranks.words(count, words)
        one_line(ranks.ended(ranks.start(words), words), 0)
    must_equal(run, ranks.scenes.reference(name))


def _killed(ranks, draw, folder, number):
    name, run = list(SCENES)[number % len(SCENES)], folder / "run"
    kills = 0
    for _ in range(3):
        words = ranks.words(draw.choice((2, 3, 4)), next_words(ranks, name, run))
        process = ranks.start(words)
        time.sleep(draw.uniform(0.0, LONGEST_LIFE))
        there = ranks.ranks_of(process)
        if there:
            kill_all([draw.choice(there)])
        ended = ranks.ended(process, words)
        if ended.code == 0:
            break  # it was faster
        kills += 1
    finish(ranks, name, run, draw)
    return max(kills, 1)


def _signalled(ranks, draw, folder, number):
    """Signals to mpirun. USR1 reaches the ranks; for the others mpirun ends them itself."""
    name, run = list(SCENES)[number % len(SCENES)], folder / "run"
    for kind in (signal.SIGUSR1, draw.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP))):
        words = ranks.words(draw.choice((2, 3)), next_words(ranks, name, run))
        process = ranks.start(words)
        ranks.ranks_of(process)
        time.sleep(draw.uniform(0.0, LONGEST_LIFE))
        process.send_signal(kind)
        ended = ranks.ended(process, words)
        if kind == signal.SIGUSR1 and ended.code == 75 and not checkpoints(run):
            raise Broken("lost", f"stopped without a checkpoint: {ended.described()}")
    finish(ranks, name, run, draw)
    return 2


def _stopped(ranks, draw, folder, number):
    """A rank does nothing for a while: the others wait, and all go on; or it never goes on, and mpirun is asked to end."""
    name, run = list(SCENES)[number % len(SCENES)], folder / "run"
    words = ranks.words(draw.choice((2, 3)), next_words(ranks, name, run))
    process = ranks.start(words)
    time.sleep(draw.uniform(0.0, LONGEST_LIFE))
    there = ranks.ranks_of(process)
    if there:
        stopped = draw.choice(there)
        kill_all([stopped], signal.SIGSTOP)
        time.sleep(draw.uniform(0.5, 1.5))
        if number % 2:
            process.send_signal(signal.SIGTERM)
            ranks.ended(process, words)
        else:
            kill_all([stopped], signal.SIGCONT)
            one_line(ranks.ended(process, words), 0)
    else:
        ranks.ended(process, words)
    finish(ranks, name, run, draw)


def _file_size(ranks, draw, folder, number):
    name, run = list(SCENES)[number % len(SCENES)], folder / "run"
    limits = Limits(file_size=4096 * number + draw.randrange(4096))
    words = ranks.words(draw.choice((2, 3)), next_words(ranks, name, run))
    one_line(ranks.ended(ranks.start(words, limits), words), 0, 4)
    if list(run.glob("*.tmp")):
        raise Broken("wrong", f"{limits}: a part of a file was left")
    finish(ranks, name, run, draw)


def _small_disk(shared, draw, folder, number):
    ranks, mount = shared
    disk, copy = folder / "disk", folder / "copy"
    for made in (disk, copy):
        made.mkdir()
    size = 32768 + 49152 * number
    run = mount + ["bash", "-c", MOUNTED.format(size=size), "bash", disk,
                     *ranks.words(draw.choice((2, 3)), ranks.scenes.words(RICH, disk / "run", "-q"))]
    process = ranks.start(run, env={"KEELER_DISK": str(disk), "KEELER_COPY": str(copy)})
    one_line(ranks.ended(process, run), 0, 4)
    if list((copy / "run").glob("*.tmp")):
        raise Broken("wrong", f"{size} bytes: a part of a file was left")
    finish(ranks, RICH, copy / "run", draw)


OTHERS = ["particles.count=151", "particles.density=601.0", "time.end=0.41", "time.step=5e-3", "box.size=[32,33]", "gravity.force_error=1e-2",
          "collisions.friction.coefficient=0.1", "output.series_every=0.04", "particles.seed=7", "planet.vertical_ratio=1.5"]


def _other_scenes(ranks, draw, folder, number):
    """One rank is asked for another scene, folder or command: refused by all, and nothing is written."""
    run, first = folder / "run", draw.choice((1, 2))
    plain = ranks.scenes.words(RICH, run, "-q")
    other = {0: ranks.scenes.words(RICH, folder / "other", "-q"), 1: ["resume", run, "-q"]}.get(
        number % 10, plain + ["--set", OTHERS[number % len(OTHERS)]])
    words = ["mpirun", *TRANSPORT, "-n", str(first), ranks.program, *plain, ":", "-n", "1", ranks.program, *other]
    one_line(ranks.ended(ranks.start(words), words), 2)
    if list(folder.iterdir()):
        raise Broken("wrong", f"{other}: something was written")


def _two_hosts(ranks, folder):
    if os.getuid() != 0:
        raise Skipped("network namespaces need root here")
    made = subprocess.run(["bash", TWO_HOSTS, folder, "true"], capture_output=True, text=True)
    if made.returncode != 0:
        raise Skipped(made.stderr.strip().removeprefix("skipped: "))
    return ranks


def processes_of(network):
    """All processes of a network namespace."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(process / "ns" / "net") == network:
                found.append(int(process.name))
        except OSError:
            pass
    return found


def _lost_host(ranks, draw, folder, number):
    """The second of two hosts loses its power, its daemon or its cable, or stands still for a while."""
    name, run = list(SCENES)[number % len(SCENES)], folder / "run"
    host_file = folder / "host"
    words = ["bash", TWO_HOSTS, folder, "mpirun", "--host", "10.0.7.1:2,10.0.7.2:2", "-n", str(draw.choice((2, 3, 4))), "--map-by",
             "node", "--bind-to", "none", "-x", "OMP_NUM_THREADS", "-x", "OMP_WAIT_POLICY", ranks.program,
             *next_words(ranks, name, run)]
    process = ranks.start(words)
    while not host_file.exists() or not host_file.read_text().strip():
        time.sleep(0.005)
    host = int(host_file.read_text())
    network = os.readlink(f"/proc/{host}/ns/net")
    time.sleep(draw.uniform(0.2, LONGEST_LIFE))
    there = [other for other in processes_of(network) if other != host]
    loss = ("power", "daemon", "cable", "pause")[number % 4]
    if loss == "power":
        kill_all(there)
    elif loss == "daemon":
        kill_all([other for other in there if _comm(other) == "orted"])
    elif loss == "cable":
        subprocess.run(["nsenter", "--target", str(host), "--net", "ip", "link", "set", "keeler-2", "down"], capture_output=True)
    else:
        kill_all(there, signal.SIGSTOP)
        time.sleep(2.0)
        kill_all(there, signal.SIGCONT)
    try:
        ended = ranks.ended(process, words)
        if loss == "pause":
            one_line(ended, 0)
    finally:
        kill_all(there)  # what a lost cable leaves on that host
    finish(ranks, name, run, draw)


def _comm(process):
    try:
        return Path(f"/proc/{process}/comm").read_text().strip()
    except OSError:
        return ""


def faults(program):
    """The faults of ranks. Without a program with MPI (None) they have their places on the page alone."""
    def prepared(more=lambda ranks, folder: ranks):
        return lambda scenes, folder: more(Ranks(scenes, program), folder)

    return [
        Fault("rank-kill", "ranks: one of 2 to 4 killed (SIGKILL) at a random moment", f"{len(SCENES)} scenes, three times each "
              "run; each life on another number of ranks, the last on 1 to 3", 12, 1, _killed, prepared()),
        Fault("rank-signals", "ranks: USR1, then INT, TERM or HUP to mpirun at random moments", "the same scenes", 8, 1,
              _signalled, prepared()),
        Fault("rank-stopped", "ranks: one of 2 or 3 stands still (SIGSTOP)", "half of them go on after a second, and so does the "
              "run; in the others mpirun is told to end", 8, 2, _stopped, prepared()),
        Fault("rank-file-size", "ranks: limits on the size of files", "the same scenes, 0 to 64 KB in steps of 4 KB", 16, 2,
              _file_size, prepared()),
        Fault("rank-small-disk", "ranks: small disks that fill up", "a run with every kind of file on file systems of 32 to 560 KB",
              12, 1, _small_disk, prepared(lambda ranks, folder: (ranks, mounter()))),
        Fault("rank-scenes", "ranks: one is asked for another scene, folder or command", "refused by all, nothing is written", 20, 3,
              _other_scenes, prepared()),
        Fault("rank-host", "ranks: a host vanishes", "two hosts (network namespaces) over TCP: the second loses its power, its "
              "daemon or its cable, or stands still for two seconds and goes on, at random moments", 12, 2, _lost_host, prepared(_two_hosts)),
    ]
