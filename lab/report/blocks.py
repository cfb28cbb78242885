"""What a report is made of. Each writer (HTML, Markdown) shows the kinds of block that it can."""

from dataclasses import dataclass, field


@dataclass
class Cell:
    """Text in a table; css names its look: met, near, short, text."""
    text: str
    css: str = ""


@dataclass
class Row:
    """One row; a heading spans the table with its only cell."""
    cells: list
    is_heading: bool = False
    css: str = ""


@dataclass
class Table:
    head: list
    rows: list


@dataclass
class Text:
    text: str
    is_note: bool = False


@dataclass
class Command:
    """How to repeat what stands above it."""
    text: str


@dataclass
class Charts:
    """SVG texts with captions."""
    charts: list


@dataclass
class Pictures:
    """Pairs of PNG bytes and caption."""
    pictures: list


@dataclass
class Strip:
    """A title and rows of a label and PNG bytes."""
    title: str
    rows: list


@dataclass
class Details:
    """Blocks that are folded away."""
    summary: str
    blocks: list


@dataclass
class Section:
    title: str
    blocks: list = field(default_factory=list)
