#!/usr/bin/env python3
"""Joins two rawlogs of pole-import, of two LiDARs on one vehicle, into one.

Usage: share/experiments/join_lidars.py FRONT.rawlog REAR.rawlog OUT.rawlog
Both hold the same moments, scan by scan, with the clouds outside. The scans get the sensor labels
`front` and `stern`, as long as the `lidar` of pole-import. The motions are those of FRONT.
"""
import sys

ACTION, FRAME = b"mrpt::obs::CActionCollection", b"mrpt::obs::CSensoryFrame"
LABEL = b"\x05\0\0\0lidar"


def scans(path, label):
    """What comes before the first scan, and of each scan the action and the frame."""
    with open(path, "rb") as file:
        head, *pairs = file.read().replace(LABEL, b"\x05\0\0\0" + label).split(bytes([0x80 | len(ACTION)]) + ACTION)
    return head, [pair.split(bytes([0x80 | len(FRAME)]) + FRAME) for pair in pairs]


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    head, front = scans(sys.argv[1], b"front")
    _, stern = scans(sys.argv[2], b"stern")
    if len(front) != len(stern):
        sys.exit(f"join_lidars.py: {len(front)} and {len(stern)} scans; the same number is needed")
    action, frame = bytes([0x80 | len(ACTION)]) + ACTION, bytes([0x80 | len(FRAME)]) + FRAME
    with open(sys.argv[3], "wb") as out:
        out.write(head)
        for (motion, first), (_, second) in zip(front, stern):
            out.write(action + motion + frame + first + frame + second)


if __name__ == "__main__":
    main()
