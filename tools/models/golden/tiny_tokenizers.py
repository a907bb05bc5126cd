# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tokenizers of the checkpoints' formats with vocabularies of a few hundred entries."""

import io
import json
import pathlib
import unicodedata

import sentencepiece
from sentencepiece import sentencepiece_model_pb2 as model_proto
from tokenizers import AddedToken, Tokenizer, models, normalizers, pre_tokenizers, processors
from tokenizers import trainers
from transformers import BertTokenizer, CLIPTokenizer, Siglip2Tokenizer, SiglipTokenizer

from .corpus import training_sentences

UNIGRAM_PIECES, GEMMA_PIECES, CLIP_PIECES, WORD_PIECES = 320, 640, 660, 360
# Pieces that Gemma's vocabulary lists as they are: runs of blanks and line ends, some tags.
GEMMA_SYMBOLS = ["<mask>", "\n", "\n\n", "▁▁", "▁▁▁", "▁▁▁▁", "<table>", "<tr>"]


def normalisation_rules() -> str:
    """NFKC of some blocks, control characters to nothing or a blank: as nmt_nfkc does for all of
    Unicode, whose table would be larger than the rest of the test data."""
    rules = {}
    blocks = [(0xA0, 0x180), (0x1C4, 0x1F1), (0x2000, 0x2070), (0x2070, 0x20A0), (0x2150, 0x2190)]
    blocks += [(0x2460, 0x2474), (0x3000, 0x3001), (0xFB00, 0xFB07), (0xFF01, 0xFFA0)]
    for first, last in blocks:
        for code in range(first, last):
            folded = unicodedata.normalize("NFKC", chr(code))
            if folded != chr(code):
                rules[chr(code)] = folded
    for base in "aeiounAEIOUNсгカ":
        for mark in "\u0300\u0301\u0303\u0308\u3099":
            composed = unicodedata.normalize("NFKC", base + mark)
            if len(composed) == 1:
                rules[base + mark] = composed
    for code in [*range(1, 9), 0xB, *range(0xE, 0x20), 0x7F, 0x8F, 0x9F, 0x200B]:
        rules[chr(code)] = ""
    for blank in "\t\n\x0c\r\x85\u1680\u2028\u2029\u200e\u200f\ufeff":
        rules[blank] = " "
    line = "{}\t{}\n".format
    return "".join(
        line(" ".join(f"{ord(c):X}" for c in a), " ".join(f"{ord(c):X}" for c in b))
        for a, b in sorted(rules.items())
    )


def train_sentencepiece(folder: pathlib.Path, **options) -> pathlib.Path:
    data = io.BytesIO()
    sentencepiece.SentencePieceTrainer.train(
        sentence_iterator=iter(training_sentences()),
        model_writer=data,
        num_threads=1,
        minloglevel=2,
        **options,
    )
    path = folder / "spiece.model"
    path.write_bytes(data.getvalue())
    return path


def siglip(folder: pathlib.Path) -> SiglipTokenizer:
    rules = folder / "rules.tsv"
    rules.write_text(normalisation_rules(), encoding="utf-8")
    model = train_sentencepiece(
        folder,
        model_type="unigram",
        hard_vocab_limit=False,
        vocab_size=UNIGRAM_PIECES,
        pad_id=0,
        eos_id=1,
        unk_id=2,
        bos_id=-1,
        normalization_rule_tsv=str(rules),
    )
    rules.unlink()
    return SiglipTokenizer(str(model), model_input_names=["input_ids"])


def siglip2(folder: pathlib.Path) -> Siglip2Tokenizer:
    """Trained as Gemma's; then converted as Gemma's checkpoints were, to a tokenizer.json."""
    model = train_sentencepiece(
        folder,
        model_type="bpe",
        vocab_size=GEMMA_PIECES,
        pad_id=0,
        eos_id=1,
        bos_id=2,
        unk_id=3,
        eos_piece="<eos>",
        bos_piece="<bos>",
        byte_fallback=True,
        split_digits=True,
        allow_whitespace_only_pieces=True,
        normalization_rule_name="identity",
        add_dummy_prefix=False,
        remove_extra_whitespaces=False,
        user_defined_symbols=GEMMA_SYMBOLS,
    )
    converted = gemma_backend(model)
    model.unlink()
    return Siglip2Tokenizer(
        tokenizer_object=converted,
        padding_side="right",
        add_bos_token=False,
        add_eos_token=True,
        model_input_names=["input_ids"],
    )


def all_merges(scores: dict) -> list:
    """Every way to put a piece together of two others, best-scored piece first."""
    merges = []
    for piece, score in scores.items():
        for cut in range(1, len(piece)):
            left, right = piece[:cut], piece[cut:]
            if left in scores and right in scores:
                merges.append((score, len(left), len(right), left, right))
    merges.sort(key=lambda m: m[:3], reverse=True)
    return [(left, right) for *_, left, right in merges]


def gemma_backend(path: pathlib.Path) -> Tokenizer:
    """A SentencePiece model in the form of Gemma's tokenizer.json files."""
    trained = model_proto.ModelProto.FromString(path.read_bytes())
    special = {p.piece for p in trained.pieces if p.type in (p.CONTROL, p.UNKNOWN)}
    listed = [p.piece for p in trained.pieces if p.type == p.USER_DEFINED]
    scores = {"\t" if p.piece == "<0x09>" else p.piece: p.score for p in trained.pieces}
    vocab = {piece: index for index, piece in enumerate(scores)}
    tokenizer = Tokenizer(
        models.BPE(vocab, all_merges(scores), unk_token="<unk>", fuse_unk=True, byte_fallback=True)
    )
    tokenizer.normalizer = normalizers.Replace(" ", "▁")
    tokenizer.pre_tokenizer = pre_tokenizers.Split(" ", "merged_with_previous")
    tokenizer.add_special_tokens([AddedToken(p, normalized=False) for p in sorted(special)])
    tokenizer.add_tokens([AddedToken(p, normalized=False) for p in listed])
    tokenizer.post_processor = processors.TemplateProcessing("$A <eos>", special_tokens=[("<eos>", 1)])
    return tokenizer


def byte_pairs(end_of_word: str) -> dict:
    """Vocabulary and merges of a byte-level encoding in CLIP's order: the bytes, the bytes at the
    end of a word, the merged pieces."""
    tokenizer = Tokenizer(models.BPE(end_of_word_suffix=end_of_word))
    tokenizer.normalizer = normalizers.Sequence([normalizers.NFC(), normalizers.Lowercase()])
    tokenizer.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    alphabet = sorted(pre_tokenizers.ByteLevel.alphabet())
    trainer = trainers.BpeTrainer(
        vocab_size=CLIP_PIECES,
        initial_alphabet=alphabet,
        end_of_word_suffix=end_of_word,
        show_progress=False,
    )
    # Without the blanks between the words, which CLIP's pre-tokenizer drops.
    tokenizer.train_from_iterator((w for s in training_sentences() for w in s.split()), trainer)
    merges = []
    model = json.loads(tokenizer.to_str())["model"]
    for pair in model["merges"]:
        merges.append(tuple(pair.split(" ")) if isinstance(pair, str) else tuple(pair))
    pieces = alphabet + [b + end_of_word for b in alphabet]
    pieces += [p for p in dict.fromkeys("".join(m) for m in merges) if p not in set(pieces)]
    return {"pieces": pieces, "merges": merges}


def clip(_folder: pathlib.Path) -> CLIPTokenizer:
    trained = byte_pairs("</w>")
    pieces = [*trained["pieces"], "<|startoftext|>", "<|endoftext|>"]
    vocab = {piece: index for index, piece in enumerate(pieces)}
    return CLIPTokenizer(vocab=vocab, merges=trained["merges"], model_max_length=77)


def minilm(folder: pathlib.Path) -> BertTokenizer:
    tokenizer = Tokenizer(models.WordPiece(unk_token="[UNK]"))
    tokenizer.normalizer = normalizers.BertNormalizer()
    tokenizer.pre_tokenizer = pre_tokenizers.BertPreTokenizer()
    special = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]"]
    trainer = trainers.WordPieceTrainer(
        vocab_size=WORD_PIECES, special_tokens=special, show_progress=False
    )
    tokenizer.train_from_iterator(training_sentences(), trainer)
    vocab = tokenizer.get_vocab()
    by_id = sorted(vocab, key=vocab.get)
    path = folder / "vocab.txt"
    path.write_text("".join(piece + "\n" for piece in by_id), encoding="utf-8")
    return BertTokenizer(vocab=vocab)
