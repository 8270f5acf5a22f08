"""mutations [--check] [--only NAME...] [--write FILE]: builds each fault of faults.py into a copy of the sources
and runs the test that must then fail. Prints a line a fault, and writes their rows of the page. Exit code 1 when a fault does
not apply any more, does not compile, or is caught by nobody. --check: only whether each still applies and its test is there."""

import argparse
import os
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

from faults import FAULTS

SOURCE = Path(__file__).resolve().parents[2]
WORK = SOURCE / "build" / "mutations"
BEGIN, END = "<!--made:mutations.table-->\n", "<!--/-->\n"


class Unfit(Exception):
    """The fault, the build or the test is not what it is taken for."""


@dataclass
class Outcome:
    code: int  # of the test; negative: killed by a signal; none: it did not end
    checks: int = 0
    failed: int = 0
    cases: int = 0
    seconds: float = 0.0

    def words(self):
        if self.code is None:
            return "does not end"
        if self.code < 0:
            return f"dies by signal {-self.code}"
        return f"{self.failed} of {self.checks} checks fail" if self.failed else "ends with an error"


def applied(fault, text):
    count = text.count(fault.old)
    if count != 1:
        raise Unfit(f"{fault.name}: its text stands {count} times in {fault.file}, not once")
    return text.replace(fault.old, fault.new)


def require_tests(faults):
    """Each fault's test program is on a list of the build, and its case in a source."""
    tests = SOURCE / "tests"
    lists = "".join(made.read_text() for made in tests.rglob("CMakeLists.txt"))
    programs = {name for names in re.findall(r"(?:keeler_test\(|IN ITEMS )([\w ]+?)(?:\s+SOURCES|\))", lists) for name in names.split()}
    cases = {case for source in tests.rglob("*.cpp") for case in re.findall(r'^TEST_CASE\("(.*)"\)', source.read_text(), re.M)}
    for fault in faults:
        if fault.target not in programs or fault.case not in cases:
            raise Unfit(f"{fault.name}: there is no program test_{fault.target}, or no case '{fault.case}'")


def copy_sources(to):
    """What git knows, or would; files of equal content keep their times, so that only what changed is built."""
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=SOURCE,
                            check=True, capture_output=True).stdout.decode().split("\0")
    wanted = {name for name in listed if name and (SOURCE / name).is_file()}
    for old in [path for path in to.rglob("*") if path.is_file()]:
        name = str(old.relative_to(to))
        if name not in wanted and not name.startswith("build/"):
            old.unlink()
    for name in wanted:
        content, target = (SOURCE / name).read_bytes(), to / name
        if target.is_file() and target.read_bytes() == content:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)
        target.chmod((SOURCE / name).stat().st_mode)


def called(command, log):
    with open(log, "w") as out:
        return subprocess.run(command, stdout=out, stderr=subprocess.STDOUT).returncode == 0


class Build:
    def __init__(self):
        self.sources = WORK / "source"
        self.folder = self.sources / "build" / "default"  # as usual, so that ccache knows the files
        copy_sources(self.sources)
        self.require(["cmake", "-G", "Ninja", "-S", str(self.sources), "-B", str(self.folder),
                      "-DCMAKE_BUILD_TYPE=Release", "-DKEELER_TESTS=ON", "-DKEELER_PYTHON=OFF"], "configuring")

    def require(self, command, what):
        log = WORK / "log.txt"
        if not called(command, log):
            raise Unfit(f"{what} fails:\n{log.read_text()[-3000:]}")

    def make(self, targets, what):
        self.require(["cmake", "--build", str(self.folder), "-j", str(os.cpu_count()), "--target",
                      *(f"test_{target}" for target in targets)], what)

    def run(self, fault, limit):
        program, = (self.folder / "tests").rglob(f"test_{fault.target}")
        started = time.monotonic()
        try:  # doctest parts its filters by commas
            done = subprocess.run([program, "--test-case=" + fault.case.replace(",", "?"), "--no-colors"],
                                  capture_output=True, text=True, errors="replace", timeout=limit,
                                  env={**os.environ, "OMP_WAIT_POLICY": "passive"})
        except subprocess.TimeoutExpired:
            return Outcome(None, seconds=time.monotonic() - started)
        outcome = Outcome(done.returncode, seconds=time.monotonic() - started)
        if found := re.search(r"test cases: +(\d+)", done.stdout):
            outcome.cases = int(found[1])
        if found := re.search(r"assertions: +(\d+) \| +\d+ passed \| +(\d+) failed", done.stdout):
            outcome.checks, outcome.failed = int(found[1]), int(found[2])
        return outcome


def caught(build, fault, sound):
    """What the test says to the fault; the copy has its sources back afterwards."""
    file = build.sources / fault.file
    text = file.read_text()
    file.write_text(applied(fault, text))
    try:
        build.make([fault.target], f"{fault.name}: the build")
        return build.run(fault, 60.0 + 20.0 * sound.seconds)
    finally:
        file.write_text(text)


def try_all(faults):
    WORK.mkdir(parents=True, exist_ok=True)
    build = Build()
    build.make(sorted({fault.target for fault in faults}), "the build without a fault")
    rows, missed = {}, 0
    for fault in faults:
        build.make([fault.target], "the build without a fault")
        sound = build.run(fault, 600.0)
        if sound.code != 0 or sound.cases != 1:
            raise Unfit(f"{fault.name}: without it '{fault.case}' of test_{fault.target} is {sound.cases} tests, exit "
                        f"{sound.code}")
        outcome = caught(build, fault, sound)
        found = outcome.code != 0
        missed += not found
        verdict = outcome.words() if found else "**nobody**"
        print(f"{fault.name:18} {verdict}", flush=True)
        rows[fault.name] = f"| {fault.title} | `{fault.file}` | {fault.case} (`test_{fault.target}`) | {verdict} |\n"
    print(f"{len(faults)} faults, {missed} caught by nobody")
    return rows, missed


def write(page, rows):
    """Rows of faults that were not tried stay as they are."""
    head, rest = page.read_text().split(BEGIN)
    old, tail = rest.split(END)
    written = dict(re.findall(r"^\| `([\w-]+)` (.*\n)", old, re.MULTILINE)) | rows
    lines = [f"| `{fault.name}` {written[fault.name]}" for fault in FAULTS if fault.name in written]
    page.write_text(f"{head}{BEGIN}| name | fault | in | test | what it says |\n|---|---|---|---|---|\n{''.join(lines)}{END}{tail}")


def main():
    parser = argparse.ArgumentParser(prog="mutations", description=__doc__)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--only", metavar="NAME", nargs="+", choices=[fault.name for fault in FAULTS])
    parser.add_argument("--write", metavar="FILE", type=Path)
    options = parser.parse_args()
    faults = [fault for fault in FAULTS if options.only is None or fault.name in options.only]
    try:
        for fault in faults:
            applied(fault, (SOURCE / fault.file).read_text())
        require_tests(faults)
        if options.check:
            print(f"{len(faults)} faults apply")
            return 0
        rows, missed = try_all(faults)
    except Unfit as unfit:
        print(unfit, file=sys.stderr)
        return 1
    if options.write:
        write(options.write, rows)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
