"""Shared by the tests of `fovea view`: the program, a headless Chromium that looks at it, and requests without one.

Exits with 77, which CTest reports as skipped, if the browser or selenium are missing.
"""

import http.client
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import unittest
from urllib.parse import quote, urlsplit

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
SOURCE = pathlib.Path(sys.argv[2]).resolve()
CHROMIUM, DRIVER = shutil.which("chromium"), shutil.which("chromedriver")
if not CHROMIUM or not DRIVER:
    print("skipped: there is no chromium or no chromedriver")
    sys.exit(77)

# Full numbers of reloads, frames and connections, which take minutes each on a machine that does nothing else.
SOAK = os.environ.get("FOVEA_VIEW_SOAK") == "1"
PATIENCE = 60  # seconds; the device renders on the CPU and shares it with other tests


class Viewer:
    """A running `fovea view` over the Cornell box at 256x256."""

    def __init__(self, folder, graph, *arguments, scene="cornellbox", size="256x256", env=None):
        self.folder = folder
        self.log = open(folder / "viewer.log", "a+")
        self.process = subprocess.Popen(
            [str(PROGRAM), "view", *([str(graph)] if graph else []), "--scene", str(scene), "--size", size, *map(str, arguments)],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=self.log, text=True, cwd=folder,
            env={**os.environ, **(env or {})})
        line = self.process.stdout.readline()
        if not line.startswith("open http://"):
            raise AssertionError(f"no address: {line!r} {self.errors()}")
        self.url = line.split()[1]
        self.number = 0  # of the last picture whose pixels were read
        self.port = urlsplit(self.url).port
        self.path = urlsplit(self.url).path

    def errors(self):
        self.log.seek(0)
        return self.log.read()

    def resident(self):
        """Memory of the program in KiB."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s*(\d+)", status).group(1))

    def close(self):
        if self.process.poll() is None:
            self.process.terminate()
            self.process.wait(PATIENCE)
        self.process.stdout.close()
        self.log.close()

    def request(self, target, method="GET", body=None, headers=None, whole=False):
        """Returns status, headers and body. `whole`: the target is not below the token."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            connection.request(method, target if whole else self.path + target, body, headers or {})
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def state(self):
        return json.loads(self.request("state")[2])

    def control(self, **command):
        status, _, body = self.request("control", "POST", json.dumps(command))
        if status != 204:
            raise AssertionError(f"{command}: {status} {body}")

    def pixels(self, source, x=0, y=0, width=1, height=1, after=0):
        """Returns the number of the frame, the number of channels and the words of a region."""
        status, headers, body = self.request(
            f"pixels?source={quote(source)}&x={x}&y={y}&width={width}&height={height}&after={after}")
        self.number = int(headers.get("X-Fovea-Number", 0))
        if status != 200:
            raise AssertionError(f"{source}: {status} {body}")
        return (int(headers["X-Fovea-Frame"]), int(headers["X-Fovea-Channels"]),
                struct.unpack(f"<{len(body) // 4}I", body))


class ViewTest(unittest.TestCase):
    driver = None

    @classmethod
    def setUpClass(cls):
        options = Options()
        options.binary_location = CHROMIUM
        for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
                         "--window-size=1280,800"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(service=Service(DRIVER), options=options)
        cls.driver.set_script_timeout(PATIENCE)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="fovea-view-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def view(self, graph, *arguments, **more):
        viewer = Viewer(self.folder, graph, *arguments, **more)
        self.addCleanup(viewer.close)
        return viewer

    def open(self, viewer):
        """Opens the page and waits for its first picture. No error may be in the browser's console at the end."""
        self.driver.get(viewer.url)
        self.addCleanup(self.check_console)
        self.addCleanup(self.driver.get, "about:blank")
        self.wait(lambda: self.find("#canvas").get_attribute("data-frame"), "the first picture")

    def check_console(self):
        severe = [entry for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]
        self.assertEqual(severe, [])

    def wait(self, condition, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            value = condition()
            if value:
                return value
            time.sleep(0.05)
        self.fail(f"waited {PATIENCE} s for {what}")

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def find_all(self, selector):
        return self.driver.find_elements(By.CSS_SELECTOR, selector)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def press(self, keys):
        self.find("#stage").send_keys(keys)

    def choose(self, selector, value):
        """Sets a control and tells the page, in one step, as the page may replace the control at any time."""
        self.find(selector)
        self.script("const control = document.querySelector(arguments[0]);"
                    "control.value = arguments[1];"
                    "control.dispatchEvent(new Event('input', {bubbles: true}));"
                    "control.dispatchEvent(new Event('change', {bubbles: true}));", selector, value)

    def canvas(self):
        """The pixels of the canvas as a list of bytes, RGBA."""
        return self.script("const c = document.getElementById('canvas');"
                           "return [...c.getContext('2d').getImageData(0, 0, c.width, c.height).data];")

    def scale(self):
        """Pixels of the page for one of the picture."""
        return self.script("const c = document.getElementById('canvas');"
                           "return c.getBoundingClientRect().width / c.width")

    def shown_frame(self):
        return int(self.find("#canvas").get_attribute("data-frame"))

    def render(self, *arguments):
        run = subprocess.run([str(PROGRAM), "render", *map(str, arguments)], cwd=self.folder, capture_output=True,
                             text=True, timeout=300)
        self.assertEqual(run.returncode, 0, run.stderr)

    def write(self, name, content):
        """Writes as editors do: under another name first."""
        path = self.folder / name
        text = content if isinstance(content, str) else json.dumps(content, indent=2)
        path.with_suffix(".part").write_text(text)
        path.with_suffix(".part").rename(path)
        return path


class PlainGraph:
    """A graph of one pass in a file, which shows one colour."""

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


def read_ppm(path):
    """The bytes of the RGB of a picture, pixel after pixel."""
    plain = path.with_suffix(".ppm")
    subprocess.run(["oiiotool", path, "--ch", "R,G,B", "-d", "uint8", "-o", plain], check=True)
    head = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", plain.read_bytes())
    return plain.read_bytes()[head.end():]


__all__ = ["By", "Keys", "PATIENCE", "PROGRAM", "PlainGraph", "SOAK", "SOURCE", "ViewTest", "Viewer", "read_exr",
           "read_ppm"]
