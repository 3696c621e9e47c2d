"""Draws operators and constants of core/ and mrpt/, and writes them as faults for run.sh --drawn.

Usage: draw.py TOP SEED COUNT. Every arithmetic operator, comparison, logical operator and constant in
a function may be drawn, where both sides are numbers or truth values. Left out: expressions that stand
twice in their file or lie in another drawn one, those of compile time, and sizes that are only reserved.
An operator is turned into its opposite (< into >=, + into -, && into ||); a whole number grows by one,
another constant is doubled. Needs python3-clang and cmake.
"""
import hashlib
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import clang.cindex
from clang.cindex import CursorKind as Kind, TypeKind

OPPOSITE = {"+": "-", "-": "+", "*": "/", "/": "*", "<": ">=", ">=": "<", ">": "<=", "<=": ">",
            "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
NUMBERS = {getattr(TypeKind, name) for name in
           ("BOOL", "INT", "UINT", "LONG", "ULONG", "LONGLONG", "ULONGLONG", "SHORT", "USHORT",
            "UCHAR", "SCHAR", "CHAR_S", "FLOAT", "DOUBLE")}
FLOATING = {TypeKind.FLOAT, TypeKind.DOUBLE}
FUNCTIONS = {Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.CONSTRUCTOR, Kind.DESTRUCTOR,
             Kind.CONVERSION_FUNCTION, Kind.FUNCTION_TEMPLATE, Kind.LAMBDA_EXPR}


def commands(top, folder):
    """(source, arguments of clang) of each source of core/ and mrpt/."""
    subprocess.run(["cmake", "-S", top, "-B", folder, "-DPOLEMCL_UNITY=OFF",
                    "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"], check=True, stdout=subprocess.DEVNULL)
    rooms = [top / "libpolemcl/src" / room for room in ("core", "mrpt")]
    for entry in json.loads((folder / "compile_commands.json").read_text()):
        source = pathlib.Path(entry["file"])
        if any(room in source.parents for room in rooms):
            words = entry["command"].split()[1:]
            keep = [word for word in words if re.match(r"-(I|D|std)|/", word) or word in
                    ("-isystem", "-iquote")]
            yield source, [word.replace('\\"', '"') for word in keep if word != str(source)]


def is_constexpr(cursor):
    """By its first words, which may be those of a template."""
    return any(token.spelling == "constexpr" for token in itertools.islice(cursor.get_tokens(), 20))


def bare(cursor):
    """Without the implicit conversions round it."""
    while cursor.kind == Kind.UNEXPOSED_EXPR and len(list(cursor.get_children())) == 1:
        cursor = next(cursor.get_children())
    return cursor


def is_number(cursor):
    return cursor.type.get_canonical().kind in NUMBERS


def is_constant(cursor):
    if cursor.kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL):
        return True
    return (cursor.kind == Kind.DECL_REF_EXPR and cursor.referenced is not None
            and re.match(r"k[A-Z]", cursor.spelling) is not None)


class Source:
    """The places of one file where a fault may be put."""

    def __init__(self, path, unit):
        self.data, self.path = path.read_bytes(), str(path)
        self.found = []  # (begin, end, new)
        self.visit(unit.cursor, False)

    def text(self, begin, end):
        return self.data[begin:end].decode()

    def visit(self, cursor, in_function):
        for child in cursor.get_children():
            if child.location.file is not None and child.location.file.name != self.path:
                continue
            if child.kind in (Kind.VAR_DECL, Kind.STATIC_ASSERT, *FUNCTIONS) and (
                    child.kind == Kind.STATIC_ASSERT or is_constexpr(child)):
                continue
            if child.kind == Kind.CALL_EXPR and child.spelling in ("reserve", "shrink_to_fit"):
                continue
            if child.kind == Kind.BINARY_OPERATOR and in_function:
                self.add(child)
            self.visit(child, in_function or child.kind in FUNCTIONS)

    def add(self, cursor):
        left, right = cursor.get_children()
        begin, end = cursor.extent.start.offset, cursor.extent.end.offset
        a, b = left.extent, right.extent
        operator = self.text(a.end.offset, b.start.offset).strip()
        if operator not in OPPOSITE or not is_number(left) or not is_number(right):
            return
        opposite = f"{self.text(begin, a.end.offset)} {OPPOSITE[operator]} {self.text(b.start.offset, end)}"
        if (operator, cursor.type.get_canonical().kind in FLOATING) not in (("*", False), ("/", False)):
            self.found.append((begin, end, opposite))
        for side in (bare(left), bare(right)):
            if is_constant(side):
                begin_of, end_of = side.extent.start.offset, side.extent.end.offset
                value = self.text(begin_of, end_of)
                floating = side.type.get_canonical().kind in FLOATING
                zero = re.fullmatch(r"[0.]+f?", value) is not None
                changed = f"(2 * {value})" if floating and not zero else f"({value} + 1)"
                self.found.append((begin, end, self.text(begin, begin_of) + changed
                                   + self.text(end_of, end)))

    def faults(self, top):
        """(file, begin, end, old, new) of those that insert.py finds."""
        whole = self.data.decode()
        name = str(pathlib.Path(self.path).relative_to(top / "libpolemcl/src"))
        for begin, end, new in self.found:
            old = " ".join(self.text(begin, end).split())
            new = " ".join(new.split())
            same = re.findall(r"\s+".join(map(re.escape, old.split(" "))), whole)
            if len(same) == 1 and "//" not in old and " | " not in old + new:
                yield name, begin, end, old, new


def draw(candidates, seed, count):
    """Without those that lie in one another; by a hash, so that other places change little."""
    drawn = []
    for file, begin, end, old, new in sorted(candidates, key=lambda fault: hashlib.sha256(
            f"{seed} {fault[0]} {fault[3]} {fault[4]}".encode()).digest()):
        if len(drawn) == count:
            break
        if all(file != other or end <= b or begin >= e for other, b, e, _, _ in drawn):
            drawn.append((file, begin, end, old, new))
    return sorted(drawn)


def main():
    top, seed, count = pathlib.Path(sys.argv[1]).resolve(), int(sys.argv[2]), int(sys.argv[3])
    clang.cindex.Config.set_library_file("/usr/lib/llvm-14/lib/libclang.so.1")
    candidates = []
    with tempfile.TemporaryDirectory() as folder:
        for source, arguments in sorted(commands(top, pathlib.Path(folder))):
            unit = clang.cindex.Index.create().parse(str(source), arguments)
            broken = [d for d in unit.diagnostics if d.severity >= clang.cindex.Diagnostic.Error]
            if broken:
                sys.exit(f"draw.py: {source}: {broken[0]}")
            candidates += Source(source, unit).faults(top)
            print(source.name, len(candidates), file=sys.stderr)
    print(f"# {count} of {len(candidates)} places, drawn by draw.py TOP {seed} {count}; see mutations.txt.")
    for file, _, _, old, new in draw(candidates, seed, count):
        print(file, old, new, sep=" | ")


main()
