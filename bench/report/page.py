#!/usr/bin/env python3
"""Makes one HTML page, and docs/results.md, of what script/report has measured.

usage: page.py FOLDER [--results FILE]

FOLDER holds the JSON files of `relief eval`, `bench` and `measure`, frames.csv of `relief run --log`,
machine.json and pictures; the page is FOLDER/report.html. A missing file leaves its section out, and
the page says so."""

import base64
import csv
import html
import json
import os
import sys

import charts

STYLE = """
:root { color-scheme: light dark; --ink: #1c1c1e; --soft: #6b6b70; --line: #d9d9de; --paper: #fff;
        --c0: #1764ab; --c1: #c2561a; --c2: #2f7d4f; --c3: #7a4fa3; }
@media (prefers-color-scheme: dark) { :root { --ink: #ececf0; --soft: #a0a0a8; --line: #3a3a40;
        --paper: #17171a; --c0: #6db1f2; --c1: #f29a63; --c2: #6cc791; --c3: #bf9be0; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--paper);
       max-width: 1100px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.7rem; margin-bottom: 0; } h2 { margin-top: 2.2rem; font-size: 1.25rem; }
p.note, figcaption { color: var(--soft); font-size: .9rem; }
code { font-size: .88em; } figure { margin: 0; }
.grid2 { display: grid; grid-template-columns: repeat(auto-fit, minmax(440px, 1fr)); gap: 1.2rem; }
img { max-width: 100%; border-radius: 4px; }
.scroll { overflow-x: auto; } table { border-collapse: collapse; font-size: .87rem; width: 100%; }
th, td { text-align: right; padding: .22rem .55rem; border-bottom: 1px solid var(--line);
         font-variant-numeric: tabular-nums; } th { color: var(--soft); font-weight: 600; }
th:first-child, td:first-child { text-align: left; } td.scene { font-weight: 600; padding-top: .8rem; }
.short { color: var(--c1); font-weight: 600; } .met { color: var(--c2); }
svg { width: 100%; max-width: 560px; overflow: visible; } svg text { fill: var(--ink); font-size: 12px; }
svg .tick, svg .title { fill: var(--soft); } .grid { stroke: var(--line); }
.mark { stroke: var(--c1); stroke-dasharray: 4 3; } .line { fill: none; stroke-width: 2; }
.bar { fill: var(--c0); }
.line.c0 { stroke: var(--c0); } .dot.c0, text.c0 { fill: var(--c0) !important; }
.line.c1 { stroke: var(--c1); } .dot.c1, text.c1 { fill: var(--c1) !important; }
.line.c2 { stroke: var(--c2); } .dot.c2, text.c2 { fill: var(--c2) !important; }
.line.c3 { stroke: var(--c3); } .dot.c3, text.c3 { fill: var(--c3) !important; }
"""

VIEWS = [("camera", "the camera's picture with the cubes"), ("depth", "depth"), ("normals", "normals"),
         ("regions", "regions"), ("foreground", "foreground"), ("thickness", "thickness"),
         ("velocity", "velocity"), ("reason", "why a pixel is missing")]


def load_json(folder, name):
    try:
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            return json.load(file)
    except OSError:
        return None


def load_frames(folder):
    try:
        with open(os.path.join(folder, "log", "frames.csv"), encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))
    except OSError:
        return []


def number(value, digits=4):
    return "-" if value is None else f"{value:.{digits}g}"


def spread(side):
    """Mean and half width of the 95 % interval, as the command prints them."""
    if not side or side.get("mean") is None:
        return "-"
    width = side.get("ci95")
    return number(side["mean"]) + ("" if width is None else f" ± {number(width, 2)}")


def limit(row, name):
    value = row.get(name)
    return "" if value is None else f"{'≤' if row['relation'] == '<=' else '≥'} {number(value)}"


def is_met(row):
    mean = (row.get("live") or {}).get("mean")
    goal = row.get("goal")
    if mean is None or goal is None:
        return None
    return mean <= goal if row["relation"] == "<=" else mean >= goal


def accuracy_rows(data):
    """Rows with a goal or a bound, scene by scene."""
    figures = (data["eval"] or {}).get("figures", [])
    return [row for row in figures if "relation" in row]


def table_rows(data):
    return [(f"{row['scale']}, {row['case']}", row) for row in (data["table"] or {}).get("rows", [])]


def bench_rows(data, group):
    return [row for row in (data["bench"] or {}).get("rows", []) if row["group"] == group]


THESIS_TABLE = {"a": 165.468, "b": 15.548, "c": 188.573, "d": 57.113}


# ---- the page -----------------------------------------------------------------------------------


def picture(folder, name, caption):
    path = os.path.join(folder, "pictures", name + ".png")
    try:
        with open(path, "rb") as file:
            content = base64.b64encode(file.read()).decode("ascii")
    except OSError:
        return ""
    return (f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{content}">'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>")


def html_table(head, rows):
    cells = "".join(f"<th>{html.escape(h)}</th>" for h in head)
    body = "".join("<tr>" + "".join(row) + "</tr>" for row in rows)
    return f'<div class="scroll"><table><tr>{cells}</tr>{body}</table></div>'


def cell(content, css=""):
    return f'<td class="{css}">{html.escape(str(content))}</td>' if css else f"<td>{html.escape(str(content))}</td>"


def command(text):
    return f'<p class="note">Repeat it: <code>{html.escape(text)}</code></p>'


def section_accuracy(data):
    rows, scene = [], None
    for row in accuracy_rows(data):
        if row["scene"] != scene:
            scene = row["scene"]
            rows.append([f'<td class="scene" colspan="7">{html.escape(scene)}</td>'])
        met = is_met(row)
        css = {True: "met", False: "short", None: ""}[met]
        rows.append([cell(row["title"]), cell(limit(row, "goal")), cell(spread(row.get("live")), css),
                     cell(spread(row.get("thesis"))), cell(limit(row, "bound")),
                     cell(row.get("published") or ""), cell(row.get("others") or "")])
    if not rows:
        return "<p>no figures: eval.json is missing</p>"
    seeds = len(data["eval"]["seeds"])
    return (f"<p>Mean over {seeds} seeds ± 95 % confidence interval, of profile live and of the method as the "
            "thesis published it, on the same frames. Green reaches the goal, orange does not yet. The bound is "
            "what the test suite refuses to fall behind.</p>"
            + html_table(["figure", "goal", "live", "thesis", "bound", "published", "others"], rows)
            + command(f"relief eval --seeds {seeds}"))


def curve(data, what, side):
    points = []
    for row in (data["eval"] or {}).get("figures", []):
        if row["scene"] == "room" and row["key"].startswith("distance_") and row["key"].endswith(what):
            points.append((float(row["key"].split("_")[1]) + 0.25, (row.get(side) or {}).get("mean")))
    return points


def section_distance(data):
    depth = charts.line_chart([("raw frame", curve(data, "m_raw_rmse_mm", "live")),
                               ("live", curve(data, "m_rmse_mm", "live")),
                               ("thesis", curve(data, "m_rmse_mm", "thesis"))],
                              "distance, m", "depth error, RMSE, mm")
    normals = charts.line_chart([("live", curve(data, "normal_mean_deg", "live")),
                                 ("thesis", curve(data, "normal_mean_deg", "thesis"))],
                                "distance, m", "normals, mean error, degrees")
    return (f'<div class="grid2"><figure>{depth}</figure><figure>{normals}</figure></div>'
            + command("relief eval --scene room"))


def section_speed(data):
    stages = [(r["name"], r["median"], "") for r in bench_rows(data, "live_1")
              if r["name"] in ("capture", "surface", "physics", "render")]
    steps = [(r["name"].split("/")[1], r["median"], "") for r in bench_rows(data, "live_1")
             if r["name"].startswith("surface/")]
    rows = [[cell(f"{r['group']}: {r['name']}"), cell(number(r["median"], 3)), cell(number(r["p95"], 3)),
             cell(r["unit"]), cell(number(r["ratio"], 3))]
            for group in ("live_1", "live_8", "thesis_1", "thesis_8") for r in bench_rows(data, group)]
    frames = [sum(float(f[k]) for k in ("capture_ms", "surface_ms", "physics_ms", "render_ms"))
              for f in data["frames"]]
    return ('<div class="grid2"><figure>' + charts.bar_chart(stages, "ms")
            + "<figcaption>stages of profile live at 512x424, median, one thread</figcaption></figure><figure>"
            + charts.bar_chart(steps, "ms") + "<figcaption>steps of its surface stage</figcaption></figure><figure>"
            + charts.histogram(frames, 30, "from frame to picture, ms")
            + "<figcaption>latency that Relief adds: capture to finished picture, all threads</figcaption></figure></div>"
            "<details><summary>all rows</summary>"
            + html_table(["case", "median", "p95", "unit", "ratio"], rows) + "</details>"
            + command("relief bench") + command("relief run synthetic:room --headless --log log"))


def sweep(data, group):
    points = []
    for row in bench_rows(data, group):
        name = row["name"].split()[0]
        sizes = [float(v) for v in name.split("x")]
        points.append((sizes[0] * (sizes[1] if len(sizes) > 1 else 1.0), row["median"]))
    return points


def section_growth(data):
    plots = [("resolution", "pixels", True), ("bodies", "bodies", True), ("regions", "regions", False),
             ("people", "people", False)]
    figures = "".join(f"<figure>{charts.line_chart([(group, sweep(data, group))], title, 'ms', log)}</figure>"
                      for group, title, log in plots)
    return f'<div class="grid2">{figures}</div>' + command("relief bench")


def section_table(data):
    rows = [[cell(name), cell(f"{row['width']}x{row['height']}"), cell(number(row["missing"])),
             cell(number(THESIS_TABLE[row["case"]]) if row["scale"] == 8 else ""),
             cell(number(row["missing_percent"], 3)), cell(number(row["estimated_bad_percent"], 3)),
             cell(number(row["counted_bad_percent"], 3))] for name, row in table_rows(data)]
    return ("<p>Points that the sensor did not deliver, averaged over the frames: a, b nobody moves, c, d somebody "
            "does; b, d the centre only. The room was furnished to match the published row, so that agreement is "
            "not evidence for the simulator.</p>"
            + html_table(["scale, case", "grid", "missing", "thesis", "%", "thesis's estimate of wrong normals, %",
                          "counted, %"], rows) + command("relief measure synthetic:thesis"))


def noise_curve(noise, key):
    return [(row["distance_m"], row[key]) for row in noise["noise"]]


def section_noise(data):
    figures = []
    for noise in data["noise"]:
        plot = charts.line_chart([("1 pixel apart", noise_curve(noise, "step_1_mm")),
                                  ("4 pixels apart", noise_curve(noise, "step_4_mm")),
                                  ("in time", noise_curve(noise, "temporal_mm")),
                                  ("assumed", noise_curve(noise, "assumed_mm"))],
                                 "distance, m", "standard deviation of depth, mm")
        caption = f"{noise['source']}: {noise['frames']} frames, {number(noise['missing_percent'], 3)} % missing"
        figures.append(f"<figure>{plot}<figcaption>{html.escape(caption)}</figcaption></figure>")
    note = ("<p>Noise that is alike in neighbouring pixels grows with their distance along the row. The simulator's "
            "does not; that of a real sensor does, and so its normals are worse than the simulator says.</p>")
    if len(data["noise"]) < 2:
        note += '<p class="note">No real clip was given: script/report --clip FOLDER puts one beside it.</p>'
    return note + f'<div class="grid2">{"".join(figures)}</div>' + command("relief measure SOURCE --noise")


def make_page(folder, data):
    machine = data["machine"] or {}
    about = ", ".join(f"{key} {value}" for key, value in machine.items())
    views = "".join(picture(folder, name, caption) for name, caption in VIEWS)
    strips = "".join(picture(folder, "strip_" + name, caption + ": the thesis above, live below")
                     for name, caption in (("behind", "thrown at a back"), ("book_edge", "a book seen edge-on"),
                                           ("moved_chair", "a chair that has left")))
    sections = [("What it looks like", f'<div class="grid2">{views}</div>{strips}'),
                ("Accuracy, where the truth is known", section_accuracy(data)),
                ("Error against distance", section_distance(data)),
                ("Speed", section_speed(data)),
                ("How the cost grows", section_growth(data)),
                ("Table 5.1 of the thesis", section_table(data)),
                ("Is the simulator like a sensor?", section_noise(data))]
    body = "".join(f"<h2>{html.escape(title)}</h2>{content}" for title, content in sections)
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Relief, measured</title>'
            f'<meta name="viewport" content="width=device-width"><style>{STYLE}</style></head><body>'
            f'<h1>Relief, measured</h1><p class="note">{html.escape(about)}</p>{body}</body></html>\n')


# ---- docs/results.md ----------------------------------------------------------------------------


def markdown_table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]) + "\n"


def make_results(data):
    machine = data["machine"] or {}
    seeds = len((data["eval"] or {}).get("seeds", []))
    parts = ["# Results\n",
             "Made by `script/report`; do not edit. " + ", ".join(f"{k} {v}" for k, v in machine.items()) + ".\n",
             f"## Accuracy\n\n`relief eval --seeds {seeds}`: mean ± 95 % confidence interval over the seeds.\n",
             markdown_table(["scene", "figure", "goal", "live", "thesis", "reached"],
                            [[r["scene"], r["title"], limit(r, "goal"), spread(r.get("live")), spread(r.get("thesis")),
                              {True: "yes", False: "no", None: ""}[is_met(r)]] for r in accuracy_rows(data)]),
             "## Speed\n\n`relief bench`: one thread, milliseconds; the ratio is to the memory floor for the surface "
             "stage, and to the surface stage for its steps.\n",
             markdown_table(["case", "what", "median", "p95", "ratio"],
                            [[r["group"], r["name"], number(r["median"], 3), number(r["p95"], 3),
                              number(r["ratio"], 3)] for g in ("live_1", "thesis_8") for r in bench_rows(data, g)
                             if r["unit"] == "ms"]),
             "## Growth\n\nThe ratio is to a cost in proportion (pixels, bodies) or to none (regions, people).\n",
             markdown_table(["against", "size", "median ms", "ratio"],
                            [[r["group"], r["name"], number(r["median"], 3), number(r["ratio"], 3)]
                             for g in ("resolution", "regions", "people", "bodies") for r in bench_rows(data, g)]),
             "## Table 5.1\n\n`relief measure synthetic:thesis`: missing points per frame.\n",
             markdown_table(["scale, case", "missing", "thesis", "estimated wrong, %", "counted wrong, %"],
                            [[n, number(r["missing"]), number(THESIS_TABLE[r["case"]]) if r["scale"] == 8 else "",
                              number(r["estimated_bad_percent"], 3), number(r["counted_bad_percent"], 3)]
                             for n, r in table_rows(data)])]
    return "\n".join(parts)


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__)
        return 0 if arguments else 2
    folder = arguments[0]
    if not os.path.isdir(folder):
        print(f"page.py: {folder}: is not a folder", file=sys.stderr)
        return 1
    data = {name: load_json(folder, name + ".json") for name in ("eval", "bench", "table", "machine")}
    data["frames"] = load_frames(folder)
    data["noise"] = [load_json(folder, name) for name in sorted(os.listdir(folder))
                     if name.startswith("noise") and name.endswith(".json")]
    with open(os.path.join(folder, "report.html"), "w", encoding="utf-8") as file:
        file.write(make_page(folder, data))
    if len(arguments) == 3 and arguments[1] == "--results":
        with open(arguments[2], "w", encoding="utf-8") as file:
            file.write(make_results(data))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
