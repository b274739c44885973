"""Suites and references on a cluster of two processes, which find what one process finds."""

import csv
import json
import os
import signal
import threading

import numpy
import pytest

import fovea

distributed = pytest.importorskip("distributed")

SUITE = {"description": "a test", "scenes": ["cornellbox"], "graphs": ["direct"], "set": {"shadow_map_size": 64},
         "sweeps": [{"name": "stills", "size": "24x16", "seeds": 3, "reference": {"spp": 4, "depth": 3},
                     "measures": ["error", "pictures"]}]}
JOBS = 3


@pytest.fixture(scope="module")
def client():
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        with distributed.Client(cluster) as found:
            yield found


@pytest.fixture
def suite(tmp_path):
    file = tmp_path / "tiny.json"
    file.write_text(json.dumps(SUITE))
    return file


def errors(folder):
    """The rows of the tables that hold no times."""
    rows = []
    for table in sorted((folder / "tables").glob("*.csv")):
        with open(table, encoding="utf-8", newline="") as file:
            rows += [row for row in csv.reader(file) if not any("_ms" in cell or "time" in cell for cell in row)]
    return rows


def what_is_done_is_not_done_again(client, suite, folder):
    before = {p: p.stat().st_mtime_ns for p in (folder / "results").glob("*.json")}
    next(iter(before)).unlink()
    assert fovea.bench(suite, folder, client=client, options=["-q"])
    after = {p: p.stat().st_mtime_ns for p in (folder / "results").glob("*.json")}
    assert after.keys() == before.keys() and sum(after[p] != before[p] for p in before) == 1


def test_a_cluster_finds_what_one_process_finds(client, suite, tmp_path):
    assert fovea.bench(suite, tmp_path / "one", options=["-q"])
    assert fovea.bench(suite, tmp_path / "two", client=client, options=["-q"])
    assert len(errors(tmp_path / "one")) > JOBS
    assert errors(tmp_path / "two") == errors(tmp_path / "one")
    names = {p.relative_to(tmp_path / "one") for p in (tmp_path / "one").rglob("*") if p.is_file()}
    assert names == {p.relative_to(tmp_path / "two") for p in (tmp_path / "two").rglob("*") if p.is_file()}
    for picture in (tmp_path / "one/pictures").glob("*.png"):
        assert picture.read_bytes() == (tmp_path / "two/pictures" / picture.name).read_bytes()
    results = [json.loads(p.read_text()) for p in (tmp_path / "two/results").glob("*.json")]
    assert len(results) == JOBS and all(r["machine"] and r["made_with"]["device"] for r in results)
    what_is_done_is_not_done_again(client, suite, tmp_path / "two")


class Begun(distributed.WorkerPlugin):
    """Writes down each task that a worker begins."""

    def __init__(self, file):
        self.name, self.file = "begun", file

    def transition(self, key, start, finish, **more):
        if finish == "executing":
            with open(self.file, "a", encoding="utf-8") as file:
                file.write(f"{key}\n")


def test_a_killed_worker_costs_its_job_once(client, suite, tmp_path):
    client.register_plugin(Begun(str(tmp_path / "begun.txt")))
    pids = client.run(os.getpid)
    killed = []

    def kill_the_first_that_works():
        while not killed:
            for address, keys in client.processing().items():
                if keys and not killed and address in pids:
                    os.kill(pids[address], signal.SIGKILL)
                    killed.append(address)

    killer = threading.Thread(target=kill_the_first_that_works)
    killer.start()
    assert fovea.bench(suite, tmp_path / "out", client=client, options=["-q"])
    killer.join()
    assert len(list((tmp_path / "out/results").glob("*.json"))) == JOBS
    begun = [key for key in (tmp_path / "begun.txt").read_text().split() if key.startswith("fovea-")]
    assert len(set(begun)) == JOBS and len(begun) <= JOBS + 1
    client.wait_for_workers(2, timeout=30)
    client.unregister_worker_plugin("begun")


def test_a_job_that_fails_twice_is_named(client, suite, tmp_path, capsys):
    wrong = {**SUITE, "graphs": ["direct", str(tmp_path / "gone.json")]}
    (tmp_path / "gone.json").write_text('{"version": 2, "extends": "direct", "passes": {"x": {"type": "no-such"}}}')
    suite.write_text(json.dumps(wrong))
    assert not fovea.bench(suite, tmp_path / "out", client=client, options=["-q"])
    said = capsys.readouterr().err
    assert "gone" in said and "no-such" in said and "has failed twice" in said
    assert len(list((tmp_path / "out/results").glob("*.json"))) == JOBS


def test_a_split_reference_is_that_of_one_process(client):
    alone = fovea.reference("cornellbox", size=(24, 20), spp=64)
    told = []
    split = fovea.reference("cornellbox", size=(24, 20), spp=64, client=client, parts=8,
                            progress=lambda name, share: told.append(share))
    assert set(split) == set(alone)
    for name, layer in alone.items():
        numpy.testing.assert_array_equal(split[name], layer)
    assert told == [i / 8 for i in range(1, 9)]
