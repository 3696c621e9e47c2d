"""Runs a command with a fault, and judges what stands under the final names afterwards."""

import os
import re
import shutil
import signal
import subprocess
import time
from collections import Counter

from commands import CHANGING, COMMANDS, TEMPORARY, arguments, make_inputs, unit

# Warnings, and what libraries print whether they are asked to or not.
OTHERS = re.compile(": warning: |^Fontconfig error: |^(proj|pj_obj)_create: ")
# A batch with failed tasks reports those.
FAILURES = re.compile(r"batch/(failed/|\w+\.(csv|json|tex)$)")
LONGEST = 60  # seconds; no command takes a tenth of it


class Bench:
    def __init__(self, programs, preload, folder):
        self.programs, self.preload, self.folder = programs, preload, folder
        self.root, self.keep, self.log = folder / "root", folder / "keep", folder / "calls"
        self.inputs, self.out = self.root / "in", self.root / "out"
        folder.chmod(0o755)  # also for a user without rights
        make_inputs(programs, self.inputs)

    def learn(self, command):
        """Undisturbed: the outputs of both versions, how long it takes and writes, how often it
        does what."""
        self.command, self.line = command, COMMANDS[command]
        self.earlier = self.folder / "earlier"
        shutil.rmtree(self.earlier, ignore_errors=True)
        self.old = self.undisturbed("b")
        shutil.copytree(self.out, self.earlier)
        self.undisturbed("a", preload=True)
        self.calls = Counter(line.split("\t")[0].replace("exchange", "rename")
                             for line in self.log.read_text().splitlines())
        if self.calls["rename"] == 0:
            raise SystemExit(f"{self.command}: {self.preload} sees no calls")
        self.new = self.undisturbed("a")
        if self.new == self.old:
            raise SystemExit(f"{self.command} writes the same from both inputs")

    def undisturbed(self, version, **options):
        self.fresh()
        begin = time.monotonic()
        process = self.start(version, **options)
        self.wait_for_writing(process)
        first = time.monotonic()
        code, stderr = self.finish(process)
        self.seconds, self.writing = time.monotonic() - begin, time.monotonic() - first
        if code != 0:
            raise SystemExit(f"{self.command} fails without any fault: {stderr}")
        return self.files()

    def fresh(self, earlier=False):
        """An empty folder for the outputs, or one with an earlier output."""
        for folder in (self.out, self.keep):
            shutil.rmtree(folder, ignore_errors=True)
        self.keep.mkdir()
        if earlier:
            shutil.copytree(self.earlier, self.out)
        else:
            self.out.mkdir()

    def start(self, version="a", fault="", preload=False, **options):
        """Starts it in a group of its own, which a power cut ends."""
        env = dict(os.environ)
        if fault or preload:
            self.log.write_text("")
            (self.folder / "calls.count").write_bytes(bytes(8))
            env |= {"LD_PRELOAD": str(self.preload), "POLEMCL_FAULT": fault,
                    "POLEMCL_FAULT_ROOT": str(self.root), "POLEMCL_FAULT_LOG": str(self.log),
                    "POLEMCL_FAULT_KEEP": str(self.keep)}
        return subprocess.Popen(
            arguments(self.programs, self.line, self.inputs, version, self.out), env=env,
            cwd=self.root, start_new_session=True, text=True, stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE, **options)

    def wait_for_writing(self, process):
        """Until the first name comes or goes in the folder of outputs."""
        before = list(os.walk(self.out))
        while process.poll() is None and list(os.walk(self.out)) == before:
            time.sleep(0.0005)

    @staticmethod
    def finish(process):
        """Exit code and standard error."""
        try:
            _, stderr = process.communicate(timeout=LONGEST)
            return process.returncode, stderr
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            return "none: it hangs", ""

    def files(self):
        """What stands under final names, without what differs from run to run."""
        return {name: (self.out / name).read_bytes() for name in self.names()
                if not TEMPORARY.search(name) and not CHANGING.search(name)}

    def names(self):
        return [str(path.relative_to(self.out)) for path in self.out.rglob("*") if path.is_file()]

    def judge(self, earlier, code=None):
        """What is wrong with it; after exit code 0, the new output must be there."""
        units, allowed = whole(self.files()), [self.new] if code == 0 else [self.new, self.old]

        def is_of(files, name):
            return units[name] in (whole(files).get(name), {name: files.get(name)})
        wrong = [f"{name} is not complete" for name in units
                 if not (code == 1 and FAILURES.match(name)) and not any(is_of(files, name) for files in allowed)]
        expected = whole(self.new if code == 0 else self.old if earlier else {})
        if code == 0:
            return wrong + [f"{name} is gone" for name in expected if name not in units]
        if self.command.startswith(("localize", "batch")):  # those remove the old first
            return wrong
        if not wrong and not any(all(is_of(files, name) for name in units) for files in allowed):
            wrong = ["old and new files stand together: " + ", ".join(units)]
        # Of files that belong together, the others go before the main one is replaced.
        ends = ((".rawlog", ".polemap"), ".json", ".3Dscene", "")
        main = next(filter(None, ([name for name in expected if name.endswith(end)] for end in ends)), [])
        return wrong + [f"{name} is gone" for name in main if name not in units]

    def said(self, code, stderr):
        """What is wrong with how it ended: exit 1 and one line, if not as if nothing had been."""
        lines = [line for line in stderr.splitlines() if not OTHERS.search(line)]
        program = self.line[0] + ": "
        many = self.command == "batch"  # a line for each task that failed
        if code == 0 or code == 1 and lines and all(line.startswith(program) for line in lines) \
                and (many or len(lines) == 1):
            return []
        return [f"exit {code}, says: {stderr.strip() or 'nothing'}"]

    def repeat(self):
        """The same once more: the bytes of an undisturbed run, and nothing else is left."""
        code, stderr = self.finish(self.start())
        if code != 0:
            return [f"again: exit {code}: {stderr.strip()}"]
        wrong = self.judge(True, code)
        wrong += [f"{name} is left" for name in self.names()
                  if TEMPORARY.search(name) and ".incomplete-" not in name]
        return [f"again: {text}" for text in wrong]


def whole(files):
    """The files by what must be complete together."""
    units = {}
    for name, content in files.items():
        units.setdefault(unit(name, files), {})[name] = content
    return units
