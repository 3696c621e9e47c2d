#!/bin/sh
# Prints the share of lines and branches that the tests reach, for each room of share/doc/architecture.md.
# Usage: tests/coverage.sh [TEST_PROGRAM...]
#   TEST_PROGRAM  builds and runs only these (test_core, test_io, ...); without: all tests
# Of all tests, exits with 1 when they reach less than 95 % of the lines, or less than 85 % of the branches.
# Builds in build-coverage, little optimized. Counts of code that runs in several threads are not exact.
# Needs gcovr, which share/setup/install.sh full installs.
set -eu
top=$(cd "$(dirname "$0")/.." && pwd)
build=$top/build-coverage
[ $# -gt 0 ] || set -- all

for target in "$@"; do "$top/share/setup/build.sh" coverage "$target"; done
find "$build" -name '*.gcda' -delete
if [ "$1" = all ]; then
  ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)"
else
  for program in "$@"; do "$build/bin/$program" --gtest_brief=1; done
fi

# Branches of exceptions that no source line names do not count.
gcovr --root "$top" --object-directory "$build" --filter "$top/libpolemcl/" --filter "$top/apps/" \
  --exclude-throw-branches --exclude-unreachable-branches --gcov-ignore-parse-errors \
  -j "$(nproc)" --json-summary "$build/coverage.json"
python3 - "$build/coverage.json" "$1" <<'END'
import collections, json, os, sys

rooms = collections.defaultdict(lambda: [0, 0, 0, 0])
for file in json.load(open(sys.argv[1]))["files"]:
    room = os.path.dirname(file["filename"])
    for base in ("libpolemcl/src/", "libpolemcl/include/polemcl/"):
        room = room.removeprefix(base)
    for name in (room, "all"):
        for i, key in enumerate(("line_covered", "line_total", "branch_covered", "branch_total")):
            rooms[name][i] += file[key]
print(f"{'room':30} {'lines':>8} {'reached':>8} {'branches':>9} {'reached':>8}")
for room, (lines, all_lines, branches, all_branches) in sorted(rooms.items()):
    print(f"{room:30} {all_lines:8} {lines / max(1, all_lines):8.1%} {all_branches:9} {branches / max(1, all_branches):8.1%}")
lines, all_lines, branches, all_branches = rooms["all"]
if sys.argv[2] == "all" and (lines < 0.95 * all_lines or branches < 0.85 * all_branches):
    sys.exit("coverage: less than 95 % of the lines, or less than 85 % of the branches")
END
