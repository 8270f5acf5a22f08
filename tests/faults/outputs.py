"""Names of results that others use too: a second command, planted links, files of others, pipes, killed writers."""

import os
import signal
import stat
import threading
import time

from program import DEADLINE, Broken
from rows import Fault
from scenes import RICH, same_results

VICTIM = b"of another user\n"


class Commands:
    """What writes a result under a name that the user gives, in two versions, and the results without harm."""

    def __init__(self, scenes, folder):
        self.program = scenes.program
        whole = scenes.reference(RICH)
        first, last = whole / "snap_000000.hdf", whole / "snap_000004.hdf"
        equal = "particles.sizes={law='equal',radius=1.0}"
        generate = ["generate", scenes.file, "--set", equal, "--force", "-q"]
        self.kinds = {  # by ending: the two versions, without -o NAME
            "csv": [["convert", first, "--to", "csv", "--force", "-o"], ["convert", last, "--to", "csv", "--force", "-o"]],
            "vtp": [["convert", first, "--to", "vtp", "--force", "-o"], ["convert", last, "--to", "vtp", "--force", "-o"]],
            "hdf": [[*generate, "-o"], [*generate, "--set", "particles.seed=2", "-o"]],
            "png": [["render", last, "--width", "400", "-o"], ["render", last, "--width", "500", "-o"]],
            "svg": [["render", whole, "--series", "-o"], ["render", whole, "--series", "--theme", "light", "-o"]],
            "table": [["analyze", last, "--csv"], ["analyze", whole, "--csv"]],
            "toml": [["new", "a-ring-wakes", "--force", "-o"], ["new", "equilibrium", "--force", "-o"]],
        }
        self.results = {}
        for ending, versions in self.kinds.items():
            for k, words in enumerate(versions):
                self.results[ending, k] = folder / f"{k}.{ending}"
                self.program.run(*words, self.results[ending, k]).must_be(0)

    def kind(self, number):
        return list(self.kinds)[number % len(self.kinds)]

    def require_whole(self, ending, file, versions):
        """The file is one of the results; and no part of a file is beside it."""
        if not any(same_results(file, self.results[ending, k]) for k in versions):
            raise Broken("wrong", f"{file.name} is no whole result: {file.stat().st_size} bytes")
        parts = list(file.parent.glob("*.keeler-*.tmp"))
        if parts:
            raise Broken("wrong", f"left over: {parts}")


def _one_name(commands, draw, folder, number):
    """Two commands at once: each ends well, and the name has the whole result of one."""
    ending = commands.kind(number)
    file = folder / f"result.{ending}"
    words = [[*version, file] for version in commands.kinds[ending]]
    one = commands.program.start(*words[0])
    time.sleep(draw.choice((0.0, draw.uniform(0.0, 0.05))))
    other = commands.program.start(*words[1])
    for process, said in ((one, words[0]), (other, words[1])):
        commands.program.ended(process, said).must_be(0)
    commands.require_whole(ending, file, (0, 1))


def _planted(folder, name, victim, stop):
    """Makes links of all names that could be guessed, again and again: what is written to one is the victim's."""
    guesses = [name + ".tmp", name + "~", name + ".part", "." + name + ".tmp", name + ".new"]
    while not stop.is_set():
        for guess in guesses:
            try:
                (folder / guess).symlink_to(victim)
            except FileExistsError:
                pass
        time.sleep(0.0005)


def _links(commands, draw, folder, number):
    ending = commands.kind(number)
    file, victim, other = folder / f"result.{ending}", folder / "victim", folder / f"result.{ending}.tmp"
    left = folder / f"result.{ending}.keeler-0123456789abcdef.tmp"
    victim.write_bytes(VICTIM)
    victim.chmod(0o640)
    if number // 2 % 2:
        other.write_bytes(VICTIM)  # by another program, which is not a link
    os.link(victim, left)  # a second name of it, as a killed writer leaves one
    if number % 2 and ending != "table":  # a table takes the place of tables alone
        file.symlink_to(victim)
    stop = threading.Event()
    attack = threading.Thread(target=_planted, args=(folder, file.name, victim, stop))
    attack.start()
    time.sleep(draw.uniform(0.0, 0.01))
    try:
        ended = commands.program.run(*commands.kinds[ending][0], file)
    finally:
        stop.set()
        attack.join()
    if number % 2 and ended.code == 2:  # pictures replace pictures alone
        if ending not in ("png", "svg"):
            raise Broken("wrong", ended.described())
    else:
        ended.must_be(0)
        left.unlink()
        commands.require_whole(ending, file, (0,))
    if victim.read_bytes() != VICTIM or stat.S_IMODE(victim.stat().st_mode) != 0o640:
        raise Broken("lost", f"a link was followed: {ended.described()}")
    if not other.exists() or other.read_bytes() != VICTIM:
        raise Broken("lost", "a file of another program")


def _pipes(commands, draw, folder, number):
    """Pipes, by their names, by links, and standard output, get the result and stay what they are."""
    ending = commands.kind(number)
    words = commands.kinds[ending][0]
    result, pipe = folder / f"got.{ending}", folder / f"pipe.{ending}"
    os.mkfifo(pipe)
    way = number // len(commands.kinds) % 4
    name = [pipe, folder / f"link.{ending}", "-", "/dev/stdout"][way]
    if way == 1:
        name.symlink_to(pipe)
    streams = ending != "hdf"
    reader = None
    if way < 2 and streams:
        reader = threading.Thread(target=lambda: result.write_bytes(pipe.read_bytes()), daemon=True)
        reader.start()
    ended = commands.program.run(*words, name).must_be(0 if streams else 2)
    if not stat.S_ISFIFO(pipe.stat().st_mode) or (way == 1 and not name.is_symlink()):
        raise Broken("lost", f"a pipe was replaced: {ended.described()}")
    if reader:
        reader.join(DEADLINE)
    elif streams:
        result.write_bytes(ended.out)
    if streams:
        commands.require_whole(ending, result, (0,))


def _killed_writers(commands, draw, folder, number):
    """What killed commands leave is removed by the next one, and no live one's file is."""
    ending = commands.kind(number)
    file = folder / f"result.{ending}"
    words = [*commands.kinds[ending][0], file]
    for _ in range(3):
        process = commands.program.start(*words)
        time.sleep(draw.uniform(0.0, 0.08))
        process.send_signal(signal.SIGKILL)
        commands.program.ended(process, words)
    commands.program.run(*words).must_be(0)
    commands.require_whole(ending, file, (0,))
    return 3


FAULTS = [
    Fault("one-name", "two commands onto one name", "tables, pictures, movies, states and scenes, up to 0.05 s apart", 140, 7,
          _one_name, Commands),
    Fault("links", "links planted beside a result and under its name",
          "to a file of another, at all names that can be guessed, again and again while the same commands work", 140, 7, _links,
          Commands),
    Fault("pipes", "named pipes, links to them and standard output as results", "the same commands", 56, 7, _pipes, Commands),
    Fault("left-overs", "commands that write a result, killed at random moments", "three times, then left to end", 70, 7,
          _killed_writers, Commands),
]
