"""Blocks as one HTML page that loads nothing."""

import base64
import html
import os

from blocks import Cell, Charts, Command, Details, Pictures, Strip, Table, Text


def _escape(text):
    return html.escape(str(text))


def _cell(cell, tag="td"):
    cell = cell if isinstance(cell, Cell) else Cell(cell)
    css = f' class="{cell.css}"' if cell.css else ""
    return f"<{tag}{css}>{_escape(cell.text)}</{tag}>"


def _row(row, width):
    if row.is_heading:
        return f'<tr><td class="scene" colspan="{width}">{_escape(row.cells[0])}</td></tr>'
    css = f' class="{row.css}"' if row.css else ""
    return f"<tr{css}>" + "".join(_cell(c) for c in row.cells) + "</tr>"


def _image(png, alt):
    content = base64.b64encode(png).decode("ascii")
    return f'<img alt="{_escape(alt)}" src="data:image/png;base64,{content}">'


def _strip(strip):
    rows = []
    for label, pictures in strip.rows:
        images = "".join(f'<div class="cut">{_image(png, f"{strip.title}, {label}")}</div>' for png in pictures)
        rows.append(f'<div class="strip"><span>{_escape(label)}</span>{images}</div>')
    return f"<h3>{_escape(strip.title)}</h3>" + "".join(rows)


def _block(block):
    if isinstance(block, Text):
        css = ' class="note"' if block.is_note else ""
        return f"<p{css}>{_escape(block.text)}</p>"
    if isinstance(block, Command):
        return f'<p class="note">Repeat it: <code>{_escape(block.text)}</code></p>'
    if isinstance(block, Table):
        head = "".join(_cell(h, "th") for h in block.head)
        body = "".join(_row(row, len(block.head)) for row in block.rows)
        return f'<div class="scroll"><table><tr>{head}</tr>{body}</table></div>'
    if isinstance(block, Charts):
        return '<div class="grid">' + "".join(
            f'<figure><div class="chart">{svg}</div><figcaption>{_escape(caption)}</figcaption></figure>'
            for svg, caption in block.charts) + "</div>"
    if isinstance(block, Pictures):
        return '<div class="grid">' + "".join(
            f"<figure>{_image(png, caption)}<figcaption>{_escape(caption)}</figcaption></figure>"
            for png, caption in block.pictures) + "</div>"
    if isinstance(block, Strip):
        return _strip(block)
    if isinstance(block, Details):
        return (f"<details><summary>{_escape(block.summary)}</summary>"
                + "".join(_block(b) for b in block.blocks) + "</details>")
    raise TypeError(block)


def page(title, about, sections):
    with open(os.path.join(os.path.dirname(__file__), "style.css"), encoding="utf-8") as file:
        style = file.read()
    links = "".join(f'<a href="#s{i}">{_escape(s.title)}</a>' for i, s in enumerate(sections))
    body = "".join(f'<h2 id="s{i}">{_escape(s.title)}</h2>' + "".join(_block(b) for b in s.blocks)
                   for i, s in enumerate(sections))
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{_escape(title)}</title>'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{style}</style></head><body>'
            f'<h1>{_escape(title)}</h1><p class="note">{_escape(about)}</p><nav>{links}</nav>{body}</body></html>\n')
