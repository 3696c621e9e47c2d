"""Copies the sources and puts all faults of mutations.txt into the copy, each behind a switch.

Usage: insert.py TOP COPY. Prints a line for each fault: number, program, filter, place, old, new,
with tabs between them. Files that would be the same are left alone, so that little is built anew.
"""
import pathlib
import re
import subprocess
import sys

SWITCH = """#pragma once
#include <cstdlib>
/// Whether this fault is the one that POLEMCL_FAULT names.
inline bool isFault(int number) {
  static const char* wanted = std::getenv("POLEMCL_FAULT");
  static const int fault = wanted ? std::atoi(wanted) : 0;
  return fault == number;
}
"""


def table(path):
    """The faults, from 1: (number, file, old, new, program, filter)."""
    faults = []
    for line in path.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        file, old, new, tests = line.split(" | ")
        faults.append((len(faults) + 1, "libpolemcl/src/" + file, old, new, *tests.split()))
    return faults


def insert(text, faults):
    """The source with its faults, and the line of each."""
    places = {}
    for number, file, old, new, _, _ in faults:
        found = list(re.finditer(r"\s+".join(map(re.escape, old.split(" "))), text))
        if len(found) != 1:
            sys.exit(f"mutations.txt: {old} stands {len(found)} times in {file}; choose another expression")
        places[number] = text.count("\n", 0, found[0].start()) + 1
        text = f"{text[:found[0].start()]}(isFault({number}) ? ({new}) : ({old})){text[found[0].end():]}"
    return '#include "isFault.h"\n#line 1\n' + text, places


def write(path, data):
    if not path.is_file() or path.read_bytes() != data:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def main():
    top, copy = map(pathlib.Path, sys.argv[1:])
    faults = table(top / "tests/mutation/mutations.txt")
    listing = ["git", "-C", top, "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.check_output(listing, text=True).split("\0")
    places = {}
    for name in filter(None, names):
        if not (top / name).is_file():
            continue
        data = (top / name).read_bytes()
        own = [fault for fault in faults if fault[1] == name]
        if own:
            text, lines = insert(data.decode(), own)
            data, places = text.encode(), {**places, **lines}
        write(copy / name, data)
        (copy / name).chmod((top / name).stat().st_mode)
    write(copy / "libpolemcl/src/isFault.h", SWITCH.encode())
    for number, file, old, new, program, tests in faults:
        print(number, program, tests, f"{file}:{places[number]}", old, new, sep="\t")


main()
