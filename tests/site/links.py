#!/usr/bin/env python3
"""Checks that each link, anchor and picture of a built site is there. Usage: links.py SITE

Doxygen's pages are not read for links of their own: Doxygen has checked these. Links to other hosts are not followed.
"""
import functools
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """The anchors of a page, and where its links and pictures point."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.targets = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name == "id" or (tag == "a" and name == "name"):
                self.anchors.add(value)
            if name in ("href", "src") and tag in ("a", "img") and value is not None:
                self.targets.append(value)


@functools.lru_cache(maxsize=None)
def page_of(path):
    return Page(path)


def fault(site, path, target):
    """What is wrong with a link on a page; an empty text if nothing is."""
    parts = urllib.parse.urlsplit(target)
    if parts.scheme or parts.netloc:
        return ""
    name = urllib.parse.unquote(parts.path)
    file = (path.parent / name).resolve() if name else path
    if file.is_dir():
        file = file / "index.html"
    if site not in file.parents or not file.is_file():
        return "no such file"
    anchor = urllib.parse.unquote(parts.fragment)
    if anchor and file.suffix == ".html" and anchor not in page_of(file).anchors:
        return "no such anchor on that page"
    return ""


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    pages = [path for path in sorted(site.rglob("*.html"))
             if "api" not in path.relative_to(site).parts and path.name != "404.html"]
    faults, links = [], 0
    for path in pages:
        for target in page_of(path).targets:
            links += 1
            wrong = fault(site, path, target)
            if wrong:
                faults.append(f"{path.relative_to(site)}: {target}: {wrong}")
    for line in sorted(set(faults)):
        print(line, file=sys.stderr)
    if links < 1000:
        sys.exit(f"links.py: only {links} links were found in {site}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
