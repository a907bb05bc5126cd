#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Files that the documentation names ("docs/query.md", "tools/setup.sh"): whether they exist, and links to them in the site.

Usage: doc_links.py   prints each name that stands for nothing, and fails if there is one. mkdocs.yml uses it as a hook.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TOP_PAGES = {"README.md": "index.md", "ARCHITECTURE.md": "architecture.md", "CONTRIBUTING.md": "contributing.md",
             "CHANGELOG.md": "changelog.md", "SECURITY.md": "security-policy.md"}  # fmt: skip
FOLDERS = "docs|tools|src|apps|tests|python|examples|bench|fuzz|viewer|cmake"
# A path into the repository, in prose, code or a link; not one of another project or of a build.
NAME = re.compile(rf"(?<![\w./-])((?:{FOLDERS})/[\w./-]*\w|(?:{'|'.join(TOP_PAGES)}))")
LINK = re.compile(r"\[[^\]]*\]\(([^)#\s]+)[^)]*\)")


def pages():
    return [*(ROOT / name for name in TOP_PAGES), *sorted((ROOT / "docs").glob("*.md"))]


def is_there(name):
    """Also several files that are named by how they begin."""
    path = ROOT / name
    return path.exists() or ("." not in path.name and any(path.parent.glob(path.name + "*")))


def dead_names(page):
    text = page.read_text()
    dead = [name for name in NAME.findall(text) if not is_there(name)]
    return dead + [link for link in LINK.findall(text) if "://" not in link and not (page.parent / link).exists()]


def site_address(name):
    if name in TOP_PAGES:
        return TOP_PAGES[name]
    return name.removeprefix("docs/") if name.startswith("docs/") and name.endswith(".md") else None


def linked(line):
    """The line with links where it names pages of the documentation."""

    def link(match):
        address = site_address(match[1])
        return f"[{match[1]}]({address})" if address else match[1]

    return line if line.startswith("    ") or "](" in line else NAME.sub(link, line.replace("`docs/", "docs/").replace(".md`", ".md"))


def on_files(files, config):
    """Of mkdocs: pages of the root are part of the site."""
    from mkdocs.structure.files import File

    for name, address in TOP_PAGES.items():
        files.append(File.generated(config, address, content=(ROOT / name).read_text().replace("(docs/", "(")))
    return files


def on_page_markdown(markdown, **_):
    """Of mkdocs: names of pages become links."""
    fenced, lines = False, []
    for line in markdown.splitlines():
        fenced ^= line.startswith("```")
        lines.append(line if fenced else linked(line))
    return "\n".join(lines)


def main():
    dead = [f"{page.relative_to(ROOT)}: there is no '{name}'" for page in pages() for name in dead_names(page)]
    print("\n".join(dead) or "every file that the documentation names exists")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
