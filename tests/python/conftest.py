"""Shared by the tests of the module: the program, and small scenes and sizes."""

import os
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2]


@pytest.fixture
def program(tmp_path):
    """Runs `fovea` in a folder of its own, where what it writes stays."""
    def run(*arguments):
        done = subprocess.run([os.environ["FOVEA_PROGRAM"], *map(str, arguments)], cwd=tmp_path, capture_output=True,
                              text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return done.stdout
    return run
