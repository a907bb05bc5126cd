# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of objects, and one search over many maps."""
import json
import os
import shutil
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import ovimap
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from conftest import set_meta
from ovimap.index import ObjectIndex, export_objects, object_table, search, vectors
from ovimap.index.objects import object_schema
from ovimap.index.store import Store
from ovimap.index_command import main
from ovimap.map_facts import Encoder, map_facts

ENCODER = Encoder("made up", 32, "0" * 64)


class Colours:
    """An encoder of three numbers: how red, green and blue a picture is. Its words are colours."""

    name, dimension = "colours", 3
    words = {"red": (1, 0, 0), "green": (0, 1, 0), "blue": (0, 0, 1)}

    def encode_images(self, images):
        return np.array([image.reshape(-1, 3).mean(axis=0) + 1 for image in images], np.float32)

    def encode_texts(self, texts):
        return np.array([self.words.get(text, (1, 1, 1)) for text in texts], np.float32)


def table(name, embeddings):
    """A table as of a map with these embeddings; zeros: unknown."""
    rows, flat = len(embeddings), lambda values: pa.array(np.asarray(values, np.float32).reshape(-1))
    corner = pa.FixedSizeListArray.from_arrays(flat(np.zeros((rows, 3))), 3)
    same = lambda value: pa.repeat(value, rows)
    known = pa.array(~np.any(embeddings, axis=1))
    return pa.table(
        [same(name), same("1"), same(""), pa.array(np.arange(rows, dtype=np.uint32)), same(""), corner, corner, corner,
         pa.array(np.ones(rows, np.int64)), pa.array(np.ones(rows, np.int64)),
         pa.nulls(rows, pa.float32()), same(ENCODER.name), same(ENCODER.digest),
         pa.FixedSizeListArray.from_arrays(flat(embeddings), ENCODER.dimension, mask=known)],
        schema=object_schema(ENCODER))


def unit(rows, seed):
    made = np.random.default_rng(seed).standard_normal((rows, ENCODER.dimension)).astype(np.float32)
    return made / np.linalg.norm(made, axis=1, keepdims=True)


@pytest.fixture
def maps(saved_map, tmp_path):
    """Two maps of one room, of which the second has a name in it."""
    paths = [tmp_path / "first.ovimap", tmp_path / "second.ovimap"]
    for path in paths:
        shutil.copyfile(saved_map, path)
    rename(paths[1], "tea pot")
    return paths


def rename(path, name):
    program = os.environ.get("OVIMAP_PROGRAM")
    if not program:
        pytest.skip("OVIMAP_PROGRAM does not name the program")
    number = ovimap.Map.open(path).instances.ids[0]
    subprocess.run([program, "edit", path, "rename", str(number), name], check=True, capture_output=True)


def test_a_table_holds_what_the_map_holds(saved_map, tmp_path):
    opened, made = ovimap.Map.open(saved_map), object_table(saved_map)
    assert made["object"].to_pylist() == opened.instances.ids.tolist()
    assert np.allclose(made["box_max"].to_pylist(), opened.instances.boxes[:, 1])
    for row, embedding in zip(made["embedding"].to_pylist(), opened.embeddings):
        assert np.array_equal(row, embedding) if embedding.any() else row is None
    assert made["encoder"][0].as_py() == opened.encoder and made["content_hash"][0].as_py() == opened.content_hash
    assert export_objects([saved_map, saved_map], tmp_path / "all.parquet") == 2 * len(opened)
    read = pq.read_table(tmp_path / "all.parquet")
    assert read.schema == made.schema and read.slice(0, len(made)) == made


def test_a_map_is_found_by_its_words(maps, tmp_path, capsys):
    assert main(["build", *map(str, maps), "-o", str(tmp_path / "index")]) == 0
    index = ObjectIndex(tmp_path / "index")
    assert len(index) == 2 * len(ovimap.Map.open(maps[0]))
    own = {str(path): ovimap.Map.open(path).query("sofa").matches[0] for path in maps}  # names that people gave make a difference
    answer = index.query("sofa")
    assert answer.found and {said.map for said in answer.maps} == set(own)
    for said in answer.maps:
        assert said.found and (said.best.id, said.best.p_value) == (own[said.map].id, own[said.map].p_value)
    assert answer.p_value == pytest.approx(1 - (1 - min(best.p_value for best in own.values())) ** 2)
    absent = index.query("elephant", top=1)
    assert not absent.found and len(absent.maps) == 1 and absent.maps[0].hits
    capsys.readouterr()
    assert main(["query", str(tmp_path / "index"), "elephant", "--top", "1", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["verdict"] == "not_in_map"
    with pytest.raises(ovimap.Error, match="empty"):
        index.query(" , ")


@pytest.mark.filterwarnings("error")
def test_the_worst_p_value_is_no_fault():
    asked = [SimpleNamespace(best=SimpleNamespace(p_value=value)) for value in (1.0, None)]
    assert search._p_among(asked, 5) == 1.0


def test_only_what_changed_is_taken_anew(maps, tmp_path):
    folder = tmp_path / "index"
    assert ObjectIndex.build(folder, maps).added == [str(map) for map in maps]
    assert ObjectIndex.build(folder, maps).kept == [str(map) for map in maps]
    before = map_facts(maps[0])
    rename(maps[0], "kettle")  # which leaves the voxels, and so the content hash, as they are
    assert map_facts(maps[0]).content_hash == before.content_hash
    asked = ObjectIndex(folder).query("sofa").maps
    assert {said.map: "has changed" in said.notice for said in asked} == {str(maps[0]): True, str(maps[1]): False}
    update = ObjectIndex.build(folder, maps)
    assert (update.replaced, update.kept) == ([str(maps[0])], [str(maps[1])])
    [entry] = [entry for entry in ObjectIndex(folder).maps if entry.path == str(maps[0])]
    assert "kettle" in pq.read_table(folder / entry.file)["name"].to_pylist()
    assert len(list(folder.glob("maps/*"))) == 2
    ObjectIndex.remove(folder, maps[:1])
    assert {hit.map for hit in ObjectIndex(folder).nearest_to_text("sofa", 1000)} == {str(maps[1])}
    with pytest.raises(ovimap.Error, match="not in the index"):
        ObjectIndex.remove(folder, maps[:1])


def test_a_map_that_is_gone_is_told(maps, tmp_path):
    ObjectIndex.build(tmp_path / "index", maps)
    maps[0].unlink()
    answer = ObjectIndex(tmp_path / "index").query("sofa")
    assert [said.answer is None for said in answer.maps] == [False, True] and answer.found
    told = answer.maps[1].notice
    assert "not there any more" in told and f"ovimap-index remove {tmp_path}/index {maps[0]}" in told and answer.maps[1].hits
    assert "unable to open" not in told and "\n" not in told


def test_what_cannot_be_opened_is_told_as_the_system_says_it(tmp_path):
    (tmp_path / "folder.ovimap").mkdir()
    missing, folder = tmp_path / "missing.ovimap", tmp_path / "folder.ovimap"
    for path, why in ((missing, f"cannot open map '{missing}': No such file or directory"), (folder, f"'{folder}' is not a file")):
        update = ObjectIndex.build(tmp_path / "index", [path])
        assert list(update.refused.values()) == [f"{why}; give a map file that `ovimap run` wrote"]


def test_what_maps_that_are_gone_may_have_is_unknown(maps, tmp_path, capsys):
    index = str(tmp_path / "index")
    ObjectIndex.build(index, maps)
    maps[0].unlink()
    assert main(["query", index, "elephant"]) == 2
    said = capsys.readouterr().out
    assert "in none of the maps" not in said and f"{maps[0]}: not asked" in said
    maps[1].unlink()
    assert main(["query", index, "sofa", "--json"]) == 2
    answer = json.loads(capsys.readouterr().out)
    assert answer["verdict"] == "unknown" and [said["verdict"] for said in answer["maps"]] == [None, None]


def test_a_reader_goes_on_with_what_a_writer_put_in_force(tmp_path):
    Store(tmp_path).put_tables([table(f"/room/{number}", unit(50, number)) for number in range(4)], ENCODER)
    readers = [Store(tmp_path), Store(tmp_path)]
    Store(tmp_path).remove([f"/room/{number}" for number in range(3)])  # of most: the vectors are written anew
    query = unit(50, 3)[7]
    assert readers[0].search(query, 1)[0][:2] == ("/room/3", 7)
    for path in tmp_path.glob("rows-*"):
        path.unlink()
    with pytest.raises(ovimap.Error, match="is damaged"):
        readers[1].search(query, 1)


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="this system has no /dev/full")
def test_a_full_disk_is_said_in_one_line(saved_map, tmp_path, capsys):
    (tmp_path / f"index.json.{os.getpid()}.new").symlink_to("/dev/full")
    assert main(["build", saved_map, "-o", str(tmp_path)]) == 2
    told = capsys.readouterr().err
    assert "cannot write the index" in told and "No space left" in told and "make room" in told and told.count("\n") == 1


def test_maps_that_cannot_be_compared_are_left_out(maps, tmp_path, capsys):
    other, bare, broken = (tmp_path / f"{name}.ovimap" for name in ("other", "bare", "broken"))
    for path, name in ((other, "another encoder"), (bare, "")):
        shutil.copyfile(maps[0], path)
        set_meta(path, "encoder.name", name)
    broken.write_text("no map")
    words = ["build", *map(str, [maps[0], other, bare, broken, maps[1]]), "-o", str(tmp_path / "index"), "--json"]
    assert main(words) == 2
    said, told = capsys.readouterr()
    assert json.loads(said)["added"] == [str(map) for map in maps]
    assert all(words in line for words, line in zip(("cannot be compared", "has no embeddings", "is not an ovimap map"), told.splitlines(), strict=True))
    with pytest.raises(ovimap.Error, match="cannot be compared"):
        export_objects([maps[0], other], tmp_path / "all.parquet")
    assert not list(tmp_path.glob("*.parquet*"))


def test_an_index_of_ones_own_encoder(room, tmp_path):
    ovimap.run(room, tmp_path / "a.ovimap", masks="gt", encoder=Colours(), frames=":20:4", settings={"map.voxel_size_m": 0.02})
    ObjectIndex.build(tmp_path / "index", [tmp_path / "a.ovimap"])
    index, opened = ObjectIndex(tmp_path / "index", encoder=Colours()), ovimap.Map.open(tmp_path / "a.ovimap", encoder=Colours())
    expected = opened.instances.ids[np.argmax(opened.embeddings[:, 0])]
    assert index.nearest_to_text("red")[0].object == expected
    with pytest.raises(ovimap.Error, match="name that model as the encoder"):
        ObjectIndex(tmp_path / "index").query("red")


def test_many_are_found_as_a_plain_search_finds_them(tmp_path, monkeypatch):
    monkeypatch.setattr(vectors, "EXACT_ROWS", 2000)
    store, rooms = Store(tmp_path), {f"/room/{number}": unit(600, number) for number in range(6)}
    rooms["/room/0"][7] = 0  # its look is unknown
    for name, embeddings in list(rooms.items())[:3]:  # one by one, then some at once: few, then so many that they get codes
        store.put_tables([table(name, embeddings)], ENCODER)
    assert not list(tmp_path.glob("codes-*"))
    store.put_tables([table(name, embeddings) for name, embeddings in list(rooms.items())[3:5]], ENCODER)
    store.put_tables([table("/room/5", rooms["/room/5"])], ENCODER)
    assert len(list(tmp_path.glob("codes-*"))) == 1
    queries, every = unit(50, 99), np.concatenate(list(rooms.values()))
    found = 0
    for query in queries:
        exact = {(f"/room/{place // 600}", place % 600) for place in np.argsort(-every @ query)[:10].tolist()}
        hits = Store(tmp_path).search(query, 10)
        assert [hit[2] for hit in hits] == sorted((hit[2] for hit in hits), reverse=True)
        assert all(abs(rooms[name][number] @ query - cosine) < 1e-3 for name, number, cosine in hits)
        found += len(exact & {hit[:2] for hit in hits})
    assert found >= 0.95 * 10 * len(queries)
    store.remove(["/room/5"])
    assert all(name != "/room/5" for query in queries for name, _, _ in Store(tmp_path).search(query, 10))
    store.remove([f"/room/{number}" for number in range(1, 5)])
    assert (tmp_path / store._state.file).with_suffix(".ids").stat().st_size == 8 * 599, "what nobody needs was not given back"


def test_a_writer_that_is_killed_leaves_the_index_as_it_was(tmp_path):
    """At every moment: a program that adds a map is killed at each file that it opens, renames or deletes, in turn."""
    Store(tmp_path / "index").put_tables([table("/room/0", unit(50, 0))], ENCODER)
    script = tmp_path / "writer.py"
    script.write_text(f"""
import os, sys
sys.path.insert(0, {os.path.dirname(__file__)!r})
from test_index import ENCODER, table, unit
from ovimap.index.store import Store
left = int(sys.argv[1])
def watch(event, arguments):
    global left
    opened = event == "open" and "index" in str(arguments[0])
    if opened or event in ("os.rename", "os.remove"):
        left -= 1
        if left == 0:
            os.kill(os.getpid(), 9)
store = Store(sys.argv[2])
rooms = [table("/room/1", unit(50, 1))]
sys.addaudithook(watch)
store.put_tables(rooms, ENCODER)
""")
    query, killed = unit(50, 1)[3], 0
    for moment in range(1, 100):
        folder = tmp_path / f"index-{moment}"
        shutil.copytree(tmp_path / "index", folder)
        done = subprocess.run([sys.executable, script, str(moment), folder], capture_output=True, text=True)
        assert done.returncode in (0, -9), done.stderr
        killed += done.returncode == -9
        store = Store(folder)
        names = set(store.entries)
        assert names in ({"/room/0"}, {"/room/0", "/room/1"})
        assert ("/room/1", 3) in {hit[:2] for hit in store.search(query, 1)} or "/room/1" not in names
        if "/room/1" not in names:
            store.put_tables([table("/room/1", unit(50, 1))], ENCODER)
        assert Store(folder).search(query, 1)[0][:2] == ("/room/1", 3)
        if done.returncode == 0:
            break
    assert killed >= 5


def test_what_is_no_index_is_said_in_one_line(tmp_path, capsys):
    assert main(["query", str(tmp_path), "mug"]) == 2
    assert "there is no index in" in capsys.readouterr().err
    for text in ("{", "[1]", '{"a":' * 500_000, "[" * 500_000, '{"format": 1}', '{"format": 1, "encoder": 3, "vectors": 0, "next_number": 1, "maps": []}'):
        (tmp_path / "index.json").write_text(text)
        assert main(["list", str(tmp_path)]) == 2
        said = capsys.readouterr().err
        assert "no sound index" in said and said.count("\n") == 1
    (tmp_path / "index.json").write_text('{"format": 99}')
    assert main(["list", str(tmp_path)]) == 2
    assert "format 99" in capsys.readouterr().err
    (tmp_path / "pyarrow.py").write_text("raise ModuleNotFoundError('no', name='pyarrow')")
    environment = os.environ | {"PYTHONPATH": f"{tmp_path}:{os.environ['PYTHONPATH']}"}
    done = subprocess.run([sys.executable, "-m", "ovimap.index_command", "list", "a"], env=environment, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == "ovimap-index: pyarrow is not installed; pip install 'ovimap[index]'\n"


def test_what_is_no_embedding_is_told_from_a_damaged_index(maps, tmp_path):
    ObjectIndex.build(tmp_path / "index", maps[0])  # one path, not a list
    index = ObjectIndex(tmp_path / "index")
    for wrong in ("chair", np.zeros(7, np.float32), np.zeros((1, 768), np.float32)):
        with pytest.raises(ovimap.Error, match="embedding must be .* floats"):
            index.nearest(wrong)
