# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""examples/evening_and_morning.py in a small room: it maps both visits, answers what moved, and draws them. Usage: overnight_test.py PROGRAM"""
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).parent.parent / "examples/evening_and_morning.py"
NOT_AVAILABLE = 77


def main(program):
    try:
        from PIL import Image
    except ImportError:
        print("Pillow is not installed; run tools/setup.sh --tests")
        return NOT_AVAILABLE
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        ended = subprocess.run([sys.executable, str(SCRIPT), scratch, "--room", "tiny", "--seed", "2", "--size", "320x240", "--program", program],
                               capture_output=True, text=True)  # fmt: skip
        assert ended.returncode == 0, ended.stderr
        history, *answers = ended.stdout.split("\n> ")
        assert "visit 2" in history and "moved" in history, history
        assert len(answers) == 3 and "moved" in answers[0], ended.stdout
        lamp = subprocess.run([program, "query", str(folder / "morning.ovimap"), "table lamp"], capture_output=True, text=True)
        assert lamp.returncode == 1, f"it was carried off: {lamp.stdout}"
        earlier = [program, "run", str(folder / "room/visit2"), "--recorded", "2026-03-01", "--continue", str(folder / "morning.ovimap")]
        refused = subprocess.run(earlier, capture_output=True, text=True)
        assert refused.returncode == 2 and "before the map's last visit" in refused.stderr, refused.stderr
        picture = Image.open(folder / "overnight.jpg")
        parts = [picture.crop((left, 0, left + picture.width // 3, picture.height)) for left in range(0, picture.width - 2, picture.width // 3)]
        assert len({part.tobytes() for part in parts}) == 3, "evening, morning and changes look the same"
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
