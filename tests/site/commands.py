#!/usr/bin/env python3
"""Checks the commands on the pages: each option of a program of ours is in its --help, each key of --set is on a
page of settings. Usage: commands.py SOURCES PROGRAMS

Commands are the lines of blocks marked sh, or not marked, and code within lines that begins with a program's name.
"""
import functools
import pathlib
import re
import subprocess
import sys

PROGRAM = re.compile(r"(?:^|[\s(/])(pole-[a-z]+)((?:\s.*)?)$")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
SETTING = re.compile(r"--set\s+([a-z_]+)\.([a-z0-9_]+)=")


@functools.lru_cache(maxsize=None)
def help_of(*command):
    """The options and the subcommands that a program names in its help."""
    printed = subprocess.run([*command, "--help"], capture_output=True, text=True, check=True).stdout
    options, _, subcommands = printed.partition("\nSubcommands:\n")
    return ({"--help", *OPTION.findall(" ".join(re.findall(r"^  (\S+)", options, re.M)))},
            re.findall(r"^  ([a-z][\w-]*)", subcommands, re.M))


def known_options(programs, name, arguments):
    """The options of the subcommands that are named; of all where none is."""
    program = str(programs / name)
    options, subcommands = help_of(program)
    named = [word for word in re.split(r"[\s|\\]+", arguments) if word in subcommands]
    return options.union(*(help_of(program, word)[0] for word in named or subcommands))


def settings_of(sources):
    """All keys as (section, key)."""
    found, section = set(), ""
    for page in sorted((sources / "share/doc").glob("settings-*.md")):
        for line in page.read_text(encoding="utf-8").splitlines():
            heading, row = re.match(r"## \[(\w+)\]", line), re.match(r"\| `(\w+)`", line)
            section = heading[1] if heading else section
            if row:
                found.add((section, row[1]))
    return found


def commands_of(page):
    """Line number and text of each command on a page; lines that end with a backslash are joined."""
    fence, text, first = None, "", 0
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        mark = re.match(r"\s*```(\w*)", line)
        if mark:
            fence = mark[1] if fence is None else None
        elif fence in ("", "sh"):
            first = first or number
            text += " " + re.sub(r"\s#.*", "", line).rstrip("\\")
            if not line.endswith("\\"):
                for command in re.split(r"&&|\|\s|;\s", text):
                    yield first, command
                text, first = "", 0
        elif fence is None:
            for code in re.findall(r"`([^`]+)`", line):
                yield number, code


def faults_of(command, programs, settings):
    match = PROGRAM.search(command.rstrip()) or PROGRAM.search(command)
    if not match:
        return
    name, arguments = match[1], match[2]
    if not (programs / name).is_file():
        yield f"there is no program {name}"
        return
    known = known_options(programs, name, arguments)
    for option in OPTION.findall(re.sub(r"--sbatch\s+\S+", "--sbatch", arguments)):
        if option not in known:
            yield f"{name} has no option {option}"
    if name != "pole-batch":  # its keys are those of the batch
        for section, key in SETTING.findall(arguments):
            if (section, key) not in settings:
                yield f"there is no setting {section}.{key}"


def main():
    sources, programs = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    settings = settings_of(sources)
    pages = [sources / "README.md", sources / "CONTRIBUTING.md",
             *sorted((sources / "share/doc").glob("*.md")), sources / "share/reports/BENCHMARK.md"]
    checked, faults = 0, []
    for page in pages:
        for line, command in commands_of(page):
            checked += bool(PROGRAM.search(command))
            for fault in faults_of(command, programs, settings):
                faults.append(f"{page.relative_to(sources)}:{line}: {fault}: {command.strip()}")
    print("\n".join(faults), file=sys.stderr, end="\n" if faults else "")
    if checked < 100:
        sys.exit(f"commands.py: only {checked} commands were found")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
