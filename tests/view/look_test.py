"""The contents of the page of `fovea view`: pictures, numbers, comparisons.

Usage: look_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import re
import shutil
import struct
import subprocess
import sys
import unittest

from viewer import ViewTest, read_exr, read_ppm  # before selenium, which may be missing

from selenium.webdriver.common.action_chains import ActionChains


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
        viewer = self.view("ir_1000", "--set", "vpl_count=20", "--frames", 3, size="64x64")
        self.open(viewer)
        frame, channels, words = viewer.pixels("radiance", 0, 0, 64, 64)
        self.assertEqual(channels, 4)
        self.render("ir_1000", "--scene", "cornellbox", "--size", "64x64", "--set", "vpl_count=20", "--frames",
                    frame + 1, "-o", "truth_%d.exr", "-q")
        truth = read_exr(self.folder / f"truth_{frame}.exr", "radiance")
        seen = tuple(word for i, word in enumerate(words) if i % 4 != 3)
        self.assertEqual(seen == truth, True, "the pictures differ")
        # The pixel that the page tells.
        self.choose("#source", "radiance")
        self.wait(lambda: self.find("#canvas").get_attribute("data-source") == "radiance", "the radiance")
        for keys, wanted in (("0", (33, 20)), ("+++++++", (30, 35)), ("++++++", (31, 34)), ("0--------", (40, 12))):
            for key in keys:
                self.press(key)
            left, top, scale = self.script(
                "const b = document.getElementById('canvas').getBoundingClientRect();"
                "const s = document.getElementById('stage').getBoundingClientRect();"
                "return [b.left - s.left - s.width / 2, b.top - s.top - s.height / 2, b.width / 64]")
            at = [round(a + scale * (w + 0.5)) for a, w in zip((left, top), wanted)]
            ActionChains(self.driver).move_to_element_with_offset(self.find("#stage"), *at).perform()
            place = f"{wanted[0]}, {wanted[1]}"
            text = self.wait(lambda: (t := self.find("#pixel").text).startswith(place) and t, f"pixel {place} at {scale}")
            told = struct.unpack("<3I", struct.pack("<3f", *map(float, text.split("   ")[1:4])))
            first = 3 * (wanted[1] * 64 + wanted[0])
            self.assertEqual(told, truth[first:first + 3], (place, scale))

    @unittest.skipUnless(shutil.which("oiiotool"), "needs oiiotool")
    def test_a_still_picture_is_shown_to_the_last_bit(self):
        """Where coloured squares of a compression would be taken for light."""
        for graph, size, arguments in (("ir_1000", "320x240", ("--frames", 2)), ("direct", "512x384", ())):
            viewer = self.view(graph, *arguments, size=size, scene="cornellbox_moving")
            self.open(viewer)
            if not arguments:
                self.wait(lambda: self.find("#canvas").get_attribute("data-exact") == "false", "a compressed picture")
                viewer.control(playing=False)  # frames go on
            self.wait(lambda: self.find("#canvas").get_attribute("data-exact") == "true", "the pixels")
            viewer.control(frozen=True)
            self.wait(lambda: self.script("return import('./store.js').then((m) => m.store.tick.frozen)"), "rest")
            status, _, body = viewer.request("picture.png?source=image")
            self.assertEqual(status, 200)
            (self.folder / "truth.png").write_bytes(body)
            truth = read_ppm(self.folder / "truth.png")
            shown = lambda: bytes(v for i, v in enumerate(self.canvas()) if i % 4 != 3)
            self.wait(lambda: shown() == truth, "the same pixels")
            # On the screen, too, a pixel of the picture is a square of one colour, be it a little larger than the
            # screen's or much.
            width, height = map(int, size.split("x"))
            for keys, least, most in (("", 1, 2), ("-" if self.scale() > 1.5 else "+", 1.1, 1.9), (9 * "+", 4, 64)):
                for key in keys:
                    self.press(key)
                scale = self.scale()
                self.assertTrue(least <= scale <= most, scale)
                left, top = self.script("const b = document.getElementById('canvas').getBoundingClientRect();"
                                        "return [b.left, b.top]")
                self.driver.save_screenshot(str(self.folder / "screen.png"))
                screen, across = read_ppm(self.folder / "screen.png"), self.script("return innerWidth")
                for dx, dy in ((-9, 10), (-8, 10), (0, 1), (7, 5)):
                    x, y = width // 2 + dx, height // 2 + dy
                    u, v = int(left + scale * (x + 0.5)), int(top + scale * (y + 0.5))
                    at, of = 3 * (v * across + u), 3 * (y * width + x)
                    self.assertEqual(screen[at:at + 3], truth[of:of + 3], (x, y, scale))
            self.driver.get("about:blank")  # the page must not ask a program that has ended
            viewer.close()

    def test_every_port_that_is_made_can_be_seen(self):
        viewer = self.view("ours", "--set", "vpl_count=64", "--frames", 2, "--validation", size="64x64")
        self.open(viewer)
        sources = [port["source"] for p in viewer.state()["graph"]["passes"] for port in p["ports"] if port["made"]]
        self.assertGreater(len(sources), 40)
        for source in sources:
            status, _, body = viewer.request(f"picture?source={source}&width=64")
            self.assertEqual(status, 200, f"{source}: {body[:200]}")
        self.assertIsNone(viewer.process.poll(), viewer.errors())
        self.assertNotIn("validation", viewer.errors())

    def test_exposure_channel_and_false_colour_change_the_picture(self):
        viewer = self.view("direct", "--frames", 2, size="64x64")
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
        middle = 4 * (32 * 64 + 5)
        self.assertEqual(len(set(red[middle:middle + 3])), 1)
        false = changes(lambda: self.choose("#map", "helix"), "false colours")
        self.assertTrue(any(len(set(false[i:i + 3])) > 1 for i in range(0, len(false), 100)))

    def test_signed_numbers_are_blue_white_and_red_by_themselves(self):
        (self.folder / "passes").mkdir()
        self.write("passes/slope.pass.json", {
            "doc": "Rises from -1 to 3.",
            "outputs": {"slope": {"doc": "from left to right", "format": "r32f", "usage": ["storage_write"]}},
            "steps": [{"shader": "slope.comp", "over": "slope"}]})
        self.write("passes/slope.comp", """layout(local_size_x = 8, local_size_y = 8) in;
layout(r32f) uniform writeonly image2D slope;
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  imageStore(slope, p, vec4(float(p.x) / 16.0 - 1.0));
}
""")
        graph = self.write("slope.json", {"passes": {"slope": {"type": "slope"}}, "outputs": {"image": "slope"}})
        viewer = self.view(graph, "--frames", 2, size="64x64")
        self.open(viewer)
        at = lambda x: self.canvas()[4 * (32 * 64 + x):][:3]
        red, green, blue = at(0)
        self.assertTrue(red < green < blue, (red, green, blue))
        self.assertGreater(min(at(16)), 240)
        red, green, blue = at(63)
        self.assertTrue(red > 100 > blue > green, (red, green, blue))
        self.wait(lambda: self.find("#legend").is_displayed(), "the legend")
        self.assertEqual(self.find("#legend").text.split(), ["-2.938", "0", "2.938"])
        self.choose("#map", "plain")
        self.wait(lambda: len(set(at(63))) == 1, "grey")
        self.assertFalse(self.find("#legend").is_displayed())

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
  uint word = p.x < 16 ? 0x7fc00000u : p.x < 32 ? 0x7f800000u : 0x3f000000u;
  imageStore(radiance, p, vec4(uintBitsToFloat(word)));
}
""")
        graph = self.write("wrong.json", {"passes": {"wrong": {"type": "wrong"}}, "outputs": {"image": "wrong"}})
        viewer = self.view(graph, "--frames", 2, size="64x64")
        self.open(viewer)
        pixels = self.canvas()
        at = lambda x: pixels[4 * (32 * 64 + x):][:3]
        for x, colour in ((5, (255, 0, 255)), (25, (0, 255, 255))):
            self.assertLess(max(abs(a - b) for a, b in zip(at(x), colour)), 12, (x, at(x)))
        self.wait(lambda: self.find("#numbers").get_attribute("data-nan") == str(4 * 16 * 64), "the number of NaNs")


    def test_text_can_be_read_in_light_and_dark(self):
        """The contrast of WCAG AA, 4.5 : 1, for every pair of colours that the page uses for text."""
        viewer = self.view("direct", "--frames", 2, size="64x64")
        self.open(viewer)
        pairs = [("text", ground) for ground in ("ground", "panel", "tint", "wrong-ground")]
        pairs += [("soft", ground) for ground in ("ground", "panel", "stage", "wrong-ground")]
        pairs += [("accent", "panel"), ("accent", "tint"), ("wrong", "panel"), ("text", "bar"), ("on-accent", "accent")]

        def luminance(colour):
            levels = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
            linear = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in levels]
            return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]

        for scheme in ("light", "dark"):
            self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                        {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            colour = lambda name: self.script("return getComputedStyle(document.documentElement)"
                                              ".getPropertyValue('--' + arguments[0]).trim()", name)
            for text, ground in pairs:
                light, dark = sorted((luminance(colour(text)), luminance(colour(ground))), reverse=True)
                self.assertGreaterEqual((light + 0.05) / (dark + 0.05), 4.5, f"{text} on {ground}, {scheme}")

    def test_every_control_has_a_name_and_can_be_reached(self):
        viewer = self.view("ours", "--frames", 1, size="64x64")
        self.open(viewer)
        nameless = self.script("""
            const named = (e) => e.labels?.length || e.getAttribute("aria-label") || e.title || e.innerText.trim();
            return [...document.querySelectorAll("button, select, input, a, [role=button], summary")]
              .filter((e) => !named(e) || e.tabIndex < 0).map((e) => e.outerHTML);""")
        self.assertEqual(nameless, [])


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


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
