"""Tests that no command loses a file. Usage: outputs_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import os
import shutil
import sys
import threading
import time
import unittest

from program import BAD_INPUT, DIRECT, PROGRAM, SMALL, SOURCE, USAGE, CliTest


class Outputs(CliTest):
    def kept(self, before):
        """Checks that these files have the content that they had."""
        for name, content in before.items():
            self.assertEqual((self.folder / name).read_bytes(), content, name)

    def contents(self):
        return {p.relative_to(self.folder): p.read_bytes() for p in self.folder.rglob("*") if p.is_file()}

    def test_without_the_image_library(self):
        """Who has lost the library behind images is told so before anything is rendered. Other commands do without it."""
        shutil.copy(PROGRAM.parent.parent / "lib" / "libfovea.so.0", self.folder)
        alone = {"LD_LIBRARY_PATH": str(self.folder)}
        run = self.fails(BAD_INPUT, *DIRECT, "-o", "a.png", env=alone,
                         says=("the image library cannot be loaded", "libfovea-images.so", "build fovea again"))
        self.assertNotIn("pass", run.stderr)
        self.succeeds(*DIRECT, "-q", "--timings", "t.json", env=alone)

    def test_pictures_without_a_number(self):
        """They end with an error, also where the file shows what is no number as black; the files are written."""
        (self.folder / "passes").mkdir()
        self.write("passes/broken.frag", "uniform texture2D picture;\nlayout(location = 0) out vec4 image;\n"
                   "void main() { image = texelFetch(picture, ivec2(0), 0) * uintBitsToFloat(0x7fc00000u); }\n")
        self.write("passes/broken.pass.json", {
            "doc": "makes what is no number", "inputs": {"picture": "any"},
            "outputs": {"image": {"doc": "NaN", "format": "rgba16f"}},
            "steps": [{"shader": "broken.frag", "colors": ["image"]}]})
        self.graph(version=2, passes={"broken": {"type": "broken", "inputs": {"picture": "direct"}},
                                      "tonemap": {"inputs": {"radiance": "broken"}}}, outputs={"radiance": "broken"})
        for name in ("a.png", "a.exr"):
            run = self.call("render", "graph.json", "--scene", "cornellbox", *SMALL, "-o", name)
            self.assertEqual(run.returncode, 1, run.stderr)
            self.assertIn("no pixel of the output `radiance` is a number", run.stderr)
            self.assertTrue((self.folder / name).exists())

    def test_one_file_for_two_outputs(self):
        (self.folder / "sub").mkdir()
        os.symlink("a.png", self.folder / "link.png")
        for outputs in (["-o", "a.png", "-o", "./a.png"], ["-o", "a.png", "-o", "sub/../a.png"],
                        ["-o", "a.png", "-o", "image=a.png"], ["-o", "a.png", "-o", "link.png"],
                        ["--timings", "t.json", "--trace", "t.json"], ["-o", "a_%d.png", "-o", "a_7.png"],
                        ["-o", "a_%d.png", "-o", "image=a_%04d.png"]):
            with self.subTest(outputs=outputs):
                self.fails(USAGE, *DIRECT, *outputs, says=["two outputs", outputs[-1].split("=")[-1][0]])
        self.succeeds(*DIRECT, "-q", "-o", "a_%d.png", "-o", "b_%d.png", "-o", "a_%d.exr", "--frames", "2")

    def test_inputs_of_render(self):
        self.graph()
        self.write("gaze.csv", "t,x,y,valid\n0,0.5,0.5,1\n")
        self.write("scene.json", {"models": [{"file": "box/cornellbox.gltf"}]})
        self.succeeds("scene", "export", "cornellbox", "-o", "box")
        self.succeeds("render", "direct", "--scene", "cornellbox", "--size", "64x32", "-q", "-o", "radiance=sky_0003.exr")
        before = self.contents()
        command = ["render", "graph.json", "--scene", "scene.json", "--gaze-trace", "gaze.csv", "--environment",
                   "sky_0003.exr", *SMALL]
        for output in (["--trace", "graph.json"], ["--trace", "./scene.json"], ["--timings", "gaze.csv"],
                       ["--trace", "box/cornellbox.bin"], ["-o", "sky_0003.exr"], ["-o", "sky_%04d.exr"]):
            with self.subTest(output=output):
                self.fails(USAGE, *command, *output, says=["would replace", "input of this command"])
                self.kept(before)

    def test_shader_of_a_pass(self):
        shutil.copytree(SOURCE / "samples/own_pass/files", self.folder / "own")
        before = self.contents()
        self.fails(USAGE, "render", "own/outlined.json", "--scene", "cornellbox", *SMALL, "--trace",
                   "own/passes/outline.frag", says=["outline.frag"])
        self.kept(before)

    def test_error_picture(self):
        self.succeeds(*DIRECT, "-q", "-o", "a.exr", "-o", "b.exr")
        os.symlink("b.exr", self.folder / "link.exr")
        before = self.contents()
        for name in ("a.exr", "b.exr", "./b.exr", "link.exr"):
            self.fails(USAGE, "compare", "a.exr", "b.exr", "--error-image", name, says=[name])
            self.kept(before)

    def test_baseline(self):
        command = ["bench", "passes", "--graph", "direct", "--scene", "cornellbox", "--size", "16x16", "--repeats", "1",
                   "--frames", "1", "-q"]
        self.succeeds(*command, "-o", "base.json")
        self.fails(USAGE, *command, "--baseline", "base.json", "-o", "base.json", says=["base.json"])

    def test_export_beside_the_model(self):
        self.succeeds("scene", "export", "cornellbox", "-o", "box")
        before = self.contents()
        for scene in ("box/cornellbox.gltf", "box/cornellbox.json"):
            for form in ("gltf", "mitsuba"):
                for folder in ("box", "./box/../box"):
                    with self.subTest(scene=scene, form=form):
                        self.fails(USAGE, "scene", "export", scene, "-o", folder, "--format", form, says=["box"])
                        self.kept(before)
        self.succeeds("scene", "export", "box/cornellbox.json", "-o", "again")

    def test_links_are_followed(self):
        (self.folder / "real").mkdir()
        self.write("real/old.png", "old")
        os.symlink("real/old.png", self.folder / "old.png")
        os.symlink("real/new.json", self.folder / "new.json")  # leads to nothing yet
        self.succeeds(*DIRECT, "-q", "-o", "old.png", "--timings", "new.json")
        self.assertTrue((self.folder / "old.png").is_symlink() and (self.folder / "new.json").is_symlink())
        self.assertEqual((self.folder / "real/old.png").read_bytes()[:4], b"\x89PNG")
        self.assertIn("frames", json.loads((self.folder / "real/new.json").read_text()))
        self.assertEqual({p.name for p in (self.folder / "real").iterdir()}, {"old.png", "new.json"})

    def test_pipes_and_devices_get_the_content(self):
        for name in ("pipe.png", "pipe.json"):
            os.mkfifo(self.folder / name)
        got = {}
        def read(name):
            got[name] = (self.folder / name).read_bytes()
        readers = [threading.Thread(target=read, args=[name], daemon=True) for name in ("pipe.png", "pipe.json")]
        for reader in readers:
            reader.start()
        self.succeeds(*DIRECT, "-q", "-o", "pipe.png", "--timings", "pipe.json")
        for reader in readers:
            reader.join(20)
        self.assertEqual(got["pipe.png"][:4], b"\x89PNG")
        self.assertIn("frames", json.loads(got["pipe.json"]))
        self.assertTrue((self.folder / "pipe.png").is_fifo())
        self.assertIn("traceEvents", json.loads(self.succeeds(*DIRECT, "-q", "--trace", "/dev/stdout").stdout))
        self.succeeds(*DIRECT, "-q", "--trace", "/dev/null")

    def test_pipes_are_no_inputs(self):
        for name in ("pipe.exr", "pipe.so", "pipe.json", "pipe.csv", "pipe.gltf"):
            os.mkfifo(self.folder / name)
        self.succeeds(*DIRECT, "-q", "-o", "a.exr")
        for command in (["compare", "a.exr", "pipe.exr"], [*DIRECT, "--plugin", "pipe.so"], ["passes", "--plugin", "pipe.so"],
                        [*DIRECT, "--gaze-trace", "pipe.csv"], [*DIRECT, "--environment", "pipe.exr"],
                        ["scene", "info", "pipe.gltf"], ["scene", "info", "pipe.json"], ["bench", "pipe.json", "--list"]):
            with self.subTest(command=command):
                self.fails(3, *command, says=["regular file"])

    def test_two_runs_give_the_same_bytes(self):
        self.succeeds(*DIRECT, "-q", "-o", "a.exr", "-o", "a.png", "-o", "a.pfm")
        time.sleep(1.1)  # the clock in a file would have seconds
        self.succeeds(*DIRECT, "-q", "-o", "b.exr", "-o", "b.png", "-o", "b.pfm")
        for form in ("exr", "png", "pfm"):
            self.assertEqual(*((self.folder / f"{name}.{form}").read_bytes() for name in "ab"), form)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
