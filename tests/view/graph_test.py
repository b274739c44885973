"""The graph and the grid of resources in the page of `fovea view`.

Usage: graph_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import sys
import unittest

from viewer import Keys, ViewTest

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin

INSIDE = """const outer = document.getElementById('graph-view').getBoundingClientRect();
const inner = document.querySelector(arguments[0]).getBoundingClientRect();
return inner.left >= outer.left && inner.right <= outer.right && inner.top >= outer.top && inner.bottom <= outer.bottom;"""


class Graph(ViewTest):
    def graph_scale(self):
        return float(self.find("#graph-view").get_attribute("data-scale"))

    def box(self, selector):
        """Where it is in the view of the graph."""
        return self.script("const a = document.querySelector(arguments[0]).getBoundingClientRect();"
                           "const b = document.getElementById('graph-view').getBoundingClientRect();"
                           "return {x: a.left - b.left, y: a.top - b.top, width: a.width, height: a.height}", selector)

    def test_the_graph_zooms_moves_and_fits(self):
        viewer = self.view("foveal", "--frames", 1, size="64x64")
        self.open(viewer)
        view = self.find("#graph-view")
        before, picture = self.graph_scale(), self.scale()
        # What is under the mouse stays there.
        node = "#graph-view .node.shown rect"
        at = self.box(node)
        wheel = ScrollOrigin.from_element(self.find(node))
        ActionChains(self.driver).scroll_from_origin(wheel, 0, -300).perform()
        self.assertAlmostEqual(self.graph_scale() / before, 1.568, delta=0.01)
        self.assertAlmostEqual(self.box(node)["x"] + self.box(node)["width"] / 2, at["x"] + at["width"] / 2, delta=2)
        # A drag moves, and is no click on the pass where it begins.
        at, source = self.box(node), self.find("#canvas").get_attribute("data-source")
        other = self.find("#graph-view .node.shown")
        ActionChains(self.driver).move_to_element(other).click_and_hold().move_by_offset(-70, 20).release().perform()
        self.assertAlmostEqual(self.box(node)["x"], at["x"] - 70, delta=2)
        self.assertAlmostEqual(self.box(node)["y"], at["y"] + 20, delta=2)
        # With keys: the picture has the same ones, and is left alone.
        for _ in range(3):
            view.send_keys("-")
        self.assertLess(self.graph_scale(), before)
        view.send_keys("0")
        nodes = len(viewer.state()["graph"]["passes"])
        self.assertGreater(nodes, 25)
        for index in range(nodes):
            self.assertTrue(self.script(INSIDE, f"#graph-view .node:nth-of-type({index + 1})"), index)
        view.send_keys("+")
        at = self.box(node)["x"]
        view.send_keys(Keys.ARROW_LEFT)
        self.assertAlmostEqual(self.box(node)["x"], at + 60, delta=2)
        self.assertEqual(self.scale(), picture)
        self.find("#graph-fit").click()
        self.assertEqual(self.find("#canvas").get_attribute("data-source"), source)
        # Two fingers that move apart.
        fitted = self.graph_scale()
        box = self.find("#graph-view").rect
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        touch = lambda kind, spread: self.driver.execute_cdp_cmd("Input.dispatchTouchEvent", {
            "type": kind, "touchPoints": [] if kind == "touchEnd" else [
                {"x": x - spread, "y": y, "id": 1}, {"x": x + spread, "y": y, "id": 2}]})
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": True, "maxTouchPoints": 2})
        touch("touchStart", 30)
        for spread in (40, 50, 60):
            touch("touchMove", spread)
        touch("touchEnd", 0)
        self.driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": False})
        self.assertGreater(self.graph_scale(), 1.4 * fitted)

    def test_a_pass_is_found_by_its_name(self):
        viewer = self.view("foveal", "--frames", 1, size="64x64")
        self.open(viewer)
        self.press("/")
        self.assertEqual(self.driver.switch_to.active_element.get_attribute("id"), "find-pass")
        field = self.find("#find-pass")
        field.send_keys("shadow")
        names = [p["name"] for p in viewer.state()["graph"]["passes"] if "shadow" in p["name"]]
        self.assertGreater(len(names), 1)
        found = lambda: self.find("#graph-view .node.found").get_attribute("data-pass")
        self.assertEqual(found(), names[0])
        self.assertTrue(self.script(INSIDE, "#graph-view .node.found"))
        self.assertIn(f"1 of {len(names)}", self.find("#found").text)
        field.send_keys(Keys.ENTER)
        self.assertEqual(found(), names[1])
        self.assertTrue(self.script(INSIDE, "#graph-view .node.found"))
        self.assertEqual(len(self.find_all("#graph-view .node.match")), len(names))
        field.send_keys("xyz")
        self.assertEqual(self.find("#found").text, "no pass")
        field.send_keys(Keys.ESCAPE)
        self.assertEqual(self.find_all("#graph-view .node.match"), [])
        # A change of a parameter leaves the view where it is.
        self.find("#graph-view").send_keys("++")
        scale, build = self.graph_scale(), viewer.state()["build"]
        viewer.control(set={"tonemap.exposure": 2})
        self.wait(lambda: int(self.find("body").get_attribute("data-build")) > build, "the change")
        self.assertEqual(self.graph_scale(), scale)


class Resources(ViewTest):
    def test_the_grid_says_who_uses_what_and_when(self):
        viewer = self.view("foveal", "--frames", 1, size="64x64")
        self.open(viewer)
        graph = viewer.state()["graph"]
        self.find("#plan-panel summary").click()
        plan = graph["plan"]
        order = [p["name"] for level in plan["levels"] for p in level["passes"]]
        cells = self.script("return [...document.querySelectorAll('#plan tbody tr')].map((row) => ["
                            "row.dataset.resource, [...row.cells].slice(3).map((c) => [c.innerText, c.className])])")
        self.assertEqual(sorted(r["name"] for r in plan["resources"]), sorted(name for name, _ in cells))
        heads = [h.get_attribute("data-pass") for h in self.find_all("#plan thead th[data-pass]")]
        self.assertEqual(heads, order)
        passes = {p["name"]: p for p in graph["passes"]}
        levels = [i for i, level in enumerate(plan["levels"]) for _ in level["passes"]]
        resources = {r["name"]: r for r in plan["resources"]}
        for name, row in cells:
            for column, (text, kinds) in enumerate(row):
                ports = [p for p in passes[order[column]]["ports"] if p["resource"] == name]
                wanted = ("P" * any(p["previous"] for p in ports) +
                          "R" * any(p["reads"] and not p["previous"] for p in ports) + "W" * any(p["writes"] for p in ports))
                self.assertEqual(text, wanted, (name, order[column]))
                first, last = resources[name].get("levels", [0, 1000])
                alive = "heap" not in resources[name] or first <= levels[column] <= last
                self.assertEqual("alive" in kinds, alive and not wanted, (name, order[column], kinds))
        # What shares memory is marked, and told for a row that is clicked.
        shares = lambda a, b: (a is not b and a.get("heap") is not None and a["heap"] == b.get("heap") and
                               a["offset"] < b["offset"] + b["bytes"] and b["offset"] < a["offset"] + a["bytes"])
        name, others = next((r["name"], others) for r in plan["resources"]
                            if (others := [o["name"] for o in plan["resources"] if shares(r, o)]))
        row = f"#plan tr[data-resource='{name}']"
        self.assertEqual(self.find(f"{row} .shared").text, f"⇄{len(others)}")
        self.script("document.querySelector(arguments[0]).click()", f"{row} th")
        self.assertEqual(sorted(e.get_attribute("data-resource") for e in self.find_all("#plan tr.sharing")),
                         sorted(others))
        self.assertIn(others[0], self.find("#chosen").text)
        # Barriers stand before the passes that wait.
        barriers = [b.text for b in self.find_all("#plan td.barriers")]
        for level, is_first, text in zip(levels, [True] + [a != b for a, b in zip(levels, levels[1:])], barriers):
            of = plan["levels"][level]["barriers"] if is_first else {}
            self.assertEqual(text, "M" * ("memory" in of) + str(len(of.get("images", [])) or ""))
        # A click on a pass shows it.
        self.script("document.querySelector(\"#plan th[data-pass='gbuffer']\").click()")
        self.wait(lambda: self.find("#canvas").get_attribute("data-source").startswith("gbuffer:"), "the pass")
        self.assertIn("gbuffer", self.find("#chosen h3").text)
        self.assertIn("shown", self.find("#graph-view .node[data-pass='gbuffer']").get_attribute("class"))
        self.choose("#plan-order", "bytes")
        sizes = [resources[r.get_attribute("data-resource")]["bytes"] for r in self.find_all("#plan tbody tr")]
        self.assertEqual(sizes, sorted(sizes, reverse=True))

    def test_the_grid_is_walked_with_keys(self):
        viewer = self.view("direct", "--frames", 1, size="64x64")
        self.open(viewer)
        self.find("#plan-panel summary").click()
        self.assertEqual(len(self.find_all("#plan [tabindex='0']")), 1)
        self.script("document.querySelector(\"#plan [tabindex='0']\").focus()")
        keys = lambda *k: [self.driver.switch_to.active_element.send_keys(key) for key in k]
        keys(Keys.ARROW_DOWN, Keys.ARROW_DOWN)
        at = self.driver.switch_to.active_element
        first = self.find("#plan tbody tr").get_attribute("data-resource")
        self.assertEqual((at.tag_name, at.text), ("th", first))
        keys(Keys.ENTER)
        self.assertEqual(self.find("#chosen h3").text, first)
        keys(Keys.END, Keys.ARROW_UP, Keys.ARROW_UP)
        last = self.find_all("#plan th[data-pass]")[-1].get_attribute("data-pass")
        self.assertEqual(self.driver.switch_to.active_element.get_attribute("data-pass"), last)
        keys(Keys.ARROW_DOWN, Keys.HOME, Keys.ARROW_RIGHT)
        self.assertEqual(self.driver.switch_to.active_element.get_attribute("class"), "barriers")
        self.assertEqual(len(self.find_all("#plan [tabindex='0']")), 1)


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
