"""Passes that are written in Python, and in files."""

import inspect

import numpy
import pytest

import fovea

SIZE = (20, 12)


def negative(body, kind="negative", **more):
    def execute(self, frame):
        body(self, frame)

    declaration = {"doc": "what is bright becomes dark",
                   "inputs": {"image": {"doc": "the image", "format": "rgba8"}},
                   "outputs": {"negative": {"doc": "its negative", "format": "rgba8"}}, **more}
    return fovea.host_pass(type("Negative", (), {"type": kind, "declaration": declaration, "execute": execute}))


def graph(kind="negative", **params):
    return fovea.Graph.load("direct").patch({
        "passes": {"negative": {"type": kind, "inputs": {"image": "tonemap.image"}, "params": params}},
        "outputs": {"negative": "negative"}})


def invert(self, frame):
    frame.output("negative")[:] = 255 - frame.input("image")


def test_a_pass_in_python():
    negative(invert)
    frame = fovea.Renderer(graph(), "cornellbox", size=SIZE).frame()
    assert frame["negative"].shape == (12, 20, 4)
    numpy.testing.assert_allclose(frame["negative"], 1 - frame["image"], atol=1e-6)
    assert "negative" in {p.type for p in fovea.passes()}


def test_parameters_counters_and_what_a_pass_remembers():
    seen = []

    def execute(self, frame):
        invert(self, frame)
        self.frames = getattr(self, "frames", 0) + 1
        seen.append((frame.index, frame.parameters["strength"], frame.size if hasattr(frame, "size") else None))
        frame.counter("frames", self.frames)

    negative(execute, "counting", params={"strength": {"doc": "some number", "default": 0.5, "min": 0, "max": 1}},
             counters={"frames": "frames so far"})
    renderer = fovea.Renderer(graph("counting", strength=0.25), "cornellbox", size=SIZE)
    for _ in range(3):
        renderer.frame()
    assert [(index, strength) for index, strength, _ in seen] == [(0, 0.25), (1, 0.25), (2, 0.25)]
    assert dict(renderer._finished()._result.counters)["negative.frames"] == 3


def test_a_class_can_be_defined_again():
    negative(lambda self, frame: frame.output("negative").fill(0), "again")
    first = fovea.Renderer(graph("again"), "cornellbox", size=SIZE)
    assert first.frame()["negative"].max() == 0
    negative(lambda self, frame: frame.output("negative").fill(255), "again")
    assert fovea.Renderer(graph("again"), "cornellbox", size=SIZE).frame()["negative"].min() == 1
    assert first.frame()["negative"].max() == 0


def fails(self, frame):
    raise ValueError("too dark")


def test_exceptions_of_a_pass_carry_their_place_and_cause():
    negative(fails, "failing")
    renderer = fovea.Renderer(graph("failing"), "cornellbox", size=SIZE)
    with pytest.raises(fovea.Error, match="negative.*failing.*ValueError: too dark") as caught:
        renderer.frame()
    assert isinstance(caught.value.__cause__, ValueError)
    assert (caught.value.file, caught.value.line) == (__file__, inspect.getsourcelines(fails)[1] + 1)


def test_a_keyboard_interrupt_stays_one():
    def stop(self, frame):
        raise KeyboardInterrupt

    negative(stop, "stopping")
    renderer = fovea.Renderer(graph("stopping"), "cornellbox", size=SIZE)
    with pytest.raises(KeyboardInterrupt):
        renderer.frame()


def test_the_frame_of_a_pass_ends_with_it():
    kept = []
    negative(lambda self, frame: (kept.append(frame), invert(self, frame)), "keeping")
    fovea.Renderer(graph("keeping"), "cornellbox", size=SIZE).frame()
    with pytest.raises(fovea.Error, match="after its execute"):
        kept[0].input("image")


def test_a_pass_cannot_render_on_its_own_device():
    def nested(self, frame):
        invert(self, frame)
        other.frame()

    negative(nested, "nested")
    renderer, other = (fovea.Renderer(g, "cornellbox", size=SIZE) for g in (graph("nested"), "direct"))
    with pytest.raises(fovea.Error, match="device of that frame"):
        renderer.frame()


def test_mistakes_in_a_declaration_are_named():
    with pytest.raises(fovea.Error, match="rgba9"):
        negative(invert, "wrong", outputs={"negative": {"doc": "it", "format": "rgba9"}})
    with pytest.raises(fovea.Error, match="stepz"):
        negative(invert, "wrong", stepz=[])
    with pytest.raises(fovea.Error, match="tonemap"):
        negative(invert, "tonemap")


def test_a_pass_in_files_is_read_again_when_it_has_changed(tmp_path):
    def write(value):
        (tmp_path / "constant.pass.json").write_text(
            '{"doc": "one value", "outputs": {"image": {"doc": "it", "format": "rgba32f"}},'
            ' "steps": [{"shader": "constant.frag", "colors": ["image"]}]}' + " " * int(value))
        (tmp_path / "constant.frag").write_text(
            f"layout(location = 0) out vec4 color;\nvoid main() {{ color = vec4({value}); }}\n")

    constant = fovea.Graph.parse({"version": 2, "passes": {"constant": {"type": "constant"}},
                                  "outputs": {"image": "constant"}})
    for value in (1.0, 2.0):
        write(value)
        image = fovea.Renderer(constant, "cornellbox", size=SIZE, passes=[tmp_path]).frame()["image"]
        assert (image == value).all()
