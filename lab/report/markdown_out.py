"""The same blocks as Markdown: text, tables and commands; charts and pictures are left to the page."""

from blocks import Cell, Command, Details, Table, Text


def _text(cell):
    return str(cell.text if isinstance(cell, Cell) else cell).strip().replace("|", "\\|")


def _table(table):
    lines = ["| " + " | ".join(_text(h) for h in table.head) + " |", "| " + " | ".join("---" for _ in table.head) + " |"]
    for row in table.rows:
        cells = [f"**{_text(row.cells[0])}**"] if row.is_heading else [_text(c) for c in row.cells]
        lines.append("| " + " | ".join(cells + [""] * (len(table.head) - len(cells))) + " |")
    return "\n".join(lines)


def _block(block):
    if isinstance(block, Text):
        return block.text
    if isinstance(block, Command):
        return f"Repeat it: `{block.text}`"
    if isinstance(block, Table):
        return _table(block)
    if isinstance(block, Details):
        return "\n\n".join([f"### {block.summary}"] + [_block(b) for b in block.blocks])
    return ""


def document(title, about, sections):
    parts = [f"# {title}", about]
    for section in sections:
        blocks = [text for text in (_block(b) for b in section.blocks) if text]
        if blocks:
            parts += [f"## {section.title}"] + blocks
    return "\n\n".join(parts) + "\n"
