#!/usr/bin/env python3
"""Makes docs/python_tour.md of tour.py: python3 python/examples/page.py [FOLDER]

The cells of tour.py (`# %%`) run one after the other; what each prints stands below it. The page
goes to FOLDER (default: docs) and its picture to FOLDER/pictures.
"""

import contextlib
import io
import os
import shutil
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
DOCS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "docs")


def cells(text):
    """(is_markdown, lines) of each cell."""
    for part in text.split("# %%")[1:]:
        head, body = part.split("\n", 1)
        yield head.strip() == "[markdown]", body.strip("\n").splitlines()


def page_of(path):
    out = [f"<!-- made by python/examples/page.py of {os.path.basename(path)} -->"]
    names = {"__name__": "__main__"}
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for is_markdown, lines in cells(text):
        if is_markdown:
            out += ["", *(line[2:] for line in lines)]
            continue
        out += ["", "```python", *lines, "```"]
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile("\n".join(lines), path, "exec"), names)
        if printed.getvalue():
            out += ["", "```text", *printed.getvalue().splitlines(), "```"]
    return "\n".join(out) + "\n"


def main():
    folder = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else DOCS)
    with tempfile.TemporaryDirectory() as scratch:
        before = os.getcwd()
        os.chdir(scratch)
        try:
            page = page_of(os.path.join(HERE, "tour.py"))
        finally:
            os.chdir(before)
        os.makedirs(os.path.join(folder, "pictures"), exist_ok=True)
        shutil.copy(os.path.join(scratch, "python_tour.png"), os.path.join(folder, "pictures"))
    with open(os.path.join(folder, "python_tour.md"), "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
