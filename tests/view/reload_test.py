"""Files that are saved while `fovea view` runs.

Usage: reload_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import shutil
import struct
import sys
import time
import unittest

from viewer import PROGRAM, PlainGraph, SOAK, SOURCE, ViewTest


class Reload(ViewTest, PlainGraph):
    def colour(self):
        return self.script("const c = document.getElementById('canvas');"
                           "return [...c.getContext('2d').getImageData(9, 9, 1, 1).data].slice(0, 3)"
                           ".map((v) => Math.round(v / 51))")

    def errors(self):
        return self.script("return [...document.querySelectorAll('.message.error')].map((e) => e.innerText).join(' ')")

    def test_shader_pass_and_graph_show_at_once_and_mistakes_are_located(self):
        viewer = self.view(self.plain(), size="64x64")
        self.open(viewer)
        self.wait(lambda: self.colour() == [5, 0, 0], "red")
        # A shader.
        start = time.monotonic()
        self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "1.0, 0.0"))
        self.wait(lambda: self.colour() == [5, 5, 0], "yellow")
        self.assertLess(time.monotonic() - start, 5)  # a second, on a machine that does nothing else
        # A mistake in it: file, line and the line itself are told, and the last picture goes on.
        self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "nothing, 0.0"))
        text = self.wait(lambda: "nothing" in self.errors() and self.errors(), "the mistake")
        self.assertIn("plain.frag:3", text)
        self.assertIn("image = vec4(level, nothing", text)
        frame = self.shown_frame()
        self.wait(lambda: self.shown_frame() > frame + 2, "the last good graph")
        self.assertEqual(self.colour(), [5, 5, 0])
        self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "0.0, 1.0"))
        self.wait(lambda: self.colour() == [5, 0, 1 * 5] and not self.errors(), "magenta, and no message")
        # A binding that is no port, which some passes notice only when they are recorded.
        self.write("passes/plain.frag", "uniform texture2D elsewhere;\n" +
                   self.SHADER.replace("COLOUR", "texelFetch(elsewhere, ivec2(0), 0).xy"))
        self.wait(lambda: "elsewhere" in self.errors(), "the missing port")
        self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "0.0, 1.0"))
        self.wait(lambda: self.colour() == [5, 0, 5] and not self.errors(), "magenta again")
        # The declaration.
        changed = json.loads(json.dumps(self.PASS))
        changed["params"]["level"]["default"] = 0.0
        self.write("passes/plain.pass.json", changed)
        self.wait(lambda: self.colour() == [0, 0, 5], "blue")
        self.write("passes/plain.pass.json", '{"doc": "Shows one colour.", "outpts": {}}')
        self.wait(lambda: "outpts" in self.errors(), "the mistake in the declaration")
        self.write("passes/plain.pass.json", changed)
        self.wait(lambda: not self.errors(), "no message")
        # The graph.
        good = {"passes": {"plain": {"type": "plain", "params": {"level": 0.6}}}, "outputs": {"image": "plain"}}
        self.write("plain.json", good)
        self.wait(lambda: self.colour() == [3, 0, 5], "some red")
        self.write("plain.json", '{\n  "passes": { "plain": { "type": "plan" } }, "outputs": { "image": "plain" } }')
        text = self.wait(lambda: "plan" in self.errors() and self.errors(), "the mistake in the graph")
        self.assertIn("plain.json:2:", text)
        self.assertIn("did you mean", text)
        # Bytes that are no text.
        (self.folder / "plain.json").write_bytes(b'{ "passes": "\xff\xfe" }')
        self.wait(lambda: self.errors(), "a message")
        self.write("plain.json", good)
        self.wait(lambda: not self.errors(), "no message")

    def test_changes_show_in_the_next_frame_but_one_and_graphs_within_a_second(self):
        viewer = self.view(self.plain(), size="256x256")
        red = lambda: (viewer.pixels("image", 9, 9, after=viewer.number), viewer.pixels("image", 9, 9))[1]
        self.wait(lambda: red()[2][0] > 0, "the first picture")
        delays = []
        for i in range(10):
            level = 0.25 + 0.5 * (i % 2)
            before = red()[0]
            viewer.control(set={"plain.level": level})
            shown = round(255 * level) / 255
            seen = []
            while not seen or abs(struct.unpack("<f", struct.pack("<I", seen[-1][1]))[0] - shown) > 1e-3:
                frame, _, words = viewer.pixels("image", 9, 9, after=viewer.number)
                seen.append((frame, words[0]))
                self.assertLess(len(seen), 50)
            delays.append(seen[-1][0] - before)
        # `before` may be followed by a frame that is already under way when the command arrives.
        self.assertLessEqual(sorted(delays)[len(delays) // 2], 2, delays)
        start = time.monotonic()
        viewer.control(graph="direct")
        self.wait(lambda: viewer.state()["graph_name"] == "direct" and viewer.pixels("image"), "another graph")
        seconds = time.monotonic() - start
        if SOAK:
            print(f"parameters: {delays} frames later; another graph: {seconds:.2f} s", file=sys.stderr)
        self.assertLess(seconds, 1 if SOAK else 10)  # a second, on a machine that does nothing else

    def test_what_a_graph_extends_and_the_scene_are_watched(self):
        self.write("base.json", {"extends": "direct.json"})
        graph = self.write("mine.json", {"extends": "base.json"})
        scene = self.write("room.json",
                           json.loads((SOURCE / "samples/scenes/cornellbox_walk.json").read_text()))
        viewer = self.view(graph, scene=scene, size="64x64")
        self.open(viewer)
        self.write("base.json", {"extends": "direct.json", "passes": {"tonemap": {"params": {"exposure": 3}}}})
        self.wait(lambda: any(p["name"] == "exposure" and p["value"] == 3 for q in viewer.state()["graph"]["passes"]
                              for p in q["parameters"]), "the base")
        build = viewer.state()["build"]
        changed = json.loads(scene.read_text())
        changed["exposure"] = 0.01
        before = sum(self.canvas())
        self.write("base.json", {"extends": "direct.json"})
        self.write("room.json", changed)
        self.wait(lambda: viewer.state()["build"] > build and sum(self.canvas()) < 0.7 * before, "a darker scene")

    def test_a_plug_in_is_loaded_anew(self):
        plugins = PROGRAM.parent.parent / "tests/plugins"

        def install(name):
            # As a linker does: the old file goes, and the new one is written in its place.
            (self.folder / "grey.so").unlink(missing_ok=True)
            if isinstance(name, bytes):
                (self.folder / "grey.so").write_bytes(name)
            else:
                shutil.copy(plugins / f"{name}.so", self.folder / "grey.so")

        install("grey_60_plugin")
        graph = self.write("mine.json", {"passes": {"grey": {"type": "grey"}}, "outputs": {"image": "grey"}})
        viewer = self.view(graph, "--plugin", "grey.so", size="64x64")
        self.open(viewer)
        level = lambda: self.canvas()[0]
        self.wait(lambda: abs(level() - 60) < 3, "the first state")
        viewer.control(camera={"position": [1, 2, 3], "yaw": 0.5, "pitch": 0.25}, gaze=[0.25, 0.75],
                       set={"grey.share": 0.5}, playing=False, speed=2)
        self.wait(lambda: abs(level() - 30) < 3, "the parameter")
        tick = lambda: self.script("return import('./store.js').then((m) => m.store.tick)")
        before = self.wait(lambda: (now := tick())["camera"]["own"] and not now["playing"] and now, "the camera")
        install("grey_200_plugin")
        self.wait(lambda: abs(level() - 100) < 3, "the second state")  # the page goes on under its address
        after = self.wait(lambda: (now := tick())["camera"]["own"] and now, "the camera again")
        for name in ("camera", "gaze", "time", "speed", "playing"):
            self.assertEqual(after[name], before[name], name)
        self.assertEqual(viewer.state()["set"], ["grey.share=0.5"])
        # What cannot be used is told, and the last state goes on.
        for broken, says in ((b"no library", "grey.so"), ("broken_declaration_plugin", "contradiction"),
                             ("other_version_plugin", "0.0.7")):
            install(broken)
            text = self.wait(lambda: says in self.errors() and self.errors(), f"a message about {says}")
            frame = self.shown_frame()
            self.wait(lambda: self.shown_frame() > frame + 2, "frames that go on")
        self.assertIn("what was loaded before goes on", text)
        install("grey_60_plugin")
        self.wait(lambda: abs(level() - 30) < 3 and not self.errors(), "the first state again")
        self.assertEqual(viewer.process.poll(), None)
        # The browser tells of the moments in which nobody answered.
        self.driver.get_log("browser")


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
