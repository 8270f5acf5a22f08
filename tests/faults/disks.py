"""Disks that are full or fail: at every call, by a limit on the size of files, on a small disk; and little memory."""

import os
import shutil
import signal
import subprocess

from kills import finish
from program import Broken, Limits
from rows import Fault, Skipped
from scenes import RICH, SHORT, must_equal

KINDS = ("kill", "torn", "nospace", "io")


class Calls:
    """Two commands, and how many calls on files each makes: a run from its start, and one that goes on."""

    def __init__(self, scenes, folder):
        self.scenes = scenes
        self.half = folder / "half"
        scenes.program.run(*scenes.words(SHORT, self.half, "--set", "time.end=0.04", "-q")).must_be(0)
        self.counts = [self._count(folder / "counted", resumes, folder / "count") for resumes in (False, True)]

    def begin(self, run, resumes):
        if resumes:
            shutil.copytree(self.half, run)
            return ["resume", run, "--until", "0.08", "-q"]
        return self.scenes.words(SHORT, run, "-q")

    def _count(self, run, resumes, file):
        words = self.begin(run, resumes)
        self.scenes.program.run(*words, env=self.scenes.program.failing(run, "none", 0, file)).must_be(0)
        shutil.rmtree(run)
        return int(file.read_text())


def _failing_call(calls, draw, folder, number):
    """The calls in turn, each with each kind of failure; then from the first again."""
    scenes, run = calls.scenes, folder / "run"
    total = sum(calls.counts)
    at = (number // len(KINDS) * 7) % total + 1  # 7: a quick run sees all parts of it too
    resumes = at > calls.counts[0]
    kind = KINDS[number % len(KINDS)]
    words = calls.begin(run, resumes)
    ended = scenes.program.run(*words, env=scenes.program.failing(run, kind, at - calls.counts[0] if resumes else at))
    ended.must_be(0, 4, signals=(signal.SIGKILL,) if kind in ("kill", "torn") else ())
    if resumes:
        scenes.program.run("resume", run, "--until", "0.08", "-q").must_be(0)
    else:
        finish(scenes, SHORT, run, draw)
    must_equal(run, scenes.reference(SHORT))


def _goes_on(scenes, run, draw):
    """With room again the run comes to the end that it would have had."""
    finish(scenes, RICH, run, draw)
    must_equal(run, scenes.reference(RICH))


def _file_size(scenes, draw, folder, number):
    run = folder / "run"
    limits = Limits(file_size=256 * number + draw.randrange(256))
    scenes.program.run(*scenes.words(RICH, run, "-q"), limits=limits).must_be(0, 4)
    if list(run.glob("*.tmp")):
        raise Broken("wrong", f"{limits}: a part of a file was left")
    _goes_on(scenes, run, draw)


MOUNTED = """mount -t tmpfs -o size={size} none "$1" || exit 99
shift
"$@"
code=$?
cp -r "$KEELER_DISK/." "$KEELER_COPY" && exit $code"""


def mounter():
    for words in (["unshare", "-m"], ["unshare", "-rm"]):
        if shutil.which("unshare") and subprocess.run(words + ["true"], capture_output=True).returncode == 0:
            return words
    raise Skipped("mounting is not permitted here")


def _small_disk(shared, draw, folder, number):
    scenes, mounter = shared
    disk, copy = folder / "disk", folder / "copy"
    for made in (disk, copy):
        made.mkdir()
    size = 4096 * (number + 5)
    run = ["bash", "-c", MOUNTED.format(size=size), "bash", disk, scenes.program.path,
           *scenes.words(RICH, disk / "run", "-q")]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "KEELER_DISK": str(disk), "KEELER_COPY": str(copy)}
    process = subprocess.Popen(mounter + [str(word) for word in run], env=environment, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True)
    scenes.program.ended(process, run).must_be(0, 4)
    if list((copy / "run").glob("*.tmp")):
        raise Broken("wrong", f"{size} bytes: a part of a file was left")
    _goes_on(scenes, copy / "run", draw)


def _other_outputs(scenes, draw, folder, number):
    """Commands that write one result: it is there whole, or not at all."""
    whole = scenes.reference(RICH)
    result = folder / "result"
    snapshot = whole / "snap_000001.hdf"
    words = [["render", snapshot, "-o", f"{result}.png"],
             ["render", whole, "--movie", "-o", f"{result}.mp4"],
             ["render", snapshot, "-o", f"{result}.png"],
             ["convert", snapshot, "--to", "csv", "-o", f"{result}.csv"],
             ["convert", whole, "--to", "vtp", "-o", folder / "vtp"],
             ["report", whole, "-o", f"{result}.html"],
             ["generate", scenes.file, "--set", "particles.sizes={law='equal',radius=1.0}", "-q", "-o", f"{result}.hdf"],
             ["tile", whole / "snap_000000.hdf", "2", "2", "-o", f"{result}.hdf"],
             ["analyze", whole, "--profile", f"{result}.csv"],
             ["analyze", whole, "--csv", f"{result}.csv"]][number % 10]
    ended = scenes.program.run(*words, limits=Limits(file_size=draw.randrange(60000))).must_be(0, 4)
    left = [file.name for file in folder.rglob("*") if file.suffix == ".tmp" or file.stem == "result"]
    if left and ended.code == 4:
        raise Broken("wrong", f"left {left}: {ended.described()}")


def least_memory(scenes, folder):
    """Bytes of address space below which the program's libraries do not load."""
    low, high = 0, 1 << 30
    while high - low > 1 << 20:
        middle = (low + high) // 2
        ended = scenes.program.run("--version", limits=Limits(memory=middle))
        low, high = (low, middle) if ended.code == 0 else (middle, high)
    return scenes, high


def _little_memory(shared, draw, folder, number):
    scenes, least = shared
    run = folder / "run"
    limits = Limits(memory=least + (number << 18) + draw.randrange(1 << 18))
    threads = {"OMP_NUM_THREADS": str(1 + number % 2)}
    ended = scenes.program.run(*scenes.words(RICH, run, "-q"), limits=limits, env=threads)
    ended.must_be(0, 1, 4)
    _goes_on(scenes, run, draw)
    scenes.program.run("convert", run, "--to", "csv", limits=limits).must_be(0, 1, 4)
    scenes.program.run("analyze", run, limits=limits).must_be(0, 1, 4)
    return 3


def _few_files(scenes, draw, folder, number):
    run = folder / "run"
    scenes.program.run(*scenes.words(RICH, run, "-q"), limits=Limits(files=4 + number)).must_be(0, 1, 4)
    _goes_on(scenes, run, draw)


FAULTS = [
    Fault("calls", "a call on a file fails: killed before it, killed with half of it written, no space, input/output error",
          "open, write, fsync, close, ftruncate, rename, remove and mkdir of a run and of a resume, one after the other", 1000,
          24, _failing_call, Calls),
    Fault("file-size", "limits on the size of files", "a run with every kind of file, 0 to 64 KB in steps of 256 bytes", 256,
          6, _file_size),
    Fault("small-disk", "small disks that fill up", "the same run on file systems of 20 to 600 KB", 150, 4, _small_disk,
          lambda scenes, folder: (scenes, mounter())),
    Fault("outputs", "limits on the size of files: other commands", "pictures, movies, tables, reports, states, profiles",
          200, 10, _other_outputs),
    Fault("memory", "limits on memory", "a run, convert and analyze, in steps of 0.25 MB from what the libraries alone take",
          80, 3, _little_memory, least_memory),
    Fault("open-files", "limits on open files", "a run with 4 to 19 descriptors", 16, 3, _few_files),
]
