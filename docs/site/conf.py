"""The site: every page is a file of this repository, where it lies. `make site` builds it into build/site/html.

The README is its home. The tables of docs/README.md, the map of the documentation, are its navigation. References come
from the headers, by Doxygen and Breathe, and from the docstrings of the Python package, by autodoc.
"""

import os
import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = ROOT / "build/site"
PAGE = ROOT / "web/dist"  # the page that burns a letter, where `make web` has built it

SUMMARY = "Singe burns cloth and paper: a C17 library, a command, a Python package and an npm package."
FRAME = """

<iframe src="../burn/index.html" title="A letter that burns" style="width: 100%; height: 70vh; border: 0"></iframe>

"""

project = "Singe"
author = copyright = "the Singe authors"
release = version = re.search(r'SINGE_VERSION "([^"]+)"', (ROOT / "include/singe/base.h").read_text()).group(1)
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "sphinx_copybutton"]
root_doc = "README"
include_patterns = ["README.md", "docs/**", "bindings/web/README.md"]
exclude_patterns = ["build*", "**/node_modules", "out", ".*"]
highlight_language = "none"

myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence"]

breathe_projects = {"singe": str(WORK / "doxygen/xml")}
breathe_default_project = "singe"
breathe_domain_by_extension = {"h": "c"}
breathe_show_include = False
c_id_attributes = ["SINGE_API", "SINGE_NODISCARD"]
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
python_use_unqualified_type_names = True
maximum_signature_line_length = 90
autodoc_preserve_defaults = True

html_theme = "furo"
html_title = f"Singe {version}"
html_copy_source = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_theme_options = {"light_css_variables": {"color-brand-primary": "#a63c06", "color-brand-content": "#a63c06"},
                      "dark_css_variables": {"color-brand-primary": "#ff9a52", "color-brand-content": "#ff9a52"}}

sys.path.insert(0, str(ROOT / "bindings/python"))  # its library is the one that SINGE_LIBRARY names


def navigation():
    """Toctrees of the pages that docs/README.md maps, each under the first of its headings that names it."""
    seen, lines = set(), []
    for part in re.split(r"^## ", (ROOT / "docs/README.md").read_text(), flags=re.MULTILINE)[1:]:
        caption, _, body = part.partition("\n")
        pages = [page for page in re.findall(r"\]\(([^)#]+\.md)\)", body) if not (page in seen or seen.add(page))]
        places = [str((ROOT / "docs" / page).resolve().relative_to(ROOT)) for page in pages]
        lines += ["", "```{toctree}", ":hidden:", f":caption: {caption}", "", *places, "```"]
    return "\n".join(lines)


def read_source(app, name, source):
    """Adds the navigation to the pages that are maps. Links to folders, which no page shows, become words; the headers'
    folder is the C reference. A link that names a file has the title of its page instead."""
    def folder(match):
        place = (ROOT / name).parent / match.group(2)
        if place.resolve() == ROOT / "include/singe":
            return f"[{match.group(1)}](/docs/site/c.md)"
        return match.group(1) if place.is_dir() else match.group()

    source[0] = re.sub(r"\[([^][]*)\]\(([^)#:]+)\)", folder, source[0])
    source[0] = re.sub(r"\[[\w./-]+\.md\](\([\w./-]+\.md(#[^)]*)?\))", r"[]\1", source[0])
    if name == root_doc:
        source[0] += navigation()
    if name == "docs/web" and PAGE.exists():
        source[0] = source[0].replace("\n\n", FRAME, 1)
    if name == "docs/equations/README":
        source[0] += "\n```{toctree}\n:hidden:\n:glob:\n\n[a-z]*\n```\n"


def finish(app, error):
    """The home's own address, and llms.txt: the map of the documentation for programs that read."""
    if error or app.builder.name != "html":
        return
    out = pathlib.Path(app.outdir)
    if PAGE.exists():
        shutil.copytree(PAGE, out / "burn", dirs_exist_ok=True)
    (out / "index.html").write_bytes((out / "README.html").read_bytes())
    pages = sorted(app.env.found_docs, key=lambda name: (name != root_doc, name))
    lines = [f"- [{app.env.titles[name].astext()}]({name}.html)" for name in pages]
    (out / "llms.txt").write_text("\n".join([f"# Singe {release}", "", "> " + SUMMARY, "", "## Pages", "", *lines, ""]))


def setup(app):
    app.connect("source-read", read_source)
    app.connect("build-finished", finish)
