"""The marks in the pages, which scripts/remake fills in.

A mark is <!--made:PART.VALUE-->TEXT<!--/-->: a comment that no reader of the page sees. TEXT is a number in a sentence, or whole
lines, a table or a block of code, between marks on lines of their own."""

import hashlib
import re
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1]
MARK = re.compile(r"<!--made:([a-z0-9-]+)\.([a-z0-9-]+)-->(.*?)<!--/-->", re.S)
ANY = re.compile(r"<!--(made:[^>]*|/)-->")


def page_files():
    """The pages that may hold marks."""
    return [SOURCE / "README.md", *sorted((SOURCE / "docs").rglob("*.md")), *sorted((SOURCE / "examples").rglob("*.md"))]


def read_pages():
    return {path.relative_to(SOURCE).as_posix(): path.read_text(encoding="utf-8") for path in page_files()}


def marks(pages):
    """Yields (page, part, value, text) of each mark."""
    for page, text in pages.items():
        for found in MARK.finditer(text):
            yield page, found[1], found[2], found[3]


def filled(text, part, values):
    """The page's text with the marks of `part` filled in; `values` maps a name to a function of the former text."""
    def fill(found):
        if found[1] != part:
            return found[0]
        return f"<!--made:{found[1]}.{found[2]}-->{values[found[2]](found[3])}<!--/-->"

    return MARK.sub(fill, text)


def section(text, name):
    """The part of a page below a heading `name`, up to the next one of that level or above; None without such a heading."""
    heading = re.search(rf"^(#+) {re.escape(name)}\n", text, re.M)
    if not heading:
        return None
    end = re.search(rf"^#{{1,{len(heading[1])}}} ", text[heading.end():], re.M)
    return text[heading.end():heading.end() + end.start()] if end else text[heading.end():]


def digest(data):
    return hashlib.sha256(data if isinstance(data, bytes) else data.encode()).hexdigest()[:16]


def faults_of_marks(page, text):
    """Marks that are not closed, or that a reader would see."""
    for found in re.finditer(r"<!-- ?made.*?-->|<!--/-->", text):
        if not ANY.fullmatch(found[0]) or (found[0] != "<!--/-->" and not MARK.match(text, found.start())):
            yield f"{page}: {found[0]} is not closed, or is no mark"
    if len(re.findall(r"<!--made:", text)) != len(re.findall(r"<!--/-->", text)):
        yield f"{page}: marks and their ends do not match"
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            fenced = not fenced
        if not ANY.search(line):
            continue
        alone = ANY.fullmatch(line)
        if fenced or line.startswith("    "):
            yield f"{page}:{number}: a mark within code would be seen"
        elif re.match(r"<!--", line) and not alone:
            yield f"{page}:{number}: a mark that begins a line would make it HTML: move a word before it"


def lines_like(former, output):
    """The lines of a block of code `former`, each as the line of `output` with the same label has it; elisions stay."""
    printed = {}
    for line in output.splitlines():
        printed.setdefault(label(line), line)
    made = []
    for line in former.splitlines():
        if line in ("", "…") or line.startswith("```"):
            made.append(line)
        elif label(line) in printed:
            made.append(printed[label(line)].rstrip())
        else:
            raise ValueError(f"the command does not print a line '{label(line)}'")
    return "\n".join(made) + "\n"


def label(line):
    return re.split(r"  +", line.strip())[0]
