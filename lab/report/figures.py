#!/usr/bin/env python3
"""Takes the values of docs/figures.csv from what script/report has gathered.

usage: figures.py FOLDER FIGURES.csv

A row's column `from` says where its value stands: eval:SCENE:KEY:PROFILE or bench:GROUP:NAME:COLUMN,
and after a blank how it is printed, as %.1f. Rows without such a place, and places that were not
measured, stay as they are.
"""

import os
import sys

from data import Data


def value_of(data, place):
    kind, *words = place.split(":")
    if kind == "eval" and len(words) == 3:
        figure = data.figure(words[0], words[1])
        profile = figure and figure.get(words[2])
        return (profile["mean"], data.eval["machine"]) if profile else None
    if kind == "bench" and len(words) == 3:
        row = data.bench_row(words[0], words[1])
        value = row and row.get(words[2])
        return (value, data.bench["machine"]) if value is not None else None
    return None


def filled(line, data):
    words = line.rstrip("\n").split(",")
    if line.startswith("#") or len(words) != 8 or ":" not in words[4]:
        return line
    place, _, form = words[4].partition(" ")
    found = value_of(data, place)
    if found is None:
        print(f"figures: {words[0]}: not measured here: it stays {words[1]}")
        return line
    value, machine = found
    words[1] = (form or "%.3g") % value
    words[5:8] = machine["date"], machine["commit"], machine["cpu"].replace(",", "")
    return ",".join(words) + "\n"


def main():
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    data = Data(sys.argv[1])
    with open(sys.argv[2], encoding="utf-8") as file:
        lines = [filled(line, data) for line in file]
    part = sys.argv[2] + ".part"
    with open(part, "w", encoding="utf-8") as file:
        file.writelines(lines)
    os.replace(part, sys.argv[2])
    return 0


if __name__ == "__main__":
    sys.exit(main())
