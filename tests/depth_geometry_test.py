# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""What the finder is trained to see of depth is what the program was tested to show it (depth_view_test.cpp has the other half)."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tools" / "models"))
try:
    import make_golden_depth_view as golden
    import numpy as np
except ImportError as missing:  # the tools' packages are set up by tools/setup.sh
    print(f"skipped: {missing}; tools/setup.sh installs what the model tools need")
    sys.exit(77)


class DepthGeometryTest(unittest.TestCase):
    def test_it_says_what_the_committed_file_says(self):
        def numbers(text):
            return np.array(text.split(), float)

        kept, made = numbers(golden.FILE.read_text()), numbers(golden.text())
        self.assertEqual(kept.shape, made.shape)
        np.testing.assert_allclose(kept, made, atol=1e-4)


if __name__ == "__main__":
    unittest.main()
