"""What MkDocs calls while it makes the site (mkdocs.yml): pages are written in GitHub's Markdown, and in two things the
site's reader of Markdown is of another opinion. The library's reference is in the site alone, and so are links to it."""

import re


def on_page_markdown(markdown, page, **_):
    """A list may follow a paragraph without an empty line between them."""
    if page.file.src_path == "docs/manual/library.md":
        markdown = markdown.replace("the library's reference", "[the library's reference](../../reference/index.html)")
    lines, fenced, previous = [], False, ""
    for line in markdown.splitlines():
        if line.startswith("```"):
            fenced = not fenced
        starts_list = re.match(r"(-|\d+\.) ", line) and not fenced
        if starts_list and previous and not re.match(r"(-|\d+\.| ) ?", previous):
            lines.append("")
        lines.append(line)
        previous = line
    return "\n".join(lines)


def on_page_content(html, **_):
    """In the code of a table's cell, a bar that does not part cells has a backslash before it."""
    return re.sub(r"<code>[^<]*</code>", lambda code: code[0].replace("\\|", "|"), html)
