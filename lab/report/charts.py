"""Charts as inline SVG: a few lines, bars and a histogram, with one axis each and nothing to load."""

import html
import math

WIDTH, HEIGHT = 560, 300
LEFT, RIGHT, TOP, BOTTOM = 56, 150, 14, 40


def nice_ticks(low, high, wanted=5):
    """Round numbers from low to high, both included."""
    span = (high - low) or 1.0
    step = 10.0 ** math.floor(math.log10(span / wanted))
    for factor in (1, 2, 5, 10):
        if span / (step * factor) <= wanted:
            step *= factor
            break
    first = math.floor(low / step + 1e-9)
    last = math.ceil(high / step - 1e-9)
    return [i * step for i in range(first, last + 1)]


def log_ticks(low, high):
    """Powers of ten from low to high, both included; over two decades or less also 2 and 5 of each."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    factors = (1, 2, 5) if math.log10(high / low) <= 2.0 else (1,)
    ticks = [f * 10.0 ** e for e in range(first, last + 1) for f in factors]
    begin = max(t for t in ticks if t <= low * 1.000001)
    end = min(t for t in ticks if t >= high * 0.999999)
    return [t for t in ticks if begin <= t <= end]


def label(value):
    for size, suffix in ((1e6, "M"), (1e4, "k")):
        if abs(value) >= size:
            return f"{value / (size if suffix == 'M' else 1e3):g}{suffix}"
    return f"{value:g}"


class Axis:
    """Values to pixels, linear or logarithmic, between its outer ticks."""

    def __init__(self, values, pixels, log=False, zero=True):
        low, high = min(values), max(values)
        if log:
            self.ticks = log_ticks(low, high)
        else:
            self.ticks = nice_ticks(min(low, 0.0) if zero else low, high)
        self.log = log
        self.low, self.high = self.ticks[0], self.ticks[-1]
        if self.high <= self.low:
            self.high = self.low * 10 if log else self.low + 1
        self.begin, self.end = pixels

    def at(self, value):
        if self.log:
            share = math.log(value / self.low) / math.log(self.high / self.low)
        else:
            share = (value - self.low) / (self.high - self.low)
        return self.begin + share * (self.end - self.begin)


def text(x, y, content, css, anchor="start"):
    return f'<text x="{x:.1f}" y="{y:.1f}" class="{css}" text-anchor="{anchor}">{html.escape(content)}</text>'


def line(x1, y1, x2, y2, css):
    return f'<line x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}" class="{css}"/>'


def frame(x_axis, y_axis, x_title, y_title, right=WIDTH - RIGHT):
    """Grid lines, tick labels and axis titles."""
    parts = []
    for tick in y_axis.ticks:
        y = y_axis.at(tick)
        parts.append(line(LEFT, y, right, y, "grid-line"))
        parts.append(text(LEFT - 6, y + 4, label(tick), "tick", "end"))
    for tick in x_axis.ticks if x_axis else []:
        parts.append(text(x_axis.at(tick), HEIGHT - BOTTOM + 16, label(tick), "tick", "middle"))
    parts.append(text((LEFT + right) / 2, HEIGHT - 6, x_title, "title", "middle"))
    parts.append(text(4, TOP - 20, y_title, "title"))
    return parts


def svg(parts, description, height=HEIGHT):
    return (f'<svg viewBox="0 -18 {WIDTH} {height + 18}" role="img" aria-label="{html.escape(description)}">'
            + "".join(parts) + "</svg>")


def whisker(x, y, low, high, css):
    """A vertical bar from low to high about a point, in pixels."""
    return line(x, low, x, high, "whisker " + css) + line(x - 3, low, x + 3, low, "whisker " + css) + (
        line(x - 3, high, x + 3, high, "whisker " + css) if high != y else "")


def line_chart(series, x_title, y_title, log=False, only_up=False):
    """series: [(name, [(x, y) or (x, y, half width), ...]), ...]; y may be None. Names stand at the lines' ends."""
    series = [(name, [(*p, None)[:3] for p in points if p[1] is not None and (not log or (p[0] > 0 and p[1] > 0))])
              for name, points in series]
    colors = [index for index, (_, points) in enumerate(series) if points]  # a name keeps its colour
    series = [(name, points) for name, points in series if points]
    if not series:
        return "<p>no data</p>"
    x_axis = Axis([p[0] for _, points in series for p in points], (LEFT, WIDTH - RIGHT), log, zero=False)
    y_axis = Axis([p[1] + (p[2] or 0.0) for _, points in series for p in points]
                  + [p[1] for _, points in series for p in points], (HEIGHT - BOTTOM, TOP), log)
    parts = frame(x_axis, y_axis, x_title, y_title)
    for index, (name, points) in zip(colors, series):
        path = " ".join(f"{x_axis.at(x):.1f},{y_axis.at(y):.1f}" for x, y, _ in points)
        parts.append(f'<polyline points="{path}" class="line c{index}"/>')
        for x, y, half in points:
            at = x_axis.at(x), y_axis.at(y)
            if half:
                low = at[1] if only_up else y_axis.at(max(y - half, y_axis.low))
                parts.append(whisker(at[0], at[1], y_axis.at(y + half), low, f"c{index}"))
            note = "" if half is None or only_up else f" ± {half:.2g}"
            parts.append(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="3" class="dot c{index}">'
                         f"<title>{html.escape(name)}: {label(x)}, {y:.4g}{note}</title></circle>")
    ends = sorted((y_axis.at(points[-1][1]), index) for index, (_, points) in enumerate(series))
    lowest = -math.inf
    for y, index in ends:  # from the top down, each below the one before
        lowest = max(y, lowest + 14)
        x = x_axis.at(series[index][1][-1][0])
        parts.append(text(x + 8, lowest + 4, series[index][0], f"name c{colors[index]}"))
    return svg(parts, f"{y_title} against {x_title}")


def scatter(points, x_title, y_title):
    """points: [(x, y, label, is_ours), ...] on a logarithmic x axis; y may be None. Ours is a square."""
    points = [p for p in points if p[0] and p[1] is not None]
    if not points:
        return "<p>no data</p>"
    x_axis = Axis([p[0] for p in points], (LEFT, WIDTH - 40), log=True)
    y_axis = Axis([p[1] for p in points], (HEIGHT - BOTTOM, TOP))
    parts = frame(x_axis, y_axis, x_title, y_title, WIDTH - 40)
    for x, y, name, is_ours in points:
        at = x_axis.at(x), y_axis.at(y)
        if is_ours:
            parts.append(f'<rect x="{at[0] - 5:.1f}" y="{at[1] - 5:.1f}" width="10" height="10" class="dot c1"/>')
        else:
            parts.append(f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="4" class="dot c0"/>')
        parts.append(text(at[0] + 8, at[1] - 5, "ours" if is_ours else name, "c1" if is_ours else "tick"))
    return svg(parts, f"{y_title} against {x_title}")


def bar_chart(bars, unit):
    """bars: [(name, value, end of the whisker or None, is_ours), ...], one row each, its value at the right."""
    bars = [bar for bar in bars if bar[1] is not None]
    if not bars:
        return "<p>no data</p>"
    begin, end, row = 250, WIDTH - 80, 24
    largest = max(max(value, whisker_end or 0.0) for _, value, whisker_end, _ in bars) or 1.0
    parts = []
    for index, (name, value, whisker_end, is_ours) in enumerate(bars):
        y = 6 + index * row
        width = max(1.0, (end - begin) * value / largest)
        far = begin + max(width, (end - begin) * (whisker_end or 0.0) / largest)
        short = name if len(name) < 35 else name[:33] + "…"
        parts.append(text(begin - 8, y + 13, short, "c1" if is_ours else "tick", "end"))
        parts.append(f'<rect x="{begin}" y="{y}" width="{width:.1f}" height="{row - 8}" rx="3" '
                     f'class="{"dot c1" if is_ours else "bar"}"/>')
        if whisker_end:
            middle = y + (row - 8) / 2
            parts.append(line(begin + width, middle, far, middle, "whisker"))
            parts.append(line(far, middle - 4, far, middle + 4, "whisker"))
        parts.append(text(far + 6, y + 13, f"{value:.3g} {unit}", "tick"))
    return svg(parts, f"bars in {unit}", 12 + len(bars) * row)


def histogram(values, cells, x_title, goal=None):
    """Share of the values per cell, from the least to the 99.5th percentile; marks the median and the goal."""
    values = sorted(v for v in values if v is not None)
    if len(values) < 2:
        return "<p>no data</p>"
    low, high = values[0], values[int(0.995 * (len(values) - 1))]
    if high <= low:
        high = low + 1.0
    counts = [0] * cells
    for value in values:
        counts[min(cells - 1, int((value - low) / (high - low) * cells))] += 1
    shares = [100.0 * c / len(values) for c in counts]
    x_axis = Axis([low, high] + ([goal] if goal else []), (LEFT, WIDTH - 40), zero=False)
    y_axis = Axis([0.0] + shares, (HEIGHT - BOTTOM, TOP))
    parts = frame(x_axis, y_axis, x_title, "share of frames, %", WIDTH - 40)
    for index, share in enumerate(shares):
        x1 = x_axis.at(low + (high - low) * index / cells)
        x2 = x_axis.at(low + (high - low) * (index + 1) / cells)
        y = y_axis.at(share)
        parts.append(f'<rect x="{x1:.1f}" y="{y:.1f}" width="{max(0.5, x2 - x1 - 0.5):.1f}" '
                     f'height="{HEIGHT - BOTTOM - y:.1f}" class="bar"/>')
    marks = [(values[len(values) // 2], "median")] + ([(goal, "goal")] if goal else [])
    for value, name in marks:
        x = x_axis.at(value)
        parts.append(line(x, TOP, x, HEIGHT - BOTTOM, "mark"))
        anchor = "end" if x > WIDTH - 120 else "start"
        parts.append(text(x + (-4 if anchor == "end" else 4), TOP + 10, f"{name} {value:.3g}", "tick", anchor))
    return svg(parts, f"histogram of {x_title}")
