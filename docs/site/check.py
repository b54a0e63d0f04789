#!/usr/bin/env python3
"""Follows every link of a built site: files must be there, and headings that are named.  usage: check.py FOLDER"""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    """What a page links to, and the places in it that links may name."""

    def __init__(self, text):
        super().__init__()
        self.links, self.places = set(), {""}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src", "poster") and value:
                self.links.add(value)
            if name in ("id", "name") and value:
                self.places.add(value)


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = {file: Page(file.read_text(encoding="utf-8")) for file in root.rglob("*.html")}
    bad = links = 0
    for file, page in pages.items():
        for link in sorted(page.links):
            address = urllib.parse.urlsplit(link)
            if address.scheme or address.netloc or link in ("#", "javascript:void(0)"):
                continue
            links += 1
            path = urllib.parse.unquote(address.path)
            target = (file.parent / path).resolve() if path else file
            if not target.is_file():
                print(f"{file.relative_to(root)}: there is no {link}")
                bad += 1
            elif target in pages and urllib.parse.unquote(address.fragment) not in pages[target].places:
                print(f"{file.relative_to(root)}: {path or 'the page'} has no place #{address.fragment}")
                bad += 1
    print(f"{links} links in {len(pages)} pages, {bad} bad")
    return 1 if bad or not links else 0


if __name__ == "__main__":
    sys.exit(main())
