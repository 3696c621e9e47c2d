"""Tries faults on every command that writes; tests/faults/run.sh has the usage."""

import argparse
import datetime
import errno
import random
import shutil
import signal
import sys
import time
from pathlib import Path
from tempfile import mkdtemp

from bench import Bench
from commands import COMMANDS
from disk import Disk
from limits import limits
from together import replaced, together, updates

ERRORS = {"open": ["EMFILE", "EIO"], "mkdir": ["ENOSPC", "EIO"], "write": ["ENOSPC", "EIO"],
          "fsync": ["EIO", "ENOSPC"], "syncfs": ["EIO", "ENOSPC"], "rename": ["EIO", "ENOSPC"],
          "unlink": ["EIO"], "close": ["EIO", "ENOSPC"], "read": ["EIO"]}
MOST_STATES = 10  # drawn ones, after each power cut


def kills(bench, count, chance):
    """Killed at any moment of its duration, half of them once it writes; with an earlier output in
    its place or without."""
    for number in range(count):
        earlier, writes = bool(number % 2), number % 4 < 2
        bench.fresh(earlier)
        process = bench.start()
        if writes:
            bench.wait_for_writing(process)
        moment = chance.uniform(0, bench.writing if writes else bench.seconds)
        time.sleep(moment)
        process.kill()
        bench.finish(process)
        yield f"kill {moment:.4f} s after its {'first name' if writes else 'start'}, earlier {earlier}", \
            bench.judge(earlier) + bench.repeat()


def power_cuts(bench, count, chance):
    """Before each change on the disk, and after the end; each leaves several states."""
    cases = [(number, earlier) for number in range(1, bench.calls["change"] + 2)
             for earlier in (False, True)]
    for number, earlier in chosen(cases, 10 * count, chance, bench):
        bench.fresh(earlier)
        code, _ = bench.finish(bench.start(fault=f"change:{number}:0"))
        ended = [] if code in (0, -signal.SIGKILL) else [f"exit {code}"]
        what = f"power cut before change {number}, earlier {earlier}"
        disk = Disk(bench.log, bench.out, bench.keep)
        for state in disk.states(min(count, MOST_STATES), f"{bench.command} {what}"):
            yield f"{what}, {state}", \
                ended + bench.judge(earlier, code) + bench.repeat()


def io_errors(bench, count, chance):
    """A call fails: one line on stderr, or the output is there as if nothing had been."""
    cases = [(kind, number, error, earlier) for kind, errors in ERRORS.items()
             for number in range(1, bench.calls[kind] + 1) for error in errors
             for earlier in (False, True)]
    for kind, number, error, earlier in chosen(cases, 3 * count, chance, bench):
        bench.fresh(earlier)
        fault = f"{kind}:{number}:{getattr(errno, error)}"
        code, stderr = bench.finish(bench.start(fault=fault))
        yield f"{error} of {kind} {number}, earlier {earlier}", \
            bench.said(code, stderr) + bench.judge(earlier, code) + bench.repeat()


def chosen(cases, most, chance, bench):
    """All, or that many of them; few of a batch, which takes seconds."""
    most = most // 20 + 5 if bench.command == "batch" else most
    return cases if len(cases) <= most else sorted(chance.sample(cases, most))


KINDS = {"kill": kills, "power": power_cuts, "error": io_errors, "limit": limits,
         "together": together, "updates": updates, "replaced": replaced}


def try_all(bench, kind, count, record):
    """Prints the findings and a line, which also goes into the record."""
    trials = found = 0
    for what, wrong in KINDS[kind](bench, count, random.Random(f"{bench.command} {kind}")):
        trials += 1
        found += bool(wrong)
        if wrong:
            print(f"{bench.command}: {what}: {'; '.join(wrong)}", file=sys.stderr, flush=True)
    if trials == 0:
        return 0
    print(f"{bench.command:16} {kind:8} {trials:6} {found:8}", flush=True)
    if record:
        with record.open("a") as stream:
            stream.write(f"{bench.command},{kind},{trials},{found},{datetime.date.today()}\n")
    return found


def main():
    parser = argparse.ArgumentParser(usage="tests/faults/run.sh --help", add_help=False)
    for name in ("programs", "preload"):
        parser.add_argument(f"--{name}", type=lambda text: Path(text).absolute(), required=True)
    parser.add_argument("--record", type=Path)
    parser.add_argument("count", type=int)
    parser.add_argument("names", nargs="*", default=[])
    option = parser.parse_args()
    kinds = [kind for kind in KINDS if kind in option.names] or list(KINDS)
    commands = [name for name in COMMANDS if name in option.names] or list(COMMANDS)
    unknown = set(option.names) - set(KINDS) - set(COMMANDS)
    if unknown:
        parser.error(f"{', '.join(unknown)}: allowed are {', '.join([*KINDS, *COMMANDS])}")
    if option.record and not option.record.exists():
        option.record.write_text("command,fault,trials,findings,date\n")
    folder = Path(mkdtemp(prefix="polemcl-faults-"))
    try:
        bench = Bench(option.programs, option.preload, folder)
        print(f"{'command':16} {'fault':8} {'trials':>6} {'findings':>8}")
        found = 0
        for command in commands:
            bench.learn(command)
            found += sum(try_all(bench, kind, option.count, option.record) for kind in kinds)
        return int(found > 0)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    sys.exit(main())
