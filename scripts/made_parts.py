"""The parts that scripts/remake makes, as the files of scripts/parts declare them, and docs/made.json, which says what made them."""

import json
import subprocess
import tomllib
from pathlib import Path

from made_pages import SOURCE, digest, marks, section

PARTS = SOURCE / "scripts" / "parts"
MANIFEST = SOURCE / "docs" / "made.json"


class Stop(Exception):
    """A part cannot be made: why, and what to do."""


class Part:
    """One entry of scripts/parts: steps that run, and what they make."""

    KEYS = {"page", "section", "files", "seconds", "timed", "builds", "rests", "steps", "values", "lines", "text", "own"}

    def __init__(self, name, entry, groups):
        if unknown := set(entry) - Part.KEYS:
            raise Stop(f"scripts/parts: {name} has a key '{min(unknown)}' that is none")
        self.name = name
        self.page, self.section = entry.get("page"), entry.get("section")
        self.files = entry.get("files", [])
        self.seconds, self.timed = entry["seconds"], entry.get("timed", False)
        self.builds = entry.get("builds", ["keeler"])
        self.steps = entry["steps"]  # name: command of bash
        self.values, self.lines, self.text = (entry.get(key, {}) for key in ("values", "lines", "text"))
        self.own = entry.get("own", [])
        self.rests = []
        for rest in entry["rests"]:
            self.rests += groups.get(rest, [rest])

    def marked(self):
        return [*self.values, *self.lines, *self.text, *self.own]

    def paths(self):
        """What the part rests on, in the source tree: folders by their names, others by their paths."""
        for rest in self.rests:
            if "/" in rest:
                yield rest
            else:
                yield from (p for p in (f"include/keeler/{rest}", f"src/{rest}", f"lab/{rest}") if (SOURCE / p).exists())

    def contents(self, pages):
        """Maps each thing that the part makes to a digest of it; None where it is not there."""
        made = {}
        if self.page:
            text = pages.get(self.page)
            text = section(text, self.section) if text is not None and self.section else text
            made[f"{self.page}#{self.section}" if self.section else self.page] = digest(text) if text else None
        for page, part, value, text in marks(pages):
            if part == self.name:
                made[page] = digest(made.get(page, "") + value + text)
        for file in self.files:
            path = SOURCE / file
            made[file] = digest(path.read_bytes()) if path.exists() else None
        return made


def read_parts():
    entries, groups = {}, {}
    for file in sorted(PARTS.glob("*.toml")):
        read = tomllib.loads(file.read_text(encoding="utf-8"))
        groups |= read.get("groups", {})
        if twice := set(entries) & set(read.get("part", {})):
            raise Stop(f"{file.relative_to(SOURCE)}: there are two parts '{min(twice)}'")
        entries |= read.get("part", {})
    return {name: Part(name, entry, groups) for name, entry in entries.items()}


def read_manifest():
    return json.loads(MANIFEST.read_text(encoding="utf-8")) if MANIFEST.exists() else {}


def write_manifest(manifest):
    new = MANIFEST.with_suffix(".new")
    new.write_text(json.dumps(dict(sorted(manifest.items())), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    new.rename(MANIFEST)


def git(*words):
    return subprocess.run(["git", "-C", SOURCE, *words], capture_output=True, text=True, check=True).stdout


def code_of(part):
    """A digest of the committed files that the part rests on: the same whatever the history. Pages are no code."""
    rows = git("ls-tree", "-r", "-z", "HEAD", "--", *part.paths()).split("\0")
    return digest("\n".join(row for row in rows if not row.endswith(".md")))


def why_stale(part, manifest):
    entry = manifest.get(part.name)
    if not entry:
        return "never made by scripts/remake"
    if entry["steps"] != part.steps:
        return "its commands have changed"
    if entry["code"] == code_of(part):
        return None
    try:
        newer = git("log", "--format=%h %s", f"{entry['commit']}..HEAD", "--", *part.paths(), ":!*.md").splitlines()
    except subprocess.CalledProcessError:
        newer = []  # that commit is of another history
    return f"{len(newer)} commits since {entry['commit'][:9]}, the last one: {newer[0]}" if newer else f"the code differs from that of {entry['commit'][:9]}"


def processor():
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return " ".join(line.split(":", 1)[1].split())
    return "unknown"
