#!/usr/bin/env python3
"""The rules of the repository, checked on its files: which room may include which, what is named where, sizes, links.

Usage: repository_test.py SOURCE_DIR [unittest arguments]
"""

import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1]).resolve()

# A room may include itself, the rooms named here and what these may include. The facade is declarations alone, so that
# every room of the framework may use it. The headers among the shaders are records that C++ and GLSL share: those of
# one pass are for the passes alone.
ROOMS = {
    "framework/include": [],
    "shaders/records": [],
    "shaders": ["shaders/records"],
    "framework/base": ["framework/include"],
    "framework/gpu": ["framework/base"],
    "framework/image": ["framework/base"],
    "framework/scene": ["framework/gpu", "framework/image", "shaders"],
    "framework/graph": ["framework/gpu", "framework/image"],
    "framework/host": ["framework/graph", "framework/scene"],
    "framework/session": ["framework/graph", "framework/scene"],
    "framework/python": ["framework/session", "passes/include", "samples/scenes/builtin/include"],
    "passes/include": [],
    "passes": ["framework/graph", "framework/scene", "shaders", "passes/include"],
    "benchmarks/runner": ["framework/session"],
    "benchmarks": ["framework/session", "passes", "samples/scenes", "benchmarks/runner"],
    "samples/scenes/builtin/include": [],
    "samples/scenes": ["framework/scene", "samples/scenes/builtin/include"],
    "samples/own_pass": ["framework/include"],
    "samples/embed": ["framework/include", "passes/include", "samples/scenes/builtin/include"],
    "samples/fovea": ["framework/session", "passes/include", "samples/scenes/builtin/include", "benchmarks/runner"],
}
# What is installed, and included without its folder.
FACADES = ["framework/include", "passes/include", "samples/scenes/builtin/include"]
# graph/ learns of the scene only through a frame.
EXCEPTIONS = {("framework/graph", "framework/scene/frame.h")}

# What computes light for the methods. The path tracer knows none of it, as it proves them; it may ask what a ray hits.
LIGHT_TRANSPORT = ("framework/scene/tables/", "framework/scene/rays/",
                   "framework/scene/lights.h", "shaders/")
RAYS_ALONE = "framework/scene/rays/ray_scene.h"

# Words that are also plain English count only where they are quoted.
PLAIN_WORDS = {"room", "yard", "balcony", "direct", "radiance", "importance", "candidates", "manage", "emit", "bounce",
               "accumulate", "compose", "deferred", "reproject", "mipmap", "gbuffer", "voxelize", "tonemap",
               "mirrors", "cones", "reflections", "contacts"}
# Words of glTF, and layers of pictures, which the framework must say.
OTHER_MEANINGS = {"weights", "radiance", "direct"}

SOURCE_ENDINGS = {".cpp", ".h", ".comp", ".frag", ".vert", ".glsl", ".py", ".sh", ".cmake"}


def tracked():
    """Paths of the files that belong to the repository: what is committed, or in an archive without history all that
    is there. What users keep in their checkout is their own affair."""
    try:
        names = subprocess.run(["git", "ls-tree", "-r", "--name-only", "HEAD"], cwd=SOURCE, check=True,
                               capture_output=True, text=True).stdout.split("\n")
    except (OSError, subprocess.CalledProcessError):
        names = [str(p.relative_to(SOURCE)) for p in SOURCE.rglob("*") if "build" not in p.relative_to(SOURCE).parts]
    return [Path(n) for n in names if n and (SOURCE / n).is_file()]


def read(path):
    return (SOURCE / path).read_text(encoding="utf-8")


def room_of(path):
    matches = [room for room in ROOMS if str(path).startswith(room + "/")]
    return max(matches, key=len, default=None)


def reachable(room):
    rooms = {room}
    for other in ROOMS[room]:
        rooms |= reachable(other)
    return rooms


class Rooms(unittest.TestCase):
    def test_includes_point_one_way(self):
        wrong, checked = [], 0
        for path in tracked():
            room = room_of(path)
            if room is None or path.suffix not in {".cpp", ".h"}:
                continue
            for name in re.findall(r'^#include "([^"]+)"', read(path), re.M):
                target = next((f"{folder}/{name}" for folder in FACADES if (SOURCE / folder / name).is_file()), name)
                if room.startswith("shaders") or path.name == "records.h":  # GLSL looks in the file's own folder first
                    beside = (SOURCE / path.parent / name).resolve()
                    target = str(beside.relative_to(SOURCE)) if beside.is_file() else f"shaders/{name}"
                there = room_of(target)
                checked += 1
                if there is None:
                    wrong.append(f"{path} includes {name}, which is in no room")
                elif there not in reachable(room) | {"framework/include"} and (room, name) not in EXCEPTIONS:
                    wrong.append(f"{path} includes {name}: {room} must not know of {there}")
        self.assertGreater(checked, 500)
        self.assertEqual(wrong, [])

    def test_the_path_tracer_shares_no_equation_with_the_methods(self):
        open_files = {p for p in tracked() if str(p).startswith("passes/path-trace/") and p.suffix in {".cpp", ".h"}}
        self.assertGreater(len(open_files), 15)
        wrong, seen = [], set()
        while open_files:
            path = open_files.pop()
            seen.add(path)
            for name in re.findall(r'^#include "([^"]+)"', read(path), re.M):
                target = Path(f"framework/include/{name}" if name.startswith("fovea/") else name)
                if name.startswith(LIGHT_TRANSPORT) and name != RAYS_ALONE:
                    wrong.append(f"{path} includes {name}")
                elif name.startswith("passes/") and target.parts[1] != "path-trace":
                    wrong.append(f"{path} includes {name}, which is another pass's")
                elif target not in seen and (SOURCE / target).is_file():
                    open_files.add(target)
        self.assertEqual(wrong, [])

    def test_the_framework_names_no_pass_and_no_scene(self):
        passes = sorted({p.parts[1] for p in tracked() if p.parts[0] == "passes" and len(p.parts) > 2} - {"include"})
        scenes = re.findall(r'FOVEA_SCENE\("(\w+)"', "".join(
            read(p) for p in tracked() if str(p).startswith("samples/scenes/builtin/")))
        scenes += [p.stem for p in (SOURCE / "samples/scenes").rglob("*.json")]
        self.assertGreater(len(passes), 25)
        self.assertGreater(len(scenes), 5)
        found = []
        for path in tracked():
            if not str(path).startswith("framework/") or path.suffix not in {".cpp", ".h"}:
                continue
            if str(path) == "framework/graph/migrate/migrate.cpp":  # names of earlier versions
                continue
            text = read(path)
            for name in set(passes + scenes) - OTHER_MEANINGS:
                pattern = rf'"{name}[./"]' if name in PLAIN_WORDS else rf"(?<![\w-]){name}(?![\w-])"
                found += [f"{path}:{text.count(chr(10), 0, m.start()) + 1}: {name}" for m in re.finditer(pattern, text)]
        self.assertEqual(found, [])

    def test_only_the_facade_is_installed(self):
        install = read("framework/cmake/install.cmake")
        folders = re.findall(r"install\(DIRECTORY (\S+/framework\S*)", install)
        self.assertEqual(folders, ["${PROJECT_SOURCE_DIR}/framework/include/fovea"])
        for path in tracked():
            if str(path).startswith("framework/include/"):
                for name in re.findall(r'^#include "([^"]+)"', read(path), re.M):
                    self.assertTrue(name.startswith("fovea/"), f"{path} includes {name}, which is not installed")


    @unittest.skipUnless((SOURCE / ".git").exists(), "an archive does not say what is committed")
    def test_the_top_level_holds_nothing_else(self):
        files = {p.name for p in tracked() if len(p.parts) == 1 and not p.name.startswith(".")}
        self.assertEqual(files, {"CHANGELOG.md", "CMakeLists.txt", "CMakePresets.json", "CONTRIBUTING.md", "LICENSE",
                                 "README.md", "SECURITY.md", "pyproject.toml"})


class Sizes(unittest.TestCase):
    def test_no_folder_holds_more_than_25_files(self):
        count = {}
        for path in tracked():
            if path.parts[0] not in {"tests", "passes"}:
                count[path.parent] = count.get(path.parent, 0) + 1
        self.assertEqual({str(f): n for f, n in count.items() if n > 25}, {})

    def test_no_source_file_passes_500_lines(self):
        long = {str(p): n for p in tracked()
                if p.suffix in SOURCE_ENDINGS and (n := read(p).count("\n")) > 500}
        self.assertEqual(long, {})

    def test_the_front_page_is_short(self):
        text = read("README.md")
        self.assertLess(len(text.split()), 900)
        self.assertLessEqual(max(map(len, text.split("\n"))), 120)


class Documents(unittest.TestCase):
    def documents(self):
        return [p for p in tracked() if p.suffix == ".md"]

    def test_links_lead_somewhere(self):
        broken = []
        for path in self.documents():
            text = re.sub(r"```.*?```", "", read(path), flags=re.S)
            for target in re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text):
                if re.match(r"[a-z]+:", target):
                    continue
                file, _, anchor = target.partition("#")
                place = (SOURCE / path.parent / file).resolve() if file else SOURCE / path
                if not place.exists():
                    broken.append(f"{path}: {target}")
                elif anchor and place.suffix == ".md" and anchor not in self.anchors(place.read_text(encoding="utf-8")):
                    broken.append(f"{path}: {target} (no such heading)")
        self.assertEqual(broken, [])

    @staticmethod
    def anchors(text):
        headings = re.findall(r"^#+ +(.*?) *$", re.sub(r"```.*?```", "", text, flags=re.S), re.M)
        return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}

    def test_named_files_exist(self):
        """A path in backquotes that begins with one of our folders names something that is there."""
        tops = {p.name for p in SOURCE.iterdir() if p.is_dir() and not p.name.startswith(".")} - {"build", "install"}
        missing, named = [], 0
        for path in self.documents():
            text = re.sub(r"```.*?```", "", read(path), flags=re.S)
            for name in re.findall(r"`([\w.\-]+/[\w.\-/]*)`", text):
                named += 1
                if name.split("/")[0] not in tops or name.split("/")[0] in {"build", "install"}:
                    continue
                if not (SOURCE / name).exists() and not (SOURCE / path.parent / name).exists():
                    missing.append(f"{path}: {name}")
        self.assertGreater(named, 20)
        self.assertEqual(missing, [])

    def test_every_pass_is_described_on_one_page(self):
        """A pass has a heading on one of the pages in passes/, and the overview leads to it."""
        pages = {p.name: read(p) for p in tracked() if p.parts[0] == "passes" and p.suffix == ".md"}
        overview = pages.pop("README.md")
        places = {}
        for page, text in pages.items():
            for name in re.findall(r"^#+ ([a-z-]+)$", text, re.M):
                places.setdefault(name, []).append(f"{page}#{name}")
        passes = {p.parts[1] for p in tracked() if p.parts[0] == "passes" and len(p.parts) > 2} - {"include"}
        self.assertGreater(len(passes), 25)
        self.assertEqual({n: places.get(n) for n in passes if len(places.get(n, [])) != 1}, {})
        self.assertEqual([n for n in sorted(passes) if f"({places[n][0]})" not in overview], [])

    def test_comments_cite_documents_that_are_there(self):
        """`NAME.md` in a source file is a document of the repository."""
        missing = []
        for path in tracked():
            if path.suffix in SOURCE_ENDINGS and path.name != "repository_test.py":
                for name in re.findall(r"\b([\w./-]+\.md)\b", read(path)):
                    if not (SOURCE / name).exists() and not (SOURCE / path.parent / name).exists():
                        missing.append(f"{path}: {name}")
                missing += [f"{path}: {name}" for name in re.findall(r"\b(?:METHOD|PLATFORM|DESIGN)\b(?!_)", read(path))]
        self.assertEqual(missing, [])


class ExitCodes(unittest.TestCase):
    def test_enum_document_and_help_agree(self):
        enum = re.search(r"enum class ExitCode : int \{(.*?)\};", read("framework/include/fovea/error.h"), re.S).group(1)
        codes = {int(n) for n in re.findall(r"= *(\d+)", enum)}
        document = {int(n) for n in re.findall(r"^\| *(\d+) *\|", read("samples/fovea/README.md"), re.M)}
        footer = re.search(r'Exit codes: .*?\)"', read("samples/fovea/main.cpp"), re.S).group(0)
        spoken = {int(n) for n in re.findall(r"\b(\d+) [a-z]", footer)}
        self.assertGreater(len(codes), 8)
        self.assertEqual(document, codes)
        self.assertEqual(spoken, codes)
        for path in tracked():
            if path.suffix in {".cpp", ".h"} and path.name != "error.h":
                self.assertNotRegex(read(path), r"ExitCode[({]\d", f"{path} makes an exit code of its own")


class Shaders(unittest.TestCase):
    def test_what_the_compiler_supplies_is_not_repeated(self):
        found = []
        for path in tracked():
            if path.suffix in {".comp", ".frag", ".vert", ".glsl"} and str(path).startswith(("shaders/", "passes/", "samples/")):
                found += [f"{path}: {line}" for line in re.findall(
                    r"^#version.*|^#extension GL_(?:EXT_samplerless|GOOGLE_include).*", read(path), re.M)]
        self.assertEqual(found, [])

    def test_resources_of_set_0_are_found_by_name(self):
        found = []
        for path in tracked():
            if path.suffix in {".comp", ".frag", ".vert", ".glsl"} and str(path).startswith(("shaders/", "passes/", "samples/")):
                for line in re.findall(r"^ *layout\(([^)]*)\) *(?:uniform|readonly|writeonly|buffer|coherent|restrict)",
                                       read(path), re.M):
                    if "binding" in line and not re.search(r"\bset *= *1\b", line):
                        found.append(f"{path}: layout({line})")
        self.assertEqual(found, [])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[2:], verbosity=1)
