"""The package, its stubs and its samples pass mypy --strict."""

import subprocess
import sys
from pathlib import Path

import fovea
from conftest import SOURCE


def test_mypy_finds_nothing(tmp_path):
    package, samples = Path(fovea.__file__).parent, sorted((SOURCE / "samples/python").glob("*.py"))
    assert len(samples) >= 5
    done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir", tmp_path, package, *samples],
                          capture_output=True, text=True, cwd=package.parent)
    assert done.returncode == 0, done.stdout + done.stderr


def test_everything_public_is_documented():
    undocumented = [name for name in fovea.__all__ if not (getattr(fovea, name).__doc__ or "").strip()]
    assert undocumented == []
    for kind in (fovea.Renderer, fovea.Graph, fovea.Frame):
        for name, member in vars(kind).items():
            if not name.startswith("_") and callable(member):
                assert member.__doc__, f"{kind.__name__}.{name}"
