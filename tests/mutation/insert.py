"""Copies the sources and puts all faults of a list into the copy, each behind a switch.

Usage: insert.py TOP COPY LIST. LIST is as mutations.txt; drawn faults lack the last field. Prints a
line for each fault: number, program, filter, place, old, new, with tabs between them. Files that would
be the same are left alone, so that little is built anew.
"""
import pathlib
import re
import subprocess
import sys

SWITCH = """#pragma once
#include <atomic>
#include <cstdlib>
#include <fstream>
/// The faults that are reached; written to the file POLEMCL_FAULTS_REACHED at the end, if it is given.
struct ReachedFaults {
  const char* file = std::getenv("POLEMCL_FAULTS_REACHED");
  std::atomic<bool> reached[1000] = {};
  ~ReachedFaults() {
    if (!file) return;
    std::ofstream out(file, std::ios::app);
    for (int i = 0; i < 1000; ++i)
      if (reached[i]) out << i << '\\n';
  }
};
/// Whether this fault is the one that POLEMCL_FAULT names.
inline bool isFault(int number) {
  static const char* wanted = std::getenv("POLEMCL_FAULT");
  static const int fault = wanted ? std::atoi(wanted) : 0;
  static ReachedFaults faults;
  if (faults.file) faults.reached[number].store(true, std::memory_order_relaxed);
  return fault == number;
}
"""


def table(path):
    """The faults, from 1: (number, file, old, new, program, filter)."""
    faults = []
    for line in path.read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        file, old, new, *tests = line.split(" | ")
        program, suites = tests[0].split() if tests else ("all", "*")
        faults.append((len(faults) + 1, "libpolemcl/src/" + file, old, new, program, suites))
    return faults


def insert(text, faults):
    """The source with its faults, and the line of each."""
    spans = []
    for number, file, old, new, _, _ in faults:
        found = list(re.finditer(r"\s+".join(map(re.escape, old.split(" "))), text))
        if len(found) != 1:
            sys.exit(f"{sys.argv[3]}: {old} stands {len(found)} times in {file}; choose another expression")
        spans.append((*found[0].span(), f"(isFault({number}) ? ({new}) : ({old}))", number))
    places = {number: text.count("\n", 0, begin) + 1 for begin, _, _, number in spans}
    for begin, end, switch, _ in sorted(spans, reverse=True):
        text = text[:begin] + switch + text[end:]
    return '#include "isFault.h"\n#line 1\n' + text, places


def write(path, data):
    if not path.is_file() or path.read_bytes() != data:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def main():
    top, copy, faults = map(pathlib.Path, sys.argv[1:])
    faults = table(faults)
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
