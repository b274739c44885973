"""Scenes of arrays and of models."""

import numpy
import pytest

import fovea

FLOOR = numpy.array([[-2, 0, -2], [2, 0, -2], [2, 0, 2], [-2, 0, 2]], numpy.float32)
QUAD = numpy.array([[0, 2, 1], [0, 3, 2]], numpy.uint32)
GREY = fovea.Material(base_color=(0.5, 0.5, 0.5, 1))
DOWN = fovea.Light(type=fovea.LightType.POINT, position=(0, 2, 0), intensity=20)
CAMERA = fovea.Camera.look_at((0, 3, 3), (0, 0, 0))


def make(**changes):
    return fovea.Scene(**{"meshes": [fovea.Mesh(FLOOR, QUAD)], "materials": [GREY], "lights": [DOWN],
                          "cameras": [CAMERA], **changes})


def test_a_floor_is_as_bright_as_it_should_be():
    """A Lambertian surface right below a lamp of intensity I at distance d: reflectance / pi * I / d^2."""
    scene = make(cameras=[fovea.Camera.look_at((0, 3, 0.001), (0, 0, 0))])
    radiance = fovea.Renderer("direct", scene, size=(65, 65)).frame()["radiance"]
    numpy.testing.assert_allclose(radiance[32, 32, :3], 0.5 / numpy.pi * 20 / 4, rtol=2e-3)


def test_colours_and_emission():
    scene = make(materials=[fovea.Material(base_color=(0, 0, 0, 1), emission=(1, 2, 3))], lights=[])
    radiance = fovea.Renderer("direct", scene, size=(9, 9)).frame()["radiance"]
    numpy.testing.assert_allclose(radiance[4, 4, :3], (1, 2, 3), rtol=1e-3)


def test_meshes_move_along_keys():
    box = fovea.Mesh(FLOOR * 0.3 + (0, 1, 0), QUAD, motion=[fovea.Key(0, (-1, 0, 0)), fovea.Key(1, (1, 0, 0))])
    renderer = fovea.Renderer("direct", make(meshes=[fovea.Mesh(FLOOR, QUAD), box]), size=(32, 32))
    left, right = renderer.frame(0, time=0)["radiance"], renderer.frame(1, time=1)["radiance"]
    def differing(other):  # share of the pixels; a box covers 6%, and the edge of a mirrored picture may differ
        return (abs(other - right).max(axis=2) > 0.02).mean()

    assert differing(left[:, ::-1]) < 0.01 < 0.05 < differing(left)


def test_equal_scenes_have_equal_hashes():
    assert make().hash == make().hash != make(exposure=2.0).hash


@pytest.mark.parametrize("changes, says", [
    ({"materials": []}, "material"),
    ({"cameras": []}, "camera"),
    ({"meshes": []}, "triangle"),
    ({"meshes": [fovea.Mesh(FLOOR, QUAD, 3)]}, "material 3 of 1"),
    ({"meshes": [fovea.Mesh(FLOOR, QUAD + 2)]}, "vertex 4 of 4"),
    ({"meshes": [fovea.Mesh(FLOOR, QUAD, uvs=numpy.zeros((3, 2), numpy.float32))]}, "3 texture coordinates"),
    ({"meshes": [fovea.Mesh(FLOOR * numpy.float32("nan"), QUAD)]}, "not finite"),
    ({"lights": [fovea.Light(type=fovea.LightType.SPOT, direction=(0, -2, 0))]}, "length"),
    ({"meshes": [fovea.Mesh(FLOOR, QUAD, motion=[fovea.Key(1), fovea.Key(0)])]}, "increasing times"),
])
def test_mistakes_are_named(changes, says):
    with pytest.raises(fovea.Error, match=says):
        make(**changes)


def test_arrays_of_another_shape_are_refused():
    with pytest.raises(TypeError):
        fovea.Mesh(FLOOR[:, :2], QUAD)


def test_models_load_with_a_warning_of_what_they_lack(program, tmp_path):
    program("scene", "export", "cornellbox", "-o", tmp_path / "box")
    (model,) = (tmp_path / "box").glob("*.gl*")
    with pytest.warns(fovea.Warning, match="assumed"):
        scene = fovea.load_scene(model)
    assert scene.triangles == fovea.load_scene("cornellbox").triangles
    assert fovea.Renderer("direct", scene, size=(16, 16)).frame()["radiance"].max() > 0
