"""Remakes what the pages quote: called by scripts/remake, which says how."""

import argparse
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from made_pages import SOURCE, digest, faults_of_marks, filled, lines_like, marks, read_pages
from made_parts import MANIFEST, Stop, code_of, git, processor, read_manifest, read_parts, why_stale, write_manifest
from made_values import parsed, printed

WORK = SOURCE / "build" / "remake"
BUILD = Path(os.environ.get("KEELER_BUILD", SOURCE / "build" / "default"))


class Progress:
    """A line on standard error, renewed on a terminal each second."""

    def __init__(self, total):
        self.total, self.done, self.terminal, self.words = total, 0.0, sys.stderr.isatty(), ""

    def say(self, words):
        self.words = words
        self.tick(0.0)
        if not self.terminal:
            print(words, file=sys.stderr, flush=True)

    def tick(self, spent):
        if self.terminal:
            left = max(self.total - self.done - spent, 0.0)
            print(f"\r\033[K{self.words}, {spent:.0f} s; about {math.ceil(left / 60):d} min left", end="", file=sys.stderr, flush=True)


def run_step(command, folder, output, written, progress, spent):
    """Runs one step with its output in a file that appears when it has succeeded. Returns the seconds it took."""
    begun, running = time.monotonic(), output.with_suffix(".running")
    if running.exists():  # killed in it: what `keeler run` left stands in the way of the same command
        for left in re.findall(r"keeler run [^;&|]*-o (\S+)", command):
            shutil.rmtree(folder / left, ignore_errors=True)
    environment = dict(os.environ, ROOT=str(SOURCE), PAGES=str(written), PATH=f"{BUILD}:{os.environ['PATH']}", OMP_WAIT_POLICY="passive",
                       PYTHONPATH=str(BUILD / "python"), MPLBACKEND="Agg")
    with open(running, "wb") as out, open(folder / "errors", "wb") as errors:
        child = subprocess.Popen(["bash", "-euo", "pipefail", "-c", command], cwd=folder, env=environment, stdout=out, stderr=errors,
                                 start_new_session=True)
        try:
            while child.poll() is None:
                time.sleep(0.05 if time.monotonic() - begun < 2.0 else 1.0)
                progress.tick(spent + time.monotonic() - begun)
        except BaseException:
            os.killpg(child.pid, signal.SIGTERM)
            child.wait()
            raise
    if child.returncode:
        last = "\n".join((folder / "errors").read_text(errors="replace").splitlines()[-5:])
        raise Stop(f"exit code {child.returncode} of: {command}\n{last}")
    running.rename(output)
    return time.monotonic() - begun


def results_of(part, code, progress, folder, written):
    """Runs the steps of a part that are still to be run, with figures below `written`. Returns their outputs and the seconds of all."""
    key = digest(json.dumps([part.steps, code]))
    if not (folder / "key").exists() or (folder / "key").read_text() != key:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        for path in ("examples", "data", "docs", "scripts", "tests"):
            (folder / path).symlink_to(SOURCE / path)
        for file in part.files:
            (written / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / "key").write_text(key)
    results, spent = {}, 0.0
    for count, (name, command) in enumerate(part.steps.items(), 1):
        output, seconds = folder / f"{name}.out", folder / f"{name}.seconds"
        progress.say(f"{part.name}: step {count} of {len(part.steps)}, {name}")
        if not output.exists():
            seconds.write_text(str(run_step(command, folder, output, written, progress, spent)))
        spent += float(seconds.read_text())
        results[name] = parsed(output.read_text(encoding="utf-8"))
    return results, spent


def makers(part, results, folder):
    """For each value of the part a function that makes its text of the former one."""
    made = {name: lambda former: former for name in part.own}
    for name, template in part.values.items():
        try:
            text = printed(template, results)
        except Exception as error:
            raise Stop(f"{part.name}.{name}, '{template}': {error}") from None
        made[name] = lambda _, text=text: text
    for name, step in part.lines.items():
        made[name] = lambda former, step=step: "\n" + lines_like(former.strip("\n"), (folder / f"{step}.out").read_text())
    for name, step in part.text.items():
        made[name] = lambda _, step=step: "\n" + (folder / f"{step}.out").read_text().rstrip("\n") + "\n"
    return made


def new_pages(part, pages, results, folder):
    """The pages that change when the marks of the part are filled in."""
    values = makers(part, results, folder)
    changed = {}
    for page, text in pages.items():
        try:
            new = filled(text, part.name, values)
        except ValueError as error:
            raise Stop(f"{page}: {error}") from None
        if new != text:
            changed[page] = new
    return changed


def build(parts):
    targets = sorted({target for part in parts for target in part.builds})
    for command in (["cmake", "--preset", "default", "-DKEELER_TESTS=ON"], ["cmake", "--build", "build/default", "--target", *targets]):
        done = subprocess.run(command, cwd=SOURCE, capture_output=True, text=True)
        if done.returncode:
            raise Stop(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")


def remake(chosen):
    for part in chosen:
        if changed := git("status", "--porcelain", "--", *part.paths(), ":!*.md").strip():
            raise Stop(f"{part.name} rests on files that are not committed, so no commit would make it:\n{changed}")
    build(chosen)
    progress, failed = Progress(sum(part.seconds for part in chosen)), []
    for count, part in enumerate(chosen, 1):
        try:
            results, seconds = results_of(part, code_of(part), progress, WORK / part.name, SOURCE)
            for page, text in new_pages(part, read_pages(), results, WORK / part.name).items():
                (SOURCE / page).write_text(text, encoding="utf-8")
        except Stop as error:
            print(f"\n{part.name}: {error}", file=sys.stderr)
            failed.append(part.name)
            continue
        finally:
            progress.done += part.seconds
        manifest = read_manifest()
        manifest[part.name] = {"made": part.contents(read_pages()), "steps": part.steps, "commit": git("rev-parse", "HEAD").strip(),
                               "code": code_of(part), "seconds": round(seconds, 1), "machine": processor()}
        write_manifest(manifest)
        shutil.rmtree(WORK / part.name)
        print(f"\r\033[K[{count}/{len(chosen)}] {part.name}: {seconds:.1f} s" if progress.terminal
              else f"[{count}/{len(chosen)}] {part.name}: {seconds:.1f} s", file=sys.stderr, flush=True)
    return 1 if failed else 0


def differences(part, folder):
    """Runs a part in `folder`, and yields what differs from the pages."""
    written, pages = folder / "written", read_pages()
    shutil.rmtree(folder, ignore_errors=True)
    results, _ = results_of(part, "", Progress(part.seconds), folder, written)
    for page, text in new_pages(part, pages, results, folder).items():
        for old, new in zip(marks({page: pages[page]}), marks({page: text})):
            if old != new:
                yield f"{page}: {part.name}.{old[2]} is {old[3].strip()}, and is now {new[3].strip()}"
    for file in part.files:
        if digest((written / file).read_bytes()) != digest((SOURCE / file).read_bytes()):
            yield f"{file} is now another one"


def check(chosen):
    """Runs the parts and compares with the pages."""
    found = 0
    for part in chosen:
        if part.own or part.page:
            raise Stop(f"{part.name} writes its page itself, so it cannot be checked")
        begun = time.monotonic()
        now = list(differences(part, WORK / f"check-{part.name}"))
        print(*now, f"{part.name}: {len(now)} differences, {time.monotonic() - begun:.1f} s", sep="\n")
        shutil.rmtree(WORK / f"check-{part.name}")
        found += len(now)
    return 1 if found else 0


def test(parts):
    """What is wrong with marks, parts and the manifest, without a run."""
    pages, faults, seen = read_pages(), [], set()
    for page, text in pages.items():
        faults += faults_of_marks(page, text)
    for page, part, value, _ in marks(pages):
        seen.add((part, value))
        if part not in parts or value not in parts[part].marked():
            faults.append(f"{page}: scripts/parts has no part '{part}' with a value '{value}'")
    for part in parts.values():
        faults += [f"scripts/parts: no page has a mark {part.name}.{value}" for value in part.marked() if (part.name, value) not in seen]
        faults += [f"scripts/parts: {part.name} makes {what}, which is not there" for what, found in part.contents(pages).items() if found is None]
        faults += [f"scripts/parts: {part.name} rests on {path}, which is not there" for path in part.paths() if not (SOURCE / path).exists()]
        if not part.contents(pages):
            faults.append(f"scripts/parts: {part.name} makes nothing")
    for name, entry in read_manifest().items():
        if name not in parts:
            faults.append(f"{MANIFEST.name}: {name} is no part of scripts/parts: take it out")
            continue
        now = parts[name].contents(pages)
        faults += [f"{what} is not what `scripts/remake {name}` wrote: run it, or take {name} out of docs/{MANIFEST.name}"
                   for what in sorted(entry["made"] | now) if entry["made"].get(what) != now.get(what)]
    print(*faults, sep="\n")
    print(f"{len(parts)} parts, {len(seen)} marks, {len(read_manifest())} made, {len(faults)} faults")
    return 1 if faults else 0


def show_list(parts):
    pages, manifest = read_pages(), read_manifest()
    for part in sorted(parts.values(), key=lambda p: p.seconds):
        took = manifest[part.name]["seconds"] if part.name in manifest else part.seconds
        print(f"{part.name}  {took:g} s{', quotes times' if part.timed else ''}")
        print(f"    makes    {', '.join(part.contents(pages))}")
        print(f"    rests on {', '.join(part.rests)}")
    print(f"{len(parts)} parts, {sum(p.seconds for p in parts.values()) / 60:.0f} min")
    return 0


def show_stale(parts):
    manifest, stale = read_manifest(), []
    for part in sorted(parts.values(), key=lambda p: p.seconds):
        if why := why_stale(part, manifest):
            stale.append(part)
            print(f"{part.name}  {part.seconds:g} s: {why}\n    {', '.join(part.contents(read_pages()))}")
    print(f"{len(stale)} of {len(parts)} parts are stale: {sum(p.seconds for p in stale) / 60:.0f} min")
    return 0


def chosen_parts(parts, asked):
    if unknown := [name for name in asked.names if name not in parts]:
        raise Stop(f"there is no part '{unknown[0]}'; scripts/remake --list shows them")
    manifest = read_manifest()
    chosen = [parts[name] for name in asked.names] if asked.names else \
        [part for part in parts.values() if asked.all or why_stale(part, manifest)]
    chosen = [part for part in chosen if not (asked.untimed and part.timed)]
    return sorted(chosen, key=lambda part: (part.timed, part.seconds)) if not asked.check else chosen


def main():
    options = argparse.ArgumentParser(prog="scripts/remake", description="Remakes what the pages quote.")
    options.add_argument("names", nargs="*", metavar="NAME")
    for flag, meaning in (("all", "every part, stale or not"), ("untimed", "leave out the parts that quote times"), ("list", "list the parts"),
                          ("stale", "list the stale parts"), ("test", "compare marks, pages and docs/made.json"),
                          ("check", "run parts, compare with the pages, write nothing; KEELER_BUILD names another build folder")):
        options.add_argument(f"--{flag}", action="store_true", help=meaning)
    asked = options.parse_args()
    parts = read_parts()
    if asked.list:
        return show_list(parts)
    if asked.stale:
        return show_stale(parts)
    if asked.test:
        return test(parts)
    chosen = chosen_parts(parts, asked)
    return check(chosen) if asked.check else remake(chosen)


if __name__ == "__main__":
    for stop_signal in (signal.SIGINT, signal.SIGTERM):  # which a shell may have set to be ignored
        signal.signal(stop_signal, signal.default_int_handler)
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # --list | head
    try:
        sys.exit(main())
    except Stop as stop:
        sys.exit(f"remake: {stop}")
    except KeyboardInterrupt:
        sys.exit("\nremake: stopped; the same command goes on")
