# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""A Hugging Face tokenizer as the files and keys that ovimap's own tokenizers read."""

import json

import sentencepiece
from sentencepiece import sentencepiece_model_pb2 as proto

from .errors import ExportError

# Short texts on which the written files must give what the Hugging Face tokenizer gives.
PROBES = (
    "a photo of a wooden chair.",
    "Red MUG, 24 cm; ça va?",
    "  two  blanks\tand\na line ",
    "机 デスク 책상 стол",
    "🪑 ﬁne",
    "",
)
SPIECE, VOCAB, MERGES = "spiece.model", "vocab.json", "merges.txt"
Piece = proto.ModelProto.SentencePiece


def special_ids(tokenizer) -> dict:
    """bos_id and eos_id: what the tokenizer puts before and after a text of its own accord."""
    bare = tokenizer("a", add_special_tokens=False)["input_ids"]
    full = tokenizer("a")["input_ids"]
    for start in range(len(full) - len(bare) + 1):
        before, after = full[:start], full[start + len(bare) :]
        if full[start : start + len(bare)] == bare and len(before) < 2 and len(after) < 2:
            keys = {"bos_id": before, "eos_id": after}
            return {key: int(ids[0]) for key, ids in keys.items() if ids}
    raise ExportError(
        f"the tokenizer makes {full} of 'a' ({bare} bare); ovimap knows at most one id around it"
    )


def common_keys(tokenizer, context_length: int) -> dict:
    keys = {"context_length": context_length, "pad_to_context": True}
    keys["pad_id"] = int(tokenizer.pad_token_id)
    return keys | special_ids(tokenizer)


def backend_json(tokenizer) -> dict:
    return json.loads(tokenizer.backend_tokenizer.to_str())


def siglip_tokenizer(tokenizer, writer, context_length: int) -> dict:
    """SigLIP: the SentencePiece unigram model as the tokenizer uses it, that is without the blank
    that the file would put first: the tokenizer does that itself, after its canonicalisation."""
    writer.path(SPIECE).write_bytes(tokenizer.sp_model.serialized_model_proto())
    return {
        "tokenizer": "sentencepiece",
        "tokenizer_model": SPIECE,
        **common_keys(tokenizer, context_length),
        "lowercase": bool(tokenizer.do_lower_case),
        "text_rule": "siglip",
    }


def gemma_tokenizer(tokenizer, writer, context_length: int) -> dict:
    """SigLIP 2: Gemma's byte-pair encoding with byte fallback. Its checkpoints hold only
    tokenizer.json, so the SentencePiece model is put together from that. SigLIP 2 was trained on
    lower-case text whatever the tokenizer's own settings are."""
    data = spiece_of(backend_json(tokenizer), tokenizer)
    writer.path(SPIECE).write_bytes(data)
    keys = common_keys(tokenizer, context_length)
    check_pieces(data, tokenizer, keys)
    return {
        "tokenizer": "sentencepiece",
        "tokenizer_model": SPIECE,
        **keys,
        "lowercase": True,
        "text_rule": "none",
    }


def clip_tokenizer(tokenizer, writer, context_length: int) -> dict:
    model = backend_json(tokenizer)["model"]
    if model["type"] != "BPE" or model.get("end_of_word_suffix") != "</w>":
        raise ExportError("the tokenizer is not CLIP's byte-pair encoding")
    pairs = [pair if isinstance(pair, str) else " ".join(pair) for pair in model["merges"]]
    vocab = json.dumps(model["vocab"], ensure_ascii=False, separators=(",", ":"))
    writer.path(VOCAB).write_text(vocab, encoding="utf-8")
    writer.path(MERGES).write_text("#version: 0.2\n" + "\n".join(pairs) + "\n", encoding="utf-8")
    return {
        "tokenizer": "clip_bpe",
        "tokenizer_vocab": VOCAB,
        "tokenizer_merges": MERGES,
        **common_keys(tokenizer, context_length),
        "lowercase": True,
        "text_rule": "clip",
    }


def spiece_of(backend: dict, tokenizer) -> bytes:
    """tokenizer.json of a byte-pair encoding as a SentencePiece model: a piece's score is the rank
    of the first merge that makes it, so that the best-scored pair is the next merge in the list."""
    bpe = backend["model"]
    if bpe["type"] != "BPE" or not bpe.get("byte_fallback"):
        raise ExportError("the tokenizer is not Gemma's byte-pair encoding with byte fallback")
    ranks = {}
    for rank, pair in enumerate(bpe["merges"]):
        ranks.setdefault("".join(pair.split(" ") if isinstance(pair, str) else pair), rank)
    added = {token["id"]: token for token in backend["added_tokens"]}
    by_id = {index: piece for piece, index in bpe["vocab"].items()}
    by_id.update({index: token["content"] for index, token in added.items()})
    if sorted(by_id) != list(range(len(by_id))):
        raise ExportError("the tokenizer's ids are not 0, 1, 2, ... without a gap")
    model = proto.ModelProto()
    for index in range(len(by_id)):
        piece = by_id[index]
        if piece == "\t" and "<0x09>" not in bpe["vocab"]:
            piece = "<0x09>"  # Gemma's conversion writes the byte as the character
        kind = piece_type(piece, added.get(index), bpe["unk_token"])
        score = 0.0 if kind == Piece.USER_DEFINED else -float(ranks.get(piece, len(ranks)))
        model.pieces.add(piece=piece, score=score, type=kind)
    trainer = model.trainer_spec
    trainer.model_type = proto.TrainerSpec.BPE
    trainer.vocab_size, trainer.byte_fallback = len(by_id), True
    trainer.unk_id, trainer.pad_id = tokenizer.unk_token_id, tokenizer.pad_token_id
    trainer.bos_id, trainer.eos_id = tokenizer.bos_token_id, tokenizer.eos_token_id
    rule = model.normalizer_spec
    rule.name = "identity"
    rule.add_dummy_prefix = rule.remove_extra_whitespaces = False
    rule.escape_whitespaces = True
    return model.SerializeToString(deterministic=True)


def piece_type(piece: str, added, unknown: str) -> int:
    if piece == unknown:
        return Piece.UNKNOWN
    if len(piece) == 6 and piece.startswith("<0x") and piece.endswith(">"):
        return Piece.BYTE
    if added:
        return Piece.CONTROL if added["special"] else Piece.USER_DEFINED
    return Piece.NORMAL


def check_pieces(data: bytes, tokenizer, keys: dict) -> None:
    processor = sentencepiece.SentencePieceProcessor(model_proto=data)
    for text in PROBES:
        lower = text.lower()
        expected = tokenizer(lower)["input_ids"]
        found = [keys[k] for k in ("bos_id",) if k in keys]
        found += processor.encode(lower) + [keys[k] for k in ("eos_id",) if k in keys]
        if found != expected:
            raise ExportError(
                f"the SentencePiece model makes {found} of {lower!r}, the tokenizer {expected}; "
                "its tokenizer.json is not one that ovimap can read"
            )
