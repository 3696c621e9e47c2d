"""Compares the numbers of JSON files with those of a list.

Usage: figures.py FOLDER LIST TOLERANCE WRITE
LIST has a line for each number, `FILE/KEY VALUE`; figures of files that are not in FOLDER do not count.
With WRITE = yes the list is written instead. Times and the identity of the build are left out.
"""
import json
import pathlib
import sys

SKIPPED = {"build", "config", "format_version", "version", "versions"}


def numbers(node, place):
    """Pairs of a place and a number."""
    if isinstance(node, dict):
        for key, value in node.items():
            if key not in SKIPPED and not key.endswith(("_ms", "_s")):
                yield from numbers(value, f"{place}/{key}")
    elif isinstance(node, list):
        for i, value in enumerate(node):
            yield from numbers(value, f"{place}/{i}")
    elif isinstance(node, (int, float)) and not isinstance(node, bool):
        yield place, float(node)


def main():
    folder, listed, tolerance, write = sys.argv[1:]
    found = {}
    for path in sorted(pathlib.Path(folder).glob("*.json")):
        found.update(numbers(json.loads(path.read_text()), path.stem))
    if write == "yes":
        pathlib.Path(listed).write_text("".join(f"{place} {value:.9g}\n" for place, value in found.items()))
        return
    lines = [line.split() for line in pathlib.Path(listed).read_text().splitlines()]
    files = {place.split("/")[0] for place in found}
    expected = {place: float(value) for place, value in lines if place.split("/")[0] in files}
    bad = 0
    for place in sorted(expected.keys() | found.keys()):
        before, now = expected.get(place), found.get(place)
        # Nine digits are written.
        if before is None or now is None or abs(now - before) > (float(tolerance) + 1e-8) * abs(before) + 1e-12:
            print(f"{place}: {before} before, {now} now")
            bad += 1
    print(f"golden figures: {len(found)} compared, {bad} differ")
    sys.exit(bad > 0)


main()
