#!/bin/sh
# Prints the examples that --help shows, in an order in which each finds what it reads in a copy of share/sample.
# Not among them: those on data of others and on sensors, and the year, which takes minutes.
# Usage: tests/install/examples.sh FOLDER      FOLDER holds the programs
set -eu

# help_of PROGRAM: what it prints for --help, and what its subcommands do.
help_of() {
  "$1" --help
  "$1" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\).*/\1/p' |
    while read -r subcommand; do "$1" "$subcommand" --help; done
}
for program in simulate import extract localize map eval batch; do help_of "$1/pole-$program"; done |
  awk '/^[^ ]/ { on = /^Examples:/ } on && /^  pole-/ && !seen[$0]++' |
  grep -vE '^  pole-import (kitti|nclt|mulran|pcd|rosbag2)| --sensors | --data |batches/year'
