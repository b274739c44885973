"""Tests rays by ray queries on a lavapipe that has them, which lavapipe.sh fetches; skipped where it cannot be had.

Usage: FOVEA_DEVICE_TESTS=PROGRAM ray_query_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import CliTest  # noqa: E402

FETCH = pathlib.Path(__file__).with_name("lavapipe.sh")
# Tests of rays, and of all passes that trace them. Compiling the shaders of passes takes minutes.
RAYS = "DeviceRays*:DeviceEmitters*"
PASSES = "Passes/RaysBoth*"
OTHERS = "Rays/*:ContactRaysBoth*:NearFieldBoth*:Mirrors*:LongDeviceRays*"


class OnLavapipe(CliTest):
    @classmethod
    def setUpClass(cls):
        run = subprocess.run([FETCH], capture_output=True, text=True)
        if run.returncode != 0:
            raise unittest.SkipTest(run.stderr.strip())
        driver = run.stdout.strip()
        cls.driver = {"VK_DRIVER_FILES": driver, "VK_ICD_FILENAMES": driver}

    def device_tests(self, chosen):
        run = subprocess.run([os.environ["FOVEA_DEVICE_TESTS"], f"--gtest_filter={chosen}"], capture_output=True,
                             text=True, env={**os.environ, **self.driver})
        self.assertEqual(run.returncode, 0, run.stdout[-4000:] + run.stderr[-2000:])
        self.assertRegex(run.stdout, r"\[  PASSED  \] [1-9]")


class RayQueries(OnLavapipe):
    def test_rays(self):
        self.device_tests(RAYS)


class LongRayQueryPictures(OnLavapipe):
    def picture(self, name, seed, *options):
        self.succeeds("render", "foveal", "--scene", "cornellbox_moving", "--size", "96x96", "--warmup", "6",
                      "--seed", seed, "--quiet", "-o", name, *options, env=self.driver)
        return name

    def difference(self, a, b):
        report = json.loads(self.succeeds("compare", a, b, "--layer", "indirect", "--json").stdout)
        return report["whole"]["mse"]

    def test_pictures_are_within_the_noise_of_others(self):
        queries = self.picture("queries.exr", 1, "--rays", "device")
        noise = self.difference(self.picture("seed.exr", 2, "--rays", "device"), queries)
        trees = self.picture("trees.exr", 1, "--rays", "device", "--without", "VK_KHR_ray_query")
        host = self.picture("host.exr", 1, "--rays", "host")
        self.assertGreater(noise, 0)
        self.assertLess(self.difference(trees, queries), 1.2 * noise)
        self.assertLess(self.difference(host, queries), 1.2 * noise)


class LongRayQueryPasses(OnLavapipe):
    def test_find_what_they_find_on_the_host(self):
        self.device_tests(PASSES)


class LongRayQueries(OnLavapipe):
    def test_other_tests_with_rays(self):
        self.device_tests(OTHERS)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
