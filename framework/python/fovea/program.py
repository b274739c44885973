"""The program `fovea` of an installed package."""

from __future__ import annotations

import argparse
import os
import shutil
import sys
from pathlib import Path
from typing import Any


def program() -> str:
    """The file of the program: that of this package, or else what FOVEA_PROGRAM or PATH say."""
    own = Path(__file__).parent / "bin/fovea"
    found = str(own) if own.is_file() else os.environ.get("FOVEA_PROGRAM") or shutil.which("fovea")
    if not found:
        raise FileNotFoundError("there is no program `fovea`: put its folder in PATH, or name it in FOVEA_PROGRAM")
    return found


def main() -> None:
    """`fovea bench SUITE --dask ADDRESS` runs on a cluster; every other command is that of the program in C++."""
    if "--dask" not in sys.argv[1:] or sys.argv[1:2] != ["bench"]:
        # Reports are made by the `python3` of the path: this one, which has what they need.
        os.environ["PATH"] = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])
        os.execv(program(), ["fovea", *sys.argv[1:]])
    import distributed

    from .bench import bench

    parser = argparse.ArgumentParser("fovea bench", description="Runs a suite on a Dask cluster. Further options are "
                                     "those of `fovea bench` without --dask.")
    parser.add_argument("suite", metavar="SUITE")
    parser.add_argument("--dask", metavar="ADDRESS", required=True, help="of the scheduler, like tcp://host:8786")
    parser.add_argument("-o", "--output", metavar="DIR", required=True)
    options, more = parser.parse_known_args(sys.argv[2:])
    connect: Any = distributed.Client
    with connect(options.dask) as client:
        sys.exit(0 if bench(options.suite, options.output, client=client, options=more) else 1)
