"""The sections of the report, out of what was measured."""

import charts
import speed
from blocks import Cell, Charts, Command, Details, Pictures, Row, Section, Strip, Table, Text
from data import number, percentile
from judge import limit, reach, spread, status, status_of

VIEWS = [("camera", "the camera's picture with the cubes"), ("depth", "depth"), ("normals", "normals"),
         ("regions", "regions and their boxes"), ("foreground", "foreground"), ("thickness", "thickness"),
         ("velocity", "velocity"), ("reason", "why a pixel has no depth of its own")]

SCENES = {"room": "a person walks in and reaches out", "empty": "nobody", "thesis": "the room of the thesis",
          "chair": "a chair is taken away", "book": "a book held edge-on, then turned", "hand": "a hand close up",
          "steps": "noise of structured light: whole steps, alike in neighbouring pixels",
          "picture": "what hides bodies, at the colour camera", "planes": "planes without noise",
          "plate": "a moving plate before a still wall", "simulator": "the simulated sensor beside the thesis's",
          "physics": "bodies on analytic surfaces", "sensed": "bodies on what the sensor shows"}


GROWTH = 1.25  # a cost that is to stay the same may vary by as much


def summary(data):
    goals = [row for row in data.figures() if reach(row) is not None]
    short = [row for row in goals if not reach(row)]
    timed, slow = speed.counts(data)
    rows = [Row([f"{row['scene']}: {row['title']}", limit(row["relation"], row["goal"]),
                 spread(row["live"]), spread(row.get("thesis"))]) for row in short]
    rows += [Row([g.title.strip(), limit(g.relation, g.goal), f"{number(value, 3)} {g.unit}", g.thesis or "-"])
             for g, value in slow]
    blocks = [Text(f"Accuracy: {len(goals) - len(short)} of {len(goals)} figures with a goal reach it. "
                   f"Speed: {timed - len(slow)} of {timed}. What is short of its goal stands here first.")]
    if rows:
        blocks.append(Table(["short of the goal", "goal", "ours", "the thesis's method"], rows))
    blocks.append(Text("Every figure is the mean over seeds ± its 95 % confidence interval (Student's t), or a "
                       "median and a 95th percentile of times. The commands are those of relief (build/release/app) "
                       "or programs of build/release/lab/bench.", True))
    machine = data.machine()
    if machine:
        blocks.append(Table(["made on", ""], [Row([key, Cell(value, "text")]) for key, value in machine.items()]))
    return Section("In short", blocks)


def views(data):
    pictures = [(data.picture("views", name + ".png"), caption) for name, caption in VIEWS]
    pictures = [(png, caption) for png, caption in pictures if png]
    if not pictures:
        return Section("What it looks like", [Text("no pictures: the folder views is missing")])
    return Section("What it looks like", [
        Text("Frame 92 of the demo: a visitor walks through a room with virtual cubes. One camera, no scan, no training, no GPU."),
        Pictures(pictures),
        Command("relief run synthetic:room --scene scenes/demo.json --headless --frames 93 "
                "--view normals --pictures out/views?at=92")])


def strips(data):
    blocks = [Text("Chapter 5 of the thesis again. Upper row: its method, as published. Lower row: Relief. Where the "
                   "thesis reports a failure, the upper row must show it and the lower must not; "
                   "tests/scene/test_io_thesis_scenes.c checks both.")]
    for scene, source, frames, title in data.strips():
        rows = [(profile, [data.picture("strips", scene, profile, f"{frame:06d}.png") for frame in frames])
                for profile in ("thesis", "live")]
        if all(all(row) for _, row in rows):
            blocks.append(Strip(title, rows))
            listed = "+".join(map(str, frames))
            blocks.append(Command(f"relief run {source} --scene scenes/thesis/{scene}.json --profile thesis "
                                  f"--headless --frames {frames[-1] + 1} --pictures out/{scene}?at={listed}"))
    if len(blocks) == 1:
        blocks.append(Text("no pictures: the folder strips is missing"))
    return Section("The thesis's scenes", blocks)


def accuracy(data):
    rows, scene = [], None
    for row in data.figures():
        if "relation" not in row:
            continue
        if row["scene"] != scene:
            scene = row["scene"]
            rows.append(Row([f"{scene}: {SCENES[scene]}" if scene in SCENES else scene], is_heading=True))
        rows.append(Row([row["title"], limit(row["relation"], row["goal"]), spread(row.get("live")), status(row),
                         spread(row.get("thesis")), Cell(row.get("published") or "-", "text"),
                         Cell(row.get("others") or "-", "text"), limit(row["relation"], row["bound"])]))
    if not rows:
        return Section("Accuracy", [Text("no figures: eval.json is missing")])
    return Section("Accuracy", [
        Text(f"Mean over {data.seeds()} seeds ± 95 % confidence interval. Both profiles see the same frames, of which "
             "the truth is known. Reported or measured elsewhere: what the thesis says of itself, or what its "
             "formulas gave in another simulation; what other systems gave there. The test suite fails beyond the "
             "bound; a bound looser than the goal is told as such. A dash: nothing was measured there; the surfaces of scene physics "
             "have no regions, which the thesis's method needs: scene sensed has those experiments for both."),
        Table(["figure", "goal", "ours (live)", Cell("goal reached?", "text"), "thesis's method, same frames",
               Cell("thesis elsewhere", "text"), Cell("other systems", "text"), "bound"], rows),
        Command(f"relief-lab eval --seeds {data.seeds()}")])


def _curve(data, what, side):
    points = []
    for row in data.figures():
        if row["scene"] == "room" and row["key"].startswith("distance_") and row["key"].endswith(what):
            value = row.get(side) or {}
            points.append((float(row["key"].split("_")[1]) + 0.25, value.get("mean"), value.get("ci95")))
    return points


def distance(data):
    curves = {"raw frame, RMSE mm": _curve(data, "m_raw_rmse_mm", "live"),
              "live, RMSE mm": _curve(data, "m_rmse_mm", "live"),
              "thesis, RMSE mm": _curve(data, "m_rmse_mm", "thesis"),
              "live, normals deg": _curve(data, "normal_mean_deg", "live"),
              "thesis, normals deg": _curve(data, "normal_mean_deg", "thesis")}
    if not any(curves.values()):
        return Section("Error against distance", [Text("no figures: eval.json has no scene room")])

    def chart(names, title):
        series = [(name.split(",")[0], curves[name]) for name in names]
        return charts.line_chart(series, "distance, m", title)
    rows = [Row([f"{point[0] - 0.25:g} to {point[0] + 0.25:g} m"]
                + [spread({"mean": c[i][1], "ci95": c[i][2]}) for c in curves.values()])
            for i, point in enumerate(curves["live, RMSE mm"])]
    return Section("Error against distance", [
        Text("Away from depth edges, scene room. Bars: 95 % confidence intervals over the seeds."),
        Charts([(chart(list(curves)[:3], "depth error, RMSE, mm"), "depth: the raw frame is what both start from"),
                (chart(list(curves)[3:], "normals, mean error, degrees"), "normals")]),
        Details("the same as a table", [Table(["distance"] + list(curves), rows)]),
        Command(f"relief-lab eval --scene room --seeds {data.seeds()}")])


def _peer_group(group):
    rows = [Row([f"{i + 1}. {r['peer']} {r['stage']}", number(r["median"], 3), number(r["least"], 3)]
                + [number(v, 3) for v in r["values"]], css="ours" if r["peer"] == "relief" else "")
            for i, r in enumerate(group["rows"])]
    points = {}
    for index, head in enumerate(group["heads"]):
        points[head] = [(r["least"], r["values"][index], str(i + 1), r["peer"] == "relief")
                        for i, r in enumerate(group["rows"])]
    errors = [head for head in group["heads"] if head in (">30%", "edge>30%", "RMSE mm", "edge>40mm%")]
    drawn = [(charts.scatter(points[head], "least time, ms", head),
              f"{head} against time; the numbers are those of the table, ours is the square; lower left is better")
             for head in errors if any(p[1] is not None for p in points[head])]
    bars = [(f"{r['peer']} {r['stage']}", r["least"], None, r["peer"] == "relief") for r in group["rows"]]
    drawn.append((charts.bar_chart(bars, "ms"), "least time of one frame, 512x424, one thread"))
    blocks = [Text(group["title"]), Charts(drawn),
              Table(["library and stage", "median ms", "least ms"] + group["heads"], rows)]
    return blocks


def peers(data):
    groups = (data.bench or {}).get("peers")
    if not groups:
        return Section("Beside other libraries", [Text(
            "ABSENT: no results of other libraries were given to this report. script/peers DIR makes them "
            "with a harness (lab/measuring.md), and script/report --peers out/peers/results.txt puts their "
            "times and errors beside ours here.")])
    blocks = [Text("Other libraries on the very same clip of the synthetic room, one after the other on one thread. "
                   "Shares in percent: inner and edge, of pixels farther and nearer than 3 pixels from an edge; "
                   "inner% and edge% have a normal; >30% and edge>30% of those are more than 30 degrees off; median deg is "
                   "their error; lost, spoilt (> 10 degrees) and invented are of a plane with 1 % of its "
                   "pixels missing; edge>40mm% of the pixels at an edge are more than 4 cm off. "
                   "A stage called floor, none or only is a part of the work, for scale. The charts have the least "
                   "times, which a busy machine disturbs less than medians taken at different moments.")]
    for group in groups:
        blocks += _peer_group(group)
    blocks.append(Command("script/bench --peers DIR"))
    return Section("Beside other libraries", blocks)


def engines(data):
    if not data.engines:
        return Section("Beside other physics engines", [Text(
            "ABSENT: bench_peers is built where pkg-config finds ode or bullet (docs/dependencies.md).")])
    keys = ("fall_mm", "tumble", "chain_percent", "drift_mm", "deep_mm", "slope_deg", "lifted", "swept")
    heads = ["free fall of 1 s, mm off", "tumbling, 100 s: energy drift", "row of 5 balls, worst, %",
             "ten cubes, 20 s: mm aside", "mm deep", "slope, degrees off", "LIFT, of 8",
             "SWIPE, of 8"]
    counts = sorted({c["cubes"] for e in data.engines["engines"] for c in e["crowds"]})
    rows = []
    for engine in data.engines["engines"]:
        cells = [number(engine.get(k), 3) for k in keys]
        crowds = {c["cubes"]: c for c in engine["crowds"]}
        cells += [f"{crowds[n]['median_ms']:.3g} ms, {crowds[n]['lost']} lost" if n in crowds else "-" for n in counts]
        rows.append(Row([engine["name"]] + cells))
    heads += [f"{n} cubes" for n in counts]
    return Section("Beside other physics engines", [
        Text("The same scenes, 60 steps a second, one thread; crowds fall on the live surface, which the others get as "
             "two meshes, one of them new every frame. Lost: in view only. (one run)"),
        Table([""] + heads, rows), Command("build/release/lab/bench/bench_peers")])


def _bench_bars(rows, strip=""):
    return [(r["name"].removeprefix(strip), r["median"], r["p95"], False) for r in rows]


def _memory(data):
    names = ("capture", "surface", "physics", "render", "whole")
    groups = [g for g in ("live_1", "live_8", "thesis_1", "thesis_8") if data.bench_row(g, "memory/whole")]
    rows = [Row([name] + [number((data.bench_row(g, "memory/" + name) or {}).get("median"), 3) for g in groups])
            for name in names]
    return Table(["MiB, by stage"] + groups, rows) if groups else None


def _latency(data):
    values = data.latencies()
    if len(values) < 2:
        return []
    rows = [Row([f"{p}th percentile" if p != 50 else "median", number(percentile(values, p), 3)])
            for p in (5, 50, 95, 99)]
    return [Charts([(charts.histogram(values, 30, "from frame to picture, ms", goal=33),
                     f"latency that Relief adds, {len(values)} frames, all threads; goal: one camera frame, 33 ms")]),
            Table(["latency", "ms"], rows),
            Command("relief run synthetic:room --scene scenes/demo.json --headless --frames 300 --log log")]


def _phases(physics):
    """What the cubes of bench_physics cost while they are poured, ploughed and at rest."""
    rows = []
    for row in physics["rows"]:
        for phase in ("poured", "ploughed", "at rest"):
            cost = row.get(phase, {})
            if cost.get("steps"):
                rows.append(Row([f"{row['cubes']} cubes, {phase}"] +
                                [number(cost[key], 3) for key in ("median_ms", "p95_ms", "mean_ms")]))
    if physics["rows"] and physics["rows"][0].get("grid_ms") is not None:
        rows.append(Row(["of that: making the collider's grid of each new surface", "-", "-",
                         number(physics["rows"][0]["grid_ms"], 3)]))
    return [Text(f"The cubes of bench_physics fall into the room with a person in it for {physics['seconds']:g} s; then it "
                 "is empty. Above: the phase with the largest median.", True),
            Table(["physics per 1/60 s, ms", "median", "p95", "mean"], rows)]


def timing(data):
    blocks = [Text("Goals first. Thesis: 10 frames a second at 64x53 with two cubes, 3.4 GHz Xeon, capture and drawing "
                   "included. Other systems: measured or published elsewhere, at 512x424 and one thread unless "
                   "said; those measured here stand above, where results were given."), speed.table(data)]
    if data.physics:
        blocks += _phases(data.physics)
    if data.bench:
        stages = [r for r in data.bench_rows("live_1") if r["name"] in ("capture", "surface", "physics", "render")]
        steps = [r for r in data.bench_rows("live_1") if r["name"].startswith("surface/")]
        thesis = [r for r in data.bench_rows("thesis_8") if r["name"] in ("capture", "surface", "physics", "render")]
        rows = [Row([f"{r['group']}: {r['name']}", number(r["median"], 3), number(r["p95"], 3), r["unit"],
                     number(r["ratio"], 3)]) for g in ("live_1", "live_8", "thesis_1", "thesis_8")
                for r in data.bench_rows(g) if not r["name"].startswith("memory/")]
        blocks += [Charts([(charts.bar_chart(_bench_bars(stages), "ms"), "stages of profile live at 512x424"),
                           (charts.bar_chart(_bench_bars(thesis), "ms"), "stages of profile thesis at 64x53"),
                           (charts.bar_chart(_bench_bars(steps, "surface/"), "ms"),
                            "steps of the surface stage, profile live")]),
                   Text(f"Bars: median of {data.bench['frames']} frames, {data.bench['threads']} thread; whiskers: "
                        "95th percentile.", True),
                   Details("all times; the ratio of the surface stage is to the memory floor, of its steps to "
                           "the stage", [Table(["case", "median", "p95", "unit", "ratio"], rows)]),
                   Command("relief-lab bench")]
        memory = _memory(data)
        if memory:
            blocks += [Text("Memory, allocated when a stage is made; a frame allocates nothing afterwards."), memory,
                       Command("relief-lab bench")]
    else:
        blocks.append(Text("no times: bench.json is missing"))
    return Section("Speed, memory, latency", blocks + _latency(data))


def _sweep(data, group):
    points = []
    for row in data.bench_rows(group):
        sizes = [float(v) for v in row["name"].split()[0].split("x")]
        points.append((sizes[0] * (sizes[1] if len(sizes) > 1 else 1.0), row["median"],
                       (row["p95"] or row["median"]) - row["median"]))
    return points


def growth(data):
    plots = [("resolution", "pixels", True), ("bodies", "bodies", True), ("regions", "regions", False),
             ("people", "people", False), ("people of the same pixels", "people of the same pixels", False)]
    rows = [Row([f"{group}: {r['name']}", number(r["median"], 3), number(r["p95"], 3), number(r["ratio"], 3),
                 status_of("<=", GROWTH, r["ratio"])]) for group, _, _ in plots for r in data.bench_rows(group)]
    if not rows:
        return Section("How the cost grows", [Text("no sweeps: bench.json is missing or was made with --quick")])
    drawn = [(charts.line_chart([(group, _sweep(data, group))], title, "ms", log, only_up=True), f"against {title}")
             for group, title, log in plots]
    return Section("How the cost grows", [
        Text("Profile live, one thread; the surface stage, and physics for bodies. Goal: in proportion to the pixels "
             "and bodies, flat in regions and people. Bars reach to the 95th percentile. The ratio of pixels and "
             "bodies is the cost of one beside that at 512x424 or of 100; of regions and people, beside the first row. "
             "Regions fill the same pixels together, and so do people of the same pixels, who stand side by side; "
             "those of the row before walk, and each adds moving pixels until they hide one another. "
             f"Up to {GROWTH:g} counts as reached."),
        Charts(drawn), Table(["against", "median ms", "p95", "ratio", Cell("goal reached?", "text")], rows), Command("relief-lab bench")])


def table_5_1(data):
    rows = []
    for row in (data.table or {}).get("rows", []):
        off = row.get("off_percent")
        allowed = 15 if row["case"] == "c" else 5
        verdict = Cell("", "text")
        if off is not None:
            good = abs(off) <= allowed
            verdict = Cell(f"{off:+.1f} %, {'within' if good else 'BEYOND'} {allowed} %", ("met" if good else "short") + " text")
        every = f"every {row['scale']}th pixel" if row["scale"] > 1 else "every pixel"
        rows.append(Row([f"{row['case']}, {every}",
                         f"{row['width']}x{row['height']}", str(row["points"]), number(row["missing"]),
                         number(row.get("published")), verdict, number(row["missing_percent"], 3),
                         number(row["estimated_bad_percent"], 3), number(row["counted_bad_percent"], 3)]))
    if not rows:
        return Section("Table 5.1 of the thesis", [Text("no table: table.json is missing")])
    return Section("Table 5.1 of the thesis", [
        Text("Points that the sensor did not deliver, averaged over the frames: a, b nobody moves; c, d somebody does; "
             "a, c the whole scene; b, d its centre. The simulated sensor may be off by 5 %, in case c by 15 %; over "
             "several seeds it stands under simulator in the accuracy table. The room was furnished to match, so that "
             "the agreement shows what the simulator can reproduce, not that it must. The thesis estimates the "
             "share of wrong normals in d at 8.67 %; the last column counts them."),
        Table(["case", "grid", "points", "missing", "thesis", Cell("off", "text"), "missing %", "estimated wrong normals, %",
               "counted, %"], rows),
        Command("relief-lab measure synthetic:thesis")])


def noise(data):
    if not data.noise:
        return Section("Is the simulator like a sensor?", [Text("no figures: noise_0.json is missing")])
    names = [n["source"].rstrip("/").split("/")[-1].removeprefix("synthetic:") for n in data.noise]
    for n in data.noise:
        for r in n["noise"]:
            r["per_square"] = r["step_1_mm"] and r["step_1_mm"] / r["distance_m"] ** 2
    seen = [[r for r in n["noise"] if r["pixels_percent"] >= 0.1] for n in data.noise]  # fewer pixels are no curve
    keys = [("step_1_mm", "neighbours"), ("step_4_mm", "4 pixels apart"), ("temporal_mm", "from frame to frame")]
    drawn, rows = [], []
    for key, title in keys:
        series = [(name, [(r["distance_m"], r[key]) for r in rows_of]) for name, rows_of in zip(names, seen)]
        series.append(("assumed for " + names[0], [(r["distance_m"], r["assumed_mm"]) for r in seen[0]]))
        drawn.append((charts.line_chart(series, "distance, m", "standard deviation of depth, mm"), title))
    drawn.append((charts.line_chart(
        [(name, [(r["distance_m"], r["per_square"]) for r in rows_of]) for name, rows_of in zip(names, seen)],
        "distance, m", "mm per square metre"), "neighbours, over the square of the distance: what can be compared "
        "where the distances differ"))
    for name, n in zip(names, data.noise):
        rows.append(Row([f"{name}: {n['frames']} frame{'s' if n['frames'] != 1 else ''}, "
                         f"{number(n['missing_percent'], 3)} % of the pixels missing"], is_heading=True))
        rows += [Row([f"{r['distance_m'] - .25:g} to {r['distance_m'] + .25:g} m", number(r["pixels_percent"], 3)]
                     + [number(r[k], 3) for k in ("step_1_mm", "step_2_mm", "step_4_mm", "temporal_mm", "assumed_mm", "per_square")])
                 for r in n["noise"]]
    blocks = [Text("Standard deviation of depth in millimetres. Noise that is alike in neighbouring pixels grows "
                   "with their distance along the row. That of the room (time of flight, Fankhauser et al. 2015) does "
                   "not, that of noise=steps (structured light) and of real sensors does, and so their normals "
                   "are worse than most figures above, which come from the room. The room's noise grows where a "
                   "surface is seen at a slant: nearer than 3.5 m that is the floor, farther the wall. Assumed: "
                   "what the surface stage reckons with, of a wall seen straight.")]
    if all(n["source"].startswith("synthetic:") for n in data.noise):
        blocks.append(Text("ABSENT: no real clip was given; script/report --clip FOLDER puts one beside it."))
    return Section("Is the simulator like a sensor?", blocks + [
        Charts(drawn),
        Table(["distance", "pixels %", "1 pixel apart, mm", "2 apart", "4 apart", "in time", "assumed", "1 apart, mm/m²"], rows),
        Command("relief info SOURCE --noise")])


def sections(data):
    return [part(data) for part in (summary, views, strips, accuracy, distance, peers, engines, timing, growth, table_5_1,
                                    noise)]
