#!/usr/bin/env python3
"""Makes the documentation site: static pages with search, from the READMEs of the project and from what the program says.

Usage: make_site.py PROGRAM FOLDER [--pictures]

PROGRAM is the built `fovea`. FOLDER gets the site, in html/, and what it is made of. With --pictures, which takes minutes,
every graph and every scene is rendered for the galleries, and the samples for Python run; otherwise those pages have texts
alone. Needs mkdocs-material of the Python package index, which samples/setup.sh installs, and the module `fovea` for the
samples. Links are checked: a broken one ends this with exit code 1.
"""

import argparse
import itertools
import json
import os
import re
import shutil
import subprocess
import sys
from html import escape
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parent.parent
LINK = re.compile(r"(\]\()([^)\s#]+)")
PICTURE = re.compile(r'(<img src=")([^"]+)')


class Site:
    def __init__(self, program, folder, pictures):
        self.program = Path(program).resolve()
        self.folder = Path(folder).resolve()
        self.pages = self.folder / "pages"
        self.pictures = pictures

    def make(self):
        if self.pages.exists():
            shutil.rmtree(self.pages)
        for page in tracked("*.md"):
            self.copy_page(page)
        self.write("passes", passes_page(self.ask("passes", "--json")))
        self.write("graphs", self.graphs_page())
        self.write("scenes", self.scenes_page())
        self.write("notebooks", self.notebooks_page())
        config = self.folder / "mkdocs.yml"
        config.write_text((HERE / "mkdocs.yml").read_text(encoding="utf-8"), encoding="utf-8")
        command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-f", config, "-d", self.folder / "html"]
        return subprocess.run(command, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}).returncode

    def ask(self, *arguments):
        run = subprocess.run([self.program, *arguments], cwd=TOP, check=True, capture_output=True, text=True)
        return json.loads(run.stdout)

    def write(self, name, text):
        (self.pages / "site").mkdir(parents=True, exist_ok=True)
        (self.pages / "site" / name).with_suffix(".md").write_text(text, encoding="utf-8")

    def copy_page(self, page):
        """Keeps the place of a page in the tree, and what it links to comes along, so that links stay as they are."""
        text = (TOP / page).read_text(encoding="utf-8")
        text = re.sub(r"<(table|tr|td)>", r"<\1 markdown>", text)  # markdown within goes on being markdown
        place = self.pages / page
        place.parent.mkdir(parents=True, exist_ok=True)
        for pattern in (LINK, PICTURE):
            text = pattern.sub(lambda match: match[1] + self.follow(page, match[2]), text)
        place.write_text(text, encoding="utf-8")

    def follow(self, page, link):
        if re.match(r"[a-z]+:", link) or link.endswith(".md"):
            return link
        target = ((TOP / page).parent / link).resolve()
        if target.is_dir():
            self.copy_folder(target)
            return link.rstrip("/") + "/README.md"
        if target.is_file():
            self.copy_file(target)
        return link

    def copy_file(self, file):
        copied = self.pages / file.relative_to(TOP)
        copied.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copied)

    def copy_folder(self, folder):
        """A folder without a page of its own gets a list of its files."""
        place = folder.relative_to(TOP)
        if (folder / "README.md").is_file():
            return
        files = [TOP / name for name in tracked(f"{place}/*") if (TOP / name).parent == folder]
        for file in files:
            self.copy_file(file)
        (self.pages / place).mkdir(parents=True, exist_ok=True)
        listed = "".join(f"- [{file.name}]({file.name})\n" for file in files)
        (self.pages / place / "README.md").write_text(f"# {place}\n\n{listed}", encoding="utf-8")

    def render(self, name, size, *arguments):
        """The HTML of a picture that `fovea render` makes, or of none."""
        if not self.pictures:
            return ""
        file = self.pages / "site/pictures" / (name.replace("/", "-") + ".png")
        file.parent.mkdir(parents=True, exist_ok=True)
        print("rendering", name, flush=True)
        subprocess.run([self.program, "render", *arguments, "--size", size, "--quiet", "-o", file], cwd=TOP, check=True)
        return f"![{name}](pictures/{file.name})\n\n"

    def graphs_page(self):
        text = "# Every graph\n\nThe pictures show the scene `cornellbox_moving` after 4 frames.\n\n"
        for graph in self.ask("graphs", "--json"):
            name = graph["name"]
            short = ["--set", "spp=256", "--frames", "1"] if name in ("reference", "alternatives/reference_stereo") else ["--warmup", "4", "--frames", "1"]
            text += f"## {name}\n\n{graph['description']}.\n\n"
            text += self.render(name, "256x256", name, "--scene", "cornellbox_moving", *short)
            text += f"`fovea describe {name}` tells its parameters, passes and memory.\n\n"
        return text

    def scenes_page(self):
        text = "# Every scene\n\nThe pictures are those of the graph `foveal` after 8 frames.\n\n"
        for name in sorted(path.stem for path in (TOP / "samples/scenes").rglob("*.json")):
            info = self.ask("scene", "info", name, "--json")
            text += f"## {name}\n\n{info['triangles']:,} triangles, {len(info['lights'])} lights.\n\n"
            text += self.render(name, "384x216", "foveal", "--scene", name, "--warmup", "8", "--frames", "1")
        return text

    def notebooks_page(self):
        text = "# Every notebook\n\nThese are the samples for Python, cell by cell, with what they print and write.\n\n"
        for sample in sorted((TOP / "samples/python").glob("*.py")):
            text += notebook(sample.read_text(encoding="utf-8")) + self.run(sample)
        return text

    def run(self, sample):
        """What a sample prints, and the pictures that it writes; or which package it lacks."""
        if not self.pictures:
            return ""
        print("running", sample.name, flush=True)
        folder = self.pages / "site/pictures" / sample.stem
        folder.mkdir(parents=True)
        run = subprocess.run([sys.executable, sample], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if run.returncode != 0:
            last = run.stderr.strip().splitlines()[-1]
            if not last.startswith("ModuleNotFoundError"):
                raise SystemExit(run.stderr)
            print(f"{sample.name}: {last}", file=sys.stderr)
            return f"It was not run: {last.partition(': ')[2]}.\n\n"
        shown = "".join(f"![{file.name}](pictures/{sample.stem}/{file.name})\n\n" for file in sorted(folder.iterdir()))
        return f"```text\n{run.stdout}```\n\n{shown}"


def notebook(source):
    """The cells of a script in Markdown: text as it is, one heading below that of the page, and code with its title."""
    text = ""
    for cell in re.split(r"^# %%", source, flags=re.M)[1:]:
        title, _, rest = cell.partition("\n")
        lines = rest.splitlines()
        if title.strip() == "[markdown]":
            lines = [line.removeprefix("#").strip() for line in lines]
            text += "\n".join("#" + line if line.startswith("# ") else line for line in lines) + "\n\n"
            continue
        comment = list(itertools.takewhile(lambda line: line.startswith("# "), lines))  # where the title goes on
        code = "\n".join(lines[len(comment):]).strip()
        text += " ".join([title.strip(), *(line[2:] for line in comment)]) + f"\n\n```python\n{code}\n```\n\n"
    return text


def tracked(pattern):
    return subprocess.run(["git", "ls-files", pattern], cwd=TOP, check=True, capture_output=True, text=True).stdout.split()


def table(title, rows, *head):
    """A heading and a table in Markdown; nothing without rows."""
    if not rows:
        return ""
    lines = ["| " + " | ".join(escape(str(cell), quote=False).replace("|", "\\|") for cell in row) + " |" for row in rows]
    return f"**{title}**\n\n| {' | '.join(head)} |\n|{'---|' * len(head)}\n" + "\n".join(lines) + "\n\n"


def passes_page(passes):
    text = "# Every pass\n\nWhat `fovea passes NAME` says of each.\n\n"
    for one in passes:
        text += f"## {one['name']}\n\n{escape(one['doc'][0].upper() + one['doc'][1:], quote=False)}.\n\n"
        for direction, title in (("in", "Inputs"), ("inout", "Updated in place"), ("out", "Outputs")):
            ports = [port for port in one["ports"] if port["direction"] == direction]
            text += table(title, [(f"`{port['name']}`", port["doc"]) for port in ports], "port", "what it is")
        text += table("Parameters", [(f"`{p['name']}`", f"`{default(p)}`", values(p), p["doc"]) for p in one["parameters"]],
                      "parameter", "default", "values", "what it does")
        text += table("Requirements", [(f"`{r['condition']}`", r["otherwise"]) for r in one["requirements"]],
                      "condition", "what is wrong without it")
        text += table("Counters", [(f"`{c['name']}`", c["doc"]) for c in one["counters"]], "counter", "what it counts")
    return text


def default(parameter):
    value = parameter["default"]
    return f"{value:g}" if isinstance(value, float) else str(value).lower()


def values(parameter):
    if "choices" in parameter:
        return ", ".join(parameter["choices"])
    unit = f" {parameter['unit']}" if "unit" in parameter else ""
    if "min" in parameter and "max" in parameter:
        return f"{parameter['min']:g} to {parameter['max']:g}{unit}"
    return f"at least {parameter['min']:g}{unit}" if "min" in parameter else unit.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", metavar="PROGRAM")
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("--pictures", action="store_true", help="render the pictures of the galleries")
    options = parser.parse_args()
    return Site(options.program, options.folder, options.pictures).make()


if __name__ == "__main__":
    sys.exit(main())
