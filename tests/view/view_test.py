"""Tests `fovea view` from outside, in a headless Chromium. Usage: view_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import pathlib
import re
import shutil
import socket
import struct
import subprocess
import sys
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from viewer import Keys, PATIENCE, PROGRAM, SOURCE, ViewTest


def read_exr(path, layer):
    """The 32-bit words of the RGB of a layer, pixel after pixel. oiiotool undoes the compression and the layers."""
    plain = path.with_suffix(".plain.exr")
    channels = ",".join(f"{c}={layer}.{c}" for c in "RGB")
    subprocess.run(["oiiotool", path, "--ch", channels, "--compression", "none", "-d", "float", "-o", plain],
        check=True)
    data = plain.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    words = []
    for offset in struct.unpack_from(f"<{height}Q", data, at + 1):
        line = struct.unpack_from(f"<{3 * width}I", data, offset + 8)  # channels are sorted by name
        blue, green, red = line[:width], line[width:2 * width], line[2 * width:]
        words += [word for pixel in zip(red, green, blue) for word in pixel]
    return tuple(words)


class Server(ViewTest):
    def test_nothing_is_served_without_the_token(self):
        viewer = self.view("direct")
        self.assertEqual(viewer.request("")[0], 200)
        for target in ("/", "/index.html", "/state", "/picture?source=image", "/../../etc/passwd", "/%2e%2e/etc/passwd",
                       viewer.path[:-2] + "/", viewer.path.upper() + "state", viewer.path + "../state",
                       viewer.path + "..%2f..%2fetc%2fpasswd", viewer.path + "missing"):
            status, _, body = viewer.request(target, whole=True)
            self.assertEqual(status, 404, target)
            self.assertNotIn(b"<html", body)
        self.assertEqual(viewer.request("state", headers={"Host": "evil.example"})[0], 403)
        self.assertEqual(viewer.request("state", headers={"Origin": "http://evil.example"})[0], 403)
        self.assertEqual(viewer.request("state", headers={"Sec-Fetch-Site": "cross-site"})[0], 403)
        self.assertEqual(viewer.request("state", "PUT", "{}")[0], 405)
        self.assertEqual(viewer.request("control", "POST", "x" * 70000)[0], 413)
        self.assertEqual(viewer.request("control", "POST", "{")[0], 400)
        status, headers, _ = viewer.request("")
        self.assertIn("default-src 'self'", headers["Content-Security-Policy"])
        self.assertEqual(headers["X-Content-Type-Options"], "nosniff")

    def test_an_unknown_source_says_what_there_is(self):
        viewer = self.view("direct")
        for source, says in (("imag", "did you mean `image`"), ("gbufer:x", "did you mean `gbuffer`"),
                             ("gbuffer:gbuffer.norml", "did you mean `gbuffer.normal`"),
                             ("shadow-map:maps.depth@0.99999", "no mip")):
            status, _, body = viewer.request(f"picture?source={source}")
            self.assertEqual(status, 404, source)
            self.assertIn(says, body.decode())

    def test_clients_that_vanish_or_stall_do_no_harm(self):
        viewer = self.view("direct")
        stalled = []
        for i in range(60):
            client = socket.create_connection(("127.0.0.1", viewer.port))
            client.sendall(f"GET {viewer.path}events HTTP/1.1\r\nHost: localhost\r\n".encode())
            if i % 3 == 0:
                client.sendall(b"\r\n")
            if i % 3 == 1:
                client.close()
            else:
                stalled.append(client)
        end = time.monotonic() + PATIENCE
        frames = set()
        # The run goes on all the while, and the server recovers.
        while time.monotonic() < end and len(frames) < 3:
            try:
                frames.add(viewer.pixels("image", after=viewer.number)[0])
            except (OSError, AssertionError):
                time.sleep(0.2)
            if len(frames) == 1:
                for client in stalled:
                    client.close()
        self.assertGreaterEqual(len(frames), 3)
        self.assertIsNone(viewer.process.poll())

    def test_ends_when_asked(self):
        viewer = self.view("direct")
        self.open(viewer)
        self.driver.get("about:blank")
        viewer.process.terminate()
        self.assertEqual(viewer.process.wait(PATIENCE), 0)


    def test_bad_input_ends_with_the_documented_codes(self):
        for code, arguments in ((3, ["nograph", "--scene", "cornellbox"]), (3, ["direct", "--scene", "nosuch"]),
                                (2, ["direct"]), (2, ["direct", "--scene", "cornellbox", "--port", "99999"]),
                                (2, ["direct", "--scene", "cornellbox", "--host", "256.1.1.1"]),
                                (2, ["direct", "--scene", "cornellbox", "--size", "0x3"]),
                                (3, ["direct", "--scene", "cornellbox", "--set", "nope=1"]),
                                (4, ["direct", "--scene", "cornellbox", "--device", "nosuch"])):
            run = subprocess.run([PROGRAM, "view", *arguments], capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertTrue(run.stderr.startswith("fovea: "), run.stderr)
            self.assertEqual(run.stdout, "")

    def test_thousands_of_connections_leave_it_as_it_was(self):
        viewer = self.view("direct", size="32x32")

        def knock(count):
            for i in range(count):
                with socket.create_connection(("127.0.0.1", viewer.port)) as client:
                    client.sendall((b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n", b"\x16\x03\x01\x02\x00" * 9,
                                    b"POST " + viewer.path.encode() + b"control HTTP/1.1\r\nHost: localhost\r\n"
                                    b"Content-Length: 9999\r\n\r\n{", b"")[i % 4])

        def memory():
            status = pathlib.Path(f"/proc/{viewer.process.pid}/status").read_text()
            return int(re.search(r"VmRSS:\s*(\d+)", status).group(1))

        knock(500)
        before = memory()
        knock(3000)
        self.wait(lambda: viewer.request("state")[0] == 200, "an answer")
        self.assertLess(memory(), 1.05 * before + 4096)


class Look(ViewTest):
    @unittest.skipUnless(shutil.which("oiiotool"), "needs oiiotool")
    def test_pictures_can_be_kept_with_the_metadata_of_render(self):
        viewer = self.view("ir_1000", "--set", "vpl_count=20", "--frames", 2, size="64x64")
        self.open(viewer)
        self.choose("#source", "radiance")
        self.assertIn("picture.exr?source=radiance", self.find("#exr").get_attribute("href"))
        status, headers, body = viewer.request("picture.exr?source=radiance")
        self.assertEqual(status, 200, body[:200])
        frame = int(re.search(r"radiance_(\d+)\.exr", headers["Content-Disposition"]).group(1))
        (self.folder / "kept.exr").write_bytes(body)
        self.render("ir_1000", "--scene", "cornellbox", "--size", "64x64", "--set", "vpl_count=20", "--frames",
            frame + 1,
                    "-o", "radiance=truth.exr", "-q")
        kept, truth = (read_exr(self.folder / name, "radiance") for name in ("kept.exr", "truth.exr"))
        self.assertEqual(kept == truth, True, "the pictures differ")

        def metadata(name):
            text = subprocess.run(["oiiotool", "--info", "-v", name], cwd=self.folder, capture_output=True,
                text=True).stdout
            return sorted(line.strip() for line in text.splitlines() if line.strip().startswith("fovea."))

        self.assertGreater(len(metadata("kept.exr")), 8)
        self.assertEqual(metadata("kept.exr"), metadata("truth.exr"))
        status, _, body = viewer.request("picture.png?source=radiance&exposure=1")
        self.assertEqual((status, body[:4]), (200, b"\x89PNG"))

    @unittest.skipUnless(shutil.which("oiiotool"), "needs oiiotool")
    def test_pixels_equal_the_exr_of_render_to_the_bit(self):
        viewer = self.view("ir_1000", "--set", "vpl_count=20", "--frames", 3)
        self.open(viewer)
        frame, channels, words = viewer.pixels("radiance", 0, 0, 256, 256)
        self.assertEqual(channels, 4)
        self.render("ir_1000", "--scene", "cornellbox", "--size", "256x256", "--set", "vpl_count=20", "--frames",
                    frame + 1, "-o", "truth_%d.exr", "-q")
        truth = read_exr(self.folder / f"truth_{frame}.exr", "radiance")
        seen = tuple(word for i, word in enumerate(words) if i % 4 != 3)
        self.assertEqual(seen == truth, True, "the pictures differ")
        # The pixel that the page tells.
        self.choose("#source", "radiance")
        self.wait(lambda: self.find("#canvas").get_attribute("data-source") == "radiance", "the radiance")
        canvas = self.find("#canvas")
        ActionChains(self.driver).move_to_element(canvas).perform()
        text = self.wait(lambda: self.find("#pixel").text, "the pixel")
        place, *values = text.split("   ")
        x, y = map(int, place.split(","))
        _, _, words = viewer.pixels("radiance", x, y)
        told = struct.unpack("<4I", struct.pack("<4f", *map(float, values)))
        self.assertEqual(told, words)

    def test_every_port_that_is_made_can_be_seen(self):
        viewer = self.view("ours", "--set", "vpl_count=64", "--validation", size="64x64")
        self.open(viewer)
        sources = [port["source"] for p in viewer.state()["graph"]["passes"] for port in p["ports"] if port["made"]]
        self.assertGreater(len(sources), 40)
        for source in sources:
            status, _, body = viewer.request(f"picture?source={source}&width=64")
            self.assertEqual(status, 200, f"{source}: {body[:200]}")
        self.assertIsNone(viewer.process.poll(), viewer.errors())
        self.assertNotIn("validation", viewer.errors())

    def test_exposure_channel_and_false_colour_change_the_picture(self):
        viewer = self.view("direct", "--frames", 2)
        self.open(viewer)
        self.choose("#source", "radiance")
        self.wait(lambda: self.find("#canvas").get_attribute("data-source") == "radiance", "the radiance")

        def changes(act, what):
            before = self.canvas()
            act()
            return self.wait(lambda: (now := self.canvas()) != before and now, what)

        plain = self.canvas()
        bright = changes(lambda: self.choose("#exposure", "2"), "a brighter picture")
        self.assertGreater(sum(bright), sum(plain))
        red = changes(lambda: self.choose("#channel", "red"), "one channel")
        middle = 4 * (128 * 256 + 20)
        self.assertEqual(len(set(red[middle:middle + 3])), 1)
        false = changes(lambda: self.find("#false-color").click(), "false colours")
        self.assertTrue(any(len(set(false[i:i + 3])) > 1 for i in range(0, len(false), 400)))

    def test_nan_and_infinity_are_marked_and_counted(self):
        (self.folder / "passes").mkdir()
        self.write("passes/wrong.pass.json", {
            "doc": "Makes numbers that are none.",
            "outputs": {"radiance": {"doc": "NaN left, infinity beside it", "format": "rgba32f",
                "usage": ["storage_write"]}},
            "steps": [{"shader": "wrong.comp", "over": "radiance"}]})
        self.write("passes/wrong.comp", """layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform writeonly image2D radiance;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  uint word = p.x < 64 ? 0x7fc00000u : p.x < 128 ? 0x7f800000u : 0x3f000000u;
  imageStore(radiance, p, vec4(uintBitsToFloat(word)));
}
""")
        graph = self.write("wrong.json", {"passes": {"wrong": {"type": "wrong"}}, "outputs": {"image": "wrong"}})
        viewer = self.view(graph, "--frames", 2)
        self.open(viewer)
        pixels = self.canvas()
        at = lambda x: pixels[4 * (128 * 256 + x):][:3]
        for x, colour in ((20, (255, 0, 255)), (100, (0, 255, 255))):
            self.assertLess(max(abs(a - b) for a, b in zip(at(x), colour)), 12, (x, at(x)))
        self.wait(lambda: self.find("#numbers").get_attribute("data-nan") == str(4 * 64 * 256), "the number of NaNs")


class Move(ViewTest):
    def tick(self):
        return self.script("return import('./store.js').then((m) => m.store.tick)")

    def test_keys_and_mouse_move_the_camera(self):
        viewer = self.view("direct")
        self.open(viewer)
        before = self.tick()["camera"]
        self.assertFalse(before["own"])
        hold = ActionChains(self.driver).click(self.find("#stage"))
        hold.key_down("w").pause(0.5).key_up("w").perform()
        flown = self.wait(lambda: (now := self.tick()["camera"])["own"] and now, "a camera of its own")
        self.assertLess(flown["position"][2], before["position"][2] - 0.05)  # ahead, which is -Z here
        stage = self.find("#stage")
        ActionChains(self.driver).move_to_element(stage).click_and_hold().move_by_offset(80, 0).release().perform()
        turned = self.wait(lambda: abs((now := self.tick()["camera"])["yaw"] - flown["yaw"]) > 0.05 and now, "a turn")
        self.assertGreater(turned["yaw"], flown["yaw"])  # the picture follows the hand
        self.press("o")
        ActionChains(self.driver).move_to_element(stage).click_and_hold().move_by_offset(0, 60).release().perform()
        self.wait(lambda: abs(self.tick()["camera"]["position"][1] - turned["position"][1]) > 0.05, "an orbit")
        self.press("c")
        self.wait(lambda: not self.tick()["camera"]["own"], "the scene's camera")

    def test_time_runs_stands_still_and_steps(self):
        viewer = self.view("direct")
        self.open(viewer)
        self.wait(lambda: self.tick()["time"] > 0, "time")
        self.press(" ")
        still = self.wait(lambda: not (now := self.tick())["playing"] and now, "time to stand still")
        later = self.wait(lambda: (now := self.tick())["frame"] > still["frame"] + 2 and now, "frames that go on")
        self.assertEqual(later["time"], still["time"])
        self.press("f")
        self.wait(lambda: self.tick()["frozen"], "the run to freeze")
        time.sleep(0.3)
        frozen = self.tick()
        time.sleep(0.5)
        self.assertEqual(self.tick()["frame"], frozen["frame"])
        self.find("#step").click()
        stepped = self.wait(lambda: (now := self.tick())["frame"] > frozen["frame"] and now, "a step")
        self.assertEqual(stepped["frame"], frozen["frame"] + 1)
        self.assertAlmostEqual(stepped["time"], frozen["time"] + 1 / 42, places=6)
        self.choose("#speed", "4")
        self.find("#step").click()
        self.wait(lambda: abs(self.tick()["time"] - stepped["time"] - 4 / 42) < 1e-6, "a larger step")

    def test_a_recorded_gaze_replays_to_the_same_pictures(self):
        # Shows the gaze itself, through a pass whose picture depends on it.
        viewer = self.view("ours", "--set", "vpl_count=32", size="64x64")
        self.open(viewer)
        self.press("g")
        self.find("#record").click()
        self.wait(lambda: self.tick()["recording"], "the recording")
        canvas = self.find("#canvas")
        for x, y in ((-60, -40), (-50, -40), (120, 90), (125, 80), (0, 0)):
            ActionChains(self.driver).move_to_element_with_offset(canvas, x, y).perform()
            count = self.tick()["recorded"]
            self.wait(lambda: self.tick()["recorded"] >= count + 2, "frames")
        viewer.control(frozen=True)
        self.wait(lambda: self.tick()["frozen"], "the run to freeze")
        frame, channels, words = viewer.pixels("radiance", 0, 0, 64, 64)
        table = viewer.request("gaze.csv")[2].decode()
        rows = [line for line in table.splitlines() if line and not line.startswith(("#", "t"))]
        self.assertGreater(len({row.split(",", 1)[1] for row in rows}), 3)
        self.write("gaze.csv", table)
        self.render("ours", "--scene", "cornellbox", "--size", "64x64", "--set", "vpl_count=32", "--frames", frame + 1,
                    "--gaze-trace", "gaze.csv", "--gaze-gap", 0, "-o", "truth.exr", "-q")
        seen = tuple(word for i, word in enumerate(words) if i % channels < 3)
        self.assertEqual(seen == read_exr(self.folder / "truth.exr", "radiance"), True, "the pictures differ")


class Understand(ViewTest):
    def test_passes_are_timed_drawn_previewed_and_locked(self):
        viewer = self.view("ours", "--set", "vpl_count=64", size="64x64")
        self.open(viewer)
        names = [p["name"] for p in viewer.state()["graph"]["passes"] if p["level"] is not None]
        self.wait(lambda: len(self.find_all("#timings tr[data-pass]")) == len(names), "the rows of the passes")
        self.assertEqual(len(self.find_all("#graph-view .node")), len(viewer.state()["graph"]["passes"]))
        self.assertGreater(len(self.find_all("#graph-view .edge")), len(names))
        self.wait(lambda: float(self.find("#total").text or 0) > 0, "the time of the frame")
        row = self.find("#timings tr[data-pass='gbuffer']")
        ActionChains(self.driver).move_to_element(row).perform()
        self.wait(lambda: self.find("#preview").is_displayed() and
                  self.find("#preview img").get_attribute("src").startswith("blob:"), "the preview")
        row.click()
        self.wait(lambda: self.find("#canvas").get_attribute("data-source").startswith("gbuffer:"), "the locked port")
        self.assertIn("shown", self.find("#graph-view .node[data-pass='gbuffer']").get_attribute("class"))
        self.script("document.querySelector(\"#graph-view .node[data-pass='direct']\").focus()")
        self.driver.switch_to.active_element.send_keys(Keys.ENTER)
        self.wait(lambda: self.find("#canvas").get_attribute("data-source").startswith("direct:"),
            "the pass by keyboard")
        self.find("#pin").click()
        self.wait(lambda: any(cell.text for cell in self.find_all("#timings td.delta")),
            "a comparison with the baseline")

    def test_the_plan_shows_every_resource(self):
        viewer = self.view("direct")
        self.open(viewer)
        self.find("#plan-panel summary").click()
        self.assertEqual(len(self.find_all("#plan rect")), len(viewer.state()["graph"]["plan"]["resources"]))

    def test_buffers_are_tables(self):
        viewer = self.view("ir_1000", "--set", "vpl_count=20", "--frames", 2, size="64x64")
        self.open(viewer)
        source = next(p["source"] for q in viewer.state()["graph"]["passes"] for p in q["ports"]
                      if q["name"] == "emit" and p["buffer"] and p["made"])
        self.choose("#source", source)
        self.wait(lambda: len(self.find_all("#table tbody tr")) >= 20, "the table")


class Change(ViewTest):
    def test_a_parameter_changes_the_picture_and_the_saved_graph(self):
        graph = self.write("mine.json", {"extends": "ir_1000.json"})
        viewer = self.view(graph, "--frames", 2)
        self.open(viewer)
        before = self.canvas()
        self.choose("#parameter-vpl_count", "7")
        self.wait(lambda: viewer.state()["set"] == ["vpl_count=7"], "the change")
        self.wait(lambda: self.canvas() != before, "another picture")
        self.assertEqual(viewer.state()["graph"]["parameters"][0]["default"] is None, False)
        self.choose("#find-parameter", "exposure")
        self.wait(lambda: self.find_all("[id='parameter-tonemap.exposure']"), "the parameter")
        self.choose("[id='parameter-tonemap.exposure']", "2")
        self.wait(lambda: len(viewer.state()["set"]) == 2, "the second change")
        self.find("#copy").click()
        self.wait(lambda: self.find("#copy").get_attribute("data-text") ==
                  "--set tonemap.exposure=2 --set vpl_count=7", "the options")
        self.find("#save-name").send_keys("saved")
        self.find("#save").click()
        self.wait(lambda: (self.folder / "saved.json").exists(), "the file")
        saved = json.loads((self.folder / "saved.json").read_text())
        self.assertEqual({k: v for k, v in saved.items() if k != "$schema"},
                         {"extends": "mine.json", "parameters": {"vpl_count": 7},
                          "passes": {"tonemap": {"params": {"exposure": 2}}}})
        # It runs like what was shown, and is not written over.
        frame, _, words = viewer.pixels("radiance", 0, 0, 256, 256)
        self.render("saved.json", "--scene", "cornellbox", "--size", "256x256", "--frames", frame + 1, "-o",
            "saved.exr", "-q")
        seen = tuple(word for i, word in enumerate(words) if i % 4 != 3)
        self.assertEqual(seen == read_exr(self.folder / "saved.exr", "radiance"), True, "the pictures differ")
        viewer.control(save="saved")
        self.wait(lambda: "exists already" in json.dumps(viewer.state()["messages"]), "the refusal")
        viewer.control(set={"vpl_count": None})
        self.wait(lambda: viewer.state()["set"] == ["tonemap.exposure=2"], "the reset of one")
        viewer.control(reset=True)
        self.wait(lambda: viewer.state()["set"] == [], "the reset of all")

    def test_a_strategy_is_swapped_by_name(self):
        viewer = self.view("ours", "--set", "vpl_count=32", size="64x64")
        self.open(viewer)
        choices = [o.get_attribute("value") for o in self.find_all("#parameter-intensity option")]
        self.assertEqual(sorted(choices), ["area", "constant", "importance-area", "pdf"])
        self.choose("#parameter-intensity", "pdf")
        self.wait(lambda: any(p["type"] == "vpl-intensity-pdf" for p in viewer.state()["graph"]["passes"]),
                  "the strategy")

    def test_a_wrong_value_is_told_and_the_last_graph_goes_on(self):
        viewer = self.view("ir_1000", "--set", "vpl_count=20", size="64x64")
        self.open(viewer)
        viewer.control(set={"vpl_count": -3})
        message = self.wait(lambda: self.script(
            "return document.querySelector('.message.error')?.innerText"), "the message")
        self.assertIn("vpl_count", message)
        self.assertEqual(viewer.state()["set"], ["vpl_count=20"])
        frame = self.shown_frame()
        self.wait(lambda: self.shown_frame() > frame + 2, "the last good graph")

    def test_another_graph_scene_and_size(self):
        viewer = self.view("direct", size="64x64")
        self.open(viewer)
        self.choose("#size", "128x128")
        self.wait(lambda: self.script("return document.getElementById('canvas').width") == 128, "another size")
        self.choose("#graph", "ir_1000")
        self.wait(lambda: viewer.state()["graph_name"] == "ir_1000", "another graph")
        self.choose("#scene", "cornellbox_moving")
        self.wait(lambda: viewer.state()["scene"] == "cornellbox_moving", "another scene")
        status, _, _ = viewer.request("control", "POST", '{"graph": "../../etc/passwd"}')
        self.assertEqual(status, 204)
        self.wait(lambda: "there is no graph" in json.dumps(viewer.state()["messages"]), "the refusal")
        self.assertEqual(viewer.state()["graph_name"], "ir_1000")


class Compare(ViewTest):
    def second(self):
        return self.script("const c = document.getElementById('second');"
                           "return c.hidden ? null :"
                           " [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data];")

    def test_a_second_graph_is_split_subtracted_and_measured(self):
        viewer = self.view("direct", size="64x64")
        self.open(viewer)
        self.find("#compare-panel summary").click()
        self.choose("#source", "radiance")
        self.choose("#second-graph", "ir_1000")
        self.wait(self.second, "the second picture")
        self.assertNotEqual(self.second(), self.canvas())
        self.wait(lambda: float(self.find("#measures").get_attribute("data-mse") or 0) > 1e-4, "the error")
        self.assertTrue(self.find("#divider").is_displayed())
        self.choose("#compare-mode", "difference")
        self.wait(lambda: self.find("#second").get_attribute("data-mode") == "difference", "the difference")
        # Of a graph and itself there is none.
        self.choose("#second-graph", "direct")
        self.wait(lambda: (now := self.second()) and all(v < 3 for i, v in enumerate(now) if i % 4 != 3),
            "no difference")
        self.wait(lambda: self.find("#measures").get_attribute("data-mse") == "0", "no error")
        self.choose("#second-graph", "")
        self.wait(lambda: self.second() is None, "the end of the comparison")

    def test_a_reference_fills_up_while_nothing_moves(self):
        viewer = self.view(self.write("mine.json", {"extends": "reference.json", "parameters": {"spp": 256}}),
            size="32x32")
        viewer.control(playing=False, second="reference")
        self.open(viewer)
        viewer.control(frozen=False)

        def measured():
            status, _, body = viewer.request("measures?source=radiance&reference=second!radiance")
            return json.loads(body) if status == 200 else {"frames": 0}

        first = self.wait(lambda: (m := measured())["frames"] > 0 and m, "the first frames")
        later = self.wait(lambda: (m := measured())["frames"] > 30 and m, "more frames")
        self.assertLess(later["whole"]["mse"], 0.5 * first["whole"]["mse"])
        viewer.control(camera={"position": [0, 2.75, 8], "yaw": 0, "pitch": 0})
        self.wait(lambda: 0 < measured()["frames"] < later["frames"], "a new start")


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
