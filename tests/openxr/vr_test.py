"""Tests `fovea vr` against a runtime that follows a script, under the validation layers of OpenXR and Vulkan.

Usage: FOVEA_TEST_RUNTIME=runtime.json vr_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from program import BAD_INPUT, CANNOT_WRITE, NO_DEVICE, USAGE, CliTest  # noqa: E402

LOST = 6
LAYER = pathlib.Path("/usr/share/openxr/1/api_layers/explicit.d/XrApiLayer_core_validation.x86_64-linux-gnu.json")
# Results of OpenXR.
TIMEOUT_EXPIRED, RUNTIME_FAILURE, INSTANCE_LOST, SESSION_LOST = 1, -2, -13, -17

EYES = [{"size": [48, 32], "position": [-0.032, 0, 0], "fov": [-0.9, 0.7, 0.75, -0.8]},
        {"size": [48, 32], "position": [0.032, 0, 0], "fov": [-0.7, 0.9, 0.75, -0.8]}]


def turned(degrees):
    """A rotation about the vertical: x, y, z, w."""
    return [0, math.sin(math.radians(degrees) / 2), 0, math.cos(math.radians(degrees) / 2)]


# A head that walks and turns, canted eyes of different sizes of field, a gaze that jumps and blinks, and thumbsticks.
WALK = {"views": [{**EYES[0], "orientation": turned(5)}, {**EYES[1], "orientation": turned(-5), "position": [0.033, 0.002, 0]}],
        "head": [{"time": 0, "position": [0, 0, 0]},
                 {"time": 0.1, "position": [0.2, 0.05, -0.3], "orientation": turned(30)}],
        "gaze": [{"time": -1, "angles": [0.1, -0.05]}, {"time": 0.03}, {"time": 0.05, "angles": [-0.3, 0.1]}],
        "sticks": [{"time": 0}, {"time": 0.04, "walk": [0.3, 1], "turn": [0.5, 0.2]}]}


class VrTest(CliTest):
    graph = "stereo"

    def environment(self, script):
        script = {"views": EYES, **script}
        (self.folder / "out").mkdir(exist_ok=True)
        env = {"XR_RUNTIME_JSON": os.environ["FOVEA_TEST_RUNTIME"], "FOVEA_XR_SCRIPT": str(self.write("script.json", script)),
               "FOVEA_XR_OUTPUT": str(self.folder / "out")}
        if LAYER.exists():
            env |= {"XR_ENABLE_API_LAYERS": "XR_APILAYER_LUNARG_core_validation", "XR_CORE_VALIDATION_EXPORT_TYPE": "text",
                    "XR_CORE_VALIDATION_FILE_NAME": str(self.folder / "layer.txt")}
        return env

    def vr(self, script, *more, code=0, graph=None):
        """Runs it and checks the exit code, that both layers are silent and that no call was wrong."""
        run = self.call("vr", graph or self.graph, "--scene", "cornellbox", "--validation", *more,
                        env=self.environment(script))
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        log = self.folder / "out" / "log.json"
        self.log = json.loads(log.read_text()) if log.exists() else None
        if self.log:
            self.assertEqual(self.log["violations"], [])
        layer = self.folder / "layer.txt"
        if layer.exists():
            self.assertNotIn("VUID", layer.read_text())
        return run

    def shown(self):
        return [frame for frame in self.log["frames"] if frame["views"]]

    def lost(self, script, says):
        run = self.vr(script, "--frames", "8", code=LOST)
        self.assertIn(says, run.stderr)
        self.assertNotIn("defect", run.stderr)

    def frames(self):
        with open(self.folder / "frames.csv", newline="") as file:
            return list(csv.DictReader(file))


class VrPictures(VrTest):
    def replayed(self, graph, walk=WALK, outputs=("image", "image_right"), more=()):
        """What the headset was shown is what `render` makes of the recording, to the bit."""
        self.vr(walk, "--frames", "6", "--record", "walk.csv", "--log", "frames.csv", graph=graph)
        self.assertEqual(len(self.shown()), 6)
        files = [argument for output in outputs for argument in ("-o", f"{output}={output}_%d.png")]
        self.succeeds("render", graph, "--scene", "cornellbox", "--size", "48x32", *more, "--head-trace", "walk.csv",
                      "--frames", "6", *files, "--quiet")
        different = set()
        for frame in range(6):
            for view, name in enumerate(outputs):
                shown = (self.folder / f"out/frame_{frame:05d}_view{view}.ppm").read_bytes()
                ppm = self.folder / f"{name}_{frame}.ppm"
                subprocess.run(["oiiotool", f"{name}_{frame}.png", "--ch", "R,G,B", "-o", ppm.name], cwd=self.folder,
                               check=True, capture_output=True)
                self.assertEqual(shown, ppm.read_bytes(), f"{graph} {name} {frame}")
                different.add(shown)
        self.assertEqual(len(different), 6 * len(outputs))  # nothing stands still

    def test_stereo(self):
        self.replayed("stereo")

    def test_foveal_stereo(self):
        self.replayed("foveal_stereo")

    def test_foveal_stereo_view(self):
        self.replayed("foveal_stereo_view")

    def test_foveal_quad(self):
        """Insets with other sizes and fields than the pictures around them."""
        insets = [{**eye, "size": [40, 28], "fov": [-0.4, 0.35, 0.3, -0.3]} for eye in WALK["views"]]
        self.replayed("foveal_quad", {**WALK, "views": WALK["views"] + insets},
                      ("image", "image_right", "image_inset", "image_right_inset"), ("--inset", "40x28"))

    def test_graphs_for_other_displays(self):
        self.assertIn("no insets", self.vr({}, graph="foveal_quad", code=NO_DEVICE).stderr)
        self.assertIn("two eyes", self.vr({"views": 2 * EYES}, graph="stereo", code=NO_DEVICE).stderr)

    def test_gaze(self):
        self.vr(WALK, "--frames", "8", "--log", "frames.csv")
        rows = self.frames()
        self.assertEqual([row["gaze"] for row in rows], list("11001111"))
        for row in rows:
            self.assertEqual(row["gaze_to_display_ms"], "8.0000" if row["gaze"] == "1" else "")
            self.assertEqual(row["missed"], "0")

    def test_trackers_that_are_not_there(self):
        self.vr({**WALK, "without": ["XR_EXT_eye_gaze_interaction", "XR_KHR_convert_timespec_time"]}, "--frames", "3",
                "--log", "frames.csv", "--record", "walk.csv")
        self.assertEqual([row["gaze"] + row["gaze_to_submit_ms"] for row in self.frames()], ["0"] * 3)
        rows = [line for line in (self.folder / "walk.csv").read_text().splitlines() if not line.startswith("#")]
        for row in csv.DictReader(rows):  # straight ahead of the head, which is 5 degrees inward for each eye
            self.assertNotEqual(row["left.gaze_x"], "0.5")
            self.assertLess(float(row["right.gaze_x"]), float(row["left.gaze_x"]))

    def test_room(self):
        self.vr({}, "--frames", "1", "--floor", "0", "--scale", "2", "--record", "walk.csv")
        lines = (self.folder / "walk.csv").read_text().splitlines()
        row = dict(zip(lines[1].split(","), map(float, lines[2].split(","))))
        self.assertAlmostEqual(row["head.y"], 3.2, places=5)  # the runtime's head is 1.6 m above its floor
        self.assertAlmostEqual(row["right.x"] - row["left.x"], 0.128, places=5)

    def test_size(self):
        self.vr({}, "--frames", "1", "--resolution", "0.5")
        self.assertTrue((self.folder / "out/frame_00000_view0.ppm").read_bytes().startswith(b"P6\n24 16\n"))
        self.vr({}, "--frames", "1", "--size", "20x10")
        self.assertTrue((self.folder / "out/frame_00000_view1.ppm").read_bytes().startswith(b"P6\n20 10\n"))


class VrFaults(VrTest):
    def test_focus(self):
        self.vr({"frames": 10, "events": [{"frame": 3, "what": "unfocus"}, {"frame": 5, "what": "hide"},
                                          {"frame": 7, "what": "focus"}]})
        rendered = [frame["rendered"] for frame in self.log["frames"]]
        self.assertEqual(rendered[:9], [False, True, True, True, True, False, False, True, True])
        self.assertEqual(len(self.shown()), 10)

    def test_restart(self):
        self.vr({"events": [{"frame": 3, "what": "stop"}]}, "--frames", "8")
        self.assertEqual(len(self.shown()), 8)

    def test_end_by_the_runtime(self):
        self.vr({"events": [{"frame": 4, "what": "exit"}]}, "--log", "frames.csv")
        self.assertEqual(len(self.frames()), len(self.shown()))

    def test_losses(self):
        self.lost({"events": [{"frame": 3, "what": "lose_session"}]}, "gone away")
        self.lost({"events": [{"frame": 3, "what": "lose_instance"}]}, "gone away")
        for function, result, says in (("xrEndFrame", SESSION_LOST, "SESSION_LOST"), ("xrWaitFrame", RUNTIME_FAILURE, "RUNTIME_F"),
                                       ("xrLocateViews", INSTANCE_LOST, "INSTANCE_LOST"), ("xrBeginFrame", SESSION_LOST, "LOST"),
                                       ("xrSyncActions", SESSION_LOST, "LOST"), ("xrPollEvent", INSTANCE_LOST, "LOST"),
                                       ("xrAcquireSwapchainImage", RUNTIME_FAILURE, "RUNTIME_F")):
            with self.subTest(function):
                self.lost({"events": [{"frame": 3, "what": "fail", "function": function, "result": result}]}, says)

    def test_images_that_come_late(self):
        late = {"frame": 3, "what": "fail", "function": "xrWaitSwapchainImage", "result": TIMEOUT_EXPIRED}
        self.vr({"events": [{**late, "count": 5}]}, "--frames", "4")
        self.lost({"events": [{**late, "count": 10**6}]}, "within 10 seconds")

    def test_heads_that_are_not_tracked(self):
        self.vr({"events": [{"frame": 3, "what": "untracked"}]}, "--frames", "4", "--log", "frames.csv")
        self.assertEqual([len(frame["views"]) for frame in self.log["frames"]][:6], [0, 2, 2, 0, 2, 2])
        self.assertEqual([row["missed"] for row in self.frames()], list("0010"))

    def test_missed_frames(self):
        self.vr({"events": [{"frame": 3, "what": "miss"}]}, "--frames", "4", "--log", "frames.csv")
        self.assertEqual([row["missed"] for row in self.frames()], list("0010"))

    def test_nothing_to_show_on(self):
        for script, says in (({"headset": False}, "headset"), ({"without": ["XR_KHR_vulkan_enable2"]}, "XR_KHR_vulkan_enable2"),
                             ({"formats": [37]}, "VK_FORMAT_R8G8B8A8_SRGB")):
            run = self.vr(script, code=NO_DEVICE)
            self.assertIn(says, run.stderr)
        run = self.call("vr", "stereo", "--scene", "cornellbox", env={"XR_RUNTIME_JSON": str(self.folder / "none.json")})
        self.assertEqual(run.returncode, NO_DEVICE, run.stderr)
        self.assertIn("XR_RUNTIME_JSON", run.stderr)

    def test_wrong_input(self):
        self.assertIn("foveal_stereo", self.vr({}, graph="direct", code=USAGE).stderr)
        self.vr({}, "--set", "nothing=1", code=BAD_INPUT)
        self.vr({}, "--record", "nowhere/walk.csv", code=CANNOT_WRITE)
        self.write("mine.json", {"extends": "stereo.json"})
        self.assertIn("mine.json", self.vr({}, "--log", "mine.json", "--frames", "1", graph="mine.json", code=USAGE).stderr)
        self.vr({}, "--log", "a.csv", "--record", "a.csv", "--frames", "1", code=USAGE)
        for option in ("scale", "floor", "fly-speed", "speed", "frames", "seed", "resolution", "frame-limit"):
            for value in ("nan", "inf", "0x10", "+1", "01", "", "1e99"):
                self.assertIn(f"--{option}", self.vr({}, f"--{option}={value}", code=USAGE).stderr)

    def test_interrupt(self):
        command = self.command("vr", "stereo", "--scene", "cornellbox", "--log", "frames.csv")
        run = subprocess.Popen(command, cwd=self.folder, env={**os.environ, **self.environment({"pictures_every": 0})},
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for line in run.stdout:
            if "an eye, in" in line:
                break
        time.sleep(1)
        run.send_signal(signal.SIGINT)
        out, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 0, err)
        self.assertIn("frames shown", out)
        self.assertGreater(len(self.frames()), 0)


class VrMemory(VrTest):
    def peak(self, frames):
        """Of the memory of a run, in bytes."""
        small = [word for value in ("vpl_count=64", "attempts=200", "voxels=16", "map_size=16", "shadow_map_size=128")
                 for word in ("--set", value)]
        run = subprocess.Popen(self.command("vr", "stereo", "--scene", "cornellbox", *small, "--frames", frames), cwd=self.folder,
                               env={**os.environ, **self.environment({"pictures_every": 0, "events": [
                                   {"frame": f, "what": what} for f in range(20, frames, 20) for what in ("unfocus", "focus")]})},
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(run.returncode, 0)
        return 1024 * usage.ru_maxrss

    def test_flat(self):
        frames = int(os.environ.get("FOVEA_VR_FRAMES", 300))
        few, many = self.peak(50), self.peak(frames)
        self.assertLess(many - few, 4e6 + 1000 * frames, f"{few} and {many} bytes")


if __name__ == "__main__":
    if not os.environ.get("FOVEA_TEST_RUNTIME"):
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
