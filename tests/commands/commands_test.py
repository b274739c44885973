"""Tests how many commands the frames of the stock graphs consist of, on a driver that does not execute them.

Usage: FOVEA_TEST_COMMANDS=FOLDER commands_test.py PROGRAM SOURCE_DIR [CLASS...]

The folder holds command_layer.so and command_layer.json. The driver is the mock driver that comes with Chromium. Without
it the test is skipped. frame_commands.csv lists the counts that are expected. FOVEA_COMMANDS_WRITE=1 writes that file
anew; its changes then have to be reviewed.
"""

import csv
import json
import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import SOURCE, CliTest  # noqa: E402

LAYER = os.environ.get("FOVEA_TEST_COMMANDS", "")
DRIVER = pathlib.Path("/usr/lib/chromium/libVkICD_mock_icd.so")
TABLE = pathlib.Path(__file__).with_name("frame_commands.csv")
# What is counted, by columns of the table, and what must not happen in a frame.
COLUMNS = {"dispatches": ["vkCmdDispatch"], "indirect_dispatches": ["vkCmdDispatchIndirect"],
           "draws": ["vkCmdDraw", "vkCmdDrawIndexed", "vkCmdDrawIndirect"], "renderings": ["vkCmdBeginRendering"],
           "copies": ["vkCmdCopyBuffer", "vkCmdCopyImage", "vkCmdCopyBufferToImage", "vkCmdCopyImageToBuffer"],
           "fills": ["vkCmdFillBuffer", "vkCmdClearColorImage", "vkCmdClearDepthStencilImage"],
           "barriers": ["vkCmdPipelineBarrier2"], "timestamps": ["vkCmdWriteTimestamp2"]}
NEVER = ["vkAllocateDescriptorSets", "vkAllocateMemory", "vkCreateComputePipelines", "vkCreateGraphicsPipelines",
         "vkDeviceWaitIdle", "vkUpdateDescriptorSets"]
# Without those whose work is done on the host.
GRAPHS = sorted({path.relative_to(SOURCE / "graphs").with_suffix("").as_posix()
                 for folder in (".", "alternatives", "debug") for path in (SOURCE / "graphs" / folder).glob("*.json")}
                - {"fovea-graph.schema", "reference", "alternatives/pt_denoised", "alternatives/reference_stereo"})


@unittest.skipUnless(DRIVER.exists(), "there is no mock driver of Vulkan (libVkICD_mock_icd.so of chromium-common)")
class Commands(CliTest):
    maxDiff = None

    def frames(self, graph, count):
        """What the frames of a graph consist of: how often each function is called up to each submit."""
        driver = self.write("driver.json", {"file_format_version": "1.0.0",
                                            "ICD": {"library_path": str(DRIVER), "api_version": "1.3.0"}})
        self.succeeds("render", graph, "--scene", "room", "--size", "1024x1024", "--rays", "device", "--frames", count,
                      "--timings", "timings.json", "--quiet",
                      env={"VK_DRIVER_FILES": str(driver), "VK_ICD_FILENAMES": str(driver), "VK_LAYER_PATH": LAYER,
                           "VK_INSTANCE_LAYERS": "VK_LAYER_FOVEA_commands", "NODEVICE_SELECT": "1",
                           "FOVEA_COMMANDS": "commands.txt"})
        return [json.loads(line) for line in (self.folder / "commands.txt").read_text().splitlines()]

    def test_frames_of_stock_graphs(self):
        found = {}
        for graph in GRAPHS:
            with self.subTest(graph=graph):
                # Each frame is one submit, so the last four lines are the four frames, of which the first also sets up
                # the graph. As things move, the number of draws may differ from frame to frame.
                first, *others = self.frames(graph, 4)[-4:]
                last = others[-1]
                self.assertIn("vkAllocateMemory", first)
                for frame in others:
                    self.assertEqual([name for name in NEVER if name in frame], [])
                    self.assertEqual(frame["vkWaitForFences"], 1)  # for its slot
                    self.assertEqual({**frame, "vkCmdDrawIndexed": 0}, {**last, "vkCmdDrawIndexed": 0})
                passes = json.loads((self.folder / "timings.json").read_text())["passes"]
                for kind, functions in (("indirect_dispatches", ["vkCmdDispatchIndirect"]),
                                        ("renderings", ["vkCmdBeginRendering"])):
                    # Vertices are moved by dispatches of their own, which belong to no pass.
                    self.assertEqual(sum(p["commands"][kind] for p in passes if "commands" in p),
                                     sum(last.get(name, 0) for name in functions))
                found[graph] = {column: sum(last.get(name, 0) for name in names) for column, names in COLUMNS.items()}
        if os.environ.get("FOVEA_COMMANDS_WRITE"):
            with TABLE.open("w", newline="") as file:
                writer = csv.DictWriter(file, ["graph", *COLUMNS], lineterminator="\n")
                writer.writeheader()
                writer.writerows({"graph": graph, **counts} for graph, counts in found.items())
        with TABLE.open(newline="") as file:
            expected = {row.pop("graph"): {column: int(value) for column, value in row.items()}
                        for row in csv.DictReader(file)}
        self.assertEqual(found, expected)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
