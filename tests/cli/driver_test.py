"""Stock graphs on a second Vulkan driver show the pictures of the first one. Usage: driver_test.py PROGRAM SOURCE_DIR

The second driver is the one whose description (a .json file, as in vulkan/icd.d) FOVEA_SECOND_DRIVER names, or else
SwiftShader, which comes with chromium-common. Without either, all is skipped and the exit code is 77. FOVEA_DRIVER_GRAPHS
names other graphs than the test's own, or `all`; FOVEA_DRIVER_SIZE and FOVEA_DRIVER_SCENE another size and scene.
"""

import json
import os
import pathlib
import sys
import unittest

from program import SOURCE, CliTest

SWIFTSHADER = pathlib.Path("/usr/lib/chromium/libvk_swiftshader.so")
DRIVER = os.environ.get("FOVEA_SECOND_DRIVER")
if not DRIVER and not SWIFTSHADER.exists():
    print(f"skipped: there is no {SWIFTSHADER}; name a driver's .json file in FOVEA_SECOND_DRIVER")
    sys.exit(77)

SIZE = os.environ.get("FOVEA_DRIVER_SIZE", "64x64")
SCENE = os.environ.get("FOVEA_DRIVER_SCENE", "cornellbox_moving")
MOST = 1e-4  # relative mean squared error


def graphs():
    named = os.environ.get("FOVEA_DRIVER_GRAPHS", "direct foveal ours ir_1000").split()
    if named != ["all"]:
        return named
    return sorted(path.stem for path in (SOURCE / "graphs").glob("*.json") if not path.name.endswith(".schema.json"))


class Driver(CliTest):
    def driver(self):
        file = DRIVER or self.write("swiftshader.json", {"file_format_version": "1.0.0",
                                                         "ICD": {"library_path": str(SWIFTSHADER), "api_version": "1.3.0"}})
        return {"VK_DRIVER_FILES": str(file), "VK_ICD_FILENAMES": str(file)}  # the new and the old name

    def test_pictures(self):
        second = self.driver()
        self.assertNotIn("unusable", self.succeeds("devices", env=second).stdout)
        for graph in graphs():
            with self.subTest(graph=graph):
                render = ["render", graph, "--scene", SCENE, "--size", SIZE, "--quiet", "-o"]
                self.succeeds(*render, "first.exr")
                self.succeeds(*render, "second.exr", env=second)
                error = json.loads(self.succeeds("compare", "second.exr", "first.exr", "--json").stdout)["whole"]["relmse"]
                print(f"{graph}: relMSE {error:.2g}")
                self.assertLessEqual(error, MOST)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
