#!/usr/bin/env python3
"""Checks that no page of the site takes longer than ten minutes to read, and that each document has its place in the
navigation. Usage: length.py SOURCES

Words are what stands between blanks and has a letter or a digit, in texts, tables and code. The list of changes, the
benchmark and what programs print for --help may be longer: nobody reads all of them.
"""
import pathlib
import re
import sys

LIMIT = 2000
LONGER = {"CHANGELOG.md", "share/reports/BENCHMARK.md"}


def words_of(page):
    return sum(1 for word in page.read_text(encoding="utf-8").split() if re.search(r"\w", word))


def main():
    sources = pathlib.Path(sys.argv[1])
    navigation = (sources / "share/site/mkdocs.yml").read_text(encoding="utf-8").partition("\nnav:\n")[2]
    pages = re.findall(r":\s+(\S+\.md)$", navigation, re.M)
    faults = []
    for name in pages:
        if name.startswith("help/"):  # share/site/build.sh writes them
            continue
        words = words_of(sources / name)
        if words > LIMIT and name not in LONGER:
            faults.append(f"{name}: {words} words, at most {LIMIT} are allowed: cut it, or make two pages of it")
    for path in sorted((sources / "share/doc").glob("*.md")):
        if f"share/doc/{path.name}" not in pages:
            faults.append(f"share/doc/{path.name}: not in nav of share/site/mkdocs.yml: give it a place there")
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    if len(pages) < 30:
        sys.exit(f"length.py: only {len(pages)} pages were found in nav of share/site/mkdocs.yml")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
