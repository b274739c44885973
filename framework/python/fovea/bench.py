"""Suites of measurements, in one process or on a Dask cluster."""

from __future__ import annotations

import atexit
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .program import program

if TYPE_CHECKING:
    from distributed import Client

Files = dict[str, bytes]


class Server:
    """A program on a worker that measures one job after the other, with one device and the scene of the last job."""

    def __init__(self, suite: str, text: bytes | None, options: list[str]) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="fovea-bench-"))
        if text is not None:  # the suite's file lies on the machine of the client
            suite = str(self.folder / Path(suite).name)
            Path(suite).write_bytes(text)
        self.output = self.folder / "output"
        self.sent: set[Path] = set()  # references, which several jobs need
        self.errors = tempfile.TemporaryFile()
        self.process = subprocess.Popen([program(), "bench", suite, "-o", self.output, "--serve", "-q", *options],
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, text=True)

    def measure(self, name: str) -> Files:
        """The files of a job: result, pictures, and references that are new. Raises RuntimeError if it fails.

        Only references stay here, as other jobs need them.
        """
        assert self.process.stdin and self.process.stdout
        try:
            self.process.stdin.write(name + "\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            pass  # the answer is missing as well
        if not self.process.stdout.readline():
            self.process.wait()
            self.errors.seek(0)
            raise RuntimeError(self.errors.read().decode(errors="replace").strip()
                               or f"`fovea bench --serve` ended with {self.process.returncode}")
        references = set(self.output.glob("references/*.exr")) - self.sent
        self.sent |= references
        made = [*self.output.glob("results/*"), *self.output.glob("pictures/*")]
        files = {str(path.relative_to(self.output)): path.read_bytes() for path in [*made, *references]}
        for path in made:
            path.unlink()
        return files

    def close(self) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()
        shutil.rmtree(self.folder, ignore_errors=True)


server: tuple[Any, Server] | None = None
"""The server of this worker, and what it measures."""
one_at_a_time = threading.Lock()


def stop() -> None:
    global server
    if server is not None:
        server[1].close()
        server = None


atexit.register(stop)


def measure(name: str, suite: str, text: bytes | None, options: list[str]) -> Files:
    """Runs on a worker. A server that has failed, or that measures another suite, makes room for another one."""
    global server
    with one_at_a_time:
        if server is None or server[0] != (suite, text, options):
            stop()
            server = (suite, text, options), Server(suite, text, options)
        try:
            return server[1].measure(name)
        except RuntimeError:
            stop()
            raise


def store(folder: Path, files: Files) -> None:
    """Each file appears as a whole; what is there already stays."""
    for name, content in files.items():
        path = folder / name
        if path.exists():
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(path.name + ".part")
        part.write_bytes(content)
        part.rename(path)


def bench(suite: str | os.PathLike[str], output: str | os.PathLike[str], *, client: Client | None = None,
          options: Iterable[str] = ()) -> bool:
    """Runs a suite of measurements to tables and a report in the folder `output`; whether all jobs have results.

    suite: a file, or the bare name of a suite that comes along ("quick").
    client: of a Dask cluster, whose workers have this package; without one, the program runs all jobs in one process.
    options: those of `fovea bench`, such as ["--scale", "small"].

    The folder is the same either way: what is done already is not done again. A worker opens its device once and keeps
    scenes and references. A job that fails is tried once more; jobs that fail twice are named at the end. Each result
    says on which machine and device it was measured, and results of different devices in one table are an error, as
    in one process. Raises subprocess.CalledProcessError if the program refuses the suite; it says why.
    """
    suite, folder, options = os.fspath(suite), Path(output), list(options)

    def run(*more: str, **how: Any) -> subprocess.CompletedProcess[str]:
        command = [program(), "bench", suite, "-o", str(folder), *options, *more]
        return subprocess.run(command, check=True, text=True, **how)

    if client is None:
        run()
        return True
    import distributed

    as_completed: Any = distributed.as_completed
    jobs = run("--list", stdout=subprocess.PIPE).stdout.split()
    done = {path.name.rsplit(".", 2)[0] for path in (folder / "results").glob("*.json")}  # JOB.KEY.json
    text = Path(suite).read_bytes() if Path(suite).is_file() else None
    futures = client.map(measure, [job for job in jobs if job not in done], suite=suite, text=text, options=options,
                         pure=False, retries=1, key=[f"fovea-{job}" for job in jobs if job not in done])
    names = {future.key: str(future.key).removeprefix("fovea-") for future in futures}
    failed: dict[str, str] = {}
    for future in as_completed(futures):
        if future.status == "error":
            failed[names[future.key]] = str(future.exception())
        else:
            store(folder, future.result())
        future.release()
    for job, why in sorted(failed.items()):
        print(f"fovea: warning: job `{job}` has failed twice: {why}", file=sys.stderr)
    if any((folder / "results").glob("*.json")):
        run("--report")
    return not failed
