"""Nothing stays behind: many frames, and many renderers that are made and dropped."""

import gc
import resource

import fovea

LIMIT = 2 << 20  # bytes


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def grown(rounds, work):
    for _ in range(rounds // 5):
        work()
    before = resident()
    for _ in range(rounds):
        work()
    return resident() - before


def test_frames_leak_nothing():
    renderer = fovea.Renderer("ours", "cornellbox", size=(16, 16), 
                              set={"vpl_count": 20, "map_size": 16, "shadow_map_size": 64, "voxels": 16})

    def frame():
        out = renderer.frame()
        assert all(array is not None for array in out.values())
        assert len(out.timings) > 0

    assert grown(1000, frame) < LIMIT


def test_renderers_leak_nothing():
    scene = fovea.load_scene("cornellbox")

    def make():
        fovea.Renderer("direct", scene, size=(16, 16), set={"shadow_map_size": 64}).frame()

    gc.disable()  # what is dropped goes at once, as it holds memory of the device
    try:
        assert grown(200, make) < LIMIT
    finally:
        gc.enable()
