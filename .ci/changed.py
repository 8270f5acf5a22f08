"""What the last hours' commits changed, comments aside: what came before them was looked at then."""

import os
import re
import subprocess
from pathlib import Path

TOPS = ("include/keeler", "src", "lab")
INCLUDE = re.compile(r'#include ([<"])(.*)[>"]')
COMMENT = re.compile(r"(^|\s)//.*$", re.M)
HOURS = 4  # of commits before the last one


def git(*words):
    return subprocess.run(["git", *words], capture_output=True, text=True, check=False).stdout


def changed_lately():
    """Paths of files that have other code than before the last hours, and of those that lost a word or an include."""
    last = int(git("log", "--format=%ct", "-1"))
    before = git("rev-list", "-1", f"--before={last - 3600 * HOURS}", "HEAD").strip()
    paths = git("diff", "--name-only", before, "HEAD") if before else git("ls-files")
    changed, lost = set(), set()
    for path in paths.split("\n"):
        if path.endswith((".cpp", ".hpp", ".inl")) and path.startswith(TOPS) and os.path.exists(path):
            old, new = (COMMENT.sub("", text) for text in (git("show", f"{before}:{path}"), Path(path).read_text()))
            if old.split() != new.split():
                changed.add(path)
            if any(set(part.findall(old)) - set(part.findall(new)) for part in (re.compile(r"\w+"), INCLUDE)):
                lost.add(path)
    return changed, lost
