"""Tests what the program makes of functions of the system that fail: exit codes and messages.

Usage: FOVEA_TEST_FAULTS=LIBRARY faults_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import os
import pathlib
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import BAD_INPUT, DIRECT, NO_DEVICE, OUT_OF_MEMORY, SMALL, CliTest  # noqa: E402

DEVICE_LOST = 6
LIBRARY = os.environ.get("FOVEA_TEST_FAULTS", "")
NO_THREADS = 11  # EAGAIN


class Faults(CliTest):
    def faults(self, faults):
        return {"LD_PRELOAD": LIBRARY, "FOVEA_FAULTS": faults}

    def test_without_a_fault(self):
        self.succeeds(*DIRECT, "-q", "-o", "a.png", env=self.faults(""))

    def test_results_of_vulkan(self):
        for fault, code, says in (("vkCreateInstance=-3", NO_DEVICE, "VK_ERROR_INITIALIZATION_FAILED"),
                                  ("vkCreateInstance=-9", NO_DEVICE, "no Vulkan device"),
                                  ("vkEnumeratePhysicalDevices=-3", NO_DEVICE, "no Vulkan device"),
                                  ("vkEnumeratePhysicalDevices=-1", OUT_OF_MEMORY, "VK_ERROR_OUT_OF_HOST_MEMORY"),
                                  ("vkMapMemory=-5", OUT_OF_MEMORY, "VK_ERROR_MEMORY_MAP_FAILED"),
                                  ("vkAllocateDescriptorSets=-1000069000", OUT_OF_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY"),
                                  ("vkQueueSubmit2=-4@1", DEVICE_LOST, "VK_ERROR_DEVICE_LOST")):
            with self.subTest(fault=fault):
                self.fails(code, *DIRECT, "-o", "a.png", env=self.faults(fault), says=[says])

    def test_damaged_description_of_a_driver(self):
        self.write("icd.json", "\x01\x02 rubbish {")
        icd = str(self.folder / "icd.json")
        run = self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", env={"VK_DRIVER_FILES": icd, "VK_ICD_FILENAMES": icd})
        self.assertNotIn("VPLs", run.stderr)

    def renders(self, threads):
        """Whether so many threads suffice for what needs none of fovea's own."""
        try:
            return subprocess.run(self.command(*DIRECT, "-o", "a.pfm"), cwd=self.folder, stdin=subprocess.DEVNULL,
                                  env={**os.environ, **self.faults(f"pthread_create={NO_THREADS}@{threads}")},
                                  capture_output=True, timeout=10).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def test_threads(self):
        """Wherever threads cannot be made, it is the fault of the system and not of a file or of the program."""
        # Libraries make threads when they are loaded, and the driver for the device. Lavapipe waits for ever for one of
        # its own that could not be made.
        first = 0
        while not self.renders(first):
            first += 1
            self.assertLess(first, 50)
        reference = ["render", "reference", "--scene", "cornellbox", *SMALL, "--set", "spp=2", "-o", "a.png"]
        for command in (reference, [*DIRECT, "-o", "a.exr"]):
            codes = []
            for count in range(first, first + 6):
                run = self.call(*command, env=self.faults(f"pthread_create={NO_THREADS}@{count}"))
                codes.append(run.returncode)
                if run.returncode == OUT_OF_MEMORY:
                    self.assertIn("threads", run.stderr)
            self.assertLessEqual(set(codes), {0, OUT_OF_MEMORY}, codes)
            self.assertIn(OUT_OF_MEMORY, codes)


class Inputs(CliTest):
    def test_folder_of_shaders_that_cannot_be_searched(self):
        (self.folder / "data").mkdir()
        os.symlink("shaders", self.folder / "data/shaders")  # leads to itself, for which no privilege helps
        self.fails(BAD_INPUT, *DIRECT, "-o", "a.png", env={"FOVEA_DATA": str(self.folder / "data")},
                   says=["data/shaders"])

    def test_push_constants_of_a_pass_in_files(self):
        (self.folder / "passes").mkdir()
        for shader, constant, says in (("float other", "", "has the push constant `other`, which nothing sets"),
                                       ("float strenght", "", "did you mean `strength`"),
                                       ("uint more", '"constant": {"moer": 1},', "did you mean `moer`"),
                                       ("float strength", '"constant": {"other": 1},', "reads no push constant `other`"),
                                       ("float strength", "", None)):
            with self.subTest(shader=shader, constant=constant):
                self.write("passes/shade.pass.json", '{"doc": "shades",\n'
                           '"inputs": {"picture": "a picture"}, "outputs": {"image": {"doc": "it", "format": "rgba8"}},\n'
                           '"params": {"strength": {"doc": "how much", "default": 0.5, "min": 0, "max": 1}},\n'
                           '"steps": [{' + constant + '"shader": "shade.frag", "colors": ["image"]}]}')
                self.write("passes/shade.frag", "#version 460\nlayout(set = 0, binding = 0) uniform sampler2D picture;\n"
                           "layout(push_constant) uniform Push { " + shader + "; };\n"
                           "layout(location = 0) out vec4 color;\n"
                           "void main() { color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0) * " + shader.split()[1] + "; }\n")
                self.write("graph.json", {"extends": "direct.json",
                                          "passes": {"more": {"type": "shade", "inputs": {"picture": "tonemap.image"}}},
                                          "outputs": {"image": "more.image"}})
                for command in (["check", "graph.json"],
                                ["render", "graph.json", "--scene", "cornellbox", *SMALL, "-o", "a.png"]):
                    if not says:
                        self.succeeds(*command)
                        continue
                    self.fails(BAD_INPUT, *command, says=["shade.pass.json:4:", "shade.frag", says])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
