"""Frames as arrays: the pictures of `fovea render`, ports, buffers, inputs and parameters."""

import numpy
import pytest

import fovea

SIZE = (48, 32)
FEW = {"vpl_count": 20, "map_size": 16, "shadow_map_size": 64}
FEWER = {**FEW, "voxels": 16, "attempts": 200}


@pytest.mark.parametrize("graph, settings", [
    ("direct", {}),
    ("ir_1000", FEW),
    ("ours", FEWER),
    ("foveal", FEWER),
    ("reference", {"spp": 4}),
])
def test_frames_are_those_of_the_program_to_the_bit(program, tmp_path, graph, settings):
    options = [part for name, value in settings.items() for part in ("--set", f"{name}={value}")]
    program("render", graph, "--scene", "cornellbox_moving", "--size", "48x32", "--frames", "3", *options,
            "-q", "-o", "out_%04d.exr")
    renderer = fovea.Renderer(graph, "cornellbox_moving", size=SIZE, set=settings)
    for index in range(3):
        frame = renderer.frame()
        layers = fovea.read_image(tmp_path / f"out_{index:04}.exr")
        assert set(layers) <= set(frame)
        assert "radiance" in layers
        for name, layer in layers.items():
            assert frame[name].shape[:2] == (32, 48)
            numpy.testing.assert_array_equal(frame[name][..., :layer.shape[2]], layer, f"{name} of frame {index}")


def test_images_are_read_only_views_of_the_frame():
    frame = fovea.Renderer("direct", "cornellbox", size=SIZE).frame()
    radiance = frame["radiance"]
    assert (radiance.shape, radiance.dtype) == ((32, 48, 4), numpy.float32)
    assert not radiance.flags.writeable and not radiance.flags.owndata
    again = frame._result.array("radiance")
    assert again.ctypes.data == radiance.ctypes.data
    with pytest.raises(ValueError):
        radiance[0, 0, 0] = 1
    before = radiance.copy()
    del frame, again
    numpy.testing.assert_array_equal(radiance, before)


def test_displayed_images_are_floats_from_0_to_1():
    image = fovea.Renderer("direct", "cornellbox", size=SIZE).frame()["image"]
    assert image.dtype == numpy.float32
    assert 0 <= image.min() < 0.1 and 0.9 < image.max() <= 1
    numpy.testing.assert_array_equal(image, numpy.round(image * 255).astype(numpy.float32) / numpy.float32(255))


def test_arrays_go_through_dlpack():
    radiance = fovea.Renderer("direct", "cornellbox", size=SIZE).frame()["radiance"]
    shared = numpy.from_dlpack(radiance)
    assert shared.ctypes.data == radiance.ctypes.data


def test_ports_and_records():
    renderer = fovea.Renderer("ours", "cornellbox", size=SIZE, set=FEWER,
                              read=["radiance", "gbuffer.gbuffer.normal"])
    frame = renderer.frame()
    assert list(frame) == ["radiance", "gbuffer.gbuffer.normal"]
    assert frame["gbuffer.gbuffer.normal"].shape[:2] == (32, 48)
    rays = renderer.read("gbuffer.gbuffer.camera")
    assert rays.shape == (1,) and rays.dtype.itemsize == 64 and rays.dtype.names
    assert "gbuffer.gbuffer.camera" in renderer.frame()


def test_the_last_frame_is_not_rendered_again_for_what_it_has():
    renderer = fovea.Renderer("direct", "cornellbox", size=SIZE)
    frame = renderer.frame()
    numpy.testing.assert_array_equal(renderer.read("radiance"), frame["radiance"])
    assert renderer.frame().index == 1


def test_nothing_is_read_where_nothing_is_wanted():
    renderer = fovea.Renderer("direct", "cornellbox", size=SIZE)
    assert list(renderer.frame(read=False)) == []
    assert "radiance" in renderer.frame()


def test_parameters_change_while_history_goes_on():
    changed, untouched, fresh = (fovea.Renderer("ours", "cornellbox", size=SIZE, set=FEWER) for _ in range(3))
    for _ in range(3):
        changed.frame()
        untouched.frame()
    changed.set("tonemap.exposure", 2.0)
    radiance = changed.frame()["radiance"]
    numpy.testing.assert_array_equal(radiance, untouched.frame()["radiance"])
    assert not numpy.array_equal(radiance, fresh.frame(3)["radiance"])
    before = changed.frame()["radiance"]
    changed.set({"deferred.kernel": "disc"})
    assert not numpy.array_equal(changed.frame(4)["radiance"], before)


def test_a_wrong_parameter_changes_nothing():
    renderer = fovea.Renderer("direct", "cornellbox", size=SIZE)
    before = renderer.frame(0)["radiance"]
    with pytest.raises(fovea.Error, match="exposre") as caught:
        renderer.set("tonemap.exposre", 2)
    assert "exposure" in caught.value.remedy
    numpy.testing.assert_array_equal(renderer.frame(0)["radiance"], before)


def test_gaze_time_and_camera_steer_frames():
    renderer = fovea.Renderer("direct", "cornellbox_moving", size=SIZE)
    first = renderer.frame(0)["radiance"]
    assert not numpy.array_equal(renderer.frame(0, time=1)["radiance"], first)
    camera = fovea.Camera.look_at((0, 2.75, 9.2), (1, 2.75, 0))
    assert not numpy.array_equal(renderer.frame(0, camera=camera)["radiance"], first)
    with pytest.raises(fovea.Error, match="gaze"):
        renderer.frame(gaze=(2, 0))
    with pytest.raises(fovea.Error, match="time"):
        renderer.frame(time=-1)


INPUT_GRAPH = {"version": 2, "inputs": {"radiance": {"format": "rgba16f", "light": True}},
               "passes": {"tonemap": {"type": "tonemap", "inputs": {"radiance": "inputs.radiance"}}},
               "outputs": {"image": "tonemap"}}


def test_inputs_are_written():
    renderer = fovea.Renderer(fovea.Graph.parse(INPUT_GRAPH), "cornellbox", size=SIZE)
    assert renderer.inputs == {"radiance": ("float32", [32, 48, 4])}
    with pytest.raises(fovea.Error, match="never set"):
        renderer.frame()
    renderer.write("radiance", numpy.zeros((32, 48, 4)))
    assert renderer.frame()["image"][..., :3].max() == 0
    renderer.write("radiance", numpy.full((32, 48, 4), 1e3, numpy.float32))
    assert renderer.frame()["image"].min() == 1
    with pytest.raises(ValueError, match=r"\(32, 48, 4\)"):
        renderer.write("radiance", numpy.zeros((48, 32, 4)))
    with pytest.raises(TypeError, match="float32"):
        renderer.write("radiance", numpy.zeros((32, 48, 4), numpy.complex64))
    with pytest.raises(fovea.Error, match="radience"):
        renderer.write("radience", numpy.zeros((32, 48, 4)))


def test_tables_and_plan():
    renderer = fovea.Renderer("ours", "cornellbox", size=SIZE, set=FEWER)
    with pytest.raises(RuntimeError):
        renderer.timings  # noqa: B018
    frame = renderer.frame()
    rows = renderer.timings
    rows = rows if isinstance(rows, list) else rows.to_dict("records")
    assert {"gbuffer", "deferred", "tonemap"} <= {row["pass"] for row in rows}
    assert all(row["gpu_ms"] >= 0 for row in rows)
    assert 0 < sum(row["gpu_ms"] for row in rows) <= frame.gpu_ms * 1.001
    assert len(renderer.counters) > 0
    assert "gbuffer" in str(renderer.plan) and renderer.plan.data["graph"] == "ours"
