"""Pictures in files, comparisons and references."""

import json

import numpy
import pytest

import fovea

SIZE = (48, 32)


def test_comparisons_are_those_of_the_program(program, tmp_path):
    reference = fovea.reference("cornellbox", size=SIZE, spp=16)
    picture = fovea.Renderer("ir_1000", "cornellbox", size=SIZE, set={"vpl_count": 50, "map_size": 16}).frame()
    fovea.write_image(tmp_path / "picture.exr", picture)
    fovea.write_image(tmp_path / "reference.exr", reference)
    told = json.loads(program("compare", "picture.exr", "reference.exr", "--gaze", "0.5,0.5", "--radius", "0.2",
                              "--exposure", "1.25", "--json"))
    measures = fovea.compare(picture, reference, gaze=(0.5, 0.5), radius=0.2, exposure=1.25)
    for region, numbers in measures.items():
        for name, value in numbers.items():
            assert value == pytest.approx(told[region][name], rel=1e-12), (region, name)
    assert measures["whole"]["mse"] > 0 and measures["whole"]["pixels"] == 48 * 32
    assert fovea.compare(tmp_path / "picture.exr", tmp_path / "reference.exr", gaze=(0.5, 0.5), radius=0.2,
                         exposure=1.25) == measures


def test_a_picture_equals_itself():
    picture = numpy.random.default_rng(1).random((16, 16, 3), numpy.float32)
    measures = fovea.compare(picture, picture)
    assert measures["whole"]["mse"] == 0 and measures["whole"]["flip"] == 0
    with pytest.raises(fovea.Error, match="differ"):
        fovea.compare(picture, picture[:8])


def test_files_keep_floats(tmp_path):
    picture = numpy.random.default_rng(1).random((5, 7, 3), numpy.float32)
    for name in ("a.exr", "a.pfm"):
        fovea.write_image(tmp_path / name, picture)
        numpy.testing.assert_array_equal(fovea.read_image(tmp_path / name)[""], picture)
    with pytest.raises(fovea.Error, match="nowhere"):
        fovea.read_image(tmp_path / "nowhere.exr")


def test_a_reference_tells_its_progress_and_can_be_stopped():
    told = []

    def progress(name, share):
        told.append((name, share))
        return len(told) < 2

    frame = fovea.reference("cornellbox", size=(64, 64), spp=1 << 14, progress=progress)
    assert told[0][0] == "path-trace" and 0 <= told[0][1] < 1
    assert dict(frame._result.counters)["path-trace.samples"] < 1 << 14


def test_what_a_progress_function_raises_arrives():
    def progress(name, share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        fovea.reference("cornellbox", size=(64, 64), spp=1 << 14, progress=progress)
