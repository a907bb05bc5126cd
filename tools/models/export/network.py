# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A torch module to an ONNX file, and the proof that both give the same."""

import pathlib
import tempfile
import warnings

import numpy as np
import onnx
import onnxruntime
import torch

from .errors import ExportError

OPSET = 17  # the newest that ONNX Runtime 1.14 and later all take
MIN_COSINE = 0.9999
MAX_FILE_BYTES = 1_900_000_000  # a protobuf message ends at 2 GiB; weights then go to a second file


class Wrapped(torch.nn.Module):
    """A module whose forward is `function(model, *inputs)`: what is exported of a model."""

    def __init__(self, model, function):
        super().__init__()
        self.model = model
        self.function = function

    def forward(self, *inputs):
        return self.function(self.model, *inputs)


def pooled(features):
    """The pooled embedding of get_*_features, which newer transformers wrap in an output object."""
    return features if isinstance(features, torch.Tensor) else features.pooler_output


def export_network(module, examples, path: pathlib.Path, inputs, outputs, open_axes):
    """Writes `module` as `path`. `inputs` and `outputs` are tensor names in order; `open_axes` is
    tensor name -> {axis: name of the axis} of what may have any size."""
    with tempfile.TemporaryDirectory() as scratch, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # tracing warns of each constant it folds
        raw = pathlib.Path(scratch) / path.name
        torch.onnx.export(
            module.eval(),
            tuple(examples),
            str(raw),
            input_names=list(inputs),
            output_names=list(outputs),
            dynamic_axes=open_axes,
            opset_version=OPSET,
            dynamo=False,
        )
        model = onnx.load(str(raw))
    shorten(model.graph)
    save(model, path)


def shorten(graph):
    """Drops what only a debugger would read (remarks, long names of nodes and between them) and
    constants that are there already."""
    kept = {tensor.name for tensor in [*graph.input, *graph.output, *graph.initializer]}
    rename_tensors(graph, kept, {"": ""}, {})


def rename_tensors(graph, kept: set, names: dict, constants: dict):
    """Gives every tensor but the `kept` ones a short name. `names` is what has been given yet,
    `constants` the names of the constants that can be seen, by their value."""
    del graph.value_info[:]
    kept |= {tensor.name for tensor in graph.initializer}
    nodes = []
    for node in graph.node:
        node.doc_string = ""
        for attribute in node.attribute:
            if attribute.type == onnx.AttributeProto.GRAPH:
                rename_tensors(attribute.g, kept, names, dict(constants))
        if is_repeated(node, kept, names, constants):
            continue
        for tensors in (node.input, node.output):
            for i, name in enumerate(tensors):
                tensors[i] = name if name in kept else names.setdefault(name, f"t{len(names)}")
        # Names must differ: ONNX Runtime's optimiser makes new ones from them.
        node.name = "n_" + node.output[0]
        nodes.append(node)
    for output in graph.output:
        output.name = names.get(output.name, output.name)
    del graph.node[:]
    graph.node.extend(nodes)


def is_repeated(node, kept: set, names: dict, constants: dict) -> bool:
    """Whether the node is a constant that another one gives already, whose name it then takes."""
    if node.op_type != "Constant" or node.output[0] in kept:
        return False
    name = names.setdefault(node.output[0], f"t{len(names)}")
    value = b"".join(a.SerializeToString(deterministic=True) for a in node.attribute)
    names[node.output[0]] = constants.setdefault(value, name)
    return names[node.output[0]] != name


def save(model, path: pathlib.Path):
    # Not by ByteSize(), which fails on what it should measure.
    weights = sum(len(tensor.raw_data) for tensor in model.graph.initializer)
    if weights < MAX_FILE_BYTES:
        path.write_bytes(model.SerializeToString(deterministic=True))
        return
    onnx.save_model(
        model,
        str(path),
        save_as_external_data=True,
        all_tensors_to_one_file=True,
        location=path.name + ".data",
        size_threshold=1024,
    )


def run_onnx(path: pathlib.Path, feeds: dict) -> list:
    """All outputs for the NumPy arrays or tensors in `feeds`."""
    session = onnxruntime.InferenceSession(str(path), providers=["CPUExecutionProvider"])
    arrays = {name: np.asarray(value) for name, value in feeds.items()}
    return session.run(None, arrays)


def cosine(a, b) -> float:
    """The smallest cosine of any two corresponding rows (rows: all but the first axis)."""
    a, b = (np.asarray(x, np.float64).reshape(len(x), -1) for x in (a, b))
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1)
    return float(np.min((a * b).sum(1) / np.maximum(lengths, 1e-30)))


def check_same(name: str, expected, found) -> float:
    """The cosine, or ExportError when it is too low for the file to be the model."""
    expected = expected.detach().numpy() if isinstance(expected, torch.Tensor) else expected
    if expected.shape != found.shape:
        raise ExportError(
            f"{name}: torch gives shape {expected.shape}, the ONNX file {found.shape}"
        )
    value = cosine(expected, found)
    if not value >= MIN_COSINE:
        raise ExportError(
            f"{name}: the ONNX file's answer has cosine {value:.6f} with torch's, "
            f"at least {MIN_COSINE} is needed; try the pinned versions of requirements-export.txt"
        )
    return value
