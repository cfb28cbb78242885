#!/usr/bin/env python3
"""Makes one HTML page, and lab/results.md, of what script/report has gathered.

usage: page.py FOLDER [--page FILE] [--results FILE]

FOLDER holds the JSON files of `relief-lab eval`, `bench` and `measure`, of bench_render and bench_physics,
frames.csv of `relief run --log`, and pictures; the page is FOLDER/report.html unless --page tells. A missing
file leaves its part out, and the page says so. Both files are replaced when they are whole."""

import os
import sys

import content
import html_out
import markdown_out
from data import Data


def write_whole(path, text):
    part = path + ".part"
    try:
        with open(part, "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(part, path)
    finally:
        if os.path.exists(part):
            os.remove(part)


def parse(arguments):
    """(folder, page, results) or None."""
    folder, page, results = None, None, None
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        if word in ("--page", "--results") and rest:
            value = rest.pop(0)
            page, results = (value, results) if word == "--page" else (page, value)
        elif word.startswith("-") or folder is not None:
            return None
        else:
            folder = word
    return (folder, page or os.path.join(folder, "report.html"), results) if folder else None


def main(arguments):
    if arguments and arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0
    parsed = parse(arguments)
    if parsed is None:
        print(__doc__, file=sys.stderr)
        return 2
    folder, page, results = parsed
    if not os.path.isdir(folder):
        print(f"page.py: {folder}: is not a folder", file=sys.stderr)
        return 1
    try:
        data = Data(folder)
        sections = content.sections(data)
        write_whole(page, html_out.page("Relief, measured", "Made by script/report. Each section ends with the "
                                        "command that repeats it.", sections))
        if results:
            write_whole(results, markdown_out.document("Results", "Made by `script/report`; do not edit. The page of "
                                                       "that script has the same with charts and pictures.", sections))
    except (OSError, ValueError) as error:
        print(f"page.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
