"""Several renderers, several threads, and Ctrl-C."""

import signal
import subprocess
import sys
import threading
import time

import numpy

import fovea

SIZE = (48, 32)


FEW = {"vpl_count": 20, "map_size": 16, "shadow_map_size": 64}


def renderer_of(graph):
    return fovea.Renderer(graph, "cornellbox", size=SIZE, set=FEW if graph == "ir_1000" else None)


def frames(graph, count=3):
    renderer = renderer_of(graph)
    return [renderer.frame()["radiance"] for _ in range(count)]


def test_two_renderers_alternate_as_if_each_were_alone():
    alone = frames("direct"), frames("ir_1000")
    one, other = (renderer_of(g) for g in ("direct", "ir_1000"))
    for index in range(3):
        numpy.testing.assert_array_equal(one.frame()["radiance"], alone[0][index])
        numpy.testing.assert_array_equal(other.frame()["radiance"], alone[1][index])


def test_threads_render_at_once():
    alone, results = frames("direct"), {}

    def work(number):
        results[number] = frames("direct")

    threads = [threading.Thread(target=work, args=(i,)) for i in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results.values():
        numpy.testing.assert_array_equal(result, alone)
    assert len(results) == 3


def test_python_goes_on_while_a_frame_is_rendered():
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    renderer = fovea.Renderer("reference", "cornellbox", size=(64, 64), set={"spp": 512})
    thread.start()
    before, start = counted[0], time.monotonic()
    renderer.frame()
    passed, taken = counted[0] - before, time.monotonic() - start
    done.set()
    thread.join()
    assert taken > 0.05
    assert passed > 0.1 * taken / 0.001


CTRL_C = """
import fovea, os, signal, threading
threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    fovea.reference("cornellbox", size=(256, 256), spp=1 << 20)
except KeyboardInterrupt:
    print("interrupted", fovea.Renderer("direct", "cornellbox", size=(8, 8)).frame()["radiance"].shape)
"""


def test_ctrl_c_ends_a_reference_and_no_more():
    done = subprocess.run([sys.executable, "-c", CTRL_C], capture_output=True, text=True, timeout=60,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler))
    assert done.stdout == "interrupted (8, 8, 4)\n", done.stderr
