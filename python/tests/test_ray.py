# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Many scenes and one site on a cluster of two machines (processes here), whose workers are killed on the way."""
import io
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

import ovimap
import pytest
from conftest import set_meta
from ovimap.cluster import Job, eval_jobs, pool_job, run_jobs, scene_jobs, site_jobs
from ovimap.cluster.jobs import STORE_BYTES, Board, _read_board, _submit
from ovimap.cluster.scenes import scene_names
from ovimap.cluster.site import part_ranges
from ovimap.cluster.table import Lines, table_of
from ovimap.map_facts import map_facts
from ovimap.ray_command import main
from rich.console import Console

ray = pytest.importorskip("ray")
FRAMES = ":"
OPTIONS = ["--masks", "gt", "--encoder", "none", "--set", "checkpoint.frames=1", "--set", "map.voxel_size_m=0.02"]


@pytest.fixture(scope="module")
def machines():
    """A cluster of two machines with a core each."""
    from ray.cluster_utils import Cluster

    if not os.environ.get("OVIMAP_PROGRAM"):
        pytest.skip("OVIMAP_PROGRAM does not name the program")
    made = Cluster(initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False, "object_store_memory": STORE_BYTES})
    made.add_node(num_cpus=1, object_store_memory=STORE_BYTES)
    ray.init(address=made.address, log_to_driver=False)
    yield made
    ray.shutdown()
    made.shutdown()


@pytest.fixture(scope="module")
def rooms(room, tmp_path_factory):
    """Two scenes: the room, by two paths."""
    root = tmp_path_factory.mktemp("rooms")
    for name in ("east", "west"):
        (root / name).symlink_to(pathlib.Path(room).parent)
    return [str(root / name / "room") for name in ("east", "west")]


@pytest.fixture(scope="module")
def maps(machines, rooms, tmp_path_factory):
    """A map of each, undisturbed."""
    folder = tmp_path_factory.mktemp("maps")
    jobs = run(scene_jobs(rooms, folder, frames=FRAMES, options=OPTIONS))
    assert [job.state for job in jobs] == ["done", "done"], [job.fault for job in jobs]
    return [folder / "east-room.ovimap", folder / "west-room.ovimap"]


def run(jobs, **options):
    run_jobs(jobs, audience=Lines(io.StringIO()), **options)
    return jobs


def checkpoint_frames(map, scratch):
    """Frames in a checkpoint that may be in use: nobody else may open it, but a copy is what a crash would leave."""
    try:
        for ending in (".partial", ".partial-wal"):
            shutil.copyfile(f"{map}{ending}", f"{scratch}{ending}")
        return map_facts(f"{scratch}.partial").frames
    except (OSError, ovimap.Error):
        return 0


def stalling(room, root):
    """The room, but one frame does not come: its run cannot be over before its worker is killed."""
    shutil.copytree(pathlib.Path(room).parent, root, copy_function=os.symlink)
    frame = root / "room/results/depth000012.png"
    frame.rename(frame.with_suffix(".kept"))
    os.mkfifo(frame)
    return str(root / "room")


def kill_on_the_way(map, scene):
    """Kills the worker that maps a stalling scene when there is a checkpoint, of however few frames: the thread that
    writes it gives way to all others. The try after it gets all frames."""
    def wait():
        frame, end = pathlib.Path(scene) / "results/depth000012.png", time.monotonic() + 300
        while checkpoint_frames(map, map.with_suffix(".copy")) == 0 and time.monotonic() < end:
            time.sleep(0.01)
        frame.with_suffix(".kept").replace(frame)
        os.kill(int((map.parent / "jobs/room.lock").read_text().split()[0]), signal.SIGKILL)

    thread = threading.Thread(target=wait, daemon=True)
    thread.start()
    return thread


def test_scenes_are_mapped_as_the_program_does(maps, rooms, tmp_path):
    command = [os.environ["OVIMAP_PROGRAM"], "run", rooms[0], "-o", tmp_path / "a.ovimap", "--frames", FRAMES, *OPTIONS]
    subprocess.run(command, check=True, capture_output=True)
    assert {map_facts(path).content_hash for path in [*maps, tmp_path / "a.ovimap"]} == {map_facts(maps[0]).content_hash}


def test_a_killed_worker_costs_nothing(maps, rooms, tmp_path):
    map, scene = tmp_path / "room.ovimap", stalling(rooms[0], tmp_path / "scene")
    killer = kill_on_the_way(map, scene)
    [job] = run(scene_jobs([scene], tmp_path, frames=FRAMES, options=OPTIONS))
    killer.join(timeout=60)
    assert not killer.is_alive()
    assert (job.state, job.tries, job.fault) == ("done", 2, "")
    assert 0 < job.report["resumed_from"] < job.report["frames"] == 40
    # The essence of it: voxels, objects and votes are those of the run that nobody disturbed.
    assert map_facts(map).revision == map_facts(maps[0]).revision
    assert not (tmp_path / "room.ovimap.partial").exists()


def test_a_worker_lost_too_often_leaves_its_checkpoint(maps, rooms, tmp_path):
    map, scene = tmp_path / "room.ovimap", stalling(rooms[0], tmp_path / "scene")
    killer = kill_on_the_way(map, scene)
    [job] = run(scene_jobs([scene], tmp_path, frames=FRAMES, options=OPTIONS), retries=0)
    killer.join(timeout=60)
    assert not killer.is_alive()
    assert job.state == "failed" and "worker was lost" in job.fault and "goes on" in job.fault
    assert checkpoint_frames(map, map.with_suffix(".copy")) > 0 and not map.exists()
    [other] = run(scene_jobs([scene], tmp_path, frames="::2", options=OPTIONS))
    assert (other.state, other.tries) == ("failed", 1) and not map.exists(), "it went on with the frames of another order"
    assert "was begun with other frames (:)" in other.fault and f"delete {map}.partial" in other.fault
    [job] = run(scene_jobs([scene], tmp_path, frames=FRAMES, options=OPTIONS))
    assert job.report["resumed_from"] > 0
    assert map_facts(map).revision == map_facts(maps[0]).revision


def test_a_program_that_crashes_is_tried_again(machines, rooms, tmp_path):
    """A program that is killed the first time, as by a machine without memory, and then works."""
    program = tmp_path / "ovimap.sh"
    program.write_text(f'#!/bin/sh\n[ -e {tmp_path}/once ] || {{ touch {tmp_path}/once; kill -9 $$; }}\nexec "$OVIMAP_PROGRAM" "$@"\n')
    program.chmod(0o755)
    [job] = run(scene_jobs(rooms[:1], tmp_path, frames=":2", options=OPTIONS, program=str(program)))
    assert (job.state, job.tries) == ("done", 2)


def test_a_job_that_waits_again_is_shown_waiting(machines):
    board = ray.remote(Board).options(num_cpus=0).remote()
    ray.get(board.tell.remote("first", 3, 9))  # by a try that is lost
    job, running = Job("first", never, {}, cpus=64, tries=1), {}  # no machine has so many: it waits
    _submit(job, board, running)
    _read_board(board, [job], Lines(io.StringIO()))
    assert job.state == "waiting" and job.tries == 2
    ray.cancel(*running)


def test_without_an_address_no_running_cluster_is_joined(machines):
    script = "import ray; from ovimap.cluster.jobs import cluster\nwith cluster(): print(len(ray.nodes()))"
    environment = os.environ | {"RAY_ADDRESS": machines.address}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "1\n"), done.stderr


def test_what_is_done_is_not_done_again(maps, rooms):
    before = [path.stat().st_mtime_ns for path in maps]
    jobs = run(scene_jobs(rooms, maps[0].parent, frames=FRAMES, options=OPTIONS))
    assert all(job.state == "done" and job.report["there"] for job in jobs)
    assert [path.stat().st_mtime_ns for path in maps] == before


def test_another_order_or_scene_never_replaces_a_map(maps, rooms, room, tmp_path):
    jobs = run(scene_jobs(rooms, maps[0].parent, frames=":5", options=OPTIONS))
    assert all(job.state == "failed" and "other frames (:)" in job.fault and job.tries == 1 for job in jobs)
    (tmp_path / "room.ovimap").write_bytes(maps[0].read_bytes())  # without the note that says who made it
    [job] = run(scene_jobs([room], tmp_path, frames=FRAMES, options=OPTIONS))
    assert job.state == "failed" and f"is a map of {rooms[0]}" in job.fault


def test_one_bad_scene_does_not_stop_the_others(maps, rooms, tmp_path):
    (tmp_path / "empty").mkdir()
    lines = io.StringIO()
    jobs = scene_jobs([rooms[0], str(tmp_path / "empty"), str(tmp_path / "none")], maps[0].parent, frames=FRAMES, options=OPTIONS)
    jobs[0].order["map"] = str(maps[0])
    run_jobs(jobs, audience=Lines(lines))
    assert [job.state for job in jobs] == ["done", "failed", "failed"]
    assert [job.tries for job in jobs] == [1, 1, 1]
    assert "does not exist" in jobs[2].fault and "\n" not in jobs[2].fault
    assert jobs[2].fault in lines.getvalue()


def test_a_site_in_parts_is_one_map(machines, rooms, tmp_path):
    target = tmp_path / "site.ovimap"
    jobs = run(site_jobs(rooms[0], target, parts=3, overlap=6, options=OPTIONS))
    assert [job.state for job in jobs] == ["done"] * 5, [job.fault for job in jobs]
    assert [job.name for job in jobs] == ["part-0", "part-1", "part-2", "parts-0-1", "parts-0-2"]
    scores = ovimap.eval(target, rooms[0], encoder="none")["standard"]
    assert scores["geometry"]["completeness"] > 0.95 and scores["class_agnostic"]["ap50"] > 0.5
    again = run(site_jobs(rooms[0], target, parts=3, overlap=6, options=OPTIONS))
    assert all(job.report["there"] for job in again)
    (tmp_path / "site.parts/jobs").rename(tmp_path / "elsewhere")
    (tmp_path / "jobs/site.json").unlink()
    [*_, last] = run(site_jobs(rooms[0], target, parts=3, overlap=6, options=OPTIONS))
    assert last.state in ("failed", "left out") and target.exists()


def test_parts_of_a_site_share_frames():
    assert part_ranges(100, 3, 10) == [(0, 43), (33, 76), (66, 100)]
    for parts, overlap in ((1, 0), (10, 10), (200, 1)):
        with pytest.raises(ovimap.Error, match="parts"):
            part_ranges(100, parts, overlap)


@pytest.mark.parametrize("truths_given", [True, False])
def test_scores_are_pooled_over_what_could_be_scored(truths_given, maps, rooms, tmp_path, capsys):
    bad = tmp_path / "no.ovimap"
    bad.write_text("nothing")
    truths = ["--gt", *rooms, rooms[0]] if truths_given else []
    assert main(["eval", *map(str, [*maps, bad]), *truths, "--encoder", "none", "--json"]) == 2
    said, told = capsys.readouterr()
    figures = json.loads(said)
    pooled = ovimap.eval(maps, rooms, encoder="none")
    assert {key: figures[key] for key in pooled} == pooled
    assert [job["state"] for job in figures["jobs"]] == ["done", "done", "failed", "done"]
    assert f"1 of 4 jobs failed, the first: {bad}" in told


def test_what_cannot_be_scored_is_refused(maps, rooms, tmp_path):
    with pytest.raises(ovimap.Error, match="one truth for each"):
        eval_jobs([str(path) for path in maps], rooms[:1])
    pushed = tmp_path / "pushed.ovimap"
    pushed.write_bytes(maps[0].read_bytes())
    set_meta(pushed, "source", "http")
    [job] = run(eval_jobs([str(pushed)], []))
    assert job.state == "failed" and job.fault == f"{pushed} was made of pushed frames; name its truth"
    failed = eval_jobs([str(maps[0])], rooms[:1])
    failed[0].state = "failed"
    with pytest.raises(ovimap.Error, match="no map could be scored"):
        pool_job(failed)


def never(order, tell):
    raise AssertionError("this job must not run")


def test_what_needs_a_failed_job_is_left_out(machines):
    def broken(order, tell):
        raise ovimap.Error("it is broken; mend it")

    first = Job("first", broken, {})
    second = Job("second", broken, {}, needs=[first])
    run([second, first])
    assert (first.state, first.fault) == ("failed", "it is broken; mend it")
    assert (second.state, second.fault, second.tries) == ("left out", "it needs first", 0)


def test_a_folder_that_cannot_be_written_is_said_in_one_line(machines, rooms, tmp_path):
    (tmp_path / "jobs").write_text("a file where notes and locks are to be")
    [job] = run(scene_jobs(rooms[:1], tmp_path))
    assert (job.state, job.tries) == ("failed", 1) and "File exists" in job.fault and "give a folder that can be written" in job.fault


def test_a_job_that_fits_no_machine_is_refused(machines):
    with pytest.raises(ovimap.Error, match="no machine of the cluster has 64 cores, the largest has 1"):
        run([Job("large", never, {}, cpus=64)])


def test_the_command_says_what_came_of_it(maps, rooms, capsys):
    command = ["map", *rooms, "-o", str(maps[0].parent), "--json"]
    assert main([*command, "--", *OPTIONS]) == 0
    said = json.loads(capsys.readouterr().out)
    assert (said["done"], said["failed"]) == (2, 0) and said["jobs"][0]["name"] == "east-room"
    assert main([*command, "--", "--masks", "none"]) == 2
    assert "2 of 2 jobs failed, the first: east-room" in capsys.readouterr().err


def test_without_ray_one_line_says_so(tmp_path):
    (tmp_path / "ray.py").write_text("raise ModuleNotFoundError('no', name='ray')")
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    done = subprocess.run([sys.executable, "-m", "ovimap.ray_command", "map", "a", "-o", "b"], env=environment, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == "ovimap-ray: ray is not installed; pip install 'ovimap[ray]'\n"


def test_names_tell_scenes_apart():
    assert scene_names(["/a/kitchen", "/a/hall"]) == ["kitchen", "hall"]
    assert scene_names(["/a/x/room", "/a/y/room"]) == ["x-room", "y-room"]
    with pytest.raises(ovimap.Error, match="twice"):
        scene_jobs(["a", "./a"], pathlib.Path("maps"))


def test_the_table_shows_faults_first():
    jobs = [Job(f"scene-{number}", never, {}, state="done") for number in range(40)]
    jobs[35].state, jobs[35].fault = "failed", "its masks [are] bad"
    console = Console(file=io.StringIO(), width=100)
    console.print(table_of(jobs, 10))
    text = console.file.getvalue()
    assert "39 of 40 done" in text and "its masks [are] bad" in text and text.count("scene-") == 10
