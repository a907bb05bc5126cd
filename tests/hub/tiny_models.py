# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Repositories as the hub holds them, of networks of a few nodes that can be computed by hand.

The image tower averages a picture to 4x4 cells; the text tower adds what each token stands for. A name's row is what the
image tower makes of a drawing of it, so that names and drawings find each other as they do in a real model."""
import json
import pathlib

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper

SIDE, CELLS = 16, 4
WIDTH = 3 * CELLS * CELLS
CONTEXT = 12
COLOURS = {
    "red": (230, 20, 20), "green": (20, 160, 40), "blue": (20, 50, 220), "yellow": (250, 220, 20), "orange": (250, 130, 10),
    "purple": (130, 20, 150), "black": (0, 0, 0), "white": (255, 255, 255),
}
SHAPES = ("circle", "square", "triangle", "cross")
WORDS = [*COLOURS, *SHAPES, "the", "colour", "a"]
GOLDEN = pathlib.Path(__file__).resolve().parents[2] / "src/ovimap/inference/testdata"


def drawing(name):
    """[256,256,3] from 0 to 255."""
    if name in COLOURS:
        return np.full((256, 256, 3), COLOURS[name], np.float32)
    x, y = np.meshgrid(*[(np.arange(256) * 2 + 1) / 256 - 1] * 2)
    inside = {
        "circle": x**2 + y**2 < 0.36,
        "square": (abs(x) < 0.6) & (abs(y) < 0.6),
        "triangle": (abs(y) < 0.6) & (abs(x) < (y + 0.6) / 2),
        "cross": ((abs(x) < 0.15) & (abs(y) < 0.6)) | ((abs(y) < 0.15) & (abs(x) < 0.6)),
    }[name]
    return np.where(inside[..., None], 0.0, 255.0).repeat(3, 2).astype(np.float32)


def cells(picture):
    """What the image tower answers: means of cells of the normalised picture, channel by channel."""
    side = len(picture) // CELLS
    means = picture.reshape(CELLS, side, CELLS, side, 3).mean((1, 3))
    return (means / 127.5 - 1).transpose(2, 0, 1).reshape(-1)


def rows_of_words():
    """word: [WIDTH]; what all drawings of its kind have in common is left out."""
    rows = {}
    for group in (COLOURS, SHAPES):
        seen = {name: cells(drawing(name)) for name in group}
        seen = {name: row / np.linalg.norm(row) for name, row in seen.items()}
        mean = np.mean(list(seen.values()), 0)
        rows |= {name: (row - mean) / np.linalg.norm(row - mean) for name, row in seen.items()}
    return rows


# ------------------------------------------------------------------------------------------- networks


def value(name, shape, kind=TensorProto.FLOAT):
    return helper.make_tensor_value_info(name, kind, shape)


def constant(name, array):
    return numpy_helper.from_array(np.asarray(array), name)


def model_bytes(nodes, inputs, outputs, constants=()):
    graph = helper.make_graph(nodes, "tower", inputs, outputs, list(constants))
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 14)], ir_version=8)
    onnx.checker.check_model(model)
    return model.SerializeToString()


def image_tower(output, batch_mixes=False, half_inside=False, half_outside=False, side=("height", "width")):
    """`batch_mixes`: what stands beside a picture changes its answer, as in networks quantised while they run."""
    kind = TensorProto.FLOAT16 if half_outside else TensorProto.FLOAT
    nodes, last = [], "pixel_values"
    constants = [constant("least", np.float32(-1)), constant("most", np.float32(1))]
    if half_inside or half_outside:
        nodes += [helper.make_node("Cast", [last], ["half"], to=TensorProto.FLOAT16)]
        nodes += [helper.make_node("Cast", ["half"], ["whole"], to=TensorProto.FLOAT)]
        last = "whole"
    pool = SIDE // CELLS
    # Cut to what a right normalisation gives: another one is noticed.
    nodes += [helper.make_node("Clip", [last, "least", "most"], ["cut"])]
    nodes += [helper.make_node("AveragePool", ["cut"], ["cells"], kernel_shape=[pool] * 2, strides=[pool] * 2)]
    nodes += [helper.make_node("Flatten", ["cells"], ["flat"], axis=1)]
    if batch_mixes:
        nodes += [helper.make_node("ReduceMean", ["flat"], ["mean"], axes=[0], keepdims=1)]
        nodes += [helper.make_node("Mul", ["mean", "little"], ["share"])]
        nodes += [helper.make_node("Sub", ["flat", "share"], ["mixed"])]
        constants += [constant("little", np.float32(0.2))]
    nodes += [helper.make_node("Identity", ["mixed" if batch_mixes else "flat"], [output])]
    nodes += [helper.make_node("Identity", [last], ["last_hidden_state"])]
    outputs = [value("last_hidden_state", ["batch", 3, "h", "w"]), value(output, ["batch", WIDTH])]
    return model_bytes(nodes, [value("pixel_values", ["batch", 3, *side], kind)], outputs, constants)


def text_tower(table, output, mask):
    """`mask`: also takes an attention_mask, and leaves out what it hides."""
    nodes = [helper.make_node("Gather", ["table", "input_ids"], ["tokens"], axis=0)]
    inputs, last = [value("input_ids", ["batch", "length"], TensorProto.INT64)], "tokens"
    if mask:
        inputs += [value("attention_mask", ["batch", "length"], TensorProto.INT64)]
        nodes += [helper.make_node("Cast", ["attention_mask"], ["shown"], to=TensorProto.FLOAT)]
        nodes += [helper.make_node("Unsqueeze", ["shown", "last_axis"], ["column"])]
        nodes += [helper.make_node("Mul", ["tokens", "column"], ["kept"])]
        last = "kept"
    nodes += [helper.make_node("ReduceSum", [last, "second_axis"], [output], keepdims=0)]
    constants = [constant("table", table.astype(np.float32)), constant("second_axis", np.array([1]))]
    constants += [constant("last_axis", np.array([2]))] if mask else []
    return model_bytes(nodes, inputs, [value(output, ["batch", WIDTH])], constants)


def with_weights_beside(content, name):
    """The network and the file that holds its weights, as exports of more than 2 GB have them."""
    model = onnx.load_from_string(content)
    blob = b""
    for tensor in model.graph.initializer:
        data = tensor.raw_data
        if len(data) < 64:
            continue
        tensor.ClearField("raw_data")
        tensor.data_location = TensorProto.EXTERNAL
        for key, text in (("location", name), ("offset", len(blob)), ("length", len(data))):
            tensor.external_data.add(key=key, value=str(text))
        blob += data
    return model.SerializeToString(), blob


def mask_networks(boxes):
    """A `sam` pair whose mask is what is red; `boxes`: with the inputs that SAM 2's export has, else SAM's."""
    encoder = model_bytes(
        [helper.make_node("AveragePool", ["pixel_values"], ["image_embeddings"], kernel_shape=[4, 4], strides=[4, 4])],
        [value("pixel_values", ["batch", 3, 64, 64])], [value("image_embeddings", ["batch", 3, 16, 16])])
    nodes = [helper.make_node("Conv", ["image_embeddings", "red", "half"], ["logits"])]  # cells that are red for the most part
    nodes += [helper.make_node("Cast", ["input_labels"], ["labels"], to=TensorProto.FLOAT)]
    takes = ["input_points", "labels", *(["input_boxes"] if boxes else [])]
    nodes += [helper.make_node("ReduceSum", [name], [f"sum_{name}"], keepdims=0) for name in takes]
    nodes += [helper.make_node("Sum", [f"sum_{name}" for name in takes], ["sum"])]
    nodes += [helper.make_node("Mul", ["sum", "nothing"], ["zero"])]
    nodes += [helper.make_node("Add", ["logits", "zero"], ["shifted"])]
    nodes += [helper.make_node("Unsqueeze", ["shifted", "first_axis"], ["pred_masks"])]
    nodes += [helper.make_node("ReduceMax", ["pred_masks"], ["best"], axes=[3, 4], keepdims=0)]
    nodes += [helper.make_node("Identity", ["best"], ["iou_scores"])]
    inputs = [value("input_points", ["batch", 1, "points", 2]), value("input_labels", ["batch", 1, "points"], TensorProto.INT64)]
    inputs += [value("input_boxes", ["batch", "boxes", 4])] if boxes else []
    inputs += [value("image_embeddings", ["batch", 3, 16, 16])]
    red = np.array([1, -1, 0], np.float32).reshape(1, 3, 1, 1)
    constants = [constant("red", red), constant("half", np.array([-0.82], np.float32)), constant("nothing", np.float32(0)), constant("first_axis", np.array([1]))]
    outputs = [value("iou_scores", ["batch", 1, 1]), value("pred_masks", ["batch", 1, 1, 16, 16])]
    return encoder, model_bytes(nodes, inputs, outputs, constants)


# ----------------------------------------------------------------------------------------- tokenizers


def merges_of(words, ending=""):
    """Pairs that put each word together from its letters, left to right, and the pieces they make."""
    pairs, pieces = [], []
    for word in words:
        letters = list(word[:-1]) + [word[-1] + ending]
        pieces += letters
        left = letters[0]
        for right in letters[1:]:
            pairs.append((left, right))
            left += right
            pieces.append(left)
    return list(dict.fromkeys(pairs)), list(dict.fromkeys(pieces))


def byte_pairs(letters, pairs):
    """Byte-pair encoding in plain Python: again and again the first pair of the list that stands somewhere is joined."""
    rank, pieces = {pair: i for i, pair in enumerate(pairs)}, list(letters)
    while True:
        found = [(rank[pair], i) for i, pair in enumerate(zip(pieces, pieces[1:])) if pair in rank]
        if not found:
            return pieces
        at = min(found)[1]
        pieces[at : at + 2] = [pieces[at] + pieces[at + 1]]


def clip_tokenizer():
    """tokenizer.json, tokenizer_config.json, the ids of each word as it stands in a sentence, and how many ids there are."""
    pairs, made = merges_of(WORDS, "</w>")
    printable = [chr(c) for c in range(33, 127)] + [chr(c) for c in range(161, 173)] + [chr(c) for c in range(174, 256)]
    letters = printable + [chr(c) for c in range(256, 256 + 256 - len(printable))]  # CLIP's letters for bytes
    pieces = list(dict.fromkeys([*letters, *(letter + "</w>" for letter in letters), *made]))
    vocab = {piece: i for i, piece in enumerate([*pieces, "<|startoftext|>", "<|endoftext|>"])}
    begin, end = len(vocab) - 2, len(vocab) - 1
    backend = {
        "added_tokens": [{"id": begin, "content": "<|startoftext|>", "special": True},
                         {"id": end, "content": "<|endoftext|>", "special": True}],
        "post_processor": {"type": "RobertaProcessing", "sep": ["<|endoftext|>", end], "cls": ["<|startoftext|>", begin]},
        "model": {"type": "BPE", "end_of_word_suffix": "</w>", "vocab": vocab, "merges": [" ".join(p) for p in pairs]},
    }
    settings = {"pad_token": "<|endoftext|>", "tokenizer_class": "CLIPTokenizer"}
    ids = {word: [vocab[p] for p in byte_pairs([*word[:-1], word[-1] + "</w>"], pairs)] for word in WORDS}
    return backend, settings, ids, len(vocab)


def gemma_tokenizer():
    pieces = merges_of([word for name in WORDS for word in (name, "▁" + name)])[1]
    # Converted from SentencePiece, as Gemma's is: a piece may be made of any two that there are.
    cuts = [(piece[:i], piece[i:]) for piece in pieces for i in range(1, len(piece))]
    pairs = [pair for pair in cuts if set(pair) <= set(pieces)]
    special = ["<pad>", "<eos>", "<bos>", "<unk>"]
    bytes_ = [f"<0x{i:02X}>" for i in range(256)]
    vocab = {piece: i for i, piece in enumerate(dict.fromkeys([*special, *bytes_, "▁", *pieces]))}
    backend = {
        "added_tokens": [{"id": i, "content": piece, "special": True} for i, piece in enumerate(special)],
        "post_processor": None,
        "model": {"type": "BPE", "unk_token": "<unk>", "byte_fallback": True, "vocab": vocab, "merges": [list(p) for p in pairs]},
    }
    settings = {"pad_token": {"content": "<pad>"}, "eos_token": "<eos>", "bos_token": "<bos>",
                "add_bos_token": False, "add_eos_token": True}
    ids = {word: [vocab[p] for p in byte_pairs(word if word in ("the", "a") else "▁" + word, pairs)] for word in WORDS}
    return backend, settings, ids, len(vocab)


def siglip_tokenizer():
    """The committed random one, whose pieces are parts of words: nothing can be told by it."""
    content = (GOLDEN / "golden_siglip/spiece.model").read_bytes()
    pieces = list(read_pieces(content))
    backend = {
        "added_tokens": [],
        "post_processor": {"type": "TemplateProcessing", "single": [{"Sequence": {"id": "A", "type_id": 0}},
                                                                  {"SpecialToken": {"id": "</s>", "type_id": 0}}],
                           "special_tokens": {"</s>": {"id": "</s>", "ids": [1], "tokens": ["</s>"]}}},
        "model": {"type": "Unigram", "vocab": [[piece, 0.0] for piece in pieces]},
    }
    return backend, {"pad_token": "</s>"}, {}, len(pieces), content


def read_pieces(content):
    """The pieces of a SentencePiece model, in order (sentencepiece_model.proto)."""
    def varint(at):
        number = shift = 0
        while True:
            number |= (content[at] & 127) << shift
            shift, at = shift + 7, at + 1
            if content[at - 1] < 128:
                return number, at

    at = 0
    while at < len(content):
        key, at = varint(at)
        size, at = varint(at)
        if key == 10:  # ModelProto.pieces; its first field is the text
            assert content[at] == 10
            length, start = varint(at + 1)
            yield content[start : start + length].decode()
        at += size


# --------------------------------------------------------------------------------------- repositories


def table(ids, size):
    """Rows of the pieces, so that those of a word add up to its row; those of a word that names nothing, to none."""
    rows, words = rows_of_words(), list(ids)
    pieces = np.zeros((len(words), size))
    for i, word in enumerate(words):
        np.add.at(pieces[i], ids[word], 1)
    wanted = np.array([rows.get(word, np.zeros(WIDTH)) for word in words])
    found = np.linalg.lstsq(pieces, wanted, rcond=None)[0]
    assert np.allclose(pieces @ found, wanted), "two words have the same pieces"
    return found


def processor(**keys):
    return {"do_normalize": True, "do_rescale": True, "do_resize": True, "image_mean": [0.5] * 3, "image_std": [0.5] * 3,
            "rescale_factor": 1 / 255, "resample": 2, "size": {"height": SIDE, "width": SIDE}} | keys


def encoder_files(kind):
    """All three variants of a tiny `clip`, `siglip` or `siglip2`."""
    backend, settings, ids, size, *pieces = {"clip": clip_tokenizer, "siglip2": gemma_tokenizer, "siglip": siglip_tokenizer}[kind]()
    clip = kind == "clip"
    image, text = ("image_embeds", "text_embeds") if clip else ("pooler_output", "pooler_output")
    if kind == "siglip":
        rows = np.random.default_rng(3).normal(size=(size, WIDTH))
    else:
        rows = table(ids, size)
    words = text_tower(rows, text, mask=clip)
    half, half_weights = with_weights_beside(words, "text_model_fp16.onnx_data")
    config = {"model_type": "clip" if clip else "siglip", "text_config": {"max_position_embeddings": CONTEXT}, "vision_config": {}}
    files = {
        "config.json": json.dumps(config), "tokenizer.json": json.dumps(backend), "tokenizer_config.json": json.dumps(settings),
        "preprocessor_config.json": json.dumps(processor()), "README.md": "# a card\n", "LICENSE": "do as you like\n",
        "onnx/model.onnx": b"not wanted", "onnx/vision_model.onnx": image_tower(image), "onnx/text_model.onnx": words,
        "onnx/vision_model_fp16.onnx": image_tower(image, half_inside=True),
        "onnx/text_model_fp16.onnx": half, "onnx/text_model_fp16.onnx_data": half_weights,
        "onnx/vision_model_quantized.onnx": image_tower(image, batch_mixes=True), "onnx/text_model_quantized.onnx": words,
    }
    if pieces:
        files["spiece.model"] = pieces[0]
    return {path: content.encode() if isinstance(content, str) else content for path, content in files.items()}


def sam_files(boxes):
    encoder, decoder = mask_networks(boxes)
    size = {"height": 64, "width": 64} if boxes else {"longest_edge": 64}
    files = {
        "config.json": json.dumps({"model_type": "sam2" if boxes else "sam"}).encode(),
        "preprocessor_config.json": json.dumps(processor(size=size)).encode(),
        "onnx/vision_encoder.onnx": encoder, "onnx/prompt_encoder_mask_decoder.onnx": decoder,
    }
    return files


def catalogue_entry(name, kind, repository, preference=0):
    files = "{encoder: onnx/vision_encoder, decoder: onnx/prompt_encoder_mask_decoder}" if kind == "sam" else \
        "{image: onnx/vision_model, text: onnx/text_model}"
    return f"""  - name: {name}
    kind: {kind}
    repository: {repository}
    revision: main
    files: {files}
    size_mb: {{full: 1, fp16: 1, quantized: 1}}
    license: MIT
    preference: {preference}
    good_for: tests
    documentation: https://example.org/{name}
    tried: true
"""
