"""Figures against their goals. Nothing may look better than it is: a mean that reaches its goal only
within its spread is told apart, and so is one that the test suite does not guard as tightly."""

from blocks import Cell
from data import number


def holds(relation, limit, value):
    return value <= limit if relation == "<=" else value >= limit


def limit(relation, value):
    return "" if value is None else f"{'≤' if relation == '<=' else '≥'}\u00a0{number(value)}"


def spread(side):
    """Mean ± half width of the 95 % interval; a single value has none."""
    if not side or side.get("mean") is None:
        return "-"
    mean = number(side["mean"])
    if mean == "never":
        return mean
    return mean + (" (one run)" if side.get("ci95") is None else f"\u00a0±\u00a0{number(side['ci95'], 2)}")


def reach(row):
    """True or False; None without a goal or a value."""
    mean, goal = (row.get("live") or {}).get("mean"), row.get("goal")
    return None if mean is None or goal is None else holds(row["relation"], goal, mean)


def is_within_spread(row):
    """Whether the goal lies inside the interval of the mean."""
    live = row.get("live") or {}
    return live.get("ci95") is not None and abs(live["mean"] - row["goal"]) < live["ci95"]


def is_guarded(row):
    """Whether the bound is as tight as the goal."""
    return row.get("bound") is not None and holds(row["relation"], row["goal"], row["bound"])


def status(row):
    met = reach(row)
    if met is None:
        return Cell("no goal" if row.get("goal") is None else "not measured", "text")
    parts = ["reached" if met else "SHORT of the goal"]
    if is_within_spread(row):
        parts.append("within its spread")
    if met and not is_guarded(row):
        parts.append(f"guarded only to {limit(row['relation'], row['bound'])}")
    css = "short" if not met else "near" if len(parts) > 1 else "met"
    return Cell("; ".join(parts), css + " text")


def status_of(relation, goal, median, p95=None):
    """The same for a time or rate: by its median, and whether its 95th percentile keeps the goal too."""
    if median is None:
        return Cell("not measured", "text")
    if not holds(relation, goal, median):
        return Cell("SHORT of the goal", "short text")
    if p95 is not None and not holds(relation, goal, p95):
        return Cell("reached by the median, not at the 95th percentile", "near text")
    return Cell("reached", "met text")
