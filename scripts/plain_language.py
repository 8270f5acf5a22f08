#!/usr/bin/env python3
"""Counts words that make comments and docs hard to read for those who know the field but not Keeler.

  scripts/plain_language.py                a table: hits per 1000 words, a row per folder
  scripts/plain_language.py --list PATH    each hit in the files at or below PATH
  scripts/plain_language.py --check        exit 1 where code, docs or a folder has more than its limit

A hit is a place to look at: "a particle whose radius ..." is good English, "who leaves gets a new one" is not. So each
pattern has a limit per 1000 words, which the comments of well-known N-body codes hold. A folder has one hit more, since
most folders have fewer than a thousand words. docs/dev/project.md says how comments are written instead."""
import argparse
import collections
import math
import pathlib
import os
import re
import sys

Pattern = collections.namedtuple("Pattern", "name expression code docs")  # limits per 1000 words
PATTERNS = [
    Pattern("who", r"(?i)\bwho(m|se|ever)?\b", 0.3, 0.3),
    Pattern("nobody", r"(?i)\b(no|some|every)body('s)?\b", 0.05, 0.1),
    Pattern("those", r"(?i)\bthose\b", 0.5, 0.6),
    Pattern("stands", r"(?i)\bst(and|ands|ood)\b", 0.2, 0.4),
    Pattern("a step", r"\b(ns|us|ms|s|bytes|rows?|file|line|instructions) an? (particle|step|run|row|contact|file|orbit)\b", 0.1, 0.1),
    Pattern("anew", r"(?i)\banew\b", 0.05, 0.1),
    Pattern("the same", r"(^|[.;:] )The same\b(?! (bits?|particles?|scene|state|run|file|number))", 0.3, 0.3),
    Pattern("dear", r"(?i)\b(one's|what becomes of|dearer|dear)\b", 0.1, 0.1),
]
# A comment on a declaration begins with a noun or a verb. Titles and list items of docs may begin as they like.
FIRST_WORD = Pattern("Of, Where ...", r"^(Of|To|From|Where|Who|Whom|Whether|How|Which|By|In|With|Others?|Then)\b", 2.0, math.inf)
ALL = PATTERNS + [FIRST_WORD]


def comment_blocks(text):
    """Yields (line, text) of each comment: neighbouring lines that hold nothing else are one."""
    lines, begin = [], 0
    for number, line in enumerate(text.splitlines() + [""], 1):
        bare = re.sub(r'"(\\.|[^"\\])*"', '""', line)
        code, slashes, comment = bare.partition("//")
        if slashes and not code.strip():
            begin = begin if lines else number
            lines.append(comment.lstrip("/!< "))
            continue
        if lines:
            yield begin, " ".join(lines)
            lines = []
        if slashes:
            yield number, comment.lstrip("/!< ")


def paragraphs(text):
    """Yields (line, text) of each paragraph of Markdown, without code and addresses of links."""
    fenced, lines, begin = False, [], 0
    for number, line in enumerate(text.splitlines() + [""], 1):
        fence = line.lstrip().startswith("```")
        fenced ^= fence
        if fenced or fence or line.startswith("    ") or not line.strip("|-: \t"):
            if lines:
                yield begin, " ".join(lines)
            lines = []
        else:
            begin = begin if lines else number
            lines.append(re.sub(r"`[^`]*`|\]\([^)]*\)", " ", line))


def files():
    """Yields (path, kind, folder) of all sources and pages."""
    for path in sorted(p for top in ("src", "lab", "include", "docs", "examples", ".") for p in pathlib.Path(top).glob("*" if top == "." else "**/*")):
        parts = path.parts
        if path.suffix in (".cpp", ".hpp") and len(parts) > 2:
            yield path, "code", "src/" + parts[2 if parts[0] == "include" else 1]
        elif path.suffix == ".md" and path.name != "CHANGELOG.md":
            yield path, "docs", path.name if len(parts) == 1 else parts[0] if parts[0] == "examples" else "/".join(parts[:-1][:2])


def hits_in(path, kind):
    """Returns the number of words, and a list of (pattern, line, text)."""
    words, hits = 0, []
    for line, text in (comment_blocks if kind == "code" else paragraphs)(path.read_text(encoding="utf-8")):
        words += len(re.findall(r"[A-Za-z']+", text))
        for pattern in ALL:
            if pattern is not FIRST_WORD or kind == "code":
                hits += [(pattern, line, text) for _ in re.finditer(pattern.expression, text)]
    return words, hits


class Count:
    """Words, and hits of each pattern, of one row of the table."""

    def __init__(self):
        self.words, self.hits = 0, collections.Counter()

    def add(self, words, hits):
        self.words += words
        self.hits.update(pattern.name for pattern, _, _ in hits)

    def row(self):
        return "".join(f"{1000 * self.hits[p.name] / max(self.words, 1):14.2f}" for p in ALL)

    def too_many(self, kind, more):
        """Patterns with more hits than the limit and `more`."""
        return [f"{p.name}: {self.hits[p.name]}" for p in ALL
                if self.hits[p.name] > getattr(p, kind) * self.words / 1000 + more]


def main():
    os.chdir(pathlib.Path(__file__).resolve().parent.parent)
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--list", metavar="PATH", type=pathlib.Path)
    options.add_argument("--check", action="store_true")
    asked = options.parse_args()
    rows = {"code": Count(), "docs": Count()}
    kinds = {"code": "code", "docs": "docs"}
    for path, kind, folder in files():
        words, hits = hits_in(path, kind)
        kinds[folder] = kind
        for row in (kind, folder):
            rows.setdefault(row, Count()).add(words, hits)
        if asked.list and (path == asked.list or asked.list in path.parents or folder == str(asked.list)):
            for pattern, line, text in hits:
                print(f"{path}:{line}: {pattern.name}: {text[:140]}")
    if asked.list:
        return 0
    print(f"{'hits per 1000 words':28}{'words':>8}" + "".join(f"{p.name:>14}" for p in ALL))
    for name, count in rows.items():
        print(f"{name:28}{count.words:8}{count.row()}")
    for kind in ("code", "docs"):
        print(f"{'limit, ' + kind:36}" + "".join(f"{getattr(p, kind):14.2f}" for p in ALL))
    above = [f"{name} has too many: {', '.join(many)} (scripts/plain_language.py --list {name} shows them)"
             for name, count in rows.items() if (many := count.too_many(kinds[name], 0 if name in ("code", "docs") else 1))]
    print(*above, sep="\n")
    return int(asked.check and bool(above))


if __name__ == "__main__":
    sys.exit(main())
