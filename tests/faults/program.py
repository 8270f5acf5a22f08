"""The program under test: started with limits and a deadline, and judged by how it ends."""

import os
import re
import resource
import signal
import subprocess
from dataclasses import dataclass

DEADLINE = 20.0  # s: what takes longer hangs
LONGEST = 2000   # bytes of a message
NOISE = ("Sanitizer", "runtime error:", "terminate called", "Assertion", "HDF5-DIAG", "infinite loop", "Traceback")
BESIDE = re.compile(rb"keeler: note: |^[0-9.]+/[0-9.]+ orbits | % +[0-9:]+ left |^ *[0-9]+ %  ")  # notes and progress are no messages


class Broken(Exception):
    """A trial that did not end as it must. Its verdict is a column of the table: lost, wrong, crashes or hangs."""

    def __init__(self, verdict, detail):
        super().__init__(f"{verdict}: {detail}")
        self.verdict = verdict


@dataclass
class Ended:
    words: tuple  # of the command
    code: int     # negative: the signal that ended it
    out: bytes
    err: bytes

    def messages(self):
        return [line for line in self.err.split(b"\n") if line.strip() and not BESIDE.search(line)]

    def described(self):
        return f"{' '.join(map(str, self.words))}: exit {self.code}, {self.err[-400:]!r}"

    def must_be(self, *codes, signals=()):
        """One of these exit codes or signals, and one line of its own where something failed."""
        if self.code < 0 and -self.code not in signals:
            raise Broken("crashes", self.described())
        if any(noise.encode() in self.err for noise in NOISE):
            raise Broken("crashes", self.described())
        if self.code >= 0 and self.code not in codes:
            raise Broken("wrong", self.described())
        if self.code > 0:
            said = self.messages()
            if len(said) != 1 or not said[0].startswith(b"keeler: ") or len(said[0]) > LONGEST:
                raise Broken("wrong", f"not one line: {self.described()}")
        return self


@dataclass
class Limits:
    """What a process may use: bytes of a file and of memory, open files; none where it is None."""

    file_size: int | None = None
    memory: int | None = None
    files: int | None = None

    def set(self):
        for kind, limit in ((resource.RLIMIT_FSIZE, self.file_size), (resource.RLIMIT_AS, self.memory),
                            (resource.RLIMIT_NOFILE, self.files)):
            if limit is not None:
                resource.setrlimit(kind, (limit, limit))


class Program:
    def __init__(self, path, library):
        self.path = path
        self.library = library  # of failing calls, for LD_PRELOAD
        with open("/proc/cpuinfo") as file:
            flags = set(file.read().split())
        self.instruction_sets = ["portable"] + [name for name, flag in (("avx2", "avx2"), ("avx512", "avx512f"))
                                                if flag in flags]

    def _environment(self, more):
        return {**os.environ, "OMP_NUM_THREADS": "1", "OMP_WAIT_POLICY": "passive", **more}

    def start(self, *words, env=None, limits=None, **options):
        """A process in a group of its own."""
        options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        if limits is not None:
            options["preexec_fn"] = limits.set
        return subprocess.Popen([self.path, *map(str, words)], env=self._environment(env or {}),
                                start_new_session=True, **options)

    def ended(self, process, words, deadline=DEADLINE):
        try:
            out, err = process.communicate(timeout=deadline)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            raise Broken("hangs", f"{' '.join(map(str, words))}: longer than {deadline:.0f} s") from None
        return Ended(words, process.returncode, out or b"", err or b"")

    def run(self, *words, env=None, limits=None, **options):
        return self.ended(self.start(*words, env=env, limits=limits, **options), words)

    def failing(self, folder, fault, at=0, count_file=None):
        """The environment in which the call number `at` on files of the folder fails."""
        more = {"LD_PRELOAD": self.library, "KEELER_FAULT_FOLDER": str(folder), "KEELER_FAULT": fault,
                "KEELER_FAULT_AT": str(at)}
        return {**more, "KEELER_FAULT_COUNT": str(count_file)} if count_file else more
