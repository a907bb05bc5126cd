// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/git_blob.h"

#include <gtest/gtest.h>

#include "ovimap/base/temporary_folder_fixture.h"

namespace ovimap {
namespace {

// What `git hash-object` prints.
TEST(GitBlob, IsThatOfGit) {
  const fixture::TemporaryFolder scratch;
  scratch.write("empty", "");
  scratch.write("hello", "hello\n");
  EXPECT_EQ(git_blob_of_file(scratch.path() / "empty"), "e69de29bb2d1d6434b8b29ae775ad8c2e48c5391");
  EXPECT_EQ(git_blob_of_file(scratch.path() / "hello"), "ce013625030ba8dba906f756967f9e9ca394464a");
}

}  // namespace
}  // namespace ovimap
