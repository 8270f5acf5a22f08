"""What it costs to compile Keeler: processor seconds of every compiler call and link, by folder, from an empty build
folder and without a compiler cache.

    scripts/build-cost [--demo|--program] [--lines] [--objects N] [-D...]
    scripts/build-cost --tests [FOLDER]

--demo       only what scripts/demo compiles, in place of all that scripts/test does
--program    only the program, with all its commands
--lines      also lines behind each object once its headers are in, of Keeler and of others (a minute more)
--objects N  also the N costliest objects
-D...        goes to CMake: -DKEELER_UNITY=OFF compiles each source on its own
--tests      seconds of the tests instead, the slowest first, as ctest took them in FOLDER (build/default) last

The build folder is build/cost, which is emptied first. Seconds are the compiler's own and its assembler's, of both cores.
"""

import collections
import json
import os
import resource
import shlex
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BUILD = Path("build/cost")
RECORD = "--record"  # how a build calls this script: in front of the compiler or the linker


def record(file, command):
    done = subprocess.run(command, check=False)
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    out = command[command.index("-o") + 1] if "-o" in command else command[0]
    with open(file, "a", encoding="utf-8") as log:
        log.write(json.dumps({"out": out, "seconds": used.ru_utime + used.ru_stime}) + "\n")
    return done.returncode


def folder_of(out):
    """src/cli/CMakeFiles/keeler.dir/run.cpp.o is of src/cli."""
    before = out.split("/CMakeFiles/")[0] if "/CMakeFiles/" in out else "links"
    return "/".join(before.split("/")[:3])


def lines_of(entry):
    """Lines of Keeler and of others that the compiler reads, without those that are blank."""
    words = shlex.split(entry["command"])  # without the launcher
    at = words.index("-o")
    text = subprocess.run(words[:at] + words[at + 2 :] + ["-E"], cwd=entry["directory"], capture_output=True, check=False)
    own = others = 0
    ours = True
    root = os.getcwd()
    for line in text.stdout.decode("utf-8", "replace").split("\n"):
        if line.startswith("# "):
            ours = line.split('"')[1].startswith(root)
        elif line.strip():
            own, others = (own + 1, others) if ours else (own, others + 1)
    return own, others


def compile_all(targets, definitions):
    shutil.rmtree(BUILD, ignore_errors=True)
    BUILD.mkdir(parents=True)
    log = (BUILD / "seconds.jsonl").resolve()
    launcher = f"{sys.executable};-B;{Path(__file__).resolve()};{RECORD};{log}"
    subprocess.run(
        ["cmake", "--preset", "default", "-B", BUILD, f"-DCMAKE_CXX_COMPILER_LAUNCHER={launcher}",
         f"-DCMAKE_C_COMPILER_LAUNCHER={launcher}", *definitions],
        check=True, stdout=subprocess.DEVNULL)
    start = time.monotonic()
    subprocess.run(["cmake", "--build", BUILD, *targets], check=True, stdout=subprocess.DEVNULL)
    wall = time.monotonic() - start
    return wall, [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]


def main(arguments):
    target, lines, shown, definitions = None, False, 0, []
    while arguments:
        word = arguments.pop(0)
        if word in ("--demo", "--program"):
            target = "keeler_demo" if word == "--demo" else "keeler"
        elif word == "--lines":
            lines = True
        elif word == "--objects":
            shown = int(arguments.pop(0))
        elif word.startswith("-D"):
            definitions.append(word)
        elif word == "--tests":
            return tests(Path(arguments[0] if arguments else "build/default"))
        else:
            print(__doc__, file=sys.stderr)
            return 2
    wall, calls = compile_all(
        ["--target", target] if target else [], [*definitions, f"-DKEELER_TESTS={'OFF' if target else 'ON'}"])
    read = {}
    if lines:
        entries = [e for e in json.loads((BUILD / "compile_commands.json").read_text()) if "/headers/" not in e["file"]]
        with ThreadPoolExecutor(os.cpu_count()) as workers:
            for entry, found in zip(entries, workers.map(lines_of, entries)):
                words = shlex.split(entry["command"])
                read[words[words.index("-o") + 1]] = found
    seconds, objects, own, others = (collections.Counter() for _ in range(4))
    for call in calls:
        folder = folder_of(call["out"])
        seconds[folder] += call["seconds"]
        objects[folder] += 1
        own[folder] += read.get(call["out"], (0, 0))[0]
        others[folder] += read.get(call["out"], (0, 0))[1]
    print(f"| folder | objects | processor seconds |{' lines of Keeler | of others |' if lines else ''}")
    print(f"|---|---|---|{'---|---|' if lines else ''}")
    for folder, used in seconds.most_common():
        more = f" {own[folder]} | {others[folder]} |" if lines else ""
        print(f"| {folder} | {objects[folder]} | {used:.1f} |{more}")
    print(f"| all | {sum(objects.values())} | {sum(seconds.values()):.1f} |")
    print(f"\n{wall:.0f} s on {os.cpu_count()} cores")
    for call in sorted(calls, key=lambda c: -c["seconds"])[:shown]:
        print(f"{call['seconds']:7.1f}  {call['out']}")
    return 0


def tests(build):
    """The mean of each test's runs, which CTest keeps."""
    costs = {}
    for line in (build / "Testing/Temporary/CTestCostData.txt").read_text(encoding="utf-8").split("---")[0].splitlines():
        name, _, mean = line.split()
        costs[name] = float(mean)
    for name, mean in sorted(costs.items(), key=lambda cost: -cost[1]):
        print(f"{mean:7.1f}  {name}")
    print(f"{sum(costs.values()):7.1f}  all {len(costs)}")
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == [RECORD]:
        sys.exit(record(sys.argv[2], sys.argv[3:]))
    os.chdir(Path(__file__).resolve().parent.parent)
    sys.exit(main(sys.argv[1:]))
