"""What a power cut leaves of a folder, from the log that Preload.cpp wrote."""

import os
import random
import shutil
from pathlib import Path


class Disk:
    """The folder at the moment of the cut, and what of it was not brought to the disk."""

    def __init__(self, log, root, keep):
        self.root, self.top = root, root.stat().st_ino
        self.dirty, self.changes = unsynced(log)
        self.names = {(path.parent.stat().st_ino, path.name): path.stat().st_ino
                      for path in root.rglob("*")}
        self.contents = {path.stat().st_ino: path.read_bytes()
                         for folder in (root, keep) for path in folder.rglob("*") if path.is_file()}

    def states(self, drawn, seed):
        """Lays out what the disk may hold, and names it: two extremes, and a number of drawn ones;
        none of them twice. File systems may bring names and contents to the disk in any order."""
        extremes = [("all names, no contents", [], lambda content: b""),
                    ("no names, half contents", self.changes, lambda content: content[:len(content) // 2])]
        chances = [random.Random(f"{seed} {number}") for number in range(drawn)]
        draws = [(f"drawn {number}", lost(self.changes, chance), lambda content, c=chance: cut(content, c))
                 for number, chance in enumerate(chances)]
        seen = []
        for what, missing, cut_off in extremes + draws:
            names = dict(self.names)
            for change in reversed(missing):
                undo(change, names)
            files = dict(self.files(names, self.top, Path(), cut_off))
            if files not in seen:
                seen.append(files)
                self.lay_out(files)
                yield what

    def files(self, names, folder, path, cut_off):
        """Content of each file below a folder; None for folders."""
        for (parent, name), node in names.items():
            if parent == folder and node in self.contents:
                content = self.contents[node]
                yield path / name, cut_off(content) if node in self.dirty else content
            elif parent == folder:
                yield path / name, None
                yield from self.files(names, node, path / name, cut_off)

    def lay_out(self, files):
        shutil.rmtree(self.root)
        self.root.mkdir()
        for path, content in files.items():
            if content is None:
                (self.root / path).mkdir()
            else:
                (self.root / path).write_bytes(content)


def unsynced(log):
    """Inodes with content, and changes of names, that are not on the disk for sure. A change has the
    place that loses its name or None, the place that gets one, and what was there (0: nothing);
    a place is the folder's inode and a name."""
    dirty, changes = set(), []
    for line in log.read_text().splitlines():
        kind, *rest = line.split("\t")
        if kind in ("dirty", "write"):
            dirty.add(int(rest[0]))
        elif kind == "fsync":
            dirty.discard(int(rest[0]))
            changes = [change for change in changes if change[1][0] != int(rest[0])]
        elif kind == "syncfs":
            dirty, changes = set(), []
        elif kind in ("create", "mkdir", "unlink"):
            folder, name, *before = rest
            changes.append((None, (int(folder), name), int(before[0]) if before else 0))
        elif kind in ("rename", "exchange"):
            folder, name, to, new, before = rest
            changes.append(((int(folder), name), (int(to), new), int(before)))
    return dirty, changes


def undo(change, names):
    source, target, before = change
    now = names.pop(target, None)
    if source and now:
        names[source] = now
    if before:
        names[target] = before


def lost(changes, chance):
    """Some of them, and those that build on them: later ones at the same places, and the removal of
    folders."""
    share, missing, held = chance.random(), [], set()
    for source, target, before in changes:
        if held & {source, target, before} or chance.random() < share:
            missing.append((source, target, before))
            held |= {place for end in (source, target) if end for place in (end, end[0])}
    return missing


def cut(content, chance):
    """Ends anywhere, or is zeros from there on."""
    length = chance.randint(0, len(content))
    return content[:length] + bytes((len(content) - length) * chance.randint(0, 1))
