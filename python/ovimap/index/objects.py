# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Objects of maps as Arrow tables and Parquet files: a row each."""

from __future__ import annotations

import os
import pathlib
from collections.abc import Iterable

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from .._ovimap import Error, Map
from ..map_facts import Encoder, map_facts

CORNER = pa.list_(pa.float32(), 3)


def object_schema(encoder: Encoder) -> pa.Schema:
    """The columns. Positions are metres in the map's world frame. The schema's metadata names the encoder too."""
    return pa.schema(
        [
            ("map", pa.string()),  # absolute path
            ("revision", pa.string()),  # of the map: changes with anything in it but the timings
            ("content_hash", pa.string()),  # of the map's voxels
            ("object", pa.uint32()),  # id within the map
            ("name", pa.string()),  # given by people, or empty
            ("box_min", CORNER),
            ("box_max", CORNER),
            ("centroid", CORNER),
            ("points", pa.int64()),  # surface voxels
            ("views", pa.int64()),  # frames in which it was seen
            ("confidence", pa.float32()),  # how sure masks are that it is one whole thing; null where nobody rated them
            ("encoder", pa.string()),
            ("encoder_digest", pa.string()),
            ("embedding", pa.list_(pa.float32(), encoder.dimension)),  # length 1; null where its look is unknown
        ],
        metadata={"encoder.name": encoder.name, "encoder.dimension": str(encoder.dimension), "encoder.digest": encoder.digest},
    )


def encoder_of(map: str | os.PathLike[str]) -> Encoder:
    """Raises Error for a map without embeddings or one that is not finished."""
    facts = map_facts(map)
    if facts.unfinished:
        raise Error(f"{os.fspath(map)} is a checkpoint; finish it with `ovimap run --resume`")
    if facts.encoder is None:
        raise Error(f"{os.fspath(map)} has no embeddings; give it some: `ovimap reembed {os.fspath(map)} --encoder default`")
    return facts.encoder


def object_table(map: str | os.PathLike[str]) -> pa.Table:
    """The objects of a map, corrections applied. Raises Error for a map without embeddings."""
    encoder, facts, opened = encoder_of(map), map_facts(map), Map.open(map)
    objects, count = opened.instances, len(opened)
    known = np.any(opened.embeddings != 0, axis=1)
    columns = [
        pa.repeat(os.path.abspath(map), count),
        pa.repeat(facts.revision, count),
        pa.repeat(facts.content_hash, count),
        pa.array(objects.ids),
        pa.array(objects.names, pa.string()),
        _rows(objects.boxes[:, 0]),
        _rows(objects.boxes[:, 1]),
        _rows(objects.centroids),
        pa.array(objects.points),
        pa.array(objects.views),
        pa.array(objects.confidences, from_pandas=True),
        pa.repeat(encoder.name, count),
        pa.repeat(encoder.digest, count),
        _rows(opened.embeddings, known),
    ]
    return pa.table(columns, schema=object_schema(encoder))


def embeddings_of(table: pa.Table) -> tuple[np.ndarray[tuple[int, int], np.dtype[np.float32]], np.ndarray[tuple[int], np.dtype[np.int64]]]:
    """Those rows of a table that have an embedding: float32 [rows, dimension], and their positions."""
    column = table["embedding"].combine_chunks()
    positions = np.flatnonzero(column.is_valid().to_numpy(zero_copy_only=False))
    dimension = column.type.list_size
    values = column.drop_null().flatten().to_numpy(zero_copy_only=False)
    return np.ascontiguousarray(values.reshape(-1, dimension), np.float32), positions


def export_objects(maps: Iterable[str | os.PathLike[str]], out: str | os.PathLike[str]) -> int:
    """Writes the objects of maps as one Parquet file, a row group a map; returns how many. All of one encoder.

    Raises Error for a map that cannot be in it; then nothing is written.
    """
    paths = list(maps)
    if not paths:
        raise Error("there is no map to export; name one")
    encoder = encoder_of(paths[0])
    for path in paths:
        require_same_encoder(path, encoder)
    target, rows = pathlib.Path(out), 0
    new = target.with_name(target.name + ".new")
    try:
        with pq.ParquetWriter(new, object_schema(encoder), compression="zstd") as writer:
            for path in paths:
                table = object_table(path)
                writer.write_table(table)
                rows += len(table)
        os.replace(new, target)
    except OSError as fault:
        raise Error(f"cannot write {target}: {fault.strerror or fault}; give a folder that can be written") from None
    finally:
        new.unlink(missing_ok=True)
    return rows


def require_same_encoder(map: str | os.PathLike[str], encoder: Encoder) -> None:
    other = encoder_of(map)
    if other != encoder:
        raise Error(f"{os.fspath(map)} has embeddings of {other}, the others have those of {encoder}; these cannot be compared: "
                    "`ovimap reembed` gives it the others', or keep it in an index of its own")


def _rows(values: np.ndarray[tuple[int, int], np.dtype[np.float32]], known: np.ndarray[tuple[int], np.dtype[np.bool_]] | None = None) -> pa.Array:
    flat = pa.array(np.ascontiguousarray(values, np.float32).reshape(-1))
    mask = None if known is None else pa.array(~known)
    return pa.FixedSizeListArray.from_arrays(flat, values.shape[1], mask=mask)
