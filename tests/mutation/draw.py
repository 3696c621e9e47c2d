"""Draws faults at random: operators turned round and numbers doubled, in core/ and mrpt/.

Usage: draw.py TOP COUNT SEED. Needs build/compile_commands.json and python3-clang. Prints faults as in mutations.txt.
  < to >=, <= to >, == to != and back; && to || and back; + to - and * to / and back; a number to twice it, 0 to 1
Only values of arithmetic type, that are not needed while compiling, and whose text is there once in the file. The
tests of a fault are those of its room.
"""
import collections
import json
import pathlib
import random
import re
import sys

from clang import cindex

FLIPPED = {"<": ">=", "<=": ">", "==": "!=", "&&": "||", "+": "-", "*": "/"}
FLIPPED.update({new: old for old, new in FLIPPED.items()})
NUMBERS = {cindex.CursorKind.INTEGER_LITERAL, cindex.CursorKind.FLOATING_LITERAL}
ARITHMETIC = {cindex.TypeKind.BOOL, cindex.TypeKind.INT, cindex.TypeKind.LONG, cindex.TypeKind.UINT,
              cindex.TypeKind.ULONG, cindex.TypeKind.DOUBLE, cindex.TypeKind.FLOAT}
COMPILED = {cindex.CursorKind.STATIC_ASSERT, cindex.CursorKind.CASE_STMT, cindex.CursorKind.ENUM_CONSTANT_DECL,
            cindex.CursorKind.TEMPLATE_REF, cindex.CursorKind.TYPE_REF}


def flipped(cursor, text):
    """What takes the place of an expression, or None."""
    start, end = cursor.extent.start.offset, cursor.extent.end.offset
    own = text[start:end]
    if cursor.kind in NUMBERS:
        if re.fullmatch(r"0|0\.0?", own):
            return "1" if own == "0" else "1.0"
        return f"2 * {own}" if re.fullmatch(r"[\d.e+-]+", own) else None
    left, right = list(cursor.get_children())
    between = text[left.extent.end.offset:right.extent.start.offset]
    operator = between.strip()
    if operator not in FLIPPED:
        return None
    return f"{text[start:left.extent.end.offset]} {FLIPPED[operator]} {text[right.extent.start.offset:end]}"


def expressions(cursor, file, text):
    """(start, end, old, new) of all expressions of a file that can be flipped."""
    for child in cursor.get_children():
        if child.location.file and child.location.file.name != file:
            continue
        own = text[child.extent.start.offset:child.extent.end.offset]
        if child.kind in COMPILED or "constexpr" in own.split("{")[0].split("=")[0]:
            continue
        binary = child.kind == cindex.CursorKind.BINARY_OPERATOR and len(list(child.get_children())) == 2
        if (binary or child.kind in NUMBERS) and child.type.get_canonical().kind in ARITHMETIC:
            new = flipped(child, text)
            if new:
                yield child.extent.start.offset, child.extent.end.offset, own, new
        yield from expressions(child, file, text)


def is_unique(old, text):
    return len(re.findall(r"\s+".join(map(re.escape, old.split(" "))), text)) == 1


def with_operator_round(found, text):
    """A number alone is seldom there once: take the expression round it."""
    for start, end, old, new in found:
        if not re.fullmatch(r"[\d.e+-]+", old):
            yield start, end, old, new
            continue
        for outer in found:
            if outer[0] <= start and end <= outer[1] and is_unique(outer[2], text) and outer[2] != old:
                at = start - outer[0]
                yield outer[0], outer[1], outer[2], outer[2][:at] + new.join(["(", ")"]) + outer[2][at + len(old):]
                break


def room_tests(top, source):
    """Program and filter: all suites of the room's tests."""
    program, *room = source.relative_to(top / "libpolemcl/src").parent.parts
    suites = set()
    for test in sorted((top / "tests" / program / "/".join(room)).glob("test_*.cpp")):
        suites.update(re.findall(r"^(?:TEST|TEST_F)\((\w+),", test.read_text(), re.M))
    return f"{program} " + ":".join(f"{suite}.*" for suite in sorted(suites)) if suites else None


def main():
    top, count, seed = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), int(sys.argv[3])
    commands = json.loads((top / "build/compile_commands.json").read_text())
    flags = next(c["command"] for c in commands if "polemcl-mrpt" in c["command"])
    arguments = re.findall(r"-std=\S+|-D\S+|-isystem \S+|-I\s?\S+", flags)
    arguments = [word for argument in arguments for word in argument.split()]
    index = cindex.Index.create()
    candidates = []
    for source in sorted((top / "libpolemcl/src").glob("core/**/*.cpp")) + sorted((top / "libpolemcl/src").glob("mrpt/**/*.cpp")):
        text, tests = source.read_text(), room_tests(top, source)
        if not text.isascii():  # offsets count bytes
            text = source.read_bytes().decode("latin-1")
        if tests is None:
            continue
        unit = index.parse(str(source), [a.replace("../", f"{top}/") for a in arguments] + ["-ferror-limit=0"])
        found = list(expressions(unit.cursor, str(source), text))
        for start, end, old, new in with_operator_round(found, text):
            old, new = (" ".join(s.split()) for s in (old, new))
            if is_unique(old, text) and " | " not in old and "//" not in old and old.isascii():
                candidates.append((source, start, end, old, new, tests))
    random.Random(seed).shuffle(candidates)
    taken, spans = 0, collections.defaultdict(list)
    for source, start, end, old, new, tests in candidates:
        if any(start < b and a < end for a, b in spans[source]) or taken == count:
            continue
        spans[source].append((start, end))
        taken += 1
        print(source.relative_to(top / "libpolemcl/src"), old, new, tests, sep=" | ")
    print(f"{len(candidates)} candidates", file=sys.stderr)


main()
