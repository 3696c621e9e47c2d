"""A hook of mkdocs. The documents are written for GitHub's Markdown, which takes a list right behind a line of text, and
parts of an item that stand two or three spaces in. Python's Markdown needs an empty line and four spaces."""
import re

ITEM = re.compile(r"\s*([-*+]|\d+\.)\s")


def on_page_markdown(markdown, **_):
    lines, fence, before = [], None, ""
    for line in markdown.splitlines():
        indent = len(line) - len(line.lstrip(" "))
        if line.lstrip().startswith("```"):
            fence = indent if fence is None else None
        if 1 < indent < 4 and (fence is None or fence > 0):
            line = " " * (4 - indent) + line
        elif fence:  # code of a block within an item
            line = " " * (4 - fence) + line
        if fence is None and ITEM.match(line) and before.strip() and not re.match(r"\s", before) \
                and not ITEM.match(before):
            lines.append("")
        lines.append(line)
        before = line
    return "\n".join(lines)
