"""What MkDocs calls while it makes the site (mkdocs.yml): pages are written in GitHub's Markdown, and in two things the
site's reader of Markdown is of another opinion."""

import re


def on_page_markdown(markdown, **_):
    """A list may follow a paragraph without an empty line between them."""
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
