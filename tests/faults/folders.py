"""Folders that cannot be written to, or vanish; files that vanish from them; and standard streams that are closed."""

import os
import shutil
import time

from kills import finish, next_words
from program import Broken
from rows import Fault, Skipped
from scenes import RICH, must_equal

NOBODY = 65534  # root may write everywhere
WAITS = 400     # of 5 ms, for something that a run is about to write


class Unprivileged:
    """What a run by somebody who is not root needs; and the reference by the same."""

    def __init__(self, scenes, folder):
        self.scenes = scenes
        self.user = NOBODY if os.getuid() == 0 else os.getuid()
        if os.getuid() == 0:
            open_to_all(folder.parent.parent)
            ended = scenes.program.run("--version", preexec_fn=self.change_user)
            if ended.code != 0:
                raise Skipped("the program cannot be reached by another user than root")

    def change_user(self):
        if os.getuid() == 0:
            os.setgid(NOBODY)
            os.setuid(NOBODY)

    def start(self, *words):
        return self.scenes.program.start(*words, preexec_fn=self.change_user)


def open_to_all(folder):
    for place in (folder, *folder.rglob("*")):
        place.chmod(0o755 if place.is_dir() else 0o644)


def _wait_for(process, met):
    """Until it is met or the run is over; false: it was over first."""
    for _ in range(WAITS):
        if met():
            return True
        if process.poll() is not None:
            return False
        time.sleep(0.005)
    return False


def _read_only(shared, draw, folder, number):
    scenes = shared.scenes
    os.chown(folder, shared.user, shared.user if os.getuid() == 0 else -1)
    run = folder / "run"
    words = scenes.words(RICH, run, "-q")
    if number % 4 == 0:
        folder.chmod(0o555)
        shared.scenes.program.ended(shared.start(*words), words).must_be(4)
        if run.exists():
            raise Broken("wrong", "a folder in one that is read-only")
        return
    process = shared.start(*words)
    _wait_for(process, (run / "series.csv").exists)
    time.sleep(draw.uniform(0.0, 0.2))
    if run.exists():
        run.chmod(0o555)
    scenes.program.ended(process, words).must_be(0, 4)
    run.chmod(0o755)
    again = next_words(scenes, RICH, run)
    scenes.program.ended(shared.start(*again), again).must_be(0)
    must_equal(run, scenes.reference(RICH))


def _vanishes(scenes, draw, folder, number):
    """Moved, moved and replaced, or removed; a moved run goes on where it is."""
    run, there = folder / "run", folder / "there"
    words = scenes.words(RICH, run, "-q")
    process = scenes.program.start(*words)
    _wait_for(process, (run / "series.csv").exists)
    time.sleep(draw.uniform(0.0, 0.2))
    change = number % 3
    if change == 2:
        shutil.rmtree(run, ignore_errors=True)
    else:
        run.rename(there)
        if change == 1:
            run.mkdir()
    scenes.program.ended(process, words).must_be(0, 4)  # 0: it had finished
    if run.exists() and list(run.iterdir()) and change != 2:
        raise Broken("wrong", f"output in two places: {list(run.iterdir())}")
    if change != 2:
        finish(scenes, RICH, there, draw)
        must_equal(there, scenes.reference(RICH))


def _removed_rows(scenes, draw, folder, number):
    """A table of rows vanishes: it is there again, whole, when the run has gone on."""
    run = folder / "run"
    words = scenes.words(RICH, run, "-q")
    process = scenes.program.start(*words)
    name = ("series.csv", "moonlets.csv", "impact_speeds.csv")[number % 3]
    _wait_for(process, (run / name).exists)
    time.sleep(draw.uniform(0.0, 0.1))
    if process.poll() is None and not (run / "snap_000004.hdf").exists():
        if number % 2:
            (run / name).rename(folder / name)
        else:
            (run / name).unlink(missing_ok=True)
    scenes.program.ended(process, words).must_be(0)
    must_equal(run, scenes.reference(RICH))


def _closed_streams(scenes, draw, folder, number):
    """Any of the three is closed, full or a broken pipe; what goes into files is not touched by it."""
    run = folder / "run"
    ways = [("open", "closed", "full", "broken")[number // 4**stream % 4] for stream in range(3)]

    def set_streams():
        for stream, way in enumerate(ways):
            if way == "closed":
                os.close(stream)
            elif way == "full":
                os.dup2(os.open("/dev/full", os.O_RDWR), stream)
            elif way == "broken":
                read, write = os.pipe()
                os.dup2(write, stream)
                os.close(read)
                os.close(write)

    for words in (scenes.words(RICH, run, "--set", "time.end=0.2"), ["resume", run, "--until", "0.4", "--json"],
                  ["info", run], ["analyze", run]):
        ended = scenes.program.run(*words, preexec_fn=set_streams)
        if ended.code not in (0, 4) or (ended.code == 4) != (ways[1] != "open"):
            raise Broken("crashes" if ended.code < 0 else "wrong", f"{ways}: {ended.described()}")
    must_equal(run, scenes.reference(RICH))
    return 4


FAULTS = [
    Fault("read-only", "folders that are read-only, or become so", "a quarter before the run, the others at random moments",
          40, 4, _read_only, Unprivileged),
    Fault("vanishing", "folders that are moved, moved and replaced, or removed", "at random moments", 90, 3, _vanishes),
    Fault("removed-rows", "`series.csv`, `moonlets.csv` or `impact_speeds.csv` removed or renamed", "at random moments", 90, 3,
          _removed_rows),
    Fault("streams", "standard streams closed, full or broken pipes", "run, resume, info and analyze with all 64 combinations",
          64, 4, _closed_streams),
]
