"""Tests the command line, inputs and lists of the program: exit codes and messages. Usage: cli_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import base64
import json
import re
import struct
import sys
import unittest

from program import BAD_INPUT, DIRECT, NO_DEVICE, OUT_OF_MEMORY, SMALL, SOURCE, USAGE, CliTest


class Usage(CliTest):
    def test_command_is_needed(self):
        self.fails(USAGE, says=["--help"])
        self.fails(USAGE, "rendre", "direct", says=["`rendre`", "`render`"])

    def test_help_and_version(self):
        self.assertIn("Exit codes", self.succeeds("--help").stdout)
        self.assertIn("--gaze", self.succeeds("render", "--help").stdout)
        self.assertRegex(self.succeeds("--version").stdout, r"fovea \d+\.\d+\.\d+")

    def test_unknown_option(self):
        self.fails(USAGE, *DIRECT, "--sizes", "4x4", says=["--sizes", "fovea render --help"])
        self.fails(USAGE, "render", "direct", says=["--scene"])

    def test_sizes(self):
        for size in ("0x0", "0x16", "100000x100000", "16385x16", "99999999999999999999x1"):
            with self.subTest(size=size):
                run = self.fails(USAGE, *DIRECT[:4], "--size", size, says=[size])
                self.assertIn("16384" if len(size) < 20 else "WIDTHxHEIGHT", run.stderr)
        for size in ("12", "x", "12x", "x12", "-4x4", "1e2x4", "4x4x4", "4 x 4", ""):
            with self.subTest(size=size):
                self.fails(USAGE, *DIRECT[:4], "--size=" + size)

    def test_numbers(self):
        for arguments in (["--frames", "0"], ["--frames", "-1"], ["--frames", "many"], ["--warmup", "-1"],
                          ["--seed", "-1"], ["--seed", "1.5"], ["--seed", "4294967296"], ["--first", "-1"]):
            with self.subTest(arguments=arguments):
                self.fails(USAGE, *DIRECT, *arguments, says=[arguments[0]])

    def test_every_number_has_one_spelling(self):
        """CLI11's own checks let NaN pass, and read 0x10 as 16 and 010 as 8."""
        commands = {
            "render": [*DIRECT, "--gaze-trace", "none.csv"], "view": ["view", "direct", "--scene", "cornellbox"],
            "bench": ["bench", "quick"], "compare": ["compare", "a.pfm", "b.pfm"],
            "compare-sequence": ["compare-sequence", "a", "b"],
            "export": ["scene", "export", "cornellbox", "-o", "out"]}
        options = {
            "render": ["frames", "warmup", "first", "seed", "capture", "gaze-gap", "fovea-radius", "fovea-degrees",
                       "pixels-per-degree", "jitter", "frame-limit"],
            "view": ["frames", "seed", "port", "frame-limit", "fovea-degrees"],
            "bench": ["seeds", "frames", "warmup", "first", "repeats", "threshold", "frame-limit", "shard"],
            "compare": ["radius", "exposure", "error-scale", "ppd"], "compare-sequence": ["radius", "exposure"],
            "export": ["time", "frame", "spp", "depth"]}
        for command, names in options.items():
            for name in names:
                for value in ("nan", "-nan", "NAN", "inf", "-inf", "1e999", "0x10", "1 ", " 1", "1s", "+1", "01", "1,5",
                              "", "--1"):
                    with self.subTest(command=command, option=name, value=value):
                        self.fails(USAGE, *commands[command], f"--{name}={value}", says=[f"--{name}"])
            texts = self.succeeds(commands[command][0], *(["export"] if command == "export" else []), "--help").stdout
            numbers = set(re.findall(r"--([a-z-]+) (?:N|S|MS|P|X|R|E|T)(?=\s)", texts)) - {"set"}
            self.assertLessEqual(numbers, set(names) | set(options["render"]), "an option is not tested")
        self.assertIn("from 0 to 60", self.fails(USAGE, *DIRECT, "--fovea-degrees", "nan").stderr)
        self.assertIn("from 1 to 10000000", self.fails(USAGE, *DIRECT, "--frames", "0x10").stderr)
        self.fails(USAGE, *DIRECT, "--frames", "1.5", says=["whole number"])
        self.succeeds(*DIRECT, "--frames", "1e0", "--seed", "4294967295", "-o", "a.png")

    def test_gaze(self):
        for gaze in ("0.5", "2,0", "-0.1,0.5", "nan,0", "0.5,0.5,0.5", "a,b", ","):
            with self.subTest(gaze=gaze):
                self.fails(USAGE, *DIRECT, "--gaze=" + gaze, says=["0 to 1"])

    def test_lens(self):
        for lens in ("55", "55,45,50", "55,45,50,90", "55,45,50,0", "55,45,50,nan", "a,b,c,d", "55,45,50,52,"):
            with self.subTest(lens=lens):
                self.fails(USAGE, *DIRECT, "--lens=" + lens, says=["1 to 80"])
        self.fails(USAGE, *DIRECT, "--lens", "55,45,50,52", says=["direct", "no eyes"])

    def test_gaze_trace(self):
        self.fails(USAGE, *DIRECT, "--gaze-trace", "g.csv", "--gaze", "0.5,0.5", says=["--gaze"])
        self.fails(USAGE, *DIRECT, "--gaze-gap", "20", says=["--gaze-trace"])
        self.fails(BAD_INPUT, *DIRECT, "--gaze-trace", "none.csv", says=["none.csv"])
        self.write("g.csv", "t,x,y,valid\n0,0.5,0.5,1\nrubbish\n0.2,0.5,7,1\n")
        self.fails(BAD_INPUT, *DIRECT, "--gaze-trace", "g.csv", says=["g.csv:3", "g.csv:4"])

    def test_head_trace(self):
        head = "t,head.x,head.y,head.z,head.qx,head.qy,head.qz,head.qw\n"
        self.write("h.csv", head + "0,0,1,3,0,0,0,1\n0.1,0,1,2.5,0,0,0,1\n")
        for option in ("--gaze=0.5,0.5", "--gaze-trace=g.csv"):
            self.fails(USAGE, *DIRECT, "--head-trace", "h.csv", option, says=["--head-trace"])
        self.fails(BAD_INPUT, *DIRECT, "--head-trace", "none.csv", says=["none.csv"])
        self.fails(USAGE, *DIRECT, "--head-trace", "h.csv", "--frames", "3", says=["h.csv has 2 frames", "number 2"])
        self.succeeds(*DIRECT, "--head-trace", "h.csv", "--frames", "2", "-o", "walk.png")
        self.succeeds(*DIRECT, "--head-trace", "h.csv", "--first", "1", "-o", "late.png")
        self.assertEqual((self.folder / "walk.png").read_bytes(), (self.folder / "late.png").read_bytes())
        self.write("w.csv", head + "0,0,1,3,0,0,0,1\n0.1,0,1,2.5,0,0,0,3\n")
        self.fails(BAD_INPUT, *DIRECT, "--head-trace", "w.csv", says=["w.csv:3", "head.qw"])

    def test_fovea_degrees(self):
        self.fails(USAGE, *DIRECT, "--fovea-degrees", "61", says=["--fovea-degrees", "0 to 60"])
        self.fails(USAGE, *DIRECT, "--materials", "shiny", says=["--materials", "full"])
        self.fails(BAD_INPUT, *DIRECT, "--set", "materials=full", says=["belongs to the frame", "view.materials=full"])

    def test_output_names(self):
        self.fails(USAGE, *DIRECT, "-o", "picture", says=["picture", "png"])
        self.fails(USAGE, *DIRECT, "-o", "picture.txt", says=["exr"])
        self.fails(USAGE, *DIRECT, "-o", "a.png", "-o", "a.png", says=["`a.png`", "two outputs"])
        for name in ("a_%s.png", "a_%.png", "%d_%d.png", "a_%4d.png", "a_%0999d.png"):
            with self.subTest(name=name):
                self.fails(USAGE, *DIRECT, "-o", name, says=["%04d"])
        self.fails(USAGE, *DIRECT, "--timings", "times.txt", says=[".csv"])

    def test_set_without_value(self):
        self.fails(USAGE, *DIRECT, "--set", "shadow_map_size", says=["shadow_map_size"])


class Inputs(CliTest):
    def test_missing_graph(self):
        self.fails(BAD_INPUT, "render", "no_such_graph", "--scene", "cornellbox", says=["no_such_graph"])
        self.fails(BAD_INPUT, "check", "no/such/graph.json", says=["no/such/graph.json"])

    def test_broken_json_names_the_place(self):
        self.write("graph.json", '{\n  "passes": {\n    "a": ,\n  }\n}\n')
        self.fails(BAD_INPUT, "check", "graph.json", says=["graph.json:3:"])

    def test_files_as_windows_saves_them(self):
        """With a byte-order mark and CRLF."""
        def windows(name, text):
            (self.folder / name).parent.mkdir(exist_ok=True)
            (self.folder / name).write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
        own = SOURCE / "samples/own_pass/files"
        windows("graph.json", (own / "outlined.json").read_text())
        for file in (own / "passes").iterdir():
            windows(f"passes/{file.name}", file.read_text())
        windows("scene.json", '{\n  "models": [{ "builtin": "cornellbox" }],\n  "gaze": "gaze.csv"\n}\n')
        windows("gaze.csv", "t;x;y\n0;0,25;0,5\n")
        self.succeeds("render", "graph.json", "--scene", "scene.json", *SMALL, "-o", "a.png")
        self.model([0, 0, 0, 1, 0, 0, 0, 1, 0])
        windows("model.gltf", (self.folder / "model.gltf").read_text())
        self.succeeds("scene", "info", "model.gltf")
        for name in ("graph.json", "scene.json"):
            text = (self.folder / name).read_bytes().decode("utf-8-sig")
            (self.folder / name).write_bytes(text.encode("utf-16"))
            self.fails(BAD_INPUT, "render", "graph.json", "--scene", "scene.json", *SMALL, says=[name, "UTF-16"])
            windows(name, text)

    def test_whole_numbers(self):
        for value in (500, 500.0, 5e2):
            self.write("graph.json", {"extends": "ir_1000.json", "parameters": {"vpl_count": value}})
            self.succeeds("check", "graph.json")
        for value in ("500.0", "5e2", "0.5e3"):
            self.succeeds("check", "ir_1000", "--set", f"vpl_count={value}")
        for value in (500.5, -1, 1e30, 2 ** 32, "500", True):
            self.write("graph.json", {"extends": "ir_1000.json", "parameters": {"vpl_count": value}})
            self.fails(BAD_INPUT, "check", "graph.json", says=["a whole number from 1 to 65536"])
        for value in ("nan", "0x10", "+500", "0500", " 500", "500 ", "inf", ""):
            self.fails(BAD_INPUT, "check", "ir_1000", "--set", f"vpl_count={value}", says=["a whole number from 1 to"])

    def test_all_mistakes_of_a_graph_at_once(self):
        self.write("graph.json", {
            "extends": "direct.json",
            "passes": {"tonemap": {"params": {"exposuer": 2}}, "more": {"type": "tonemapp"},
                       "direct": {"inputs": {"maps": "nothing"}}}})
        run = self.fails(BAD_INPUT, "check", "graph.json", says=["exposuer", "`exposure`", "tonemapp", "nothing"])
        self.assertGreaterEqual(len(re.findall(r"graph\.json:\d+:\d+: error", run.stderr)), 3, run.stderr)
        self.fails(BAD_INPUT, "render", "graph.json", "--scene", "cornellbox", says=["exposuer"])

    def test_part_alone(self):
        """A graph with inputs of its own is valid, but nothing fills them when it is the whole graph."""
        self.write("part.json", {"inputs": {"picture": {"format": "rgba16f"}},
                                 "passes": {"show": {"type": "tonemap", "inputs": {"radiance": "inputs.picture"}}},
                                 "outputs": {"image": "show"}})
        self.succeeds("check", "part.json")
        self.fails(BAD_INPUT, "render", "part.json", "--scene", "cornellbox", *SMALL,
                   says=["part.json:3:5", "`picture`", '"graph": "part.json"'])

    def test_unknown_override(self):
        self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_sise=64", says=["shadow_map_sise", "shadow_map_size"])
        self.fails(BAD_INPUT, *DIRECT, "--set", "tonemap.exposuer=1", says=["exposuer"])
        run = self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_size=big", says=["big"])
        self.assertEqual(run.stderr.count("error:"), 1, run.stderr)
        self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_size=-5", says=["-5"])

    def test_missing_scene(self):
        self.fails(BAD_INPUT, "render", "direct", "--scene", "no_such_scene", says=["no_such_scene"])
        self.fails(BAD_INPUT, "scene", "info", "no_such.gltf", says=["no_such.gltf"])

    def test_scene_names_missing_model(self):
        sponza = SOURCE / "samples/scenes/sponza.json"
        text = sponza.read_text().replace("Sponza.gltf", "NotThere.gltf")
        self.assertIn("NotThere", text)
        self.write("hall.json", text)
        self.fails(BAD_INPUT, "scene", "info", "hall.json", says=["NotThere.gltf"])

    def model(self, positions):
        data = struct.pack("<9f", *positions)
        return self.write("model.gltf", {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "materials": [{}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36,
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]})

    def test_follow_links(self):
        """As git-annex keeps the parts of a model."""
        model = json.loads(self.model([0, 0, 0, 1, 0, 0, 0, 1, 0]).read_text())
        data = base64.b64decode(model["buffers"][0]["uri"].split(",")[1])
        (self.folder / "objects").mkdir()
        (self.folder / "in").mkdir()
        (self.folder / "objects/data").write_bytes(data)
        (self.folder / "in/data.bin").symlink_to("../objects/data")
        model["buffers"][0]["uri"] = "data.bin"
        self.write("in/model.gltf", model)
        for command in (["scene", "info", "in/model.gltf"], ["render", "direct", "--scene", "in/model.gltf", *SMALL],
                        ["scene", "export", "in/model.gltf", "-o", "out"]):
            self.fails(BAD_INPUT, *command, says=["in/model.gltf:", "--follow-links", "FOVEA_FOLLOW_LINKS"])
        self.succeeds("scene", "info", "in/model.gltf", "--follow-links")
        self.succeeds("scene", "info", "in/model.gltf", env={"FOVEA_FOLLOW_LINKS": "1"})
        self.fails(BAD_INPUT, "scene", "info", "in/model.gltf", env={"FOVEA_FOLLOW_LINKS": "0"})
        self.succeeds("scene", "export", "in/model.gltf", "-o", "out", "--follow-links")
        for uri in ("../objects/data", str(self.folder / "objects/data")):
            model["buffers"][0]["uri"] = uri
            self.write("in/model.gltf", model)
            self.fails(BAD_INPUT, "scene", "info", "in/model.gltf", "--follow-links", says=["refused"])

    def test_numbers_that_are_none(self):
        good = [0, 0, 0, 1, 0, 0, 0, 1, 0]
        self.model(good)
        self.assertRegex(self.succeeds("scene", "info", "model.gltf").stdout, r"triangles +97 ")  # and the floor's
        for bad in (float("nan"), float("inf")):
            self.model(good[:4] + [bad] + good[5:])
            self.fails(BAD_INPUT, "render", "direct", "--scene", "model.gltf", *SMALL, says=["model.gltf"])

    def test_warnings_once(self):
        self.model([0, 0, 0, 1, 0, 0, 0, 1, 0])
        run = self.succeeds("render", "direct", "--scene", "model.gltf", *SMALL, "-o", "a.png", "--frames", "3")
        lines = [line for line in run.stderr.splitlines() if "warning" in line]
        self.assertGreaterEqual(len(lines), 1, run.stderr)
        self.assertEqual(len(lines), len(set(lines)), run.stderr)

    def test_what_a_model_does_not_say_is_printed_as_a_scene_file(self):
        self.model([0, 0, 0, 1, 0, 0, 0, 1, 0])
        run = self.succeeds("scene", "info", "model.gltf")
        self.assertIn("is assumed: a camera that shows the whole of it, a floor, a sun", run.stderr)
        values, scene_file = run.stdout.split("as a scene file, to be changed:\n")
        self.write("own.json", scene_file)
        ground = json.loads(scene_file)["environment"]["sky"]["ground"]
        self.assertEqual(json.loads(scene_file)["floor"]["color"], ground)  # which continues the floor
        self.assertNotIn(ground, ([0.2, 0.2, 0.2], [0.5, 0.5, 0.5]))        # the defaults of the two
        again = self.succeeds("scene", "info", "own.json")
        self.assertEqual(again.stderr, "")
        self.assertNotIn("scene file", again.stdout)
        for kind in ("triangles", "bounds", "camera", "light", "exposure", "sky"):
            wanted = [line for line in values.splitlines() if line.startswith(kind)]
            self.assertTrue(wanted, values)
            self.assertEqual([line for line in again.stdout.splitlines() if line.startswith(kind)], wanted)

    def test_the_printed_scene_file_shows_the_same_picture(self):
        """Wherever the model lies, and whether its camera is its own."""
        for place in ([0.1, 0.2, 0.3], [54321.1, 0, 0], [448262.125, 35.5, -5411932.25]):
            for camera in (False, True):
                with self.subTest(place=place, camera=camera):
                    model = json.loads(self.model([0, 0, 0, 1, 0, 0, 0, 1, 0]).read_text())
                    model["nodes"] += [{"children": [0, 2][:1 + camera], "translation": place}]
                    model["scenes"] = [{"nodes": [1]}]
                    if camera:
                        model["cameras"] = [{"type": "perspective", "perspective": {
                            "yfov": 0.7, "znear": 0.1, "zfar": 20, "aspectRatio": 2}}]
                        model["nodes"] += [{"camera": 0, "translation": [0.4, 0.3, 3], "rotation": [0, 0, 0.6, 0.8]}]
                    self.write("model.gltf", model)
                    printed = self.succeeds("scene", "info", "model.gltf").stdout.split("to be changed:\n")[1]
                    self.write("own.json", printed)
                    for scene in ("model.gltf", "own.json"):
                        self.succeeds("render", "direct", "--scene", scene, *SMALL, "-o", scene + ".pfm")
                    pixels = (self.folder / "model.gltf.pfm").read_bytes()
                    self.assertEqual((self.folder / "own.json.pfm").read_bytes(), pixels)
                    self.assertGreater(len(set(pixels)), 8)

    def test_graph_without_what_a_file_shows(self):
        self.graph(outputs={"image": None})
        self.fails(BAD_INPUT, "render", "graph.json", "--scene", "cornellbox", *SMALL, "-o", "a.png", says=["`image`"])

    def test_plugins(self):
        self.fails(BAD_INPUT, "passes", "--plugin", "none.so", says=["none.so"])
        self.write("text.so", "not a library")
        self.fails(BAD_INPUT, "passes", "--plugin", "text.so", says=["text.so"])

    def test_graph_beside_the_stock_passes(self):
        """As in the root of a checkout, where the front page saves its variant."""
        (self.folder / "passes").symlink_to(SOURCE / "passes")
        self.graph()
        self.succeeds("check", "graph.json")

    def test_rays_on_the_device_wait_for_no_pass_on_the_cpu(self):
        def on_the_cpu(graph, *options):
            plan = json.loads(self.succeeds("check", graph, "--plan", "json", *options).stdout)
            return {p["type"] for level in plan["levels"] for p in level["passes"] if p["host"]}

        for graph in "foveal", "foveal_stereo", "foveal_view", "ours", "stereo":
            for materials in "diffuse", "full":
                self.assertEqual(on_the_cpu(graph, "--rays", "device", "--materials", materials), set(), graph)
        self.assertLessEqual({"near-field", "eye-paths", "shadow-rays"}, on_the_cpu("foveal", "--rays", "host"))

    def test_data_folder(self):
        self.fails(BAD_INPUT, "check", "direct", env={"FOVEA_DATA": "/nowhere"}, says=["FOVEA_DATA", "/nowhere"])


    def test_content_of_other_files_is_not_shown(self):
        self.write("secret", "root:S3CRET:20228:0:99999:7:::\n")
        box = [{"builtin": "cornellbox"}]
        for scene in ({"models": box, "gaze": "secret"}, {"models": box, "environment": {"file": "secret"}},
                      {"models": [{"file": "secret"}]}):
            self.write("scene.json", scene)
            self.assertNotIn("S3CRET", self.fails(BAD_INPUT, "scene", "info", "scene.json", says=["secret"]).stderr)
        self.write("graph.json", {"extends": "secret"})
        self.assertNotIn("S3CRET", self.fails(BAD_INPUT, "check", "graph.json").stderr)

    def test_long_values_and_control_characters(self):
        long = "x" * 100_000
        self.graph(passes={"tonemap": {"params": {"exposure": long}}, "tone\0map\33": {"type": long}})
        run = self.fails(BAD_INPUT, "check", "graph.json", says=["(100000 bytes)", "tone\\x00map\\x1b"])
        self.assertLess(len(run.stderr), 2000)
        for arguments in ([*DIRECT, "--frames", long], [*DIRECT, "--set", f"shadow_map_size={long}"], ["check", long],
                          [*DIRECT, "--gaze", long], ["compare", long, long]):
            run = self.call(*arguments)
            self.assertIn(run.returncode, (USAGE, BAD_INPUT))
            self.assertLess(len(run.stderr), 2000, run.stderr[:300])

    def test_what_is_too_much(self):
        """Refused by sizes in headers, before it is read."""
        self.write("many.json", {"models": [{"file": "none.gltf"}] * 10_001})
        self.fails(BAD_INPUT, "scene", "info", "many.json", says=["10001 models", "10000"])
        self.write("many.json", {"models": [{"file": "none.gltf", "name": "x" * 800}] * 10_001})
        self.fails(BAD_INPUT, "scene", "info", "many.json", says=["8388608", "glTF"])
        self.write("many.json", {"passes": {f"p{i}": {"type": "tonemap", "comment": "x" * 800} for i in range(10_001)}})
        self.fails(BAD_INPUT, "check", "many.json", says=["8388608"])
        self.write("many.json", {"passes": {f"p{i}": {"type": "tonemap"} for i in range(10_002)}})
        self.fails(BAD_INPUT, "check", "many.json", says=["more than 10000 passes"])
        self.write("many.gltf", '{"asset": {"version": "2.0"}, "extras": [' + "0," * 4_000_000 + "0]}")
        self.fails(BAD_INPUT, "scene", "info", "many.gltf", says=["many.gltf:1:8000034", "more than 4000000 values"])
        self.write("many.json", {"passes": {f"p{i}": {"type": "tonemap"} for i in range(5_000)}})
        run = self.fails(BAD_INPUT, "check", "many.json", says=["4981 more mistakes"])
        self.assertLess(len(run.stderr), 10_000)
        for value in ("", "x", "0", "-1"):
            run = self.call("scene", "info", "cornellbox", env={"FOVEA_MEMORY_LIMIT": value})
            self.assertEqual(run.returncode, BAD_INPUT if value else 0, run.stderr)

    def test_memory_of_images(self):
        self.model([0, 0, 0, 1, 0, 0, 0, 1, 0])
        model = json.loads((self.folder / "model.gltf").read_text())
        header = struct.pack(">II", 16384, 16384) + b"\x08\x02\0\0\0"
        start = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + b"IHDR" + header
        (self.folder / "large.png").write_bytes(start + bytes(1 << 20))
        model["images"] = [{"uri": "large.png"}] * 40
        model["textures"] = [{"source": i} for i in range(40)]
        model["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(40)]
        self.write("model.gltf", model)
        self.fails(BAD_INPUT, "scene", "info", "model.gltf", says=["bytes claim 268 million pixels", "smaller"])
        (self.folder / "large.png").write_bytes(start + bytes(4 << 20))
        run = self.fails(OUT_OF_MEMORY, "scene", "info", "model.gltf", env={"FOVEA_MEMORY_LIMIT": "2000"},
                         says=["1 images of 269 million pixels", "2048 MiB", "2000 MiB", "FOVEA_MEMORY_LIMIT"])
        self.assertNotIn("bad_alloc", run.stderr)


class Devices(CliTest):
    # The old and the new name of the same variable of the Vulkan loader.
    NONE = {"VK_DRIVER_FILES": "/dev/null", "VK_ICD_FILENAMES": "/dev/null"}

    def test_list(self):
        self.assertRegex(self.succeeds("devices").stdout, r"(?m)^ *0  \S")

    def test_none(self):
        self.fails(NO_DEVICE, "devices", env=self.NONE)
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", env=self.NONE, says=["mesa-vulkan-drivers"])

    def test_unknown(self):
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", "--device", "Voodoo 2", says=["Voodoo 2"])
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", "--device", "99", says=["99"])

    def test_without(self):
        features = ["geometryShader", "shaderInt64", "shaderDrawParameters", "shaderOutputLayer",
                    "VK_KHR_push_descriptor", "maxTexelBufferElements", "VK_FORMAT_R16G16_SNORM"]
        for command in ("render", "view", "bench"):
            for feature in features:
                self.assertIn(feature, self.succeeds(command, "--help").stdout)
        self.fails(USAGE, *DIRECT, "-o", "a.png", "--without", "geometryShaders", says=["`geometryShaders`", *features])
        self.succeeds(*DIRECT, "-o", "a.exr")
        self.succeeds(*DIRECT, "-o", "b.exr", *(word for feature in features for word in ("--without", feature)))
        same = json.loads(self.succeeds("compare", "a.exr", "b.exr", "--json").stdout)
        self.assertEqual(same["whole"]["relmse"], 0)

    def test_memory(self):
        if "llvmpipe" not in self.succeeds("devices").stdout:
            self.skipTest("other devices may have the memory")
        self.fails(OUT_OF_MEMORY, "render", "direct", "--scene", "cornellbox", "--size", "16384x16384", "-o", "a.png",
                   says=["MiB", "smaller"])

    def test_what_needs_none(self):
        for arguments in (["check", "direct"], ["passes"], ["schema"], ["scene", "info", "cornellbox"]):
            with self.subTest(arguments=arguments):
                self.succeeds(*arguments, env=self.NONE)


class Lists(CliTest):
    def test_passes(self):
        listed = self.succeeds("passes").stdout
        for name in ("gbuffer", "shadow-map", "direct", "tonemap"):
            self.assertRegex(listed, rf"(?m)^{name} +\S+")
        for name in [line.split()[0] for line in listed.splitlines()]:
            with self.subTest(name=name):
                self.assertRegex(self.succeeds("passes", name).stdout, "outputs|updated in place")
        self.assertRegex(self.succeeds("passes", "tonemap").stdout, r"(?m)^  exposure +0 \(")
        self.fails(BAD_INPUT, "passes", "tonemapp", says=["`tonemap`"])

    def graphs(self):
        folder = SOURCE / "graphs"
        return [path for path in sorted([*folder.glob("*.json"), *folder.glob("debug/*.json"),
                                         *folder.glob("alternatives/*.json")])
                if not path.name.endswith(".schema.json")]

    def test_schema_accepts_the_graphs(self):
        schema = json.loads(self.succeeds("schema").stdout)
        self.assertIn("properties", schema)
        import jsonschema
        validator = jsonschema.validators.validator_for(schema)
        validator.check_schema(schema)
        for path in self.graphs():
            with self.subTest(graph=path.name):
                graph = json.loads(path.read_text())
                validator(schema).validate(graph)
                with self.assertRaises(jsonschema.ValidationError):
                    validator(schema).validate({**graph, "passses": {}})

    def test_stored_schema_is_current(self):
        stored = SOURCE / "graphs/fovea-graph.schema.json"
        self.assertEqual(json.loads(stored.read_text()), json.loads(self.succeeds("schema").stdout),
                         "graphs/fovea-graph.schema.json is out of date: write `fovea schema` into it")

    def test_migrate(self):
        old = '{\n  "extends": "direct.json",\n  "parameters": { "materials": "full" }\n}\n'
        new = '{\n  "version": 2,\n  "extends": "direct.json",\n  "view": { "materials": "full" }\n}\n'
        self.write("old.json", old)
        self.assertIn("old.json:3:", self.succeeds("check", "old.json").stderr)
        self.assertIn("fovea migrate old.json", self.succeeds("check", "old.json").stderr)
        result = self.call("migrate", "--check", "old.json")
        self.assertEqual((result.returncode, (self.folder / "old.json").read_text()), (BAD_INPUT, old))
        self.assertIn("old.json:3:", self.succeeds("migrate", "old.json").stdout)
        self.assertEqual((self.folder / "old.json").read_text(), new)
        self.assertEqual(self.succeeds("migrate", "--check", "old.json").stdout, "")
        self.assertEqual(self.succeeds("check", "old.json").stderr, "")
        self.fails(BAD_INPUT, "migrate", "none.json", says=["none.json"])

    def test_check(self):
        for path in self.graphs():
            name = str(path.relative_to(SOURCE / "graphs").with_suffix(""))
            with self.subTest(graph=name):
                self.assertIn(path.stem, self.succeeds("check", name).stdout)

    def test_plans(self):
        self.assertIn("tonemap", self.succeeds("check", "direct", "--plan", "text").stdout)
        self.assertTrue(self.succeeds("check", "direct", "--plan", "dot").stdout.lstrip().startswith("digraph"))
        json.loads(self.succeeds("check", "direct", "--plan", "json").stdout)
        self.fails(USAGE, "check", "direct", "--plan", "xml", says=["--plan"])

    def test_scene_info(self):
        text = self.succeeds("scene", "info", "cornellbox").stdout
        for word in ("triangles", "light", "camera", "exposure"):
            self.assertRegex(text, rf"(?m)^{word} +\S")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
