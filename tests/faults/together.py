"""Two programs with one output, and a map that is replaced while it is read."""

import os
import shutil
import threading
import time

from commands import UPDATE


def together(bench, count, chance):
    """Two versions of a command at once: all is of one of them."""
    for number in range(count):
        bench.fresh(number % 2)
        yield from both(bench, chance, [bench.new, bench.old])


def updates(bench, count, chance):
    """Two of `pole-map update` in place: the map of one of them, or of one after the other."""
    if bench.command != "map-update":
        return
    street, bench.line = bench.inputs / "a/street.polemap", UPDATE.split()

    def updated(*versions):
        bench.fresh()
        shutil.copy(street, bench.out)
        for version in versions:
            bench.finish(bench.start(version))
        return bench.files()

    allowed = [updated(*versions) for versions in ("a", "b", "ab", "ba")]
    for _ in range(count):
        updated()
        yield from both(bench, chance, allowed)


def both(bench, chance, allowed):
    first = bench.start("b")
    gap = chance.uniform(0, 0.03)
    time.sleep(gap)
    second = bench.start("a")
    ends = [bench.finish(process) for process in (first, second)]
    wrong = [text for end in ends for text in bench.said(*end)]
    if bench.command == "batch":  # the later one is refused
        wrong += [] if any(code == 0 for code, _ in ends) else ["none was done"]
    else:
        wrong += [f"exit {code}: {stderr.strip()}" for code, stderr in ends if code != 0]
    if bench.command.startswith(("localize", "eval-trajectory", "eval-detections")):  # several outputs, each for itself
        wrong += bench.judge(False)
    elif bench.files() not in allowed:
        wrong.append("not the output of one of them")
    yield f"two at once, {gap:.3f} s apart", wrong


def replaced(bench, count, chance):
    """Its map changes all the time: it reads one or the other."""
    name = {"map-convert": "session.polemap", "localize": "street.polemap"}.get(bench.command)
    if not name:
        return
    here = bench.inputs / "c"
    shutil.copytree(bench.inputs / "a", here, dirs_exist_ok=True)
    done = threading.Event()

    def replace(version):
        shutil.copy(bench.inputs / version / name, here / "new")
        os.replace(here / "new", here / name)

    def keep_replacing():
        while not done.is_set():
            replace("a")
            replace("b")

    allowed = []
    for version in "ab":
        replace(version)
        allowed.append(bench.undisturbed("c"))
    thread = threading.Thread(target=keep_replacing)
    thread.start()
    try:
        for _ in range(count):
            bench.fresh()
            code, stderr = bench.finish(bench.start("c"))
            fits = code == 0 and bench.files() in allowed
            yield "its map is replaced", [] if fits else [f"exit {code}, {stderr.strip()}, mixed maps"]
    finally:
        done.set()
        thread.join()
