"""What speed is meant to be, and where each value stands in the gathered files."""

from dataclasses import dataclass
from typing import Callable

from blocks import Cell, Row, Table
from data import number, percentile
from judge import holds, limit, status_of


@dataclass
class Goal:
    title: str
    relation: str
    goal: float
    unit: str
    value: Callable  # of Data: (median, 95th percentile), either None
    thesis: str
    others: str
    command: str


def _bench(group, name):
    def value(data):
        row = data.bench_row(group, name)
        return (row["median"], row["p95"]) if row else (None, None)
    return value


def _ratio(data):
    row = data.bench_row("live_1", "surface")
    return (row["ratio"], None) if row else (None, None)


def _rate(group, name="loop"):
    def value(data):
        row = data.bench_row(group, name)
        return (1000 / row["median"], 1000 / row["p95"]) if row else (None, None)
    return value


def _render(name):
    def value(data):
        row = (data.render or {}).get(name)
        return (row["median_ms"], row.get("p95_ms")) if row else (None, None)
    return value


def _cubes(count, key="median_ms", spread="p95_ms", run="physics"):
    def value(data):
        rows = (getattr(data, run) or {}).get("rows", [])
        row = next((r for r in rows if r["cubes"] == count), None)
        return (row.get(key), row.get(spread)) if row else (None, None)
    return value


def _latency(data):
    values = data.latencies()
    return percentile(values, 50), percentile(values, 95)


GOALS = [
    Goal("surface stage, 512x424, one thread", "<=", 10, "ms", _bench("live_1", "surface"), "",
         "PCL 9 to 32 for normals alone", "relief-lab bench"),
    Goal("  the same beside the memory floor", "<=", 30, "times", _ratio, "", "", "relief-lab bench"),
    Goal("whole loop, two bodies, one thread", ">=", 60, "frames/s", _rate("live_1"), "10 at 64x53", "",
         "relief-lab bench"),
    Goal("whole loop, 100 bodies, one thread", ">=", 60, "frames/s", _rate("loop", "100 bodies"), "", "",
         "relief-lab bench"),
    Goal("whole loop of the thesis's method at 64x53", ">=", 10, "frames/s", _rate("thesis_8"), "10", "",
         "relief-lab bench"),
    Goal("latency: frame to picture, all threads", "<=", 33, "ms", _latency, "100", "device SDKs 68 to 200",
         "relief run synthetic:room --scene scenes/demo.json --headless --frames 300 --log log"),
    Goal("registration to 960x540", "<=", 0.6, "ms", _render("registration to 960x540"), "", "", "bench_render"),
    Goal("picture of 100 boxes, 960x540", "<=", 3, "ms", _render("960x540 soft, 100 boxes of 12 cm"), "",
         "llvmpipe 16", "bench_render"),
    Goal("picture of 100 boxes, 1920x1080", "<=", 8, "ms", _render("1920x1080 soft, 100 boxes of 12 cm"), "",
         "llvmpipe 61", "bench_render"),
    Goal("physics, 2 cubes, per 1/60 s", "<=", 0.1, "ms", _cubes(2), "",
         "Box3D 3.3, Jolt 9.9, ODE 18, Bullet 19", "bench_physics"),
    Goal("physics, 100 cubes", "<=", 1.5, "ms", _cubes(100), "",
         "Jolt 13.4, Box3D 15 (loses 69), ODE 26, Bullet 43", "bench_physics"),
    Goal("physics, 1000 cubes", "<=", 8, "ms", _cubes(1000), "", "ODE 46, Jolt 50, Box3D 93, Bullet 145",
         "bench_physics"),
    Goal("physics, 5000 cubes", "<=", 50, "ms", _cubes(5000), "", "", "bench_physics"),
    Goal("CROWD: lost of 100, a person walks through them for 60 s", "<=", 0, "cubes",
         _cubes(100, "lost", None, "crowd"), "", "43 to 87 on one mesh, 0 to 30 on two",
         "bench_physics --bodies 100,1000 --seconds 60"),
    Goal("CROWD: lost of 1000 in 60 s", "<=", 0, "cubes", _cubes(1000, "lost", None, "crowd"), "",
         "ODE 0, Jolt 3, Bullet 19 to 30, Box3D 790 on two meshes", "bench_physics --bodies 100,1000 --seconds 60"),
    Goal("CROWD: gone through the person, of 100 in 60 s", "<=", 0, "cubes",
         _cubes(100, "through", None, "crowd"), "", "", "bench_physics --bodies 100,1000 --seconds 60"),
    Goal("CROWD: gone through the person, of 1000 in 60 s", "<=", 0, "cubes",
         _cubes(1000, "through", None, "crowd"), "", "", "bench_physics --bodies 100,1000 --seconds 60"),
    Goal("allocations in the steps of 1000 cubes", "<=", 0, "", _cubes(1000, "allocs", None), "",
         "Box3D 488 in 132 steps of 200", "bench_physics"),
]


def table(data):
    rows = []
    for g in GOALS:
        median, p95 = g.value(data)
        rows.append(Row([g.title, limit(g.relation, g.goal), Cell(number(median, 3)), number(p95, 3), g.unit,
                         status_of(g.relation, g.goal, median, p95), Cell(g.thesis or "-", "text"),
                         Cell(g.others or "-", "text"), Cell(g.command, "text")]))
    return Table(["what", "goal", "ours: median", "p95", "unit", Cell("goal reached?", "text"),
                  Cell("thesis", "text"), Cell("other systems", "text"), Cell("command", "text")], rows)


def counts(data):
    """How many goals were measured, and those that the median does not reach, with it."""
    measured = [(g, g.value(data)[0]) for g in GOALS]
    measured = [(g, v) for g, v in measured if v is not None]
    short = [(g, v) for g, v in measured if not holds(g.relation, g.goal, v)]
    return len(measured), short
