"""Tests `fovea render --capture`: which frame is captured, where the capture goes, and what is said without one.

Usage: FOVEA_TEST_RENDERDOC=FOLDER capture_test.py PROGRAM SOURCE_DIR [CLASS...]

FOLDER holds a library that stands for RenderDoc's.
"""

import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import BAD_INPUT, CANNOT_WRITE, DIRECT, USAGE, CliTest  # noqa: E402

# Two frames after one to warm up: 2, 3 and 4. The layer of a RenderDoc that is installed stays out.
FRAMES = [*DIRECT, "--first", "2", "--warmup", "1", "--frames", "2", "--quiet"]
ENVIRONMENT = {"LD_LIBRARY_PATH": os.environ.get("FOVEA_TEST_RENDERDOC", "."),
               "VK_LOADER_LAYERS_DISABLE": "VK_LAYER_RENDERDOC_Capture", "DISABLE_VULKAN_RENDERDOC_CAPTURE_1_24": "1"}


class Capture(CliTest):
    def test_one_frame(self):
        for frame in ("2", "3", "4"):
            self.succeeds(*FRAMES, "--capture", frame, "-o", "captured.exr", env=ENVIRONMENT)
            made = self.folder / f"direct-cornellbox-{frame}.rdc"
            self.assertEqual(made.read_text(), "RDOC start end")
            made.unlink()
        self.succeeds(*FRAMES, "-o", "plain.exr")
        self.assertEqual((self.folder / "captured.exr").read_bytes(), (self.folder / "plain.exr").read_bytes())
        self.assertEqual(sorted(f.name for f in self.folder.iterdir()), ["captured.exr", "plain.exr"])

    def test_no_such_frame(self):
        for frame in ("1", "5"):
            self.fails(USAGE, *FRAMES, "--capture", frame, says=[f"--capture {frame}", "2 to 4"], env=ENVIRONMENT)

    def test_no_capture(self):
        self.fails(CANNOT_WRITE, *FRAMES, "--capture", "3", says=["RenderDoc could not capture the frame"],
                   env={**ENVIRONMENT, "FOVEA_TEST_NO_CAPTURE": "1"})
        (self.folder / "direct-cornellbox-3.rdc").mkdir()
        self.fails(CANNOT_WRITE, *FRAMES, "--capture", "3", says=["direct-cornellbox-3.rdc"], env=ENVIRONMENT)

    def test_no_renderdoc(self):
        if any(pathlib.Path(folder, "librenderdoc.so").exists() for folder in ("/usr/lib", "/usr/lib/x86_64-linux-gnu")):
            self.skipTest("RenderDoc is installed")
        self.fails(BAD_INPUT, *FRAMES, "--capture", "3", says=["RenderDoc, which is not installed", "apt-get"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
