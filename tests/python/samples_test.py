"""The samples in samples/python run from the first cell to the last, with small numbers."""

import re

import pytest

from conftest import SOURCE

MAPS = {"map_size": 16, "shadow_map_size": 64}
SMALL = {
    "vpl_counts": {"SIZE": (32, 32), "COUNTS": [20, 40], "SEEDS": 2, "SAMPLES": 4, "WARMUP": 1, "DETAIL": MAPS},
    "glsl_pass": {"SIZE": (48, 32)},
    "gaze_video": {"SIZE": (48, 48), "FRAMES": 3, "DETAIL": {**MAPS, "voxels": 16, "vpl_count": 20}},
    "table1": {"SIZE": (32, 32), "VPLS": 50, "SEEDS": 1, "SAMPLES": 4, "WARMUP": 1, "DETAIL": MAPS},
    "torch_tensor": {"SIZE": (32, 32), "SAMPLES": 4},
}
SAYS = {
    "vpl_counts": r"ours 20: [\d.]+ ± [\d.]+, 40: [\d.]+ ± [\d.]+",
    "glsl_pass": r"\d+ pixels of lines at 0.25 m",
    "gaze_video": r"gaze.webp: 3 frames, 48 pixels wide",
    "table1": r"ours +0\.\d{5} +0\.00074 +0\.\d{5} +0\.00112",
    "torch_tensor": r"smoothed: MSE × 1000 = [\d.]+",
}
FILES = {"vpl_counts": "vpl_counts.png", "glsl_pass": "glsl_pass.png", "gaze_video": "gaze.webp"}


def test_every_sample_is_among_these():
    assert {path.stem for path in (SOURCE / "samples/python").glob("*.py")} == set(SMALL)


@pytest.mark.parametrize("name", SMALL)
def test_a_sample_runs(name, tmp_path, monkeypatch, capsys):
    if name == "torch_tensor":
        pytest.importorskip("torch")
    monkeypatch.chdir(tmp_path)
    cells = re.split(r"^(?=# %%)", (SOURCE / f"samples/python/{name}.py").read_text(encoding="utf-8"), flags=re.M)
    scope = {"__name__": "__main__"}
    for cell in cells:
        exec(compile(cell, name, "exec"), scope)
        if cell.startswith("# %% Parameters"):
            assert set(SMALL[name]) <= set(scope)
            scope.update(SMALL[name])
    assert re.search(SAYS[name], capsys.readouterr().out)
    if name in FILES:
        assert (tmp_path / FILES[name]).stat().st_size > 500
