# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""BERT's tokenizer (uncased) for the plain names that the model tools embed."""

import pathlib
import unicodedata

import numpy as np

LONGEST_WORD = 100  # characters; longer ones are unknown, as in BERT


def split_words(text: str) -> list:
    """Lower-case words and single punctuation marks, without accents."""
    plain = "".join(
        c for c in unicodedata.normalize("NFD", text.lower()) if unicodedata.category(c) != "Mn"
    )
    spaced = "".join(
        c if c.isalnum() or c.isspace() else f" {c} " for c in plain
    )
    return spaced.split()


class WordPiece:
    def __init__(self, vocabulary: pathlib.Path):
        lines = pathlib.Path(vocabulary).read_text(encoding="utf-8").splitlines()
        self.ids = {piece: i for i, piece in enumerate(lines)}

    def pieces(self, word: str) -> list:
        """The ids of the longest pieces from the left, or [UNK] for the whole word."""
        found, begin = [], 0
        while begin < len(word):
            for end in range(len(word), begin, -1):
                piece = ("##" if begin else "") + word[begin:end]
                if piece in self.ids:
                    break
            else:
                return [self.ids["[UNK]"]]
            found.append(self.ids[piece])
            begin = end
        return found if len(word) <= LONGEST_WORD else [self.ids["[UNK]"]]

    def encode(self, text: str) -> list:
        inner = [i for word in split_words(text) for i in self.pieces(word)]
        return [self.ids["[CLS]"], *inner, self.ids["[SEP]"]]

    def batch(self, texts: list):
        """Ids and mask, int64 [texts, longest]."""
        rows = [self.encode(text) for text in texts]
        ids = np.full((len(rows), max(map(len, rows))), self.ids["[PAD]"], np.int64)
        mask = np.zeros_like(ids)
        for i, row in enumerate(rows):
            ids[i, : len(row)] = row
            mask[i, : len(row)] = 1
        return ids, mask
