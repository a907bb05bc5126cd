# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A saved map: objects and surface as arrays, questions, exports, scores."""
import csv
import io
import json
import shutil
import threading

import numpy as np
import ovimap
import pytest
import trimesh
from PIL import Image


@pytest.fixture(scope="module")
def opened(saved_map):
    return ovimap.Map.open(saved_map)


def test_objects_are_arrays_of_equal_length(opened):
    objects = opened.instances
    count = len(opened)
    assert count == len(objects) > 3
    assert objects.ids.shape == objects.points.shape == objects.views.shape == (count,)
    assert objects.boxes.shape == (count, 2, 3) and objects.centroids.shape == (count, 3)
    assert (objects.boxes[:, 0] <= objects.centroids).all() and (objects.centroids <= objects.boxes[:, 1]).all()
    assert len(objects.names) == count and len(set(objects.ids.tolist())) == count
    assert opened.frames > 0 and len(opened.content_hash) == 16 and opened.voxel_size_m > 0
    assert "map.voxel_size_m" in opened.config_text and opened.camera.width > 0


def test_what_is_printed_says_what_it_is(opened, saved_map):
    assert repr(opened).startswith(f"Map('{saved_map}': {len(opened)} objects from {opened.frames} frames, embeddings of '{opened.encoder}')")
    assert repr(opened.instances) == f"Instances({len(opened)} objects, 0 named)"
    mesh = opened.mesh()
    assert repr(mesh) == f"Mesh({len(mesh.vertices)} vertices, {len(mesh.triangles)} triangles, colours, labels)"
    assert opened.skipped == {}


def test_embeddings_are_a_view(opened):
    assert opened.embeddings.shape[0] == len(opened) and opened.embeddings.dtype == np.float32
    assert np.shares_memory(opened.embeddings, opened.embeddings)
    lengths = np.linalg.norm(opened.embeddings, axis=1)
    assert np.all(np.isclose(lengths, 1, atol=1e-4) | (lengths == 0))


def test_the_mesh_lies_in_the_boxes_of_its_objects(opened):
    mesh = opened.mesh()
    assert mesh.vertices.shape == mesh.normals.shape == (len(mesh.labels), 3)
    assert mesh.colors.shape == (len(mesh.labels), 3) and mesh.triangles.max() < len(mesh.vertices)
    objects = opened.instances
    for box, number in zip(objects.boxes, objects.ids):
        mine = mesh.vertices[mesh.labels == number]
        inside = ((mine >= box[0] - 0.02) & (mine <= box[1] + 0.02)).all(axis=1)
        assert len(mine) and inside.mean() > 0.9  # specks of it lie outside
    vertices = mesh.vertices
    del mesh
    assert np.isfinite(vertices).all()


def test_questions_in_words(opened):
    answer = opened.query("chair", relevance=True)
    assert answer.query == "chair" and answer.matches and answer.relevance.shape == (len(opened),)
    best = answer.matches[0]
    assert opened.instances.ids[best.row] == best.id and -1 <= best.score <= 1
    assert not opened.query("elephant").found
    with pytest.raises(ovimap.Error, match="empty|text"):
        opened.query("")


def test_questions_by_object_and_by_picture(opened, room):
    first = int(opened.instances.ids[0])
    assert first not in [match.id for match in opened.query_like(first).matches]
    assert opened.query_like(ovimap.open_source(room)[0].color).query == "picture"
    with pytest.raises(ovimap.Error, match="999999"):
        opened.query_like(999999)


def test_an_object_is_described(opened):
    chair = opened.query("chair").matches[0]
    facts = opened.describe(chair.id)
    assert (facts.id, facts.name, facts.label) == (chair.id, "", "chair") and 0 < facts.label_share <= 1
    assert opened.guess_names()[chair.row] == (facts.label, facts.label_share) and len(opened.guess_names()) == len(opened)
    box = opened.instances.boxes[chair.row]
    assert facts.height_m == pytest.approx(box[1][2] - box[0][2], abs=0.1) and 0 < facts.footprint_m2 < 4
    shares = [share for _, share in facts.colors]
    assert shares == sorted(shares, reverse=True) and 0.1 <= shares[-1] and sum(shares) <= 1.01
    assert opened.up[2] == pytest.approx(1, abs=0.05)
    for ask in (opened.describe, opened.crops, opened.place):
        with pytest.raises(ovimap.Error, match="999999"):
            ask(999999)


def test_relations_are_those_of_the_export(opened, tmp_path):
    opened.export(tmp_path / "a.json")
    listed = json.loads((tmp_path / "a.json").read_text())["relations"]
    assert [(said.object, said.relation, said.anchor, said.evidence) for said in opened.relations()] == [
        (said["object"], said["relation"], said["anchor"], said["evidence"]) for said in listed
    ]
    assert listed


def test_pictures_of_an_object_and_of_its_place(opened):
    thing = opened.query("anything on the table").matches[0]
    crops = opened.crops(thing.id)
    assert 0 < len(crops) and len(set(crops)) == len(crops) and all(crop.startswith(b"\xff\xd8") for crop in crops)
    place = np.array(Image.open(io.BytesIO(opened.place(thing.id)))).astype(int)
    red = (place[..., 0] > 2 * place[..., 1]) & (place[..., 0] > 2 * place[..., 2])
    rows, columns = np.nonzero(red)
    scale = max(place.shape) / np.ptp(opened.mesh().vertices[:, :2], axis=0).max()  # pixels in a metre, margins left out
    width = np.ptp(opened.instances.boxes[thing.row], axis=0)[:2].max()
    assert max(np.ptp(rows), np.ptp(columns)) == pytest.approx(width * scale, rel=0.25)


def test_corrections_are_kept_in_the_map(saved_map, tmp_path):
    path = shutil.copy(saved_map, tmp_path / "a.ovimap")
    opened = ovimap.Map.open(path)
    chair, other = (match.id for match in opened.query("chair").matches[:2])
    first = opened.rename(chair, "throne")
    assert opened.describe(chair).name == "" and opened.reopened().describe(chair).name == "throne"
    assert ovimap.Map.open(path).describe(chair).name == "throne"
    second = opened.merge(other, chair)
    assert second == first + 1 and other not in opened.reopened().instances.ids
    assert opened.undo() == second + 1 and other in opened.reopened().instances.ids
    opened.undo(first)
    again = opened.reopened()
    assert again.describe(chair).name == "" and [match.id for match in again.query("chair").matches[:2]] == [chair, other]
    for wrong in (lambda: opened.undo(99), lambda: opened.merge(chair, chair), lambda: opened.rename(999999, "x")):
        with pytest.raises(ovimap.Error):
            wrong()


def test_names_teach_other_maps(saved_map, tmp_path):
    path, taught = shutil.copy(saved_map, tmp_path / "a.ovimap"), tmp_path / "taught.json"
    opened = ovimap.Map.open(path, teach=taught)
    chair = opened.query("chair").matches[0].id
    opened.rename(chair, "throne of Anna")
    other = ovimap.Map.open(saved_map, teach=taught)
    answer = other.query("throne of Anna")
    assert answer.matches[0].id == chair and other.describe(chair).name == ""
    untaught = {match.id: match.p_value for match in ovimap.Map.open(saved_map).query("throne of Anna").matches}
    assert answer.matches[0].p_value < 0.05 < untaught[chair]
    assert other.describe(chair).label == "throne of Anna" and ovimap.Map.open(saved_map).describe(chair).label != "throne of Anna"
    opened.undo()
    forgotten = ovimap.Map.open(saved_map, teach=taught).query("throne of Anna")
    assert [m.score for m in forgotten.matches] == [m.score for m in ovimap.Map.open(saved_map).query("throne of Anna").matches]
    assert forgotten.matches[0].standard_score < answer.matches[0].standard_score
    taught.write_text("{}")
    with pytest.raises(ovimap.Error, match="taught.json"):
        ovimap.Map.open(saved_map, teach=taught)


def test_names_are_found_without_embeddings(room, tmp_path):
    made = ovimap.run(room, tmp_path / "shapes.ovimap", frames="::10", masks="none")
    given = int(made.instances.ids[0])
    made.rename(given, "Anna's mug")
    opened = made.reopened()
    assert [match.id for match in opened.query("mug").matches] == [given]
    with pytest.raises(ovimap.Error, match="embedding"):
        opened.query("sofa")


def test_a_map_without_encoder_names_nothing(saved_map):
    opened = ovimap.Map.open(saved_map, encoder="none")
    assert opened.guess_names() == [] and opened.describe(int(opened.instances.ids[0])).label == ""


def test_several_threads_may_ask_at_once(saved_map):
    fresh = ovimap.Map.open(saved_map)
    answers = [None] * 4

    def ask(i):
        answers[i] = [match.id for match in fresh.query("table").matches]

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert answers[0] and all(answer == answers[0] for answer in answers)


def test_the_map_refuses_another_encoder(saved_map):
    class Other:
        name, dimension = "other", 3

        def encode_images(self, images):
            return np.zeros((len(images), 3))

    with pytest.raises(ovimap.Error, match="not of 'other' .3 numbers"):
        ovimap.Map.open(saved_map, encoder=Other())


def test_exports_are_what_others_read(opened, tmp_path):
    for ending in ("ply", "glb", "json", "csv"):
        opened.export(tmp_path / f"a.{ending}")
    mesh = opened.mesh()
    assert len(trimesh.load(tmp_path / "a.ply", process=False).vertices) == len(mesh.vertices)
    assert len(trimesh.load(tmp_path / "a.glb").geometry) >= len(opened)
    listed = json.loads((tmp_path / "a.json").read_text())["instances"]
    assert [entry["id"] for entry in listed] == opened.instances.ids.tolist()
    labels = [entry["label"] for entry in listed]
    assert any(labels) and labels == [word if share > 0 else "" for word, share in opened.guess_names()]
    with open(tmp_path / "a.csv", newline="") as table:
        assert [row["label"] for row in csv.DictReader(table)] == labels
    with pytest.raises(ovimap.Error, match="must end in .ply"):
        opened.export(tmp_path / "a.stl")


def test_what_is_no_map_is_an_error(tmp_path):
    (tmp_path / "a.ovimap").write_bytes(b"nothing")
    with pytest.raises(ovimap.Error, match="a.ovimap"):
        ovimap.Map.open(tmp_path / "a.ovimap")


def test_scores_against_the_truth(saved_map, room):
    figures = ovimap.eval(saved_map, room, encoder="none")  # without classes
    assert 0.3 < figures["standard"]["class_agnostic"]["miou"] <= 1
    assert figures["standard"]["geometry"]["accuracy_m"] < 0.05
    with pytest.raises(ValueError, match="1 maps but 2 truths"):
        ovimap.eval(saved_map, [room, room])


def test_the_default_encoder_puts_pictures_and_words_in_one_space(saved_map, room):
    encoder = ovimap.make_encoder()
    image = ovimap.open_source(room)[0].color
    pictures, words = encoder.encode_images([image, image[::2, ::2]]), encoder.encode_texts(["a chair"])
    assert pictures.shape == (2, encoder.dimension) and words.shape == (1, encoder.dimension)
    np.testing.assert_allclose(np.linalg.norm(pictures, axis=1), 1, atol=1e-4)
    with pytest.raises(TypeError, match="image must be uint8"):
        encoder.encode_images([image.astype(float)])


def test_a_robot_hears_where_to_stand(saved_map):
    opened = ovimap.Map.open(saved_map)
    chair = opened.query("chair").matches[0].id
    found = opened.approach(chair, start=(1.0, 1.0), radius_m=0.15, poses=2)
    assert not found.reason and 1 <= len(found.poses) <= 2
    best = found.poses[0]
    assert 0.3 <= best.seen <= 1 and best.distance_m > 0.3 and abs(best.tilt) < 1.5
    assert best.way[-1] == pytest.approx([best.x, best.y]) and best.way_m >= 0
    assert not opened.approach(chair, radius_m=0.15).poses[0].way, "there is no way without a start"
    walled = opened.approach(chair, radius_m=5.0)
    assert not walled.poses and "no free place" in walled.reason
    for wrong in ({"radius_m": 0}, {"fov_deg": 400}, {"poses": 0}):
        with pytest.raises(ovimap.Error):
            opened.approach(chair, **wrong)
    with pytest.raises(ovimap.Error, match="999999"):
        opened.approach(999999)
