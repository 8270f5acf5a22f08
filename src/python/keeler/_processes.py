"""Child processes that run the program. They and their temporary folders end with the interpreter, also when a daemon
thread waits for one at that time."""

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
    """A temporary folder for the input of a process."""
    with _registered(_folders, tempfile.TemporaryDirectory) as temporary:
        with temporary:
            try:
                yield Path(temporary.name)
            except BaseException:
                _block_at_the_end()
                raise


def run_process(command):
    """Runs a process and returns (exit code, standard error). Ctrl-C is passed on to it, and it may finish
    properly."""

    def start():
        return subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, encoding="utf-8", errors="replace",
            start_new_session=True,
        )

    with _registered(_running, start) as process, process:
        try:
            messages = process.communicate()[1]
        except BaseException:
            process.send_signal(signal.SIGINT)
            process.communicate()
            raise
        _block_at_the_end()
    return process.returncode, messages


@contextmanager
def _registered(kind, make):
    """Gives make() to a block and registers it meanwhile, so that _end() can end it."""
    with _guard:
        if not _is_over():
            made = make()
            kind.add(made)
    _block_at_the_end()
    try:
        yield made
    finally:
        kind.discard(made)


def _is_over():
    """True if the interpreter ends, in threads other than the one that ends it."""
    return _ending and threading.current_thread() is not threading.main_thread()


def _block_at_the_end():
    """Blocks forever if the interpreter ends: an exception of a daemon thread would be printed."""
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
    for temporary in list(_folders):
        temporary.cleanup()


def _forget():
    """Clears the registers in a forked process: the running processes belong to its parent."""
    global _guard
    _guard = threading.Lock()
    _running.clear()
    _folders.clear()


atexit.register(_end)
os.register_at_fork(after_in_child=_forget)
