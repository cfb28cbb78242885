"""relief-lab measure SOURCE: thesis table 5.1 for any source."""

import argparse
import csv
import io
import math

import relief

from . import report, sections
from .points import Points
from .rooms import settings_from
from .sections import Failed
from .words import Parser, check_file, file_name, number_within, usage, write_file

SCALES_MAX = 8
FRAMES_MIN = 6  # of the table: the first 5 are needed for the background

HELP = """usage: relief-lab measure SOURCE [OPTIONS]

The experiment of the thesis's section 5.1.2 on any source: points per frame that the
sensor did not deliver, averaged over the frames, in four cases:
  a  whole scene, no moving object     c  whole scene, moving object
  b  centre (77.59 %), no moving object  d  centre, moving object
with the thesis's estimate of wrong normals (4 per missing point), the counted share
(missing or more than 30 deg off) where the source knows the truth, and the reasons.

  --frames N        default: all frames of the source
  --scale LIST      scale factors, default 8,1
  --profile NAME    thesis (default) or live: whose normals are counted
  --set NAME=VALUE  a setting of the surface (see `relief list settings`); any number
  --csv FILE        the rows as CSV
  --json FILE       the rows as JSON

examples:
  relief-lab measure synthetic:thesis
  relief-lab measure path/to/clip --scale 8 --csv table.csv
"""


def scale_list(text):
    words = text.split(",")
    if len(words) > SCALES_MAX or not all(w.isdigit() and 1 <= int(w) <= 64 for w in words):
        raise argparse.ArgumentTypeError("'%s': use up to 8 numbers from 1 to 64" % text)
    return list(map(int, words))


def profile_name(text):
    if text not in ("live", "thesis"):
        raise argparse.ArgumentTypeError("'%s': use live or thesis" % text)
    return text


def parse(words):
    p = Parser("measure", HELP)
    p.add_argument("source", nargs="*")
    p.add_argument("--frames", type=number_within(1, 1000000000))
    p.add_argument("--scale", type=scale_list, default=[8, 1])
    p.add_argument("--profile", type=profile_name, default="thesis")
    p.add_argument("--set", action="append", default=[])
    p.add_argument("--csv", type=file_name(".csv"))
    p.add_argument("--json", type=file_name(".json"))
    o = p.parse(words)
    if len(o.source) != 1:
        usage("measure", "needs one SOURCE")
    if o.frames is not None and o.frames < FRAMES_MIN:
        usage("measure", "--frames %d: use %d or more" % (o.frames, FRAMES_MIN))
    if o.set:
        sections.check_settings(o.set)
    o.source = o.source[0]
    for path in (o.csv, o.json):
        check_file("measure", path)
    return o


def check_end(o):
    with relief.open(o.source) as source:
        if source.frame_count is None and o.frames is None and not source.is_live:
            raise Failed("relief-lab measure: %s: has no end; add --frames N" % o.source)


# ---- table 5.1 ---------------------------------------------------------------------------------------


def points_of(o, scale):
    out = Points()
    source = relief.open(o.source)
    with relief.Pipeline(source, profile=o.profile, render=False, threads=1, settings=settings_from(o.set),
                         scale=scale) as pipeline:
        for count, step in enumerate(pipeline, 1):
            out.add(step.surface, source.truth)
            if count == o.frames:
                break
    if not out.width:
        raise Failed("relief-lab measure: %s: too few frames with depth; the first 5 are needed for the background"
                     % o.source)
    return out


def rows_of(points, scale):
    for name, counts in points.cases.items():
        reasons = dict(zip(relief.reason_names, map(float, counts.mean_reasons())))
        yield {"scale": scale, "width": points.width, "height": points.height, "case": name, "frames": counts.frames,
               "points": counts.points, "missing": counts.missing(), "published": points.published(name),
               "off_percent": points.off_percent(name), "missing_percent": counts.missing_percent(),
               "estimated_bad_percent": counts.estimated_percent(),
               "counted_bad_percent": counts.counted_percent(), "reasons": reasons}


def print_row(row):
    grid = "%dx%d" % (row["width"], row["height"])
    reasons = "".join(" %s %.1f" % item for item in list(row["reasons"].items())[1:] if item[1] > 0)
    print("%5d %9s %4s %6d %7d %10.3f %7s %6s %7.2f %9.2f %8s  %s" % (
        row["scale"], grid, row["case"], row["frames"], row["points"], row["missing"],
        report.number(row["published"], "%.1f"), report.number(row["off_percent"], "%+.1f"), row["missing_percent"],
        row["estimated_bad_percent"], report.number(row["counted_bad_percent"], "%.2f"), reasons))


def print_table(o, rows):
    print("%s, profile %s; missing points per frame, averaged" % (o.source, o.profile))
    print("%5s %9s %4s %6s %7s %10s %7s %6s %7s %9s %8s   %s" % (
        "scale", "grid", "case", "frames", "points", "missing", "thesis", "off %", "%", "est. bad", "bad %",
        "by reason, per frame"))
    for row in rows:
        print_row(row)
    print("thesis: its table 5.1, of a room of its own; its estimate of wrong normals in d is 8.67 %")


def csv_text(rows):
    out = io.StringIO()
    keys = ("scale", "width", "height", "case", "frames", "points", "missing", "missing_percent",
            "estimated_bad_percent", "counted_bad_percent")
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow((*keys, *("reason_%d" % k for k in range(len(relief.reason_names)))))
    for row in rows:
        values = [row[key] for key in keys] + list(row["reasons"].values())
        writer.writerow(["" if isinstance(v, float) and math.isnan(v) else "%.9g" % v if isinstance(v, float) else v
                         for v in values])
    return out.getvalue()


def run_table(o):
    rows = [row for scale in o.scale for row in rows_of(points_of(o, scale), scale)]
    print_table(o, rows)
    if o.csv:
        write_file("measure", o.csv, csv_text(rows))
    if o.json:
        write_file("measure", o.json, report.json_text({"machine": sections.machine(), "source": o.source,
                                                        "profile": o.profile, "rows": rows}))


def main(words):
    o = parse(words)
    check_end(o)
    run_table(o)
    return 0
