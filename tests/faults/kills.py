"""Runs that are killed, stopped by signals, or in each other's way; in the end nothing differs from a run without."""

import signal
import time

from program import Broken
from rows import Fault
from scenes import RICH, SCENES, checkpoints, must_equal

LONGEST_LIFE = 0.25  # s: about what a whole run takes
KILLS = 10           # of one run


def _any_environment(program, draw):
    """Other threads and instructions each time: no result may depend on them."""
    return {"OMP_NUM_THREADS": str(draw.choice((1, 1, 2, 3))), "KEELER_SIMD": draw.choice(program.instruction_sets)}


def next_words(scenes, name, folder):
    """The command that brings the run of the folder to its end, whatever stands there."""
    return ["resume", folder, "-q"] if checkpoints(folder) else scenes.words(name, folder, "--force", "-q")


def finish(scenes, name, folder, draw):
    scenes.program.run(*next_words(scenes, name, folder), env=_any_environment(scenes.program, draw)).must_be(0)


def _killed(scenes, draw, folder, number):
    name = list(SCENES)[number % len(SCENES)]
    run = folder / "run"
    kills = 0
    while kills < KILLS:
        words = next_words(scenes, name, run)
        process = scenes.program.start(*words, env=_any_environment(scenes.program, draw))
        time.sleep(draw.uniform(0.0, LONGEST_LIFE))
        process.send_signal(signal.SIGKILL)
        if scenes.program.ended(process, words).code != -signal.SIGKILL:
            break  # it was faster
        kills += 1
    finish(scenes, name, run, draw)
    must_equal(run, scenes.reference(name))
    return kills


def _signalled(scenes, draw, folder, number):
    name = list(SCENES)[number % len(SCENES)]
    run = folder / "run"
    for _ in range(4):
        words = next_words(scenes, name, run)
        kind = draw.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1))
        process = scenes.program.start(*words, env=_any_environment(scenes.program, draw))
        time.sleep(draw.uniform(0.0, LONGEST_LIFE))
        process.send_signal(kind)
        if draw.random() < 0.5:  # a second one, too soon to count or not
            time.sleep(draw.uniform(0.0, 0.4))
            process.send_signal(kind)
        # 1: before there was a run; the signal itself: before the program could take it
        scenes.program.ended(process, words).must_be(0, 1, 75, signals=(kind,))
    finish(scenes, name, run, draw)
    must_equal(run, scenes.reference(name))
    return 4


def _two_at_once(scenes, draw, folder, number):
    """Two commands for one folder: one works, the other is refused."""
    run = folder / "run"
    first = scenes.words(RICH, run, "-q")
    if number % 2:
        scenes.program.run(*scenes.words(RICH, run, "--set", "time.end=0.1", "-q")).must_be(0)
        first = ["resume", run, "--until", "0.4", "-q"]
    second = draw.choice((first, ["resume", run, "-q"], scenes.words(RICH, run, "-q")))
    one = scenes.program.start(*first)
    time.sleep(draw.choice((0.0, draw.uniform(0.0, 0.1))))
    other = scenes.program.start(*second)
    ended = [scenes.program.ended(one, first), scenes.program.ended(other, second)]
    for end in ended:
        end.must_be(0, 2, 4)
    if all(end.code for end in ended):
        raise Broken("wrong", f"neither worked: {ended}")
    finish_until(scenes, run)
    must_equal(run, scenes.reference(RICH))


def finish_until(scenes, run):
    scenes.program.run("resume", run, "--until", "0.4", "-q").must_be(0)


def _clock(scenes, draw, folder, number):
    name = list(SCENES)[number % len(SCENES)]
    run = folder / "run"
    env = {"LD_PRELOAD": scenes.program.library, "KEELER_FAULT_CLOCK": "1"}
    words = scenes.words(name, run, "-q", "--set", "output.checkpoint_every_minutes=0.001")
    process = scenes.program.start(*words, env=env)
    time.sleep(draw.uniform(0.0, LONGEST_LIFE))
    process.send_signal(signal.SIGKILL)
    scenes.program.ended(process, words)
    scenes.program.run(*next_words(scenes, name, run), env=env).must_be(0)
    must_equal(run, scenes.reference(name))


FAULTS = [
    Fault("kill", "killed (SIGKILL) at random moments",
          f"{len(SCENES)} scenes: all gravity solvers, four finders, friction, moonlets, a satellite, logs of contacts, "
          "automatic steps; each life of a run with other threads and instructions", 96, 3, _killed),
    Fault("signals", "INT, TERM, HUP and USR1 at random moments, half of them twice", "the same scenes", 60, 3,
          _signalled),
    Fault("two", "two commands in one folder", "run and resume beside run and resume, up to 0.1 s apart", 100, 4,
          _two_at_once),
    Fault("clock", "the wall clock jumps by years at each look at it", "run, killed and resumed", 24, 2, _clock),
]
