"""Which suites of tests notice each fault?

Usage: notice.py FOLDER FAULTS OUT PROGRAM...
  FOLDER   holds the test programs with all faults in them
  FAULTS   what insert.py printed
  OUT      a CSV of each fault: the suite that noticed it, or nothing
Each suite runs once without a fault, which tells the faults that it reaches. Then each fault is tried on
the suites that reach it, the quickest first; slow suites only for faults that no other suite notices.
"""
import concurrent.futures
import csv
import os
import pathlib
import subprocess
import sys
import time

LONGEST = 300  # s; of a suite without a fault
SLOW = 4  # s


def suites(folder, program):
    listed = subprocess.check_output([folder / program, "--gtest_list_tests"], text=True)
    return [line.split("  #")[0].strip() for line in listed.splitlines()
            if line and not line.startswith(" ") and line.rstrip().split("  #")[0].endswith(".")]


def run(folder, program, suite, limit, **variables):
    """\\return Whether all of its tests pass in time, and how long they took, s."""
    begin = time.monotonic()
    try:
        code = subprocess.run([folder / program, "--gtest_brief=1", "--gtest_fail_fast",
                               f"--gtest_filter={suite}*"], env=os.environ | variables, timeout=limit,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode
    except subprocess.TimeoutExpired:
        code = -1
    return code == 0, time.monotonic() - begin


def reach(folder, program, suite):
    """\\return Seconds, and the faults that it reaches; a suite that fails is left out."""
    file = folder / f"reached.{program}.{suite.replace('/', '_')}"
    file.unlink(missing_ok=True)
    passed, seconds = run(folder, program, suite, LONGEST, POLEMCL_FAULTS_REACHED=str(file))
    if not passed:
        print(f"{program} {suite}* fails without any fault; left out", file=sys.stderr)
        return seconds, set()
    return seconds, set(file.read_text().split()) if file.exists() else set()


def notice(folder, number, reaching):
    """\\return The suite of these that notices this fault."""
    for seconds, program, suite in sorted(reaching):
        passed, _ = run(folder, program, suite, 10 * seconds + 20, POLEMCL_FAULT=number)
        if not passed:
            return f"{program} {suite[:-1]}"
    return ""


def main():
    folder, listing, out = map(pathlib.Path, sys.argv[1:4])
    faults = [line.split("\t") for line in listing.read_text().splitlines()]
    tests = [(program, suite) for program in sys.argv[4:] for suite in suites(folder, program)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        reached = list(pool.map(lambda test: reach(folder, *test), tests))
        noticed, suites_of = {}, {}
        for slow in (False, True):
            left = [number for number, *_ in faults if not noticed.get(number)]
            for number in left:
                suites_of[number] = [(seconds, *test) for test, (seconds, numbers) in zip(tests, reached)
                                     if number in numbers and (seconds > SLOW) == slow]
            found = pool.map(lambda number: notice(folder, number, suites_of[number]), left)
            for number, by in zip(left, found):
                noticed[number] = by
                print(number, by or "not noticed", "by slow suites" if slow else "", flush=True)
    with out.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["place", "old", "new", "noticed_by"])
        table.writerows([place, old, new, noticed[number]] for number, _, _, place, old, new in faults)
    missed = sum(not by for by in noticed.values())
    print(f"{len(faults) - missed} of {len(faults)} faults are noticed")
    sys.exit(missed > 0.05 * len(faults))


main()
