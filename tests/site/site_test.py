"""Tests the documentation site: that it can be made, that every link in it leads somewhere, and that it can be searched.

Usage: site_test.py PROGRAM SOURCE_DIR [CLASS...]

It is skipped without mkdocs-material; the exit code is then 77.
"""

import html.parser
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from urllib.parse import unquote, urlsplit

PROGRAM, SOURCE = sys.argv[1], Path(sys.argv[2])
PYTHON = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "fovea-python/bin/python"
if not PYTHON.is_file() or subprocess.run([PYTHON, "-c", "import material"], capture_output=True).returncode != 0:
    print("skipped: there is no mkdocs-material; samples/setup.sh installs it")
    sys.exit(77)


class Page(html.parser.HTMLParser):
    """The links of a page, and what can be linked to in it."""

    def __init__(self, file):
        super().__init__()
        self.links, self.anchors = [], {""}
        self.feed(file.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value is not None:
                self.links.append(value)
            if name in ("id", "name") and value:
                self.anchors.add(value)


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.made = subprocess.run([PYTHON, SOURCE / "samples/site/make_site.py", PROGRAM, cls.folder.name],
                                 capture_output=True, text=True)
        cls.html = Path(cls.folder.name) / "html"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_is_made_without_a_warning(self):
        self.assertEqual((self.made.returncode, self.made.stderr), (0, ""), self.made.stdout)

    def test_every_link_leads_somewhere(self):
        pages = {file: Page(file) for file in self.html.rglob("*.html") if file.name != "404.html"}
        self.assertGreater(len(pages), 30)
        broken = []
        for file, page in pages.items():
            for link in page.links:
                parts = urlsplit(link)
                if parts.scheme or parts.netloc:
                    continue
                target = (file.parent / unquote(parts.path)).resolve() if parts.path else file
                if target.is_dir():
                    target = target / "index.html"
                if not target.is_file() or (target in pages and unquote(parts.fragment) not in pages[target].anchors):
                    broken.append(f"{file.relative_to(self.html)}: {link}")
        self.assertEqual(broken, [])

    def test_it_needs_no_other_host(self):
        hosts = {urlsplit(link).netloc for file in self.html.rglob("*.html") for link in Page(file).links
                 if link.endswith((".js", ".css", ".woff2", ".png"))}
        self.assertEqual(hosts, {""})

    def test_passes_graphs_and_shader_functions_are_found(self):
        entries = json.loads((self.html / "search/search_index.json").read_text(encoding="utf-8"))["docs"]
        titles = {entry["title"] for entry in entries}
        for title in ("vpl-intensity-importance-area", "foveal", "ours", "atrium", "How many virtual point lights does a picture need?"):
            self.assertIn(title, titles)
        self.assertTrue(any("octahedral" in entry["text"] and entry["location"].startswith("shaders/") for entry in entries))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
