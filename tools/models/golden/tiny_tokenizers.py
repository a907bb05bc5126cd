# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Tokenizers of the checkpoints' formats with vocabularies of a few hundred entries."""

import collections
import io
import itertools
import pathlib
import unicodedata

import sentencepiece
from sentencepiece import sentencepiece_model_pb2 as model_proto
from tokenizers import AddedToken, Tokenizer, models, normalizers, pre_tokenizers, processors
from transformers import BertTokenizer, CLIPTokenizer, Siglip2Tokenizer, SiglipTokenizer

from .corpus import training_sentences

UNIGRAM_PIECES, GEMMA_PIECES, CLIP_MERGES, WORD_PARTS = 320, 640, 300, 220
WHOLE_WORD_WEIGHT = 4  # against a part of a word
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
    trained = model_proto.ModelProto.FromString(data.getvalue())
    trained.normalizer_spec.normalization_rule_tsv = ""  # a path of this run
    trained.trainer_spec.ClearField("input")
    path = folder / "spiece.model"
    path.write_bytes(trained.SerializeToString(deterministic=True))
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
    tokenizer.post_processor = processors.TemplateProcessing(
        "$A <eos>", special_tokens=[("<eos>", vocab["<eos>"])]
    )
    return tokenizer


def words_of(normalizer, pre_tokenizer) -> collections.Counter:
    return collections.Counter(
        word
        for sentence in training_sentences()
        for word, _ in pre_tokenizer.pre_tokenize_str(normalizer.normalize_str(sentence))
    )


def learned_merges(words: dict, count: int) -> list:
    """Byte-pair encoding's training: again and again the most frequent pair of neighbours becomes
    one piece. `words`: tuple of pieces -> how often. (The tokenizers library's own trainer breaks
    ties by chance, so its vocabularies cannot be made again.)"""
    merges = []
    while len(merges) < count:
        pairs = collections.Counter()
        for word, times in words.items():
            for pair in itertools.pairwise(word):
                pairs[pair] += times
        best = min(pairs, key=lambda pair: (-pairs[pair], pair))
        merges.append(best)
        merged = collections.Counter()
        for word, times in words.items():
            merged[merge_pair(word, best)] += times
        words = merged
    return merges


def merge_pair(word: tuple, pair: tuple) -> tuple:
    pieces, at = [], 0
    while at < len(word):
        both = word[at : at + 2] == pair
        pieces.append("".join(pair) if both else word[at])
        at += 2 if both else 1
    return tuple(pieces)


def clip(_folder: pathlib.Path) -> CLIPTokenizer:
    """CLIP's order of pieces: the bytes, the bytes at the end of a word, the merges, two marks."""
    empty = CLIPTokenizer().backend_tokenizer
    words = words_of(empty.normalizer, empty.pre_tokenizer)
    split = {(*word[:-1], word[-1] + "</w>"): times for word, times in words.items()}
    merges = learned_merges(split, CLIP_MERGES)
    alphabet = sorted(pre_tokenizers.ByteLevel.alphabet())
    pieces = alphabet + [b + "</w>" for b in alphabet] + ["".join(m) for m in merges]
    pieces += ["<|startoftext|>", "<|endoftext|>"]
    vocab = {piece: index for index, piece in enumerate(pieces)}
    return CLIPTokenizer(vocab=vocab, merges=merges, model_max_length=77)


def minilm(folder: pathlib.Path) -> BertTokenizer:
    """The letters, alone and inside a word, and the most frequent words, their heads and tails."""
    words = words_of(normalizers.BertNormalizer(), pre_tokenizers.BertPreTokenizer())
    letters, parts = set(), collections.Counter()
    for word, times in words.items():
        letters |= {word[0], *word[1:]} | {"##" + letter for letter in word[1:]}
        for cut in range(2, len(word)):
            parts[word[:cut]] += times
            parts["##" + word[-cut:]] += times
        parts[word] += times * WHOLE_WORD_WEIGHT
    frequent = sorted(parts, key=lambda part: (-parts[part], part))[:WORD_PARTS]
    pieces = ["[PAD]", "[UNK]", "[CLS]", "[SEP]", "[MASK]", *sorted(letters)]
    pieces += [part for part in frequent if part not in letters]
    text = "".join(piece + "\n" for piece in pieces)
    (folder / "vocab.txt").write_text(text, encoding="utf-8")
    return BertTokenizer(vocab={piece: index for index, piece in enumerate(pieces)})
