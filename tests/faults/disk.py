"""What a power cut leaves of a folder, from the log that Preload.cpp wrote."""

import os
import shutil


def after_power_cut(log, root, keep, names_survive):
    """Changes `root` to what a disk may hold: content that was not synced is lost. Names of folders
    that were not synced are as before, unless `names_survive`: file systems may do either."""
    dirty, changes = unsynced(log)
    if not names_survive:
        for change in reversed(changes):
            undo(change, root, keep)
    for folder, _, files in os.walk(root):
        for file in (os.path.join(folder, name) for name in files):
            if os.stat(file).st_ino in dirty:
                os.truncate(file, 0 if names_survive else os.path.getsize(file) // 2)


def unsynced(log):
    """Inodes with content, and changes of names, that are not on the disk for sure."""
    dirty, changes = set(), []
    for line in log.read_text().splitlines():
        kind, *rest = line.split("\t")
        if kind in ("dirty", "write"):
            dirty.add(int(rest[0]))
        elif kind == "fsync":
            dirty.discard(int(rest[0]))
            changes = [change for change in changes if change[-2] != rest[0]]
        elif kind == "syncfs":
            dirty, changes = set(), []
        elif kind in ("create", "mkdir"):
            changes.append((kind, None, None, "-", *rest))
        elif kind in ("rename", "exchange"):
            folder, name, to, new, *kept = rest
            changes.append((kind, folder, name, kept[0] if kept else "-", to, new))
        elif kind == "unlink":
            folder, name, kept = rest
            changes.append((kind, None, None, kept, folder, name))
    return dirty, changes


def undo(change, root, keep):
    kind, folder, name, kept, to, new = change
    folders = {str(os.stat(path).st_ino): path for path, _, _ in os.walk(root)}
    if to not in folders or folder is not None and folder not in folders:
        return  # the folder itself is gone
    there = os.path.join(folders[to], new)
    if kind == "mkdir":
        shutil.rmtree(there, ignore_errors=True)
    elif kind == "create" and os.path.exists(there):
        os.unlink(there)
    elif kind == "rename" and os.path.exists(there):
        os.rename(there, os.path.join(folders[folder], name))
    elif kind == "exchange":
        aside, here = there + ".aside", os.path.join(folders[folder], name)
        for old, now in ((there, aside), (here, there), (aside, here)):
            if os.path.exists(old):
                os.rename(old, now)
    if kept != "-":
        os.rename(os.path.join(keep, kept), there)
