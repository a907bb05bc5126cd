# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences to train the tiny tokenizers on, and texts that are hard to tokenise."""

import itertools
import random

COLOURS = "red blue green white black brown grey yellow".split()
THINGS = (
    "chair table mug bottle book lamp shelf cabinet monitor keyboard window door plant cushion "
    "sofa kettle sink fridge toaster bin box bag clock picture mirror towel rug curtain"
).split()
PLACES = "on the table|near the window|under the desk|in the kitchen|next to the door".split("|")
OTHER_TONGUES = (
    "ein roter Stuhl neben dem Fenster",
    "une chaise en bois près de la fenêtre",
    "el café está en la mesa pequeña",
    "красный стул у окна",
    "μία ξύλινη καρέκλα δίπλα στο παράθυρο",
    "窓のそばの赤い椅子",
    "窗边的红色椅子",
    "창가에 있는 빨간 의자",
    "كرسي أحمر بجانب النافذة",
)


def training_sentences() -> list:
    rng = random.Random(7)
    sentences = []
    for colour, thing in itertools.product(COLOURS, THINGS):
        sentences.append(f"a photo of a {colour} {thing} {rng.choice(PLACES)}.")
        sentences.append(f"This is a {thing}, {rng.randint(2, 2000)} cm from the {colour} wall!")
    return sentences + [s for s in OTHER_TONGUES for _ in range(4)]


PLAIN = (
    "a photo of a red chair.",
    "the mug on the table",
    "something to sit on",
    "This is a photo of a cushion.",
    "a picture next to the door",
    "where can I wash my hands?",
    "green plant near the window",
    "keyboard",
)

HARD = (
    "",
    " ",
    "     ",
    "\t",
    "\n",
    "\n\n",
    "\r\n",
    " leading blank",
    "trailing blank ",
    "  both  sides  ",
    "tabs\tbetween\twords",
    "lines\nbetween\nwords",
    "two\n\nlines",
    "three   blanks",
    "many          blanks",
    "UPPER CASE",
    "MiXeD cAsE",
    "ÄÖÜ ß ẞ",
    "İstanbul ISPARTA ıi",
    "ΟΔΥΣΣΕΥΣ ΣΑΣ",
    "Σ",
    "ÅNGSTRÖM Ångström",
    "naïve café déjà vu",
    "cafe\u0301 nai\u0308ve",
    "e\u0301\u0302\u0303 stacked marks",
    "\u0301starts with a mark",
    "Ǆ ǅ ǆ Ĳ",
    "ﬁne oﬃce ﬂat",
    "½ ² ³ ⅷ ①",
    "ｆｕｌｌ ｗｉｄｔｈ ＡＢＣ １２３",
    "ﾊﾝｶｸ ｶﾞ",
    "ガ ガ",
    "한글 각",
    "K Å Ω",
    "窓のそばの赤い椅子",
    "窗边的红色椅子",
    "창가에 있는 빨간 의자",
    "Tokyo東京tower",
    "𠀀𠀁 rare",
    "كرسي أحمر بجانب النافذة",
    "كُرْسِيّ",
    "שלום עולם",
    "नमस्ते दुनिया",
    "ภาษาไทยไม่มีช่องว่าง",
    "красный стул у окна",
    "КРАСНЫЙ СТУЛ",
    "μία ξύλινη καρέκλα",
    "🪑",
    "a 🪑 by the 🪟",
    "👩‍🍳 cook",
    "👍🏽 👨‍👩‍👧‍👦",
    "🇩🇪🇫🇷",
    "☕️ vs ☕",
    "zero\u200dwidth\u200djoiner",
    "zero\u200bwidth\u200bspace",
    "\ufeffbyte order mark",
    "soft\u00adhyphen",
    "no\u00a0break\u00a0space",
    "thin\u2009space em\u2003space ideographic\u3000space",
    "line\u2028separator paragraph\u2029separator",
    "next\u0085line",
    "vertical\x0btab form\x0cfeed",
    "bell\x07 and escape\x1b[0m",
    "unit\x1fseparator file\x1cseparator",
    "delete\x7f c1\x9f",
    "null\x00byte",
    "\x01\x02\x03",
    "left-to-right\u200emark right\u200f",
    "\u202ereversed",
    "private \ue000 use",
    "replacement \ufffd character",
    "unassigned \u0378 code point",
    "\U0010ffff last",
    "!!!",
    "...",
    "?!?!?!",
    "-----",
    "a-b_c/d\\e",
    "(round) [square] {curly} <angle>",
    "\"double\" 'single' `back`",
    "“curly” ‘quotes’ «guillemets»",
    "it's we're they'll I'd you've 'tis",
    "IT'S WE'RE",
    "it’s curly",
    "don''t 's 't",
    "e-mail@example.org",
    "www.example.org/path?query=1&b=2#top",
    "#hashtag @mention $9.99 50% a&b a*b a+b a=b a^b a|b a~b",
    "price: £5, €6, ¥7, ₹8",
    "1 22 333 4444 55555",
    "3.14159 1,000,000 1e-5",
    "24cm x 30cm",
    "v2.0-rc1",
    "٣٤٥ ४५ ๓",
    "x² + y² = z²",
    "∑ ∫ √ ≠ ≤ ∞",
    "→ ← ⇒",
    "…",
    "‐ ‑ ‒ – — ―",
    "、。「」・",
    "！？，．",
    "a",
    "A",
    "é",
    "▁",
    "▁▁▁",
    "a▁b",
    "▁ mixed ▁ marks",
    "##piece ##s",
    "</w> word</w>",
    "<0x41> byte",
    "<table><tr>",
    "<TABLE>",
    "antidisestablishmentarianism",
    "Donaudampfschifffahrtsgesellschaftskapitän",
    "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa",
    "abababababababababab",
    "hahahaha nooooooo",
    "ththththth",
    "thethethe",
    "xyzzy qwrtp",
    "hello,world",
    "hello , world",
    "end.Start",
    "a.b.c.d",
    "snake_case camelCase PascalCase kebab-case",
    "the the the the",
    "e\u0323\u0307 versus e\u0307\u0323",
    "ṩ ṩ ṩ",
    "ǰ ΐ ᾳ",
    "ŉ ẖ",
)
LENGTHS = (60, 300, 10000)


def texts() -> list:
    """200 texts; the first eight are plain."""
    rng = random.Random(11)
    words = THINGS + COLOURS + ["the", "a", "of", "at", "Café", "椅子", "стул", "12"]
    long = [" ".join(rng.choice(words) for _ in range(n))[:n] for n in LENGTHS]
    alphabet = "abeginoprstuv ABC019.,'-!?áßøΣжИ机椅ـع 🪑\u0301\u200d\t\u3000▁"
    noise = [
        "".join(rng.choice(alphabet) for _ in range(rng.randint(1, 40)))
        for _ in range(200 - len(PLAIN) - len(HARD) - len(long))
    ]
    return [*PLAIN, *HARD, *long, *noise]
