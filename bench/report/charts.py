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
    """Powers of ten from low to high, both included."""
    return [10.0 ** e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]


def label(value):
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


def frame(x_axis, y_axis, x_title, y_title):
    """Grid lines, tick labels and axis titles."""
    parts = []
    for tick in y_axis.ticks:
        y = y_axis.at(tick)
        parts.append(line(LEFT, y, WIDTH - RIGHT, y, "grid"))
        parts.append(text(LEFT - 6, y + 4, label(tick), "tick", "end"))
    for tick in x_axis.ticks if x_axis else []:
        parts.append(text(x_axis.at(tick), HEIGHT - BOTTOM + 16, label(tick), "tick", "middle"))
    parts.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 6, x_title, "title", "middle"))
    parts.append(text(4, TOP - 20, y_title, "title"))
    return parts


def svg(parts, description, height=HEIGHT):
    return (f'<svg viewBox="0 -18 {WIDTH} {height + 18}" role="img" aria-label="{html.escape(description)}">'
            + "".join(parts) + "</svg>")


def line_chart(series, x_title, y_title, log=False):
    """series: [(name, [(x, y), ...]), ...]; y may be None. Names stand at the lines' ends."""
    series = [(name, [(x, y) for x, y in points if y is not None and (not log or (x > 0 and y > 0))])
              for name, points in series]
    series = [(name, points) for name, points in series if points]
    if not series:
        return "<p>no data</p>"
    x_axis = Axis([x for _, p in series for x, _ in p], (LEFT, WIDTH - RIGHT), log, zero=False)
    y_axis = Axis([y for _, p in series for _, y in p], (HEIGHT - BOTTOM, TOP), log)
    parts = frame(x_axis, y_axis, x_title, y_title)
    for index, (name, points) in enumerate(series):
        path = " ".join(f"{x_axis.at(x):.1f},{y_axis.at(y):.1f}" for x, y in points)
        parts.append(f'<polyline points="{path}" class="line c{index}"/>')
        for x, y in points:
            parts.append(f'<circle cx="{x_axis.at(x):.1f}" cy="{y_axis.at(y):.1f}" r="3" class="dot c{index}">'
                         f"<title>{html.escape(name)}: {label(x)}, {y:.4g}</title></circle>")
    ends = sorted((y_axis.at(points[-1][1]), index) for index, (_, points) in enumerate(series))
    lowest = -math.inf
    for y, index in ends:  # from the top down, each below the one before
        lowest = max(y, lowest + 14)
        x = x_axis.at(series[index][1][-1][0])
        parts.append(text(x + 8, lowest + 4, series[index][0], f"name c{index}"))
    return svg(parts, f"{y_title} against {x_title}")


def bar_chart(bars, unit):
    """bars: [(name, value, note), ...], one row each, longest value at the right."""
    bars = [bar for bar in bars if bar[1] is not None]
    if not bars:
        return "<p>no data</p>"
    begin, end, row = 190, WIDTH - 90, 24
    largest = max(value for _, value, _ in bars) or 1.0
    parts = []
    for index, (name, value, note) in enumerate(bars):
        y = 6 + index * row
        width = max(1.0, (end - begin) * value / largest)
        parts.append(text(begin - 8, y + 14, name, "tick", "end"))
        parts.append(f'<rect x="{begin}" y="{y}" width="{width:.1f}" height="{row - 8}" rx="3" class="bar"/>')
        parts.append(text(begin + width + 6, y + 13, f"{value:.3g} {unit} {note}".strip(), "tick"))
    return svg(parts, f"bars in {unit}", 12 + len(bars) * row)


def histogram(values, cells, x_title):
    """Share of the values per cell, from the least to the 99.5th percentile."""
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
    x_axis = Axis([low, high], (LEFT, WIDTH - RIGHT), zero=False)
    y_axis = Axis([0.0] + shares, (HEIGHT - BOTTOM, TOP))
    parts = frame(x_axis, y_axis, x_title, "share of frames, %")
    for index, share in enumerate(shares):
        x1 = x_axis.at(low + (high - low) * index / cells)
        x2 = x_axis.at(low + (high - low) * (index + 1) / cells)
        y = y_axis.at(share)
        parts.append(f'<rect x="{x1 + 0.5:.1f}" y="{y:.1f}" width="{max(0.5, x2 - x1 - 1):.1f}" '
                     f'height="{HEIGHT - BOTTOM - y:.1f}" class="bar"/>')
    median = values[len(values) // 2]
    parts.append(line(x_axis.at(median), TOP, x_axis.at(median), HEIGHT - BOTTOM, "mark"))
    parts.append(text(x_axis.at(median) + 4, TOP + 10, f"median {median:.1f}", "tick"))
    return svg(parts, f"histogram of {x_title}")
