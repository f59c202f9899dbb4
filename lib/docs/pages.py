# Copyright 2026 The gltf-mcc authors. SPDX-License-Identifier: Apache-2.0
"""pages.py TREE FOLDER: collects the source of the site that tools/docs makes.

FOLDER gets the Markdown files of TREE under their names, README.md as index.md, with the pictures and files that they link to, and one
page for each header and each module of JavaScript. Links to folders lead to their README.md; where there is none, the text stays.
"""
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path, PurePosixPath

LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
CODE = re.compile(r"(^```[\s\S]*?^```|^(?:    .*\n)+)", re.MULTILINE)

# What the side bar lists, with titles where those of the pages are not enough; every other page follows under "More".
SECTIONS = {
    "Use": ["docs/cli.md", "docs/loaders.md", "JavaScript <lib/web/README.md>", "Python <lib/python/README.md>", "Blender <lib/blender/README.md>",
            "samples/README.md"],
    "Sizes and times": ["docs/benchmarks.md", "docs/web.md", "docs/tilesets.md", "docs/format-choices.md"],
    "Format": ["The extension <extension-spec/KHR_mesh_collapse_compression/README.md>",
               "The bitstream <extension-spec/KHR_mesh_collapse_compression/bitstream.md>",
               "The methods <extension-spec/KHR_mesh_collapse_compression/methods.md>", "extension-spec/reference/README.md",
               "tests/conformance/README.md", "docs/adoption/README.md"],
    "Reference": ["lib/docs/main.md"],
    "Change it": ["docs/architecture.md", "docs/performance.md", "CONTRIBUTING.md", "CHANGELOG.md"],
}


def page_name(name):
    """The name of a page in the site."""
    return "index.md" if name == "README.md" else name


def entry(page):
    """A line of a table of contents."""
    return page.replace("<", "</") if "<" in page else f"/{page}"


def with_one_title(parts):
    """Makes sections of all headings of the first level but the first, which Sphinx would take for titles of the page."""
    count = 0

    def heading(match):
        nonlocal count
        count += 1
        return "# " if count == 1 else "## "

    return [re.sub(r"^# ", heading, part, flags=re.MULTILINE) for part in parts]


class Site:
    def __init__(self, tree, folder):
        self.tree = Path(tree)
        self.folder = Path(folder)
        listed = subprocess.run(["git", "ls-files", "*.md"], cwd=tree, check=True, capture_output=True, text=True)
        self.pages = listed.stdout.split()

    def page_of(self, target):
        """The page that a path of the tree stands for, or None."""
        if target in self.pages:
            return target
        readme = str(PurePosixPath(target) / "README.md").removeprefix("./")
        return readme if readme in self.pages else None

    def link(self, name, match):
        """What a link of the page `name` becomes."""
        mark, text, link = match.groups()
        if re.match(r"[a-z]+:", link):
            return match.group()
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(name), path)) if path else name
        page = self.page_of(target)
        here = os.path.dirname(page_name(name))
        if page is not None:
            to = os.path.relpath(page_name(page), here or ".")
            # Sphinx knows the anchors of headings alone.
            if anchor and f'<a id="{anchor}"' in (self.tree / page).read_text():
                return f'<a href="{to.removesuffix(".md")}.html#{anchor}">{text}</a>'
            return f"{mark}[{text}]({to}{'#' if anchor else ''}{anchor})"
        if not (self.tree / target).is_file():
            return text
        copy = self.folder / target
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.tree / target, copy)
        return f"{mark}[{text}]({os.path.relpath(target, here or '.')})"

    def write_page(self, name):
        text = (self.tree / name).read_text()
        parts = CODE.split(text)  # every other one is code
        parts[::2] = with_one_title([LINK.sub(lambda match: self.link(name, match), part) for part in parts[::2]])
        self.write(page_name(name), "".join(parts) + (self.contents() if name == "README.md" else ""))

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def contents(self):
        reference = [f"reference/{path.name}.md" for path in self.headers()] + ["reference/python.md"]
        reference += sorted(str(path.relative_to(self.folder)) for path in self.folder.glob("reference/web/*.md"))
        sections = {**SECTIONS, "Reference": SECTIONS["Reference"] + reference}
        known = {re.sub(r".*<(.*)>", r"\1", page) for pages in sections.values() for page in pages}
        sections["More"] = [page for page in self.pages if page not in known and page != "README.md"]
        return "".join(f"\n```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "".join(f"{entry(page)}\n" for page in pages) + "```\n"
                       for title, pages in sections.items())

    def import_name(self, types):
        """What programs import to have the declarations of a file; the file itself where another one exports them."""
        exports = json.loads((self.tree / "lib/web/package.json").read_text())["exports"]
        names = [path for path, files in exports.items() if isinstance(files, dict) and files.get("types") == f"./{types}"]
        return f"gltf-mcc{names[0][1:]}" if names else types

    def headers(self):
        return sorted((self.tree / "lib/include/mcc").glob("*.h"))

    def write_reference(self):
        for path in self.headers():
            self.write(f"reference/{path.name}.md", f"# `mcc/{path.name}`\n\n```{{doxygenfile}} {path.name}\n```\n")
        for path in sorted((self.tree / "lib/web").glob("*.d.mts")):
            name = self.import_name(path.name)
            code = re.sub(r"\A(//.*\n)+", "", path.read_text())  # without the licence
            self.write(f"reference/web/{path.name.removesuffix('.d.mts')}.md", f"# `{name}` (JavaScript)\n\n```typescript\n{code}```\n")
        self.write("reference/python.md", "# `gltf_mcc` (Python)\n\n```{automodule} gltf_mcc\n:members:\n:imported-members:\n```\n")

    def write_all(self):
        self.write_reference()
        for name in self.pages:
            self.write_page(name)


if __name__ == "__main__":
    Site(*sys.argv[1:]).write_all()
