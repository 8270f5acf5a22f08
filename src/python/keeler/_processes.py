"""Processes of the program that this one waits for. They end with the interpreter, and so do their temporary folders:
a daemon thread may wait for one when it ends."""

import atexit
import os
import signal
import subprocess
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path

_guard = threading.Lock()
_running, _folders = set(), set()
_ending = False


@contextmanager
def folder():
    """A temporary folder, for what a process reads."""
    with _begun(_folders, tempfile.TemporaryDirectory) as place:
        with place:
            try:
                yield Path(place.name)
            except BaseException:
                _stand_still_at_the_end()
                raise


def said_by(command):
    """(exit code, what it wrote to standard error) of a process. Ctrl-C reaches it from here alone, and it takes the
    time it needs."""

    def start():
        return subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
            start_new_session=True,
        )

    with _begun(_running, start) as process, process:
        try:
            said = process.communicate()[1]
        except BaseException:
            process.send_signal(signal.SIGINT)
            process.communicate()
            raise
        _stand_still_at_the_end()
    return process.returncode, said


@contextmanager
def _begun(kind, make):
    """What make() returns, known to the end of the interpreter meanwhile."""
    with _guard:
        if not _is_over():
            made = make()
            kind.add(made)
    _stand_still_at_the_end()
    try:
        yield made
    finally:
        kind.discard(made)


def _is_over():
    """For other threads than the one in which the interpreter ends."""
    return _ending and threading.current_thread() is not threading.main_thread()


def _stand_still_at_the_end():
    """An exception of a daemon thread would be printed."""
    if _is_over():
        threading.Event().wait()


def _end():
    global _ending
    with _guard:
        _ending = True
    for process in list(_running):
        process.send_signal(signal.SIGINT)
    for process in list(_running):
        process.wait()
    for place in list(_folders):
        place.cleanup()


def _forget():
    """In a fork: what runs is its parent's."""
    global _guard
    _guard = threading.Lock()
    _running.clear()
    _folders.clear()


atexit.register(_end)
os.register_at_fork(after_in_child=_forget)
