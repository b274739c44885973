"""Tests how the program reacts when functions of the system and of Vulkan fail: exit codes and messages.

Usage: FOVEA_TEST_FAULTS=FOLDER faults_test.py PROGRAM SOURCE_DIR [CLASS...]

The folder holds faults.so, vulkan_faults.so and vulkan_faults.json. FOVEA_FAULTS_ALL=GRAPH,... makes every single
Vulkan call fail in turn, for these graphs, instead of the last call of each function, and hundreds of memory
allocations instead of ten: about a thousand runs per graph.
"""

import collections
import csv
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import BAD_INPUT, CANNOT_WRITE, DIRECT, NO_DEVICE, OUT_OF_MEMORY, SMALL, CliTest  # noqa: E402

DEVICE_LOST = 6
LIBRARIES = os.environ.get("FOVEA_TEST_FAULTS", "")
NO_THREADS = 11  # EAGAIN

# What functions of Vulkan fail with, the exit code of the program then and a part of its message, and how often each
# graph calls them. FOVEA_FAULTS_WRITE=1 counts the calls again, after which the rest has to be reviewed.
TABLE = pathlib.Path(__file__).with_name("vulkan_functions.csv")
SMALL_GRAPHS = {"direct": [], **{graph: ["--set", "vpl_count=32", "--set", "map_size=16"]
                                 for graph in ("ir_1000", "ours", "foveal", "stereo")}}


def table():
    with TABLE.open(newline="") as file:
        return {row["function"]: row for row in csv.DictReader(file)}


def write_calls(graph, counts):
    rows = table()
    for function in set(rows) | set(counts):
        rows.setdefault(function, {"function": function, "result": -2, "exit_code": OUT_OF_MEMORY,
                                   "message": "VK_ERROR_OUT_OF_DEVICE_MEMORY"})[graph] = counts[function]
    with TABLE.open("w", newline="") as file:
        writer = csv.DictWriter(file, ["function", "result", "exit_code", "message", *SMALL_GRAPHS], restval=0,
                                lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[function] for function in sorted(rows))


class VulkanFaults(CliTest):
    def faults(self, faults, **more):
        # Mesa's layer for choosing a device makes calls of its own and does not look at their results.
        return {"VK_LAYER_PATH": LIBRARIES, "VK_INSTANCE_LAYERS": "VK_LAYER_FOVEA_faults", "NODEVICE_SELECT": "1",
                "FOVEA_FAULTS": faults, **more}

    def calls(self, *command):
        """How often a command calls each function of Vulkan."""
        self.succeeds(*command, env=self.faults("", FOVEA_CALLS="calls.txt"))
        counts = collections.Counter((self.folder / "calls.txt").read_text().split())
        for file in self.folder.iterdir():
            file.unlink()
        return counts

    def test_results(self):
        for fault, code, says in (("vkCreateInstance=-9", NO_DEVICE, "no Vulkan device"),
                                  ("vkEnumeratePhysicalDevices=-3", NO_DEVICE, "no Vulkan device"),
                                  ("vkMapMemory=-5", OUT_OF_MEMORY, "VK_ERROR_MEMORY_MAP_FAILED"),
                                  ("vkAllocateDescriptorSets=-1000069000", OUT_OF_MEMORY, "VK_ERROR_OUT_OF_POOL_MEMORY")):
            with self.subTest(fault=fault):
                self.fails(code, *DIRECT, "-o", "a.png", env=self.faults(fault), says=[says])

    def test_opening_a_device(self):
        """Whatever fails until there is a device is a lack of memory, a lost device, or the fault of the driver."""
        lost, broken = (-4, DEVICE_LOST), (-3, -6, -7, -8, -9, -13, -1000069000 + 1)
        for function, calls in (("vkCreateInstance", 1), ("vkEnumeratePhysicalDevices", 2),
                                ("vkEnumerateDeviceExtensionProperties", 4), ("vkCreateDevice", 1),
                                ("vkCreateCommandPool", 1), ("vkCreatePipelineCache", 2)):
            memory = [(-1, OUT_OF_MEMORY), (-2, OUT_OF_MEMORY)]
            own = [lost] if function == "vkCreateDevice" else []
            for result, code in memory + own + [(r, NO_DEVICE) for r in broken]:
                for at in [*(f"@{i}" for i in range(calls)), ""] if calls > 1 else [""]:
                    if function == "vkCreatePipelineCache" and at:
                        continue  # without what was on the disk, there is one
                    with self.subTest(function=function, result=result, at=at):
                        run = self.call(*DIRECT, "-o", "a.png", env=self.faults(f"{function}={result}{at}"))
                        if function == "vkEnumerateDeviceExtensionProperties" and at and run.returncode == 0:
                            (self.folder / "a.png").unlink()  # a call by the loader
                            continue
                        self.assertEqual(run.returncode, code, run.stderr)
                        self.assertRegex(run.stderr, "  -> ")
                        self.assertNotIn("defect", run.stderr)
                        self.assertNotIn("damaged", run.stderr if code == OUT_OF_MEMORY else "")
                        self.assertFalse((self.folder / "a.png").exists())
            self.assertEqual(self.call("devices", env=self.faults("vkEnumeratePhysicalDevices=-1")).returncode,
                             OUT_OF_MEMORY)

    def test_every_function(self):
        """No call that fails is passed over in silence, crashes or leaves half a picture."""
        every = os.environ.get("FOVEA_FAULTS_ALL")
        small = ["--size", "32x32", "--frames", "2", "--set", "shadow_map_size=64", "-q", "-o", "a.exr"]
        # The cheapest graph calls the same functions as the others.
        for graph in every.split(",") if every else ["direct"]:
            command = ["render", graph, "--scene", "cornellbox_moving", *small, *SMALL_GRAPHS[graph]]
            counts = self.calls(*command)
            if os.environ.get("FOVEA_FAULTS_WRITE"):
                write_calls(graph, counts)
            rows = {function: row for function, row in table().items() if int(row[graph]) > 0}
            with self.subTest(graph=graph):
                self.assertEqual(dict(counts), {function: int(row[graph]) for function, row in rows.items()})
            for function, row in rows.items():
                started, count = time.monotonic(), counts[function]
                for call in range(count) if every else [count - 1]:
                    fault = f"{function}={row['result']}@{call}"
                    with self.subTest(graph=graph, fault=fault, of=count):
                        if int(row["exit_code"]):
                            self.fails(int(row["exit_code"]), *command, env=self.faults(fault), says=[row["message"]])
                        else:
                            self.succeeds(*command, env=self.faults(fault))
                            (self.folder / "a.exr").unlink()
                if every:
                    print(f"{graph}: {function}, {count} calls, {time.monotonic() - started:.0f} s", flush=True)

    def test_frames_before_the_device_is_lost(self):
        """They are kept; nothing of the others is there."""
        command = ["render", "direct", "--scene", "cornellbox_moving", *SMALL, "--frames", "4", "-o", "a_%d.exr"]
        submissions = self.calls(*command)["vkQueueSubmit2"]
        run = self.call(*command, env=self.faults(f"vkQueueSubmit2=-4@{submissions - 2}"))
        self.assertEqual(run.returncode, DEVICE_LOST, run.stderr)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a_0.exr", "a_1.exr"])

    def test_device_is_lost_during_a_suite(self):
        """The job is measured again; if that is of no use, the others still are."""
        def suite(*scenes):
            self.write("suite.json", {"scenes": scenes, "graphs": ["direct"], "size": "32x32",
                                      "set": {"shadow_map_size": 64}, "frames": 20, "measures": ["pictures"],
                                      "sweeps": [{"name": "all"}]})
        command = ["bench", "suite.json", "-o", "out"]
        suite("cornellbox")
        self.succeeds(*command, env=self.faults("", FOVEA_CALLS="calls.txt"))
        # A job takes up to eight frames more until its times have settled, so the call after these is the second job's.
        submissions = (self.folder / "calls.txt").read_text().split().count("vkQueueSubmit2") + 8
        suite("cornellbox", "cornellbox_moving")
        self.succeeds(*command)
        whole = {p.name for p in (self.folder / "out/results").iterdir()}
        self.assertEqual(len(whole), 2)
        for fault, code, says, left in ((f"@{submissions}", 0, "measured again on a new device", 2),
                                        (f"@{submissions}+", DEVICE_LOST, "the suite goes on without it", 1)):
            shutil.rmtree(self.folder / "out")
            run = self.call(*command, env=self.faults(f"vkQueueSubmit2=-4{fault}"))
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertIn(says, run.stderr)
            self.assertEqual(len(list((self.folder / "out/results").iterdir())), left)
        self.succeeds(*command)
        self.assertEqual({p.name for p in (self.folder / "out/results").iterdir()}, whole)


class Faults(CliTest):
    def faults(self, faults):
        return {"LD_PRELOAD": os.path.join(LIBRARIES, "faults.so"), "FOVEA_FAULTS": faults}

    def test_damaged_description_of_a_driver(self):
        self.write("icd.json", "\x01\x02 rubbish {")
        icd = str(self.folder / "icd.json")
        run = self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", env={"VK_DRIVER_FILES": icd, "VK_ICD_FILENAMES": icd})
        self.assertNotIn("VPLs", run.stderr)
        self.assertIn("icd.json", run.stderr)

    def test_memory(self):
        """Wherever the program cannot have memory, it ends with that message and without a picture."""
        command = ["render", "ours", "--scene", "cornellbox_moving", "--size", "32x32", "--frames", "2", "--set",
                   "shadow_map_size=64", "--set", "vpl_count=32", "--set", "map_size=16", "-q", "-o", "a.exr"]
        call, growth, codes = 0, 1.01 if os.environ.get("FOVEA_FAULTS_ALL") else 3, []
        while not codes or codes[-1] != 0:
            run = self.call(*command, env=self.faults(f"new=0@{call}"))
            codes.append(run.returncode)
            if run.returncode:
                self.assertIn(run.returncode, (OUT_OF_MEMORY, CANNOT_WRITE), f"allocation {call}: {run.stderr}")
                self.assertRegex(run.stderr, "fovea: error: .*(memory|bad_alloc)")
                self.assertEqual(list(self.folder.iterdir()), [])
            call = int(call * growth) + 1
        self.assertGreater(len(codes), 8)

    def sleeps(self, process):
        """Whether no thread of a process has anything to do."""
        tasks = pathlib.Path(f"/proc/{process.pid}/task").glob("*/stat")
        return all(task.read_text().rpartition(")")[2].split()[0] == "S" for task in tasks)

    def renders(self, threads):
        """Whether so many threads suffice for what needs none of fovea's own."""
        process = subprocess.Popen(self.command(*DIRECT, "-o", "a.pfm"), cwd=self.folder, stdin=subprocess.DEVNULL,
                                   env={**os.environ, **self.faults(f"pthread_create={NO_THREADS}@{threads}+")},
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        waits = 0  # seconds without pause; how long it works says nothing on a busy machine
        while process.poll() is None and waits < 4:
            try:
                waits = waits + 0.1 if self.sleeps(process) else 0
            except (FileNotFoundError, ProcessLookupError):
                pass  # a thread that ended meanwhile
            time.sleep(0.1)
        process.kill()
        return process.wait() == 0

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
                run = self.call(*command, env=self.faults(f"pthread_create={NO_THREADS}@{count}+"))
                codes.append(run.returncode)
                if run.returncode == OUT_OF_MEMORY:
                    self.assertIn("threads", run.stderr)
            self.assertLessEqual(set(codes), {0, OUT_OF_MEMORY}, codes)
            self.assertIn(OUT_OF_MEMORY, codes)


class Kills(CliTest):
    """SIGKILL at random moments. FOVEA_KILLS is how many each test sends; 200 by request, few in the suite."""

    KILLS = int(os.environ.get("FOVEA_KILLS", "4"))

    def killed(self, command, seconds):
        process = subprocess.Popen(self.command(*command), cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL, start_new_session=True,
                                   env={**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache")})
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)  # with the script that makes the report
            process.wait()

    def moments(self, command):
        """Random ones over the time that the command takes, with the file cache that the kills leave behind."""
        started = time.monotonic()
        self.succeeds(*command)
        whole = time.monotonic() - started
        randomness = random.Random(1)
        return [randomness.uniform(0, whole) for _ in range(self.KILLS)]

    def test_render(self):
        """What has a picture's name is the whole picture."""
        command = ["render", "direct", "--scene", "cornellbox_moving", *SMALL, "--frames", "8", "-q", "-o", "a_%d.exr"]
        moments = self.moments(command)
        whole = {p.name: p.read_bytes() for p in self.folder.glob("a_*.exr")}
        self.assertEqual(len(whole), 8)
        for moment in moments:
            for file in self.folder.glob("a_*.exr"):
                file.unlink()
            self.killed(command, moment)
            for file in self.folder.glob("a_*.exr"):
                self.assertEqual(file.read_bytes(), whole[file.name], f"killed after {moment:.3f} s")

    def test_bench(self):
        """A suite that is started again and again ends with the results of one that ran through."""
        self.write("suite.json", {"scenes": ["cornellbox", "cornellbox_moving"], "graphs": ["direct"], "size": "32x32",
                                  "set": {"shadow_map_size": 64}, "reference": {"spp": 64, "depth": 3},
                                  "measures": ["error"], "sweeps": [{"name": "all"}]})
        moments = self.moments(["bench", "suite.json", "-o", "whole"])

        def errors(folder):
            return {p.name: json.loads(p.read_text())["error"] for p in (self.folder / folder / "results").glob("*.json")}

        for moment in moments:
            self.killed(["bench", "suite.json", "-o", "out"], moment)
            for name, error in errors("out").items():
                self.assertEqual(error, errors("whole")[name], f"killed after {moment:.3f} s")
            if len(errors("out")) == 2:
                shutil.rmtree(self.folder / "out")
        self.succeeds("bench", "suite.json", "-o", "out")
        self.assertEqual(errors("out"), errors("whole"))


class Caches(CliTest):
    """Files of the caches of shaders and pipelines, of fovea and of the driver, in each of which a random bit is flipped.
    FOVEA_FLIPS is how often, once unless asked, since each time the driver compiles everything anew."""

    FLIPS = int(os.environ.get("FOVEA_FLIPS", "1"))

    def test_flipped_bits(self):
        """The pictures are the same."""
        command = ["render", "ours", "--scene", "cornellbox", *SMALL, "--set", "shadow_map_size=64", "--set",
                   "vpl_count=32", "--set", "map_size=16", "-q", "-o", "a.exr"]
        environment = {"XDG_CACHE_HOME": str(self.folder / "cache")}
        picture = self.folder / "a.exr"
        self.succeeds(*command, env=environment)
        whole = picture.read_bytes()
        cache = {p: p.read_bytes() for p in (self.folder / "cache").rglob("*") if p.is_file()}
        self.assertGreater(len(cache), 10)
        randomness = random.Random(1)
        for flip in range(self.FLIPS):
            for path, content in cache.items():
                damaged = bytearray(content)
                if damaged:
                    damaged[randomness.randrange(len(damaged))] ^= 1 << randomness.randrange(8)
                path.write_bytes(damaged)
            picture.unlink()
            self.succeeds(*command, env=environment)
            self.assertEqual(picture.read_bytes(), whole, f"flip {flip}")


class FrameLimit(CliTest):
    def test_frame_that_does_not_end(self):
        """The process ends, with what was finished before. The third frame would take minutes."""
        if "llvmpipe" not in self.succeeds("devices").stdout:
            self.skipTest("on a GPU the frame would not take long enough")
        (self.folder / "passes").mkdir()
        self.write("passes/ponder.pass.json", {
            "doc": "thinks for long from the third frame on", "inputs": {"picture": "a picture"},
            "outputs": {"image": {"doc": "it", "format": "rgba8"}},
            "steps": [{"shader": "ponder.frag", "colors": ["image"]}]})
        self.write("passes/ponder.frag", """#version 460
#include "scene/scene.glsl"
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() {
  color = texelFetch(picture, ivec2(gl_FragCoord.xy), 0);
  float x = 0;
  for (uint i = 0; frame.index >= 2 && i < 60000; ++i) x = sin(exp(sin(exp(sin(exp(sin(exp(sin(x + color.x)))))))));
  color.x += 1e-6 * x;
}
""")
        self.write("graph.json", {"extends": "direct.json", "outputs": {"image": "ponder.image"},
                                  "passes": {"ponder": {"type": "ponder", "inputs": {"picture": "tonemap.image"}}}})
        command = ["render", "graph.json", "--scene", "cornellbox", "--size", "512x512", "--set", "shadow_map_size=64",
                   "-o", "a_%d.png", "--frames"]
        self.succeeds(*command, 2, "--frame-limit", 0)
        whole = {p.name: p.read_bytes() for p in self.folder.glob("*.png")}
        for file in whole:
            (self.folder / file).unlink()
        run = self.call(*command, 4, "--frame-limit", 8)
        self.assertEqual(run.returncode, DEVICE_LOST, run.stderr)
        self.assertTrue(run.stderr.startswith("fovea: error: a frame takes longer than 8.0 s\n"), run.stderr)
        self.assertIn("--frame-limit", run.stderr)
        self.assertEqual({p.name: p.read_bytes() for p in self.folder.glob("*a_*")}, whole)


class FaultyInputs(CliTest):
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
