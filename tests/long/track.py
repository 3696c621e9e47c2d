#!/usr/bin/env python3
"""Writes the track of a drive that goes round and round a closed road of 3 km.

Usage: tests/long/track.py LENGTH_M
"""
import math
import sys

STEP = 2.0  # m between two places
CORNERS = 20000  # of a lap, with places of the track between them


def place(corner):
    turn = 2 * math.pi * corner / CORNERS
    radius = 477 * (1 + 0.06 * math.cos(3 * turn) + 0.03 * math.cos(5 * turn + 1))  # m
    return radius * math.cos(turn), radius * math.sin(turn)


def main():
    length, driven, written, corner = float(sys.argv[1]), 0.0, 0, 0
    here = place(0)
    while driven < length + STEP:
        if driven >= written * STEP:
            print(f"1 0 0 {here[0]:.6f} 0 1 0 {here[1]:.6f} 0 0 1 0")
            written += 1
        corner += 1
        there = place(corner % CORNERS)
        driven += math.dist(here, there)
        here = there


main()
