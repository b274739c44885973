"""Shared by the tests of the command-line program. Every test has the arguments PROGRAM SOURCE_DIR [CLASS...]"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
SOURCE = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None
BENCHMARKS = SOURCE / "benchmarks" if SOURCE else None

USAGE, BAD_INPUT, NO_DEVICE, OUT_OF_MEMORY, CANNOT_WRITE, INTERRUPTED = 2, 3, 4, 5, 7, 130
# Small and quick settings; the tests do not depend on the amount of work.
SMALL = ["--size", "48x32"]
DIRECT = ["render", "direct", "--scene", "cornellbox", *SMALL]


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="fovea-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def command(self, *arguments):
        return [str(PROGRAM), *map(str, arguments)]

    def call(self, *arguments, env=None, **more):
        return subprocess.run(self.command(*arguments), cwd=self.folder, env={**os.environ, **(env or {})},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, **more)

    def succeeds(self, *arguments, **more):
        run = self.call(*arguments, **more)
        self.assertEqual(run.returncode, 0, f"{arguments}: {run.stderr}")
        return run

    def fails(self, code, *arguments, says=(), **more):
        """Checks the exit code, that there is one clear message with the given names, and that no new file exists."""
        before = sorted(self.folder.iterdir())
        run = self.call(*arguments, **more)
        self.assertEqual(run.returncode, code, f"{arguments}: {run.stderr}")
        self.assertTrue(run.stderr.startswith("fovea: "), run.stderr)
        self.assertNotIn("defect", run.stderr)
        self.assertEqual(run.stdout, "")
        for text in says:
            self.assertIn(text, run.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)
        return run

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content, indent=2))
        return path

    def graph(self, **changes):
        """A graph file that extends direct.json."""
        return self.write("graph.json", {"extends": "direct.json", **changes})


class ToolTest(CliTest):
    """Of a script in benchmarks, whose name is `script`."""

    script = None

    def command(self, *arguments):
        return [sys.executable, str(BENCHMARKS / self.script), *map(str, arguments)]

    def refuses(self, code, *arguments, says=()):
        """Checks the exit code, and that there is one line that contains the given texts."""
        run = self.call(*arguments)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertEqual(run.stdout, "")
        self.assertRegex(run.stderr, r"\A" + re.escape(self.script) + r": [^\n]+\n\Z")
        for text in says:
            self.assertIn(text, run.stderr)
