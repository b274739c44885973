"""Graphs as objects, and errors with their places."""

import json

import pytest

import fovea


def test_stock_graphs_load_and_check():
    graph = fovea.Graph.load("ours")
    assert graph.name == "ours" and "passes" in graph.data
    assert "deferred" in str(graph.check(size=(64, 64)))


def test_a_patch_replaces_and_removes():
    base = fovea.Graph.load("direct")
    graph = base.patch({"passes": {"tonemap": {"params": {"exposure": 2.0}}}, "outputs": {"direct": None}})
    assert graph.data["passes"]["tonemap"]["params"]["exposure"] == 2
    assert "direct" not in graph.data["outputs"] and "direct" in base.merge().data["outputs"]
    graph.check()


def test_merging_leaves_nothing_to_extend(tmp_path):
    (tmp_path / "mine.json").write_text('{"version": 2, "extends": "ir_1000", "parameters": {"vpl_count": 77}}')
    merged = fovea.Graph.load(tmp_path / "mine.json").merge()
    assert "extends" not in merged.data and merged.data["parameters"]["vpl_count"] == 77
    merged.save(tmp_path / "merged.json")
    assert json.loads((tmp_path / "merged.json").read_text()) == merged.data
    fovea.Graph.load(tmp_path / "merged.json").check()


def test_a_graph_of_ones_own_renders():
    graph = fovea.Graph.load("direct").patch({"outputs": {"image": None}})
    assert "image" not in fovea.Renderer(graph, "cornellbox", size=(16, 16)).frame()


def test_notebooks_show_a_drawing():
    html = fovea.Graph.load("ours")._repr_html_()
    assert html.startswith("<svg") and html.count("<rect") > 10 and html.count("<path") > 10
    assert "deferred" in html and "output" in html


def test_errors_carry_file_line_column_and_remedy(tmp_path):
    file = tmp_path / "wrong.json"
    file.write_text('{\n  "version": 2,\n  "extends": "direct",\n'
                    '  "passes": { "tonemap": { "params": { "exposre": 2 } } }\n}\n')
    with pytest.raises(fovea.Error) as caught:
        fovea.Graph.load(file).check()
    error = caught.value
    assert (error.file, error.line, error.column) == (str(file), 4, 40)
    assert "exposure" in error.remedy and error.code == fovea.ExitCode.BAD_INPUT
    assert str(file) + ":4:40" in str(error)
    with pytest.raises(fovea.Error) as caught:
        fovea.Renderer(file, "cornellbox")
    assert (caught.value.file, caught.value.line) == (str(file), 4)


def test_errors_name_every_mistake():
    wrong = '{"passes": {\n"a": {"type": "tonemop"},\n"b": {"type": "gbufer"}}}'
    graph = fovea.Graph.load("direct").patch(wrong, "cell")
    with pytest.raises(fovea.Error) as caught:
        graph.check()
    assert [(d.file, d.line) for d in caught.value.diagnostics][:2] == [("cell", 2), ("cell", 3)]


def test_a_patch_that_is_no_json_is_an_error_at_its_place():
    with pytest.raises(fovea.Error) as caught:
        fovea.Graph.load("direct").patch('{\n  "passes": ]', "cell")
    assert (caught.value.file, caught.value.line) == ("cell", 2)


def test_missing_things_are_named():
    with pytest.raises(fovea.Error, match="ourz") as caught:
        fovea.Graph.load("ourz")
    assert "ours" in caught.value.remedy
    with pytest.raises(fovea.Error, match="atriun"):
        fovea.Renderer("direct", "atriun")
    with pytest.raises(fovea.Error, match="size"):
        fovea.Renderer("direct", "cornellbox", size=(0, 4))
    with pytest.raises(fovea.Error) as caught:
        fovea.Renderer("direct", "cornellbox", device="no such device")
    assert caught.value.code in (fovea.ExitCode.NO_DEVICE, fovea.ExitCode.USAGE)


def test_lists():
    assert {"atrium", "cornellbox"} <= set(fovea.scenes())
    types = {p.type: p for p in fovea.passes()}
    assert types["tonemap"].doc and not types["tonemap"].host and types["path-trace"].host
    assert "exposure" in [name for name, *_ in types["tonemap"].parameters]
