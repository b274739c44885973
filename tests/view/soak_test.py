"""Endurance of `fovea view`: memory stays constant, nothing crashes, nobody is served without the token.

Usage: soak_test.py PROGRAM SOURCE_DIR [CLASS...]

With FOVEA_VIEW_SOAK=1 in the environment, the numbers are those of a release: 1,000 reloads, 10,000 frames, 10,000
connections. Each test then prints what it measured.
"""

import json
import random
import socket
import sys
import threading
import time
import unittest

from viewer import PlainGraph, SOAK, ViewTest


class Soak(PlainGraph, ViewTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(lambda started: SOAK and print(
            f"{self.id()}: {time.monotonic() - started:.0f} s", file=sys.stderr), time.monotonic())

    def assert_flat(self, before, after, what):
        """5%, and 4 MiB for what an allocator keeps."""
        if SOAK:
            print(f"{what}: {before} KiB before, {after} KiB after", file=sys.stderr)
        self.assertLess(after, 1.05 * before + 4096, what)

    def test_reloads_leave_memory_flat(self):
        viewer = self.view(self.plain(), "--validation", size="64x64")
        viewer.pixels("image")
        good = {"passes": {"plain": {"type": "plain", "params": {}}}, "outputs": {"image": "plain"}}

        def reload(i):
            # A new shader, a wrong one, a new graph, a wrong one, in turns.
            build = viewer.state()["build"]
            kind = i % 4
            if kind < 2:
                colour = f"{i % 7}.0 / 7.0, 0.0" if kind == 0 else "wrong"
                self.write("passes/plain.frag", self.SHADER.replace("COLOUR", colour))
            else:
                good["passes"]["plain"]["params"]["level"] = (i % 9) / 9
                # Shader and graph are mended together, or the graph would not be tried.
                self.write("passes/plain.frag", self.SHADER.replace("COLOUR", "0.5, 0.0"))
                text = json.dumps(good)
                self.write("plain.json", text if kind == 2 else text.replace("plain", "plan"))
            self.wait(lambda: viewer.state()["build"] > build, f"reload {i}")
            if kind == 3:
                self.write("plain.json", good)
            viewer.pixels("image")  # a run that nobody looks at renders nothing

        first = 100 if SOAK else 12
        for i in range(first):
            reload(i)
        before = viewer.resident()
        for i in range(first, 1000 if SOAK else 32):
            reload(i)
        self.assert_flat(before, viewer.resident(), "reloads")
        self.assertIsNone(viewer.process.poll())
        self.assertNotIn("validation", viewer.errors())

    def test_pages_come_and_go(self):
        frames = 10_000 if SOAK else 200
        # Maps of 2048 texels would come and go in steps of 16 MiB, behind which smaller things could hide.
        viewer = self.view("direct", "--set", "shadow_map_size=256", "--frames", frames, "--validation", size="64x64")
        sources = ["image", "radiance", "gbuffer:gbuffer.normal", "shadow-map:maps.depth"]
        for source in sources:  # so that all buffers are there that copy them
            for _ in range(3):
                viewer.pixels(source, after=viewer.number)
        shown = [0]
        frozen = threading.Event()
        failures = []

        def page(seed):
            """Loads the page, listens, looks at sources and measures, and vanishes, again and again."""
            chance = random.Random(seed)
            try:
                while not frozen.is_set():
                    for name in ("", "main.js", "style.css", "state"):
                        if viewer.request(name)[0] != 200:
                            failures.append(name)
                    listener = socket.create_connection(("127.0.0.1", viewer.port))
                    listener.sendall(f"GET {viewer.path}events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
                    source = chance.choice(sources)
                    number = 0
                    for _ in range(chance.randint(1, 40)):
                        status, headers, _ = viewer.request(f"picture?source={source}&after={number}")
                        if status == 200:
                            number = int(headers["X-Fovea-Number"])
                            shown[0] = max(shown[0], int(headers["X-Fovea-Frame"]))
                        elif status == 204:  # nothing new for seconds
                            frozen.set()
                            break
                        elif status == 503:  # those that vanished still have the places of others
                            time.sleep(0.05)
                        else:
                            failures.append(f"{source}: {status}")
                    viewer.request(f"statistics?source={source}")
                    if chance.random() < 0.5:
                        waiting = socket.create_connection(("127.0.0.1", viewer.port))
                        waiting.sendall(f"GET {viewer.path}picture?source=image&after=9e15 HTTP/1.1\r\n"
                                        "Host: localhost\r\n\r\n".encode())
                        waiting.close()
                    listener.close()
            except OSError as error:
                failures.append(repr(error))

        pages = [threading.Thread(target=page, args=(i,)) for i in range(2)]
        for thread in pages:
            thread.start()
        while shown[0] < frames // 10 and not failures and not frozen.is_set():
            time.sleep(0.1)
        before = viewer.resident()
        for thread in pages:
            thread.join()
        self.assertEqual(failures, [])
        self.assertGreater(shown[0], 0.8 * frames)
        self.assert_flat(before, viewer.resident(), f"{frames} frames")
        self.assertIsNone(viewer.process.poll())
        self.assertNotIn("validation", viewer.errors())

    def test_connections_leave_it_as_it_was(self):
        viewer = self.view("direct", size="32x32")
        token = viewer.path.strip("/")
        hostile = [
            b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
            b"\x16\x03\x01\x02\x00" * 9,  # the beginning of TLS
            f"POST /{token}/control HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999\r\n\r\n{{".encode(),
            f"GET /{token[:-1]}x/state HTTP/1.1\r\nHost: localhost\r\n\r\n".encode(),
            f"GET /{token}/state HTTP/1.1\r\nHost: evil.example\r\n\r\n".encode(),
            f"GET /{token}/../../../etc/passwd HTTP/1.1\r\nHost: localhost\r\n\r\n".encode(),
            f"GET /{token}/%2e%2e/%2e%2e/etc/passwd HTTP/1.1\r\nHost: localhost\r\n\r\n".encode(),
            b""]
        slow = []
        served = []

        def knock(count, kept):
            for i in range(count):
                client = socket.create_connection(("127.0.0.1", viewer.port))
                text = hostile[i % len(hostile)]
                if i % 100 == 99:  # a client that sends a byte now and then, and reads nothing
                    client.sendall(b"GET /")
                    slow.append(client)
                    if len(slow) > kept:
                        slow.pop(0).close()
                    continue
                client.sendall(text)
                if i % 7 == 0 and b"HTTP" in text and not text.startswith(b"POST"):
                    client.settimeout(30)
                    answer = client.recv(4096)
                    if not answer.startswith((b"HTTP/1.1 40", b"HTTP/1.1 503")):
                        served.append(answer[:80])
                client.close()

        for _ in range(5):
            viewer.pixels("image", after=viewer.number)
        knock(400, 10)
        before = viewer.resident()
        knock(10_000 if SOAK else 800, 10)
        self.assertEqual(served, [])
        for client in slow:
            client.close()
        self.wait(lambda: viewer.request("state")[0] == 200, "an answer")
        frame = viewer.pixels("image")[0]
        self.wait(lambda: viewer.pixels("image", after=viewer.number)[0] > frame, "frames that go on")
        self.assert_flat(before, viewer.resident(), "connections")
        self.assertIsNone(viewer.process.poll())


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
