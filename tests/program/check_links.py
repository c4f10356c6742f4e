#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""check_links.py DIRECTORY: every link of the documents to a file or a heading
leads there, every picture is there, and so is every file in doc/ that a source,
a scene or a script names. Each page of doc/ can be reached from README.md, but for
that of the parameters, which only an installation has."""

import pathlib
import re
import sys

LINK = re.compile(r"\]\(([^)\s]+)\)")
PAGE = re.compile(r"\bdoc/[\w./-]*\w\.(?:md|csv|gp|py|png|svg)\b")
FOLDERS = ("include", "source", "prm", "scripts", "tests", ".ci", ".github")


def prose(path):
    """The lines of a page with their numbers, without its blocks of code."""
    fenced = False
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            yield number, line


def anchors(path):
    """The names that GitHub gives the headings of a page."""
    return {re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().lower())
            .replace(" ", "-")
            for _, line in prose(path) if line.startswith("#")}


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    faults = []
    pages = [*root.glob("*.md"), *sorted((root / "doc").rglob("*.md"))]
    leads_to = {}
    for page in pages:
        leads_to[page] = set()
        for number, line in prose(page):
            for link in LINK.findall(line):
                if re.match(r"[a-z]+:", link):
                    continue
                place = f"{page.relative_to(root)}:{number}: {link}"
                name, _, anchor = link.partition("#")
                target = (page.parent / name).resolve() if name else page
                if not target.exists():
                    faults.append(f"{place}: no such file")
                elif anchor and anchor not in anchors(target):
                    faults.append(f"{place}: no such heading")
                leads_to[page].add(target)

    reached, next_pages = set(), {
        root / "README.md", root / "doc" / "reference" / "parameters.md"}
    while next_pages:
        reached |= next_pages
        next_pages = {page for known in next_pages
                      for page in leads_to.get(known, ())} - reached
    faults += [f"{page.relative_to(root)}: no link leads here"
               for page in pages if page not in reached]

    for file in (file for folder in FOLDERS for file in (root / folder).rglob("*")
                 if file.is_file() and file.suffix not in (".png", ".pyc")):
        for number, line in enumerate(
                file.read_text(errors="replace").splitlines(), 1):
            faults += [f"{file.relative_to(root)}:{number}: {name}: no such file"
                       for name in PAGE.findall(line)
                       if not (root / name).exists()]

    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
