#!/usr/bin/env python3
"""Compares a file of an earlier release with one of today.

Usage: compare.py keys OLD NEW            all columns of a table, all keys of JSON are there still, numbers are numbers
       compare.py values OLD.csv NEW.csv  the columns of OLD have the same values in NEW
       compare.py places OLD.csv NEW.csv  x and y only
"""
import csv
import json
import sys

TOLERANCE = 1e-5  # tables are rounded to 1e-6


def table(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"{path} has no rows")
    return rows


def kind(value):
    return "number" if isinstance(value, (int, float)) and not isinstance(value, bool) else type(value).__name__


def missing_keys(old, new, where=""):
    """Keys of JSON that are gone or hold something else; null stands for any kind."""
    if isinstance(old, dict) and isinstance(new, dict):
        for key, value in old.items():
            if key not in new:
                yield f"{where}.{key} is gone"
            else:
                yield from missing_keys(value, new[key], f"{where}.{key}")
    elif isinstance(old, list) and isinstance(new, list):
        if old and new:
            yield from missing_keys(old[0], new[0], f"{where}[0]")
    elif None not in (old, new) and kind(old) != kind(new):
        yield f"{where} is a {kind(new)}, it was a {kind(old)}"


def json_of(path):
    """A JSON object, or the first of a stream, one in a line."""
    with open(path, encoding="utf-8") as file:
        text = file.read()
    return json.JSONDecoder().raw_decode(text)[0]


def different_keys(old, new):
    if old.endswith(".csv"):
        return [f"column {column} is gone" for column in table(old)[0] if column not in table(new)[0]]
    if old.endswith(".json"):
        return list(missing_keys(json_of(old), json_of(new)))
    with open(old, encoding="utf-8") as before, open(new, encoding="utf-8") as now:
        widths = [{len(line.split()) for line in file if line.strip() and line[0] != "#"} for file in (before, now)]
    return [] if widths[0] == widths[1] else [f"rows have {widths[1]} values, they had {widths[0]}"]


def same(old, new):
    try:
        return abs(float(old) - float(new)) <= TOLERANCE * max(1, abs(float(old)))
    except ValueError:
        return old == new


def different_values(old, new, columns):
    before, now = table(old), table(new)
    if len(before) != len(now):
        return [f"{len(now)} rows, there were {len(before)}"]
    return [f"row {number}, {column}: {after.get(column)}, it was {row[column]}"
            for number, (row, after) in enumerate(zip(before, now), 1)
            for column in columns or row if not same(row[column], after.get(column, ""))]


def main():
    how, old, new = sys.argv[1:]
    found = different_keys(old, new) if how == "keys" else \
        different_values(old, new, ["x", "y"] if how == "places" else None)
    for difference in found[:10]:
        print(f"{old}: {difference}", file=sys.stderr)
    sys.exit(1 if found else 0)


main()
