"""Numbers in the page of `fovea view`: tables of buffers, points that are clicked, regions.

Usage: numbers_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import socket
import struct
import sys
import unittest

from viewer import Keys, PATIENCE, ViewTest

from selenium.webdriver.common.action_chains import ActionChains


def floats(words):
    return struct.unpack(f"<{len(words)}f", struct.pack(f"<{len(words)}I", *words))


class Numbers(ViewTest):
    def card(self):
        """The card of the chosen point: its number, and its fields by name, those of its own buffer first."""
        texts = self.script("const c = document.getElementById('element');"
                            "return c.hidden ? null : [c.dataset.index,"
                            " [...c.querySelectorAll('dt:not(.group)')].map((t) => [t.innerText,"
                            " t.nextElementSibling.title]),"
                            " [...c.querySelectorAll('dt.group')].map((t) => t.innerText)]")
        if not texts:
            return None
        fields = {}
        for name, value in texts[1]:
            fields.setdefault(name, value)
        return int(texts[0]), fields, texts[2]

    def test_buffers_are_tables_of_the_fields_of_their_records(self):
        viewer = self.view("ir_1000", "--set", "vpl_count=20", "--frames", 2, size="64x64")
        self.open(viewer)
        self.choose("#source", "emit:vpls")
        self.wait(lambda: len(self.find_all("#table tbody tr")) == 20, "the table")
        # The names are those of the struct in the shaders; what only fills gaps is left out.
        heads = [cell.text for cell in self.find_all("#table thead th")]
        self.assertEqual(heads, ["element", "position", "area", "normal", "intensity"])
        _, channels, words = viewer.pixels("emit:vpls", 3)
        self.assertEqual(channels, 12)
        cells = [cell.text for cell in self.find_all("#table tbody tr:nth-child(4) td")]
        told = [float(v) for v in ", ".join(cells).split(", ")]
        values = floats(words)
        self.assertEqual(struct.pack("<10f", *told), struct.pack("<10f", *values[:7], *values[8:11]))

    def test_a_vpl_that_is_clicked_tells_its_numbers(self):
        viewer = self.view("ours", "--set", "vpl_count=64", "--frames", 4)
        self.open(viewer)
        self.wait(lambda: not self.find("#points-details").get_attribute("hidden"), "the points")
        self.assertEqual(self.find("#points").get_attribute("value"), "vpl-intensity:emitters")
        # Where the picture shows a VPL that faces the eye, by the camera that the page was told.
        _, channels, words = viewer.pixels("vpl-intensity:emitters", 0, 0, 64, 1)
        values = floats(words)
        matrix = self.script("return import('./store.js').then((m) => m.store.tick.views.main)")
        eye = self.script("return import('./store.js').then((m) => m.store.tick.camera.position)")

        def place(p):
            row = lambda i: sum(matrix[i + 4 * k] * p[k] for k in range(3)) + matrix[i + 12]
            return [(0.5 + 0.5 * row(i) / row(3)) * 256 for i in range(2)]

        vpls = {}
        for i in range(64):
            v = values[channels * i:channels * (i + 1)]
            if any(v) and sum((eye[k] - v[k]) * v[4 + k] for k in range(3)) > 0:
                vpls[i] = place(v[:3])
        distance = lambda a, b: max(abs(a[0] - b[0]), abs(a[1] - b[1]))
        alone = [i for i, at in vpls.items() if 20 < at[0] < 236 and 20 < at[1] < 150 and
                 all(i == k or distance(at, other) > 6 for k, other in vpls.items())]
        self.assertTrue(alone, vpls)
        index = alone[0]
        offset = [self.scale() * (c - 128) for c in vpls[index]]
        click = ActionChains(self.driver).move_to_element_with_offset(self.find("#canvas"), *map(round, offset))
        click.click().perform()
        number, fields, groups = self.wait(self.card, "the numbers of the VPL")
        self.assertEqual(number, index)
        told = struct.pack("<3f", *map(float, fields["position"].split(", ")))
        self.assertEqual(told, struct.pack("<3f", *values[channels * index:channels * index + 3]))
        # What other buffers say about the VPL of this number: its age (`life`) and its importance.
        self.assertGreaterEqual(set(fields), {"position", "normal", "intensity", "area", "life", "importance"})
        self.assertGreaterEqual(int(float(fields["life"])), 1)
        self.assertIn("manage · list", groups)
        # By keyboard.
        other = next(i for i in vpls if i != index)
        self.find("#points-details summary").click()
        entry = self.find("#point-number")
        entry.clear()
        entry.send_keys(str(other) + Keys.ENTER)
        self.wait(lambda: (now := self.card()) and now[0] == other, "another VPL")
        # Where there is none, nothing is told.
        self.find("#show-points").click()
        self.wait(lambda: self.find_all("#point-marks path"), "the marks")
        self.find("#element button").click()
        self.wait(lambda: self.card() is None, "the card to close")

    def test_a_region_tells_its_numbers_and_keeps_its_floats(self):
        viewer = self.view("direct", "--frames", 2)
        self.open(viewer)
        self.choose("#source", "radiance")
        self.wait(lambda: self.find("#canvas").get_attribute("data-source") == "radiance", "the radiance")
        drag = ActionChains(self.driver).key_down(Keys.CONTROL)
        drag.move_to_element_with_offset(self.find("#canvas"), -40, -30).click_and_hold().move_by_offset(70, 50)
        drag.release().key_up(Keys.CONTROL).perform()
        entries = lambda: [self.find(f"#region-{n}").get_attribute("value") for n in ("x", "y", "width", "height")]
        x, y, width, height = map(int, self.wait(lambda: all(entries()) and entries(), "the region"))
        scale = self.scale()
        self.assertAlmostEqual(width, 70 / scale, delta=2)
        self.assertAlmostEqual(y, 128 - 30 / scale, delta=2)
        for name, value in zip(("x", "y", "width", "height"), (60, 90, 16, 8)):
            self.choose(f"#region-{name}", str(value))
        _, channels, words = viewer.pixels("radiance", 60, 90, 16, 8)
        red = floats(words)[0::channels]
        expected = [min(red), max(red), sum(red) / len(red)]

        def told():
            words = self.find("#numbers").text.split("\n")[0].replace(",", "").split()
            return [float(w) for w in words[1::2]]  # "red 0.1 to 0.5, mean 0.3"; nothing before the first answer

        def told_right():
            numbers = told()
            return len(numbers) == 3 and all(abs(a - b) < 2e-4 * abs(b) + 1e-9 for a, b in zip(numbers, expected))

        self.wait(told_right, f"the numbers of the region, {expected}")
        self.assertTrue(self.find_all("#region-mark rect"))
        target = self.find("#region-raw").get_attribute("href").split(viewer.path, 1)[1]
        status, headers, body = viewer.request(target)
        self.assertEqual((status, headers["X-Fovea-Region"]), (200, "16x8"))
        self.assertEqual(struct.unpack(f"<{len(body) // 4}I", body), words)
        self.find("#region-clear").click()
        self.wait(lambda: not any(entries()), "the whole picture")
        self.assertEqual(viewer.request("statistics?source=radiance&x=256")[0], 404)

    def test_tev_is_sent_the_floats_of_a_picture(self):
        server = socket.create_server(("127.0.0.1", 0))
        self.addCleanup(server.close)
        server.settimeout(PATIENCE)
        viewer = self.view("direct", "--frames", 2, "--tev", f"127.0.0.1:{server.getsockname()[1]}", size="64x48")
        client, _ = server.accept()
        self.addCleanup(client.close)
        client.settimeout(PATIENCE)

        def packet():
            """The type of the next packet, its texts in front, and the rest."""
            length, = struct.unpack("<I", client.recv(4, socket.MSG_WAITALL))
            body = client.recv(length - 4, socket.MSG_WAITALL)
            self.assertEqual(len(body), length - 4)
            kind, focus = body[0], body[1]
            self.assertEqual(focus, 0)
            name, rest = body[2:].split(b"\0", 1)
            return kind, name.decode(), rest

        kind, name, rest = packet()
        self.assertEqual((kind, name), (4, "fovea radiance"))
        self.assertEqual(rest, struct.pack("<3i", 64, 48, 3) + b"R\0G\0B\0")
        self.wait(lambda: viewer.state(), "the state")

        def update():
            kind, name, rest = packet()
            if kind != 6 or name != "fovea radiance":
                return None
            self.assertEqual(rest[:34], struct.pack("<i", 3) + b"R\0G\0B\0" + struct.pack("<4i", 0, 0, 64, 48) +
                             struct.pack("<q", 0))
            self.assertEqual(rest[34:74], struct.pack("<5q", 1, 2, 3, 3, 3))
            return rest[74:]

        first = update()
        self.assertEqual(len(first), 64 * 48 * 3 * 4)
        _, channels, words = viewer.pixels("radiance", 0, 0, 64, 48)
        seen = struct.pack(f"<{64 * 48 * 3}I", *(w for i, w in enumerate(words) if i % channels < 3))
        while first != seen:  # the newest frame comes last
            first = update()
        # Another source, chosen in the page.
        self.open(viewer)
        self.choose("#source", "gbuffer:gbuffer.depth")
        self.wait(lambda: self.find("#tev").is_displayed(), "the button")
        self.find("#tev").click()
        kind, name, rest = packet()
        while kind != 4:
            kind, name, rest = packet()
        self.assertEqual((name, rest), ("fovea gbuffer:gbuffer.depth", struct.pack("<3i", 64, 48, 1) + b"L\0"))


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
