"""What a machine may lack: descriptors, memory, space, the right to write."""

import os
import re
import resource
import signal

NOBODY = 65534
MEGABYTE = 1 << 20
# What the loader says, libstdc++ (GDCM throws before the program begins), and Libgcrypt.
NOT_LOADED = re.compile("while loading shared libraries|terminate called|cleared memory failed")
ENOUGH = 5  # limits at which all is well; larger ones are not tried


def limits(bench, count, chance):
    """One line on stderr, or the output is there; nothing half-written."""
    largest = max(len(content) for content in bench.new.values())
    sizes = sorted(chance.sample(range(largest), min(count, largest)))
    ladders = (("descriptors", resource.RLIMIT_NOFILE, 1, range(3, 100)),
               ("MB of memory", resource.RLIMIT_AS, MEGABYTE, range(least_memory(bench), 4000)),
               ("bytes in a file", resource.RLIMIT_FSIZE, 1, sizes))
    for what, limit, unit, numbers in ladders:
        well = 0
        for number in numbers:
            code, wrong = tried(bench, number % 2, 0o755, lambda: limited(limit, number * unit))
            if wrong is not None:
                yield f"{number} {what}", wrong
            well = well + 1 if code == 0 else 0
            if well == ENOUGH:
                break
    for earlier in (False, True):
        yield f"no right to write, earlier {earlier}", tried(bench, earlier, 0o555, without_rights)[1]


def least_memory(bench):
    """Megabytes with which libraries can hardly be loaded."""
    steps = range(100, 4000, 20)
    return next(number for number in steps if tried(
        bench, False, 0o755, lambda: limited(resource.RLIMIT_AS, number * MEGABYTE))[1] is not None) - 20


def tried(bench, earlier, mode, prepare):
    """Exit code, and what is wrong; None where libraries cannot even be loaded."""
    bench.fresh(earlier)
    bench.out.chmod(mode)
    code, stderr = bench.finish(bench.start(preexec_fn=prepare))
    if NOT_LOADED.search(stderr):
        return code, None
    return code, bench.said(code, stderr) + bench.judge(earlier, code)


def limited(limit, number):
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # a file that grows too large is an error
    resource.setrlimit(limit, (number, number))


def without_rights():
    if os.geteuid() == 0:
        os.setuid(NOBODY)
