"""Moving, timing and changing a run of `fovea view` in its page.

Usage: run_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import sys
import time
import unittest

from viewer import Keys, ViewTest, read_exr

from selenium.webdriver.common.action_chains import ActionChains


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


class Change(ViewTest):
    def test_a_parameter_changes_the_picture_and_the_saved_graph(self):
        graph = self.write("mine.json", {"extends": "ir_1000.json"})
        viewer = self.view(graph, "--frames", 2, size="64x64")
        self.open(viewer)
        before = self.canvas()
        slider = self.find("[data-name='vpl_count'] input[type='range']")
        ActionChains(self.driver).click_and_hold(slider).move_by_offset(-25, 0).release().perform()
        dragged = self.wait(lambda: viewer.state()["set"], "the slider")
        self.assertRegex(dragged[0], r"^vpl_count=\d+$")
        self.wait(lambda: self.canvas() != before, "the picture of the slider's value")
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
                         {"version": 2, "extends": "mine.json", "parameters": {"vpl_count": 7},
                          "passes": {"tonemap": {"params": {"exposure": 2}}}})
        # It runs like what was shown, and is not written over.
        frame, _, words = viewer.pixels("radiance", 0, 0, 64, 64)
        self.render("saved.json", "--scene", "cornellbox", "--size", "64x64", "--frames", frame + 1, "-o",
            "saved.exr", "-q")
        seen = tuple(word for i, word in enumerate(words) if i % 4 != 3)
        self.assertEqual(seen == read_exr(self.folder / "saved.exr", "radiance"), True, "the pictures differ")
        viewer.control(save="saved")
        self.wait(lambda: "exists already" in json.dumps(viewer.state()["messages"]), "the refusal")
        viewer.control(set={"vpl_count": None})
        self.wait(lambda: viewer.state()["set"] == ["tonemap.exposure=2"], "the reset of one")
        viewer.control(reset=True)
        self.wait(lambda: viewer.state()["set"] == [], "the reset of all")

    def test_parameters_of_a_sub_graph_change_and_are_saved(self):
        self.write("part.json", {"parameters": {"curve": "clamp"}, "inputs": {"radiance": {"doc": "what is shown"}},
                                 "passes": {"tonemap": {"type": "tonemap", "inputs": {"radiance": "inputs.radiance"},
                                                        "params": {"operator": "$curve"}}},
                                 "outputs": {"image": "tonemap"}})
        graph = self.write("mine.json", {"extends": "direct.json", "outputs": {"image": "shown.image"}, "passes": {
            "tonemap": None, "shown": {"graph": "part.json", "inputs": {"radiance": "direct"}}}})
        viewer = self.view(graph, size="64x64")
        self.open(viewer)
        self.find("#parameters [data-pass='shown'] summary").click()
        options = [o.text for o in self.find_all("[id='parameter-shown.curve'] option")]
        self.assertIn("agx", options)  # as the pass declares it that takes the value
        before = self.canvas()
        self.choose("[id='parameter-shown.curve']", "agx")
        self.wait(lambda: viewer.state()["set"] == ["shown.curve=agx"] and self.canvas() != before, "another curve")
        viewer.control(save="saved")
        self.wait(lambda: (self.folder / "saved.json").exists(), "the file")
        saved = json.loads((self.folder / "saved.json").read_text())
        self.assertEqual(saved["passes"], {"shown": {"parameters": {"curve": "agx"}}})
        # No graph that extends this one reaches further in, which the page says.
        self.wait(lambda: "a saved graph cannot hold them" in self.script(
            "return document.querySelector(\"[data-pass='shown/tonemap'] .note\").textContent"), "the remark")
        viewer.control(set={"shown/tonemap.exposure": 2})
        self.wait(lambda: len(viewer.state()["set"]) == 2, "the change")
        viewer.control(save="second")
        self.wait(lambda: "inside of a sub-graph" in json.dumps(viewer.state()["messages"]), "the refusal")
        self.assertFalse((self.folder / "second.json").exists())
        # A file that changes meanwhile does not take the refusal away.
        build = viewer.state()["build"]
        self.write("another.json", {"extends": "direct.json"})
        self.wait(lambda: viewer.state()["build"] > build, "the files to be read again")
        self.assertIn("inside of a sub-graph", json.dumps(viewer.state()["messages"]))

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

    def test_without_a_graph_the_one_for_viewing_is_shown(self):
        viewer = self.view(None, "--frames", 1, size="64x64")
        self.open(viewer)
        self.assertEqual(viewer.state()["graph_name"], "foveal_view")

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


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
