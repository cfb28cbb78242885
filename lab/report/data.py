"""The files that script/report has gathered, and the figures in them. What is missing is None or empty."""

import csv
import json
import os

NEVER = 1e7  # a mean beyond it is of something that did not happen


class Data:
    def __init__(self, folder):
        self.folder = folder
        for name in ("eval", "bench", "table", "render", "physics", "crowd", "engines"):
            setattr(self, name, self._json(name + ".json"))
        self.noise = [self._json(name) for name in sorted(os.listdir(folder))
                      if name.startswith("noise") and name.endswith(".json")]
        self.frames = self._csv(os.path.join("log", "frames.csv"))

    def _json(self, name):
        try:
            with open(os.path.join(self.folder, name), encoding="utf-8") as file:
                return json.load(file)
        except OSError:
            return None

    def _csv(self, name):
        try:
            with open(os.path.join(self.folder, name), encoding="utf-8", newline="") as file:
                return list(csv.DictReader(file))
        except OSError:
            return []

    def picture(self, *path):
        try:
            with open(os.path.join(self.folder, *path), "rb") as file:
                return file.read()
        except OSError:
            return None

    def strips(self):
        """(scene, source, frames, title) of each line of strips.txt."""
        try:
            with open(os.path.join(self.folder, "strips", "strips.txt"), encoding="utf-8") as file:
                lines = [line.split(None, 3) for line in file if line.strip() and not line.startswith("#")]
        except OSError:
            return []
        return [(scene, source, [int(f) for f in frames.split(",")], title.strip())
                for scene, source, frames, title in lines]

    def machine(self):
        for source in (self.bench, self.eval, self.table):
            if source and source.get("machine"):
                return source["machine"]
        return {}

    def figures(self):
        return (self.eval or {}).get("figures", [])

    def figure(self, scene, key):
        return next((f for f in self.figures() if f["scene"] == scene and f["key"] == key), None)

    def seeds(self):
        return len((self.eval or {}).get("seeds", []))

    def bench_rows(self, group):
        return [row for row in (self.bench or {}).get("rows", []) if row["group"] == group]

    def bench_row(self, group, name):
        return next((row for row in self.bench_rows(group) if row["name"] == name), None)

    def latencies(self):
        """Milliseconds from frame to picture, one per frame, without the first ten (they warm up)."""
        keys = ("capture_ms", "surface_ms", "physics_ms", "render_ms")
        return [sum(float(frame[key]) for key in keys) for frame in self.frames[10:]]


def percentile(values, percent):
    values = sorted(values)
    return values[round(percent / 100 * (len(values) - 1))] if values else None


def number(value, digits=4):
    if value is None:
        return "-"
    if value >= NEVER:
        return "never"
    return f"{value:.0f}" if abs(value) >= 1e4 else f"{value:.{digits}g}"
