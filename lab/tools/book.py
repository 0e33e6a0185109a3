"""Runs the Python of the book, of the README and of docs/python.md: the blocks of a page in one namespace, in a folder
with a copy of `specs` and the files that the page shows behind `<!-- file: NAME -->`. A block of text behind one of Python
is what that one prints; with `--update` it is written anew.

    python lab/tools/book.py [--update] [PAGE …]
    python lab/tools/book.py --links FOLDER

The second form follows the links between the pages of the built book.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shutil
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor
from html.parser import HTMLParser
from itertools import repeat
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]
PAGES = ROOT / "docs" / "book" / "src"
OTHERS = [ROOT / "README.md", ROOT / "docs" / "python.md"]
FILE = re.compile(r"^<!-- file: (\S+) -->\n```\w+\n(.*?)^```\n", re.M | re.S)
BLOCK = re.compile(r"^```python\n(.*?)^```\n(?:\n```text\n(?!\$ )(.*?)^```\n)?", re.M | re.S)


def run(page: Path, update: bool) -> int:
    """Runs the blocks of a page; the number of those that print something else."""
    text = page.read_text(encoding="utf-8")
    for name, content in FILE.findall(text):
        Path(name).write_text(content, encoding="utf-8")
    scope: dict[str, object] = {"__name__": "__book__"}
    pieces, position, wrong = [], 0, 0
    for block in BLOCK.finditer(text):
        code, expected = block.group(1), block.group(2)
        line = text.count("\n", 0, block.start(1)) + 1
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            # the places of the page in tracebacks
            exec(compile("\n" * (line - 1) + code, str(page), "exec"), scope)
        found = printed.getvalue()
        if expected is None:
            if found:
                print(f"{page}:{line}: prints what is not shown:\n{found}")
                wrong += 1
            continue
        if found.rstrip() != expected.rstrip() and not update:
            print(f"{page}:{line}: prints\n{found}instead of\n{expected}")
            wrong += 1
        pieces += [text[position : block.start(2)], found]
        position = block.end(2)
    if update:
        page.write_text("".join([*pieces, text[position:]]), encoding="utf-8")
    return wrong


def run_apart(page: Path, update: bool) -> int:
    """`run` in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(ROOT / "specs", Path(folder) / "specs")
        os.chdir(folder)
        try:
            return run(page, update)
        finally:
            os.chdir(ROOT)


class Page(HTMLParser):
    """The links and the anchors of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value and name == "id":
                self.anchors.add(value)
            elif value and name in ("href", "src") and tag in ("a", "img", "link", "script"):
                self.links.append(value)


def follow_links(folder: Path) -> None:
    """Fails where a link of the built book leads nowhere within it."""
    # the page for missing pages is relative to the root of a server
    pages = {path: Page(path) for path in sorted(folder.rglob("*.html")) if path.name != "404.html"}
    count = wrong = 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            found = target.exists()
            if found and parts.fragment and target in pages:
                found = unquote(parts.fragment) in pages[target].anchors
            count += 1
            if not found:
                print(f"{path}: {link} leads nowhere")
                wrong += 1
    print(f"{count} links in {len(pages)} pages, {wrong} wrong")
    if wrong or count < 100:
        raise SystemExit(1)


def main() -> None:
    if sys.argv[1:2] == ["--links"]:
        follow_links(Path(sys.argv[2]).resolve())
        return
    os.environ["MPLBACKEND"] = "Agg"
    names = [name for name in sys.argv[1:] if name != "--update"]
    book = sorted(PAGES.rglob("*.md"))
    if not book:
        raise SystemExit(f"no pages in {PAGES}")
    pages = [PAGES / name for name in names] or [*OTHERS, *book]
    pages = [page.resolve() for page in pages]
    counts = [len(BLOCK.findall(page.read_text(encoding="utf-8"))) for page in pages]
    with_blocks = [page for page, count in zip(pages, counts) if count]
    with ProcessPoolExecutor() as pool:
        wrong = sum(pool.map(run_apart, with_blocks, repeat("--update" in sys.argv)))
    blocks = sum(counts)
    print(f"{blocks} blocks of Python, {wrong} wrong")
    if wrong or not blocks:
        raise SystemExit(1)


if __name__ == "__main__":
    main()
