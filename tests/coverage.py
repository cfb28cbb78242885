#!/usr/bin/env python3
"""How many lines of src each unit test runs, and how many no other one does, by gcov.

usage: tests/coverage.py [NAME...]    (NAME: tests to leave out together, e.g. unit.physics_crowd)

Builds in build/coverage, runs every unit test by itself and prints, the longest first, its seconds,
its lines and those that it alone runs; at last what would not be run without all NAMEs.
"""
import collections
import json
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "coverage"
DATA = BUILD / "data"


def build():
    flags = "-O1 --coverage"
    subprocess.run(
        ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
         f"-DCMAKE_C_FLAGS_DEBUG={flags}", "-DCMAKE_EXE_LINKER_FLAGS=--coverage",
         "-DCMAKE_SHARED_LINKER_FLAGS=--coverage", "--log-level=WARNING"], check=True)
    subprocess.run(["cmake", "--build", BUILD, "--target", "relief_tests"], check=True)


def unit_tests():
    shown = subprocess.run(["ctest", "--show-only=json-v1", "-R", "^unit"], cwd=BUILD, check=True,
                           capture_output=True, text=True).stdout
    return [t for t in json.loads(shown)["tests"] if "command" in t]


def run(test):
    """Seconds that it took; its counts are in DATA."""
    strip = len(BUILD.parts) - 1
    environment = dict(os.environ, GCOV_PREFIX=str(DATA / test["name"]), GCOV_PREFIX_STRIP=str(strip))
    folder = {p["name"]: p["value"] for p in test["properties"]}.get("WORKING_DIRECTORY", BUILD)
    begun = time.monotonic()
    done = subprocess.run(test["command"], cwd=folder, env=environment, stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL)
    if done.returncode not in (0, 77):
        sys.exit(f"tests/coverage.py: {test['name']} failed; run script/test -R {test['name']}")
    return time.monotonic() - begun


def lines_of(name):
    """Of src, as (file, line), that the test ran."""
    found = set()
    for counts in (DATA / name / "src").rglob("*.gcda"):
        notes = counts.with_suffix(".gcno")
        if not notes.exists():
            notes.symlink_to(BUILD / notes.relative_to(DATA / name))
        text = subprocess.run(["gcov", "-t", "-j", counts], capture_output=True, text=True).stdout
        for record in filter(None, text.splitlines()):
            for file in json.loads(record)["files"]:
                if file["file"].startswith("src/"):
                    found |= {(file["file"], x["line_number"]) for x in file["lines"] if x["count"]}
    return found


def main(left_out):
    if "--help" in left_out or "-h" in left_out:
        print(__doc__.strip())
        return
    build()
    subprocess.run(["rm", "-rf", DATA], check=True)
    seconds = {t["name"]: run(t) for t in unit_tests()}
    lines = {name: lines_of(name) for name in seconds}
    runs = collections.Counter(x for found in lines.values() for x in found)
    print(" seconds   lines   alone  test")
    for name in sorted(seconds, key=seconds.get, reverse=True):
        alone = sum(runs[x] == 1 for x in lines[name])
        print(f"{seconds[name]:8.1f} {len(lines[name]):7d} {alone:7d}  {name}")
    kept = set().union(*(lines[n] for n in lines if n not in left_out))
    print(f"{len(runs)} lines in all; {len(runs) - len(kept)} of them not without those left out")


main(sys.argv[1:])
