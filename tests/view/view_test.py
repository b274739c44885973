"""Tests `fovea view` from outside, in a headless Chromium. Usage: view_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import socket
import shutil
import struct
import subprocess
import sys
import time
import unittest

from selenium.webdriver.common.action_chains import ActionChains
from viewer import Keys, PATIENCE, SOURCE, ViewTest


def read_exr(path, layer):
    """The 32-bit words of the RGB of a layer, pixel after pixel. oiiotool undoes the compression and the layers."""
    plain = path.with_suffix(".plain.exr")
    channels = ",".join(f"{c}={layer}.{c}" for c in "RGB")
    subprocess.run(["oiiotool", path, "--ch", channels, "--compression", "none", "-d", "float", "-o", plain], check=True)
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


class Look(ViewTest):
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
            "outputs": {"radiance": {"doc": "NaN left, infinity beside it", "format": "rgba32f", "usage": ["storage_write"]}},
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


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
