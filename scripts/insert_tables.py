#!/usr/bin/env python3
"""Puts measured tables into a page of documentation.

The page has places for them, each between two lines:

    <!-- table eight/tables.md: one-pass evaluation -->
    <!-- end -->

What stands between is replaced by the section of the file (below the given directory) whose title begins so, with the line that
says what made it, and the commit. A place whose file is not there stays as it is, which is said.
"""
import argparse
import pathlib
import re
import subprocess
import sys

PLACE = re.compile(r"(<!-- table (\S+): ([^>]+?) -->\n).*?(<!-- end -->)", re.DOTALL)


def section(path, title):
    """The line that says what made a file, and its section whose title begins so."""
    made, *sections = re.split(r"^## ", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    for text in sections:
        heading, _, body = text.partition("\n")
        if heading.lower().startswith(title.lower()):
            return made.strip(), body.strip()
    sys.exit(f"insert_tables: {path}: no section that begins with {title!r}")


def commit():
    """The commit that is checked out; "+" behind it when sources differ from it."""
    def told(*words):
        return subprocess.run(["git", *words], capture_output=True, text=True).stdout.strip()

    return (told("rev-parse", "--short", "HEAD") or "unknown") + ("+" if told("status", "--porcelain", "src") else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("directory", type=pathlib.Path, help="where the files with the tables lie")
    arguments = parser.parse_args()
    made_at = commit()
    left = []

    def filled(match):
        opening, name, title, closing = match.groups()
        path = arguments.directory / name
        if not path.is_file():
            left.append(f"{path}: not there, its table stays as it was")
            return match[0]
        made, table = section(path, title)
        return f"{opening}\n{table}\n\n{made} Commit {made_at}.\n\n{closing}"

    text = PLACE.sub(filled, arguments.page.read_text(encoding="utf-8"))
    beside = arguments.page.with_name(arguments.page.name + ".new")
    beside.write_text(text, encoding="utf-8")
    beside.replace(arguments.page)
    print("\n".join([*left, f"written: {arguments.page}"]))


if __name__ == "__main__":
    main()
