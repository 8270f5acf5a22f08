#!/usr/bin/env python3
"""links.py FOLDER: every link of the Markdown and HTML pages below FOLDER leads to a file, and to a place in it, that is
there; no HTML page loads anything from the network. Folders named build or runs, and hidden ones, are left out. Links of
Markdown are taken as GitHub takes them."""

import os
import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page:
    """What a page links to, as (line, target), and the places in it that links may name."""

    def __init__(self):
        self.links = []
        self.places = set()
        self.loads = []  # targets that a browser fetches to show the page


def slug(heading, taken):
    """The name that GitHub gives to a heading."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
    name = re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")
    number = taken.get(name, 0)
    taken[name] = number + 1
    return f"{name}-{number}" if number else name


def read_markdown(text):
    page, taken, fenced = Page(), {}, False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        if fenced or line.startswith("    "):
            continue
        if heading := re.match(r"#+ (.*)", line):
            page.places.add(slug(heading[1], taken))
        line = re.sub(r"`[^`]*`", "code", line)
        page.links += [(number, target) for target in re.findall(r"\]\(([^)\s]+)\)", line)]
    return page


class HtmlReader(HTMLParser):
    def __init__(self):
        super().__init__()
        self.page = Page()

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.page.places.update(values[key] for key in ("id", "name") if values.get(key))
        for key in ("href", "src"):
            if values.get(key):
                self.page.links.append((self.getpos()[0], values[key]))
                if tag != "a":
                    self.page.loads.append(values[key])


def read_html(text):
    reader = HtmlReader()
    reader.feed(text)
    return reader.page


READERS = {".md": read_markdown, ".html": read_html}


def read_pages(root):
    pages = {}
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if name not in ("build", "runs") and not name.startswith(".")]
        for path in (Path(folder) / name for name in names):
            if path.suffix in READERS:
                pages[path.resolve()] = READERS[path.suffix](path.read_text(encoding="utf-8"))
    return pages


def complaint(root, pages, path, target):
    """Why a link of a page is dead, or None. One that begins with / is seen from the root."""
    parts = urlsplit(target)
    if parts.scheme or parts.netloc:
        fetched = parts.scheme != "javascript" and target in pages[path].loads
        return "is fetched from the network" if fetched else None
    base = root if parts.path.startswith("/") else path.parent
    there = (base / unquote(parts.path).lstrip("/")).resolve() if parts.path else path
    if not there.exists():
        return "is not there"
    if there.is_dir() and path.suffix == ".html" and not (there / "index.html").exists():
        return "is a folder without a page"
    place = unquote(parts.fragment)
    if place and there in pages and place not in pages[there].places:
        return "has no such place"
    return None


def main():
    root = Path(sys.argv[1])
    pages = read_pages(root)
    dead = 0
    for path, page in sorted(pages.items()):
        for line, target in page.links:
            if why := complaint(root, pages, path, target):
                print(f"{path}:{line}: {target} {why}")
                dead += 1
    links = sum(len(page.links) for page in pages.values())
    print(f"{len(pages)} pages, {links} links, {dead} of them dead")
    sys.exit(1 if dead or not links else 0)


if __name__ == "__main__":
    main()
