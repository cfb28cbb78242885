#!/usr/bin/env python3
"""A public header's comments as Doxygen reads them: doxygen_filter.py HEADER

The first comment is the file's, one after code in its line belongs to that code, others to what
follows; rulers of dashes stay plain. `float *x, *y; /* ... */` becomes a line for each name, since
Doxygen gives the comment to one of them only. Lines keep their numbers.
"""

import html
import re
import sys

DECLARATION = re.compile(r"^(\s+(?:const |struct )?\w+ )(\**\w+(?:\[\w+\])?(?:, \**\w+(?:\[\w+\])?)+);$")

BEFORE = re.compile(
    r"(/\*\*(?!<)(?:(?!\*/).)*\*/)\n(\s+(?:const |struct )?\w+ )(\**\w+(?:, \**\w+)+);(?=\n)", re.S
)


def comments(text):
    """(code before it in its line, comment) of each comment, and what is left: in their order."""
    place = 0
    for found in re.finditer(r"/\*.*?\*/", text, re.S):
        yield text[place : found.start()], found.group()
        place = found.end()
    yield text[place:], ""


def dressed(comment):
    """`code` and drawings (indented lines between blank ones) as Doxygen has them."""
    comment = re.sub(r"`([^`\n]+)`", lambda m: f"<code>{html.escape(m.group(1), quote=False)}</code>", comment)
    return re.sub(
        r"\n \*\n((?: \* {4,}.*\n)+) \*\n",
        lambda m: "\n @verbatim\n" + m.group(1).replace(" *", "") + " @endverbatim\n",
        comment,
    )


def one_each(line, comment):
    """The declaration of several names as one of each, all with the comment."""
    found = DECLARATION.match(line)
    if not found:
        return line + comment
    names = found.group(2).split(", ")
    flat = re.sub(r"\s*\n\s*\*?\s*", " ", comment)  # for all but the last: lines keep their numbers
    return "".join(f"{found.group(1)}{name}; {flat} " for name in names[:-1]) + (
        f"{found.group(1)}{names[-1]}; {comment}"
    )


def shared(found):
    """A comment before a declaration of several names, for each of them."""
    comment, kind, names = found.groups()
    flat = re.sub(r"\s*\n\s*\*?\s*", " ", comment)
    each = [f"{flat}{kind.rstrip()} {name};" for name in names.split(", ")]
    return comment + "\n" * 1 + kind + names.split(", ")[0] + "; " + " ".join(each[1:])


def filtered(text):
    out, is_first = [], True
    for code, comment in comments(text):
        line = code.rsplit("\n", 1)[-1]
        comment = dressed(comment)
        if is_first and comment:
            comment = "/**" + comment[2:].replace("SPDX-License-Identifier: MIT", "@file")
            is_first = False
        elif comment and not comment.startswith("/* ---"):
            is_after = line.strip() and not line.startswith("#if")
            comment = ("/**<" if is_after else "/**") + comment[2:]
        if comment.startswith("/**<") and line.rstrip().endswith(";"):
            out.append(code[: len(code) - len(line)])
            out.append(one_each(line.rstrip(), comment))
        else:
            out.append(code + comment)
    return BEFORE.sub(shared, "".join(out))


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        sys.stdout.write(filtered(file.read()))
