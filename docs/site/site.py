#!/usr/bin/env python3
"""Makes the guides, the examples and the start page, and joins them with Doxygen's reference.

site.py ROOT OUT: OUT/reference and OUT/tags.xml are Doxygen's. Everything is relative, so that the
site works from a folder. Ends with 1, and a line for each, when an internal link leads nowhere.
"""

import html
import html.parser
import json
import os
import re
import shutil
import sys
import urllib.parse
import xml.etree.ElementTree

import markdown

GROUPS = (
    ("Begin", ("README.md", "docs/camera-to-cube.md", "docs/guide.md", "docs/python_tour.md", "docs/coming-from.md",
               "docs/troubleshooting.md")),
    ("Use", ("docs/cameras.md", "docs/calibration.md", "docs/scenes.md", "docs/hands.md", "docs/events.md", "docs/ros2.md", "docs/several-cameras.md", "docs/moving-camera.md",
             "docs/window.md", "docs/python.md", "docs/web.md", "docs/library.md",
             "examples/README.md")),
    ("Know", ("docs/conventions.md", "docs/glossary.md", "docs/formats.md", "docs/limits.md", "docs/architecture.md", "docs/dependencies.md",
              "lab/measuring.md", "lab/results.md", "lab/experiments.md", "docs/thesis.md",
              "CONTRIBUTING.md", "CHANGELOG.md")),
)  # fmt: skip


def slug(text, separator="-"):
    """A heading's anchor, as GitHub makes it."""
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", separator)


def page_name(path):
    """Where a source file's page is, relative to the site: docs/x.md is x.html."""
    if path.endswith(".md"):
        name = path[5:] if path.startswith("docs/") else path
        return {"README.md": "readme.html"}.get(name, name.lower()[:-3] + ".html")
    header = re.fullmatch(r"include/relief/(\w+)\.h", path)
    if header:
        return f"reference/{header.group(1).replace('_', '__')}_8h.html"
    if path == "include/relief":
        return "reference/files.html"
    return path + ".html" if re.search(r"\.(c|py|h)$", path) else path


class Site:
    def __init__(self, root, out):
        self.root, self.out = root, out
        self.index, self.copied = [], set()

    def write(self, name, title, body):
        up = "../" * name.count("/")
        text = (
            f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)} - Relief</title>'
            f'<meta name="viewport" content="width=device-width"><link rel="stylesheet" href="{up}site.css"></head>'
            f"<body>{self.bar(up)}<main>{body}</main>{self.script(up)}</body></html>\n"
        )
        path = os.path.join(self.out, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)

    @staticmethod
    def bar(up):
        return (
            f'<nav class="site"><a href="{up}index.html"><b>Relief</b></a><a href="{up}guide.html">Guide</a>'
            f'<a href="{up}examples/readme.html">Examples</a><a href="{up}python.html">Python</a>'
            f'<a href="{up}reference/files.html">Reference</a>'
            '<input id="search" type="search" placeholder="search" aria-label="search"><div id="found"></div></nav>'
        )

    @staticmethod
    def script(up):
        return f'<script src="{up}index.js"></script><script src="{up}search.js" data-root="{up}"></script>'

    def target(self, source, link):
        """A link of a source file as one of its page; what it leads to becomes part of the site."""
        if re.match(r"(https?|mailto):", link) or link.startswith("#"):
            return link
        link, _, anchor = link.partition("#")
        path = os.path.normpath(os.path.join(os.path.dirname(source), link))
        full = os.path.join(self.root, path)
        if path.startswith("..") or not os.path.exists(full):
            return link  # the check below tells
        name = page_name(path)
        if os.path.isdir(full) and path != "include/relief":
            name = self.folder(path)
        elif not path.endswith(".md") and not name.startswith("reference/"):
            self.copy(path, name)
        up = os.path.relpath(name, os.path.dirname(page_name(source)) or ".")
        return up + ("#" + anchor if anchor else "")

    def folder(self, path):
        name = path + "/index.html"
        if name not in self.copied:
            self.copied.add(name)
            inside = "".join(f"<li>{html.escape(entry)}</li>" for entry in sorted(os.listdir(os.path.join(self.root, path))))
            self.write(name, path, f"<h1>{path}</h1><ul>{inside}</ul>")
        return name

    def copy(self, path, name):
        """A picture or data as it is, a program as a page."""
        if name in self.copied:
            return
        self.copied.add(name)
        full = os.path.join(self.root, path)
        if name != path:
            with open(full, encoding="utf-8") as file:
                text = file.read()
            self.write(name, path, f"<h1>{path}</h1><pre><code>{html.escape(text)}</code></pre>")
            self.index.append((os.path.basename(path), path, name, text[:600]))
            return
        os.makedirs(os.path.dirname(os.path.join(self.out, name)) or ".", exist_ok=True)
        shutil.copyfile(full, os.path.join(self.out, name))

    def guide(self, source):
        """The page of a Markdown file; gives its title and its first sentence."""
        with open(os.path.join(self.root, source), encoding="utf-8") as file:
            text = file.read()
        maker = markdown.Markdown(extensions=["tables", "fenced_code", "sane_lists", "toc"],
                                  extension_configs={"toc": {"slugify": slug}})  # fmt: skip
        body = maker.convert(re.sub(r"^(\s*)([*-]|\d\.) (.*)\n  (?! *[*-] )", r"\1\2 \3 ", text, flags=re.M))
        body = re.sub(r'(href|src)="([^"]+)"',
                      lambda m: f'{m.group(1)}="{self.target(source, html.unescape(m.group(2)))}"', body)  # fmt: skip
        words = re.sub(r"<[^>]+>", " ", body)
        heading = re.search(r"^# (.+)$", text, re.M)
        title = heading.group(1) if heading else source
        name = page_name(source)
        self.write(name, title, body)
        self.index.append((title, source, name, " ".join(words.split())[:4000]))
        for level, anchor, section in re.findall(r'<h([23]) id="([^"]+)">(.*?)</h', body):
            self.index.append((re.sub(r"<[^>]+>", "", section), title, f"{name}#{anchor}", ""))
        first = re.search(r"<p>(?!<img|<a[^>]*><img)(.*?)</p>", body, re.S)
        lead = re.sub(r"<[^>]+>", "", first.group(1)) if first else ""
        return title, re.split(r"(?<=\.)\s", lead.strip())[0]

    def reference(self):
        """Doxygen's pages get the bar and the search; its names go into the index."""
        folder = os.path.join(self.out, "reference")
        for entry in os.listdir(folder):
            if entry.endswith(".html"):
                path = os.path.join(folder, entry)
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                text = re.sub(r"(<body[^>]*>)", lambda m: m.group(1) + self.bar("../"), text, count=1)
                text = text.replace("</head>", '<link rel="stylesheet" href="../site.css"></head>', 1)
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text.replace("</body>", self.script("../") + "</body>", 1))
        for compound in xml.etree.ElementTree.parse(os.path.join(self.out, "tags.xml")).getroot():
            if compound.get("kind") == "struct":
                self.index.append((compound.findtext("name"), "struct", "reference/" + compound.findtext("filename"), ""))
            for member in compound.findall("member"):
                where = f"{member.get('kind')}, {compound.findtext('name')}"
                place = f"reference/{member.findtext('anchorfile')}#{member.findtext('anchor')}"
                if compound.get("kind") == "file" or member.get("kind") == "enumvalue":
                    self.index.append((member.findtext("name"), where, place, member.findtext("arglist") or ""))

    def start(self, leads):
        out = ["<h1>Relief</h1><p>Virtual things touch the real world that a depth camera sees: a C library, a command, a "
               'window and a Python module. Start with the <a href="readme.html">overview</a>, look up a name in the '
               '<a href="reference/files.html">reference</a>, or type into the search box.</p>']  # fmt: skip
        for group, sources in GROUPS:
            cards = "".join(
                f'<a href="{page_name(s)}"><b>{html.escape(leads[s][0])}</b><small>{leads[s][1]}</small></a>'
                for s in sources if s in leads)  # fmt: skip
            out.append(f'<h2>{group}</h2><div class="cards">{cards}</div>')
        self.write("index.html", "Start", "".join(out))


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.links, self.anchors = [], set()

    def handle_starttag(self, tag, attrs):
        for key, value in attrs:
            if key in ("id", "name") and value:
                self.anchors.add(value)
            if key in ("href", "src") and value and not re.match(r"(https?|mailto|data|javascript):", value):
                self.links.append(value)


def check(out):
    """Lines for links that lead nowhere, and how many there are."""
    pages = {}
    for folder, _, names in os.walk(out):
        for name in names:
            if name.endswith(".html"):
                path = os.path.join(folder, name)
                pages[path] = Links()
                with open(path, encoding="utf-8") as file:
                    pages[path].feed(file.read())
    wrong, count = [], 0
    for path, page in pages.items():
        for link in page.links:
            count += 1
            place, _, anchor = link.partition("#")
            place = urllib.parse.unquote(place)
            target = os.path.normpath(os.path.join(os.path.dirname(path), place)) if place else path
            is_there = os.path.isfile(target) and not place.startswith("/")
            if not is_there or (anchor and target in pages and urllib.parse.unquote(anchor) not in pages[target].anchors):
                wrong.append(f"{os.path.relpath(path, out)}: {link} leads nowhere")
    return sorted(set(wrong)), len(pages), count


def main():
    root, out = (os.path.abspath(path) for path in sys.argv[1:3])
    site = Site(root, out)
    listed = [source for _, sources in GROUPS for source in sources]
    present = [f"docs/{name}" for name in sorted(os.listdir(os.path.join(root, "docs"))) if name.endswith(".md")]
    wrong = [f"{source}: no place in GROUPS of docs/site/site.py" for source in present if source not in listed]
    leads = {source: site.guide(source) for source in listed if os.path.exists(os.path.join(root, source))}
    site.guide("clips/table/README.md")
    site.guide("clips/desk/README.md")
    site.reference()
    site.start(leads)
    here = os.path.dirname(os.path.abspath(__file__))
    for name in ("site.css", "search.js"):
        shutil.copyfile(os.path.join(here, name), os.path.join(out, name))
    with open(os.path.join(out, "index.js"), "w", encoding="utf-8") as file:
        file.write("var pages = " + json.dumps(site.index) + ";\n")
    broken, pages, links = check(out)
    for line in wrong + broken:
        print(line, file=sys.stderr)
    print(f"docs: {pages} pages, {links} links, {len(site.index)} entries of the search")
    return 1 if wrong or broken else 0


if __name__ == "__main__":
    sys.exit(main())
