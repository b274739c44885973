"""Which clients `fovea view` serves, and what the server withstands.

Usage: server_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import socket
import subprocess
import sys
import time
import unittest

from viewer import PATIENCE, PROGRAM, ViewTest


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
                                (2, ["direct", "--scene", "cornellbox", "--tev", "nowhere"]),
                                (2, ["direct", "--scene", "cornellbox", "--tev", "127.0.0.1:70000"]),
                                (3, ["direct", "--scene", "cornellbox", "--set", "nope=1"]),
                                (4, ["direct", "--scene", "cornellbox", "--device", "nosuch"])):
            run = subprocess.run([PROGRAM, "view", *arguments], capture_output=True, text=True, timeout=PATIENCE)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertTrue(run.stderr.startswith("fovea: "), run.stderr)
            self.assertEqual(run.stdout, "")


if __name__ == "__main__":
    groups = sys.argv[3:]
    unittest.main(argv=[sys.argv[0], *groups], verbosity=2)
