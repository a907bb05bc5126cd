# SPDX-FileCopyrightText: 2026 The ovimap authors
# SPDX-License-Identifier: Apache-2.0
"""The layer check itself: it accepts the project and catches each kind of offence."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))
import check_layers  # noqa: E402

TABLE = """
| layer | module | job | other libraries |
| --- | --- | --- | --- |
| 0 | base | basics | tbb |
| 1 | image | pictures | spng |
| 1 | geometry | shapes | Eigen |
| 9 | apps | program | CLI |

| room | what is in it |
| --- | --- |
| image/pixels | the lower room |
| image/files | the upper room |
| apps/command | the lower room |
| apps/maps | the upper room |
"""


class CheckLayersTest(unittest.TestCase):
    def offences(self, path, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "ARCHITECTURE.md").write_text(TABLE)
            (root / "apps").mkdir()
            (root / "src/ovimap").mkdir(parents=True)
            file = root / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
            return check_layers.check(root)

    def test_the_project_respects_its_layers(self):
        self.assertEqual(check_layers.check(ROOT), [])

    def test_accepts_lower_layers_own_headers_and_listed_libraries(self):
        text = '#include <vector>\n#include "ovimap/base/error.h"\n#include "ovimap/image/a.h"\n#include <spng.h>\n'
        self.assertEqual(self.offences("src/ovimap/image/a.cpp", text), [])

    def test_refuses_a_module_of_the_same_layer(self):
        found = self.offences("src/ovimap/image/a.cpp", '#include "ovimap/geometry/b.h"\n')
        self.assertIn("may not include geometry", found[0])

    def test_refuses_a_higher_layer(self):
        self.assertEqual(len(self.offences("src/ovimap/base/a.h", '#include "ovimap/image/b.h"\n')), 1)

    def test_refuses_a_library_that_is_not_listed(self):
        found = self.offences("src/ovimap/geometry/a.h", "\n#include <opencv2/core.hpp>\n")
        self.assertIn("a.h:2", found[0])

    def test_refuses_a_folder_without_a_row(self):
        self.assertEqual(len(self.offences("src/ovimap/utils/a.h", "\n")), 1)

    def test_a_room_uses_rooms_above_it_in_the_table_alone(self):
        upper, lower = '#include "ovimap/image/files/png.h"\n', '#include "ovimap/image/pixels/a.h"\n'
        self.assertEqual(self.offences("src/ovimap/image/files/b.cpp", lower), [])
        self.assertIn("listed later", self.offences("src/ovimap/image/pixels/b.cpp", upper)[0])
        self.assertIn("listed later", self.offences("src/ovimap/image/pixels/b.cpp", '#include "ovimap/image/front.h"\n')[0])
        self.assertEqual(self.offences("src/ovimap/image/front.cpp", upper + lower), [])
        self.assertEqual(self.offences("src/ovimap/image/pixels/b_test.cpp", upper), [])

    def test_the_program_has_rooms_as_well(self):
        self.assertEqual(self.offences("apps/maps/query.cpp", '#include "apps/command/command.h"\n'), [])
        self.assertIn("listed later", self.offences("apps/command/a.cpp", '#include "apps/maps/query.h"\n')[0])
        self.assertIn("may not include apps", self.offences("src/ovimap/image/a.cpp", '#include "apps/maps/query.h"\n')[0])

    def test_refuses_a_room_without_a_row_and_a_full_folder(self):
        self.assertIn("no row", self.offences("src/ovimap/image/attic/a.h", "\n")[0])
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "ARCHITECTURE.md").write_text(TABLE)
            (root / "apps").mkdir()
            (root / "src/ovimap/base").mkdir(parents=True)
            for number in range(check_layers.MOST_SOURCES + 1):
                (root / f"src/ovimap/base/s{number}.h").write_text("\n")
            self.assertIn("give them rooms", check_layers.check(root)[0])

    def test_refuses_two_types_of_one_name(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("base/a", "image/b", "image/b_fixture"):
                (root / f"src/ovimap/{name}.h").parent.mkdir(parents=True, exist_ok=True)
                (root / f"src/ovimap/{name}.h").write_text("class Other;\nstruct Reply : Base {\n  struct Inner {};\n};\n")
            self.assertEqual(check_layers.name_offences(root), ["src/ovimap/image/b.h: src/ovimap/base/a.h defines a 'Reply' as well"])

    def test_tests_may_use_googletest_and_sources_may_not(self):
        self.assertEqual(self.offences("src/ovimap/image/a_test.cpp", "#include <gtest/gtest.h>\n"), [])
        self.assertEqual(len(self.offences("src/ovimap/image/a.cpp", "#include <gtest/gtest.h>\n")), 1)


if __name__ == "__main__":
    unittest.main()
