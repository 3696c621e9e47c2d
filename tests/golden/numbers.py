#!/usr/bin/env python3
"""Prints the numbers of result files, in their order, and nothing else of them.

Usage: numbers.py FILE...
       numbers.py --checksums LIST
LIST has a line for each result, its name and its files; prints a checksum of the numbers of each.

Left out are names and keys, strings, effective settings, the identity of the build, versions, and all
that depends on the clock. Numbers come in one form: 5, 5.0 and 5.000 are equal.
  .csv .tum .txt       fields that are a number as a whole, without comments
  .json .geojson       numbers in the order of the document; null is printed as nan
  .polemap             poles, candidates and histories; kept scans as a checksum
  .rawlog              a checksum of the bytes without the names of classes
  .bin .label          a checksum of the bytes
"""

import hashlib
import json
import math
import re
import struct
import sys
import zipfile
import zlib

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?(nan|inf)")

# Subtrees of JSON results that no refactoring has to keep.
SKIPPED_KEYS = {"build", "config", "filter_s", "format_version", "timings", "version", "versions", "wall_s"}


def form(value):
    """A number as text, the same for equal numbers."""
    if isinstance(value, float):
        if math.isnan(value):
            return "nan"
        if value.is_integer() and abs(value) < 2**53:
            return str(int(value))
    return repr(value)


def form_of_text(text):
    return str(int(text)) if re.fullmatch(r"[-+]?\d+", text) else form(float(text))


def of_text(data, _):
    for line in data.decode().splitlines():
        fields = [field for field in re.split(r"[,\s]+", line.partition("#")[0]) if NUMBER.fullmatch(field)]
        if fields:
            yield " ".join(form_of_text(field) for field in fields)


def of_json(data, _):
    def walk(node):
        if isinstance(node, dict):
            for key, value in node.items():
                if key not in SKIPPED_KEYS and not key.endswith("_ms"):
                    yield from walk(value)
        elif isinstance(node, list):
            for value in node:
                yield from walk(value)
        elif node is None:
            yield "nan"
        elif isinstance(node, (int, float)) and not isinstance(node, bool):
            yield form(node)

    yield from walk(json.loads(data))


def of_polemap(data, _):
    position = 24  # magic, version, size, CRC-32
    while position < len(data):
        tag = data[position : position + 4]
        (size,) = struct.unpack_from("<Q", data, position + 4)
        chunk = data[position + 12 : position + 12 + size]
        position += 12 + size
        if tag in (b"POLE", b"CAND"):
            record, count = struct.unpack_from("<IQ", chunk)
            yield str(count)
            layout = "<9dI3d2I" if record >= 108 else "<9dI"
            for i in range(count):
                yield " ".join(form(value) for value in struct.unpack_from(layout, chunk, 12 + i * record))
        elif tag == b"SCAN":
            yield from of_scans(zlib.decompress(chunk[8:]))
        elif tag != b"INFO":
            raise ValueError(f"unknown chunk {tag}")


def of_scans(data):
    """Sessions of a map: all but the first one's name."""
    yield form(struct.unpack_from("<d", data)[0])
    sessions, name = struct.unpack_from("<II", data, 8)
    yield str(sessions)
    yield checksum(data[16 + name :])


def of_rawlog(data, _):
    """An object begins with the length of the name of its class (bit 7 set) and that name."""
    if data[:2] == b"\x1f\x8b":
        data = zlib.decompress(data, 31)
    rest = bytearray()
    position = 0
    for found in re.finditer(rb"[\x80-\xff](?=[a-z]\w*::)", data):
        if found.start() < position:
            continue
        end = found.end() + data[found.start()] - 128
        if re.fullmatch(rb"\w+(::\w+)+", data[found.end() : end]):
            rest += data[position : found.start()]
            position = end
    if position == 0:
        raise ValueError("no object in it")
    yield checksum(bytes(rest + data[position:]))


def of_bytes(data, _):
    yield checksum(data)


def checksum(data):
    return hashlib.sha256(data).hexdigest()


READERS = {
    "bin": of_bytes,
    "csv": of_text,
    "geojson": of_json,
    "json": of_json,
    "label": of_bytes,
    "polemap": of_polemap,
    "rawlog": of_rawlog,
    "tum": of_text,
    "txt": of_text,
}


def numbers(paths):
    """The lines of all these files."""
    for path in paths:
        with open(path, "rb") as file:
            data = file.read()
        try:
            lines = list(READERS[path.rpartition(".")[2]](data, path))
        except (ValueError, KeyError, struct.error, zlib.error, zipfile.BadZipFile) as error:
            sys.exit(f"numbers.py: cannot read {path}: {error}")
        if not lines:
            sys.exit(f"numbers.py: no numbers in {path}")
        yield "\n".join(lines) + "\n"


def main(arguments):
    if arguments[:1] != ["--checksums"]:
        for text in numbers(arguments):
            print(text, end="")
        return
    with open(arguments[1], encoding="utf-8") as results:
        for result in results:
            name, *paths = result.split()
            print(f"{checksum(''.join(numbers(paths)).encode())[:16]}  {name}")


if __name__ == "__main__":
    main(sys.argv[1:])
