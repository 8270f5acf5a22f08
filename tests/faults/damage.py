"""Files of every kind, torn anywhere and with bytes changed: refused in one line, or read with the right values."""

import shutil

import h5py

from program import Broken
from rows import Fault
from scenes import RICH, checkpoints, must_equal


def damaged(content, draw):
    """One kind of damage of eight, somewhere."""
    size = len(content)
    at = draw.randrange(max(size, 1))
    block = draw.randrange(1, 513)
    kind = draw.randrange(8)
    if kind == 0:
        return content[:at]
    if kind == 1:
        return content[:max(0, size - draw.randrange(1, 200))]
    if kind in (2, 3):
        return content[:at] + bytes([content[at] ^ (1 << draw.randrange(8))]) + content[at + 1:] if size else b"\0"
    if kind == 4:
        return content[:at] + bytes(min(block, size - at)) + content[at + block:]
    if kind == 5:
        return content[:at] + draw.randbytes(min(block, size - at)) + content[at + block:]
    if kind == 6:
        return content + draw.randbytes(block)
    other = draw.randrange(max(size, 1))
    low, high = sorted((at, other))
    block = min(block, high - low, size - high)
    exchanged = content[high:high + block] + content[low + block:high] + content[low:low + block]
    return content[:low] + exchanged + content[high + block:]


def damage(file, draw):
    """Changes it; false where chance changed nothing."""
    before = file.read_bytes()
    after = damaged(before, draw)
    file.write_bytes(after)
    return after != before


class OneFile:
    """A file whose values a command prints, and what it prints of the whole one."""

    def __init__(self, scenes, folder, file, words, codes=(4,)):
        self.scenes, self.file, self.words, self.codes = scenes, file, words, codes
        ended, self.whole = self.printed(file, folder)
        ended.must_be(0)

    def printed(self, file, folder):
        words = [str(word).format(file=file, out=folder / "out") for word in self.words]
        ended = self.scenes.program.run(*words)
        result = folder / "out"
        printed = result.read_bytes() if result.exists() else ended.out
        return ended, printed.replace(str(file).encode(), b"FILE")

    def trial(self, draw, folder):
        file = folder / self.file.name
        file.write_bytes(damaged(self.file.read_bytes(), draw))
        ended, values = self.printed(file, folder)
        ended.must_be(0, *self.codes)
        (folder / "out").unlink(missing_ok=True)
        return ended.code == 0 and values != self.whole


def _sealed(read, draw, folder, number):
    """Eight damaged files a trial."""
    for _ in range(8):
        if read.trial(draw, folder):
            raise Broken("wrong", f"{read.file.name}: other values were read from a damaged file")
    return 8


def _unsealed(read, draw, folder, number):
    """The same where nothing tells that values are others: texts, and snapshots without a seal."""
    for _ in range(8):
        read.trial(draw, folder)
    return 8


def _table_of(name):
    return lambda scenes, folder: OneFile(scenes, folder, sorted(scenes.reference(RICH).glob(name))[-1],
                                          ["convert", "{file}", "--to", "csv", "-o", "{out}"])


def _contacts(scenes, folder):
    return OneFile(scenes, folder, scenes.reference(RICH) / "collisions_000000.h5", ["info", "{file}", "--json"])


def _without_seal(scenes, folder):
    """As another program leaves it that changed a value in place."""
    file = folder / "snapshot.hdf"
    file.write_bytes((scenes.reference(RICH) / "snap_000001.hdf").read_bytes()[:-64])
    with h5py.File(file, "r+") as opened:
        opened["PartType1/Masses"][0] = 2000.0
    # 3: no state of a ring
    return OneFile(scenes, folder, file, ["convert", "{file}", "--to", "csv", "-o", "{out}"], codes=(3, 4))


def _scene(scenes, folder):
    file = folder / "damaged.toml"
    file.write_bytes((scenes.reference(RICH) / "scene.toml").read_bytes())
    return OneFile(scenes, folder, file, ["check", "{file}"], codes=(2,))


def _radii(scenes, folder):
    file = folder / "radii.txt"
    file.write_text("# radius, m\n" + "".join(f"{0.5 + 0.01 * k}\n" for k in range(150)))
    return OneFile(scenes, folder, file, ["check", scenes.file, "--set", "particles.sizes={{law='file',path='{file}'}}"],
                   codes=(2,))


def _particles(scenes, folder):
    file = folder / "particles.csv"
    scenes.program.run("convert", scenes.reference(RICH) / "snap_000000.hdf", "--to", "csv", "-o", file).must_be(0)
    return OneFile(scenes, folder, file, ["generate", scenes.file, "--set", "particles.sizes={{law='equal',radius=1.0}}",
                                          "-q", "--from-table", "{file}", "-o", "{out}"], codes=(2, 3))


def _any_table(read, draw, folder, number):
    """Overlaps (exit code 3) are what a table may have by its damage."""
    file = folder / read.file.name
    file.write_bytes(damaged(read.file.read_bytes(), draw))
    ended, _ = read.printed(file, folder)
    ended.must_be(0, 2, 3)


class HalfRun:
    """A run that was stopped half way, to be damaged and resumed."""

    def __init__(self, scenes, folder):
        self.scenes = scenes
        self.folder = folder / "half"
        scenes.program.run(*scenes.words(RICH, self.folder, "--set", "time.end=0.2", "-q")).must_be(0)

    def copied(self, folder):
        run = folder / "run"
        shutil.copytree(self.folder, run)
        return run

    def resume(self, run):
        return self.scenes.program.run("resume", run, "--until", "0.4")


def _resumed(half, draw, folder, number):
    """One file of the folder in turn. What was not damaged must be as without it."""
    run = half.copied(folder)
    files = sorted(file for file in run.iterdir())
    file = files[number % len(files)]
    newest = file == checkpoints(run)[-1]
    if not damage(file, draw):
        return
    ended = half.resume(run).must_be(0, 4)
    table = file.suffix == ".csv"
    if ended.code == 4 and not table:
        raise Broken("lost", f"{file.name} damaged: {ended.described()}")
    if ended.code == 4:
        return
    if newest and not any(file.name.encode() in line for line in ended.messages()):
        raise Broken("wrong", f"passed over {file.name} in silence")
    regular = table and file.name != "impact_speeds.csv"  # it has rows where there were contacts
    if regular and not ended.messages() and _steps(run / file.name) != _steps(half.scenes.reference(RICH) / file.name):
        raise Broken("lost", f"rows of {file.name} in silence")
    lost_contacts = file.name.startswith("collisions") and ended.messages()
    stays = table or file.suffix in (".hdf", ".jsonl") or lost_contacts  # it is not made again
    must_equal(run, half.scenes.reference(RICH), but=(file.name,) if stays else ())


def _steps(file):
    return [line.split(b",")[0] for line in file.read_bytes().splitlines()]


def _all_checkpoints(half, draw, folder, number):
    run = half.copied(folder)
    if all([damage(file, draw) for file in checkpoints(run)]):
        half.resume(run).must_be(4)


def _looked_at(half, draw, folder, number):
    """What reads a folder meets a damaged file in it."""
    run = half.copied(folder)
    files = sorted(run.iterdir())
    damage(files[number % len(files)], draw)
    for words in (["info", run], ["analyze", run], ["report", run], ["convert", run, "--to", "csv"]):
        half.scenes.program.run(*words).must_be(0, 2, 4)


FAULTS = [
    Fault("checkpoints", "damaged checkpoints", "read by convert; torn at any length, bits and bytes changed, blocks of zeros or "
          "noise, blocks exchanged, more at the end", 300, 2, _sealed, _table_of("checkpoint_*.h5")),
    Fault("snapshots", "damaged snapshots", "read by convert; in the same ways", 300, 2, _sealed, _table_of("snap_*.hdf")),
    Fault("contacts", "damaged files of contacts", "read by info; in the same ways", 150, 2, _sealed, _contacts),
    Fault("unsealed", "damaged snapshots without a seal, as other programs leave them",
          "read by convert; values may be others, which nothing can tell", 150, 1, _unsealed, _without_seal),
    Fault("scenes", "damaged scenes", "read by check; values may be others", 150, 2, _unsealed, _scene),
    Fault("radii", "damaged lists of radii", "read by check; values may be others", 100, 1, _unsealed, _radii),
    Fault("tables", "damaged tables of particles", "read by generate; values may be others", 500, 4, _any_table,
          _particles),
    Fault("resume", "a damaged file in a run's folder, resumed", "each file in turn: from the older checkpoint with a message, or as "
          "if nothing had been; tables of rows may be refused", 1000, 14, _resumed, HalfRun),
    Fault("no-checkpoint", "both checkpoints damaged, resumed", "refused", 150, 2, _all_checkpoints, HalfRun),
    Fault("look", "a damaged file in a run's folder, looked at", "info, analyze, report and convert", 300, 7, _looked_at,
          HalfRun),
]
