"""Files that are saved while `fovea view` runs.

Usage: reload_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import pathlib
import re
import sys
import time
import unittest

from viewer import SOURCE, ViewTest


class Reload(ViewTest):
    PASS = {"doc": "Shows one colour.", "outputs": {"image": {"doc": "the colour", "format": "rgba8"}},
            "params": {"level": {"doc": "of red", "default": 1.0, "min": 0, "max": 1}},
            "steps": [{"shader": "plain.frag", "colors": ["image"]}]}
    SHADER = """layout(push_constant) uniform Constants { float level; };
layout(location = 0) out vec4 image;
void main() { image = vec4(level, COLOUR, 1.0); }
"""

    def plain(self):
        (self.folder / "passes").mkdir()
        self.write("passes/plain.pass.json", self.PASS)
        self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "0.0, 0.0"))
        return self.write("plain.json", {"passes": {"plain": {"type": "plain"}}, "outputs": {"image": "plain"}})

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

    def test_many_reloads_leave_memory_flat(self):
        viewer = self.view(self.plain(), size="64x64")
        self.open(viewer)

        def resident():
            status = pathlib.Path(f"/proc/{viewer.process.pid}/status").read_text()
            return int(re.search(r"VmRSS:\s*(\d+)", status).group(1))

        def reload(i):
            # A new shader, a wrong one, and the graph, in turns; the level tells the builds apart.
            build = viewer.state()["build"]
            if i % 2:
                self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "wrong"))
            else:
                self.write("passes/plain.frag", self.SHADER.replace("COLOUR", f"{i % 7}.0 / 7.0, 0.0"))
            self.wait(lambda: viewer.state()["build"] > build, "a reload")

        for i in range(20):
            reload(i)
        before = resident()
        for i in range(60):
            reload(i)
        self.assertLess(resident(), 1.05 * before + 4096)


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
