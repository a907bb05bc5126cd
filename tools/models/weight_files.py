# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Reads the weights of published networks without the frameworks that wrote them."""

import collections
import json
import math
import pathlib
import pickle
import struct

import numpy as np

TORCH_MAGIC = 0x1950A86A20F9469CFC6C
STORAGE_TYPES = {
    "FloatStorage": np.dtype("<f4"),
    "DoubleStorage": np.dtype("<f8"),
    "HalfStorage": np.dtype("<f2"),
    "LongStorage": np.dtype("<i8"),
    "IntStorage": np.dtype("<i4"),
}
SAFETENSORS_TYPES = {"F32": "<f4", "F16": "<f2", "F64": "<f8", "I64": "<i8", "I32": "<i4"}


# What a pickle, or values of other types than a plain file has, make of the code that reads it.
DAMAGES = (pickle.UnpicklingError, EOFError, struct.error, ArithmeticError, AttributeError, LookupError, MemoryError, TypeError, ValueError)


class WeightFileError(Exception):
    """The file is not what its reader takes; the message is for the user."""


def _rebuild_tensor(storage, offset, shape, strides, *_):
    return storage, offset, tuple(shape), tuple(strides)


class _StateReader(pickle.Unpickler):
    """Builds tensors as (storage, offset, shape, strides), and nothing else that a pickle names."""

    def find_class(self, module, name):
        if (module, name) == ("collections", "OrderedDict"):
            return collections.OrderedDict
        if (module, name) == ("torch._utils", "_rebuild_tensor_v2"):
            return _rebuild_tensor
        if module == "torch" and name in STORAGE_TYPES:
            return STORAGE_TYPES[name]
        raise WeightFileError(f"the pickle names {module}.{name}, which no plain weight file does")

    def persistent_load(self, pid):
        kind, dtype, key, _, count, view = pid
        if kind != "storage" or view is not None:
            raise WeightFileError(f"unknown persistent id '{kind}'")
        return key, dtype, count


def _read_storages(file, types):
    storages = {}
    for key in _StateReader(file).load():
        (count,) = struct.unpack("<q", file.read(8))
        dtype, expected = types[key]
        if count != expected or count < 0:
            raise WeightFileError(f"storage {key} has {count} numbers where {expected} are expected")
        data = file.read(count * dtype.itemsize)
        if len(data) != count * dtype.itemsize:
            raise WeightFileError(f"storage {key} is cut short")
        storages[key] = np.frombuffer(data, dtype)
    return storages


def _view(storage, offset, shape, strides):
    """The strided view that a tensor is of its storage, copied into plain row-major order."""
    last = offset + sum((n - 1) * s for n, s in zip(shape, strides)) if 0 not in shape else offset
    if offset < 0 or any(n < 0 for n in (*shape, *strides)) or last >= storage.size:
        raise WeightFileError("a tensor reaches beyond its storage")
    if math.prod(shape) > storage.size:  # strides of 0 would repeat a number without end
        raise WeightFileError("a tensor is larger than its storage")
    bytes_strides = [s * storage.itemsize for s in strides]
    view = np.lib.stride_tricks.as_strided(storage[offset:], shape, bytes_strides)
    return np.array(view, order="C")


def read_torch_file(path: pathlib.Path) -> dict:
    """Name -> array, from a state dict in PyTorch's format before 1.6: three small pickles (magic
    number, protocol, machine), the dict itself with its storages by name, the list of storages,
    then each storage as a 64-bit count and raw little-endian numbers. Tensors are strided views."""
    with open(path, "rb") as file:
        try:
            if _StateReader(file).load() != TORCH_MAGIC:
                raise WeightFileError(f"{path} is no PyTorch file of the format before 1.6")
            _StateReader(file).load(), _StateReader(file).load()
            state = _StateReader(file).load()
            types = {t[0][0]: t[0][1:] for t in state.values()}
            storages = _read_storages(file, types)
            return {name: _view(storages[t[0][0]], *t[1:]) for name, t in state.items()}
        except DAMAGES as error:
            raise WeightFileError(f"{path} is damaged or no PyTorch file ({error})") from error


def read_safetensors(path: pathlib.Path) -> dict:
    """Name -> array. The file is a 64-bit length, a JSON header of that length, raw data."""
    data = pathlib.Path(path).read_bytes()
    try:
        (length,) = struct.unpack_from("<Q", data)
        header = json.loads(data[8 : 8 + length])
    except (struct.error, ValueError) as error:
        raise WeightFileError(f"{path} is no safetensors file ({error})") from error
    tensors = {}
    try:
        for name, entry in header.items():
            if name == "__metadata__":
                continue
            begin, end = (8 + length + offset for offset in entry["data_offsets"])
            if end > len(data):
                raise WeightFileError(f"{path} is cut short: it lacks {name}")
            array = np.frombuffer(data[begin:end], SAFETENSORS_TYPES[entry["dtype"]])
            tensors[name] = array.reshape(entry["shape"])
    except DAMAGES as error:
        raise WeightFileError(f"{path} is damaged or no safetensors file ({error})") from error
    return tensors
