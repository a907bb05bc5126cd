// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <iterator>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "ovimap/base/error_fixture.h"
#include "ovimap/base/temporary_folder_fixture.h"
#include "ovimap/image/codec.h"
#include "ovimap/image/scratch_file.h"

namespace ovimap {
namespace {

class FileBytes : public testing::Test {
 protected:
  std::ptrdiff_t files() const {
    return std::distance(std::filesystem::directory_iterator(folder_),
                         std::filesystem::directory_iterator());
  }

  const fixture::TemporaryFolder scratch_;
  const std::filesystem::path folder_ = scratch_.path();
};

TEST_F(FileBytes, WholeFileComesBack) {
  Bytes bytes(100003);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 31);
  write_file(folder_ / "a", bytes);
  EXPECT_EQ(read_file(folder_ / "a"), bytes);
  write_file(folder_ / "a", {});
  EXPECT_TRUE(read_file(folder_ / "a").empty());
  EXPECT_EQ(files(), 1);
}

TEST_F(FileBytes, MissingFileAndFolderAreNamed) {
  EXPECT_NE(error_of([&] { read_file(folder_ / "none"); }).find((folder_ / "none").string()),
            std::string::npos);
  EXPECT_NE(error_of([&] { read_file(folder_); }).find("is a folder"), std::string::npos);
  EXPECT_THROW(write_file(folder_, {}), Error);
  EXPECT_THROW(write_file(folder_ / "no-such-folder" / "a", {}), Error);
  EXPECT_EQ(files(), 0);
}

TEST_F(FileBytes, ScratchFilesBecomePartOfAFile) {
  Bytes first((1 << 20) + 7), second{1, 2, 3};
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = static_cast<std::uint8_t>(i * 31);
  ScratchFile a(folder_ / "out"), b(folder_ / "out");
  EXPECT_EQ(files(), 0) << "it has no name";
  a.append(first);
  a.append(second);
  b.append(second);
  EXPECT_EQ(a.size(), first.size() + 3);
  Bytes back(5);
  a.read(first.size() - 2, back);
  EXPECT_EQ(back, (Bytes{first[first.size() - 2], first.back(), 1, 2, 3}));
  write_file(folder_ / "out", Bytes{9}, {&b, &a});
  const Bytes whole = read_file(folder_ / "out");
  ASSERT_EQ(whole.size(), first.size() + 7);
  EXPECT_EQ(Bytes(whole.begin(), whole.begin() + 5), (Bytes{9, 1, 2, 3, first[0]}));
  EXPECT_EQ(whole.back(), 3);
  EXPECT_EQ(files(), 1);
}

TEST_F(FileBytes, ScratchFilesNeedAFolder) {
  EXPECT_THROW(ScratchFile(folder_ / "none" / "out"), Error);
  EXPECT_THROW(ScratchFile scratch(folder_), Error);
}

TEST_F(FileBytes, FailedWriteLeavesTheOldFile) {
  const Bytes old = {1, 2, 3};
  write_file(folder_ / "a", old);
  // A limit on the size of files stands in for a full disk: the write stops half-way.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_file(folder_ / "a", Bytes(5000, 9)), Error);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(read_file(folder_ / "a"), old);
  EXPECT_EQ(files(), 1);
}

}  // namespace
}  // namespace ovimap
