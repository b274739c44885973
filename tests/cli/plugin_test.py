"""Tests plug-ins with faults through the program: exit codes, and that messages name the pass and the plug-in.

Usage: FOVEA_TEST_PLUGINS=FOLDER plugin_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import os
import pathlib
import sys
import unittest

from program import BAD_INPUT, OUT_OF_MEMORY, SMALL, CliTest

INTERNAL = 1
PLUGINS = pathlib.Path(os.environ.get("FOVEA_TEST_PLUGINS", "."))
FAULTY = PLUGINS / "faulty_plugin.so"


class Plugins(CliTest):
    def render(self, type, throws):
        self.write("graph.json", {"passes": {"culprit": {"type": type, "params": {"throws": throws}}},
                                  "outputs": {"image": "culprit"}})
        return ["render", "graph.json", "--scene", "cornellbox", *SMALL, "-o", "a.png", "--plugin", FAULTY]

    def test_exceptions_name_the_pass_and_the_plugin(self):
        standard = ("standard", INTERNAL, ["std::runtime_error", "the moon is made of cheese", "the author of the plug-in"])
        number = ("number", INTERNAL, ["of type int", "the author of the plug-in"])
        memory = ("memory", OUT_OF_MEMORY, ["memory is exhausted"])
        chosen = ("input", BAD_INPUT, ["): the moon is not full", "-> wait for a week"])
        for type, place, cases in (("faulty-prepare", "prepare()", [standard, number, memory, chosen]),
                                   ("faulty-record", "record()", [standard, chosen]),
                                   ("faulty-execute", "execute()", [standard, chosen])):
            for throws, code, says in cases:
                with self.subTest(type=type, throws=throws):
                    self.fails(code, *self.render(type, throws), says=[f"pass `culprit` ({type})", str(FAULTY), place, *says])

    def test_exception_in_the_constructor(self):
        self.fails(INTERNAL, *self.render("faulty-constructor", "nothing"),
                   says=["pass `culprit` (faulty-constructor)", str(FAULTY), "constructor", "the moon is made of cheese"])

    def test_exception_in_the_declaration(self):
        broken = PLUGINS / "broken_declaration_plugin.so"
        self.fails(INTERNAL, "passes", "--plugin", broken,
                   says=[str(broken), "`Thrower`", "declaration()", "the moon is too far away",
                         "the default 5 is outside 6 to 9"])
        throws = PLUGINS / "throwing_declaration_plugin.so"
        self.fails(INTERNAL, "passes", "--plugin", throws,
                   says=[str(throws), "`Thrower`", "declaration()", "of type char const*"])

    def test_other_version(self):
        library = FAULTY.read_bytes()
        start = library.index(b"fovea 0.")
        version = library[start:library.index(b" ", start + 6)].decode()
        other = self.folder / "other.so"
        other.write_bytes(library.replace(library[start:start + 12], b"fovea 9.8.7 "))
        run = self.fails(BAD_INPUT, "passes", "--plugin", "other.so",
                         says=["other.so: error: ", "compiled for fovea 9.8.7", f"this is {version}", "-> compile it again"])
        self.assertEqual(len(run.stderr.splitlines()), 2, run.stderr)
        self.fails(BAD_INPUT, "passes", "--plugin", PLUGINS / "other_version_plugin.so", says=["fovea 0.0.7", version])

    def test_no_version(self):
        for name in ("unmarked_plugin.so", "no_pass_plugin.so"):
            self.fails(BAD_INPUT, "passes", "--plugin", PLUGINS / name, says=[name, "FOVEA_PASS"])

    def test_files_that_are_no_plugins(self):
        library = FAULTY.read_bytes()
        for part in (10, 1000, len(library) // 2, len(library) - 1):
            (self.folder / "short.so").write_bytes(library[:part])
            self.fails(BAD_INPUT, "passes", "--plugin", "short.so", says=["short.so", "cut short"])
        os.mkfifo(self.folder / "pipe.so")
        self.fails(BAD_INPUT, "passes", "--plugin", "pipe.so", says=["pipe.so", "no regular file"])
        self.fails(BAD_INPUT, "passes", "--plugin", ".", says=["a directory"])
        self.fails(BAD_INPUT, "passes", "--plugin", "/dev/zero", says=["/dev/zero", "no regular file"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
