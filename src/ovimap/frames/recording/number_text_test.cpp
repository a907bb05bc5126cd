// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/number_text.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ovimap/frames/recording/sequence_fixture.h"
#include "ovimap/geometry/pose.h"

namespace ovimap {
namespace {

TEST(NumberText, ReadsNumbersHoweverSeparated) {
  const auto numbers = parse_numbers("1 -2.5e-3,\t+3;nan\r\n inf ");
  ASSERT_TRUE(numbers);
  ASSERT_EQ(numbers->size(), 5u);
  EXPECT_EQ((*numbers)[1], -2.5e-3);
  EXPECT_EQ((*numbers)[2], 3);
  EXPECT_TRUE(std::isnan((*numbers)[3]));
  EXPECT_TRUE(std::isinf((*numbers)[4]));
  EXPECT_TRUE(parse_numbers("  ")->empty());
  EXPECT_FALSE(parse_numbers("1 2 three"));
  EXPECT_FALSE(parse_numbers("1.2.3"));
  EXPECT_FALSE(parse_numbers("+"));
}

TEST(NumberText, LinesKeepTheirNumberInTheFile) {
  const fixture::TemporaryFolder folder;
  write_text(folder.path() / "a.txt", "# head\n\n 1 2 \r\n#x\n3");
  const auto lines = read_lines(folder.path() / "a.txt");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[0].text, "1 2");
  EXPECT_EQ(lines[1].number, 5);
  EXPECT_EQ(lines[1].text, "3");
  EXPECT_THROW(read_lines(folder.path() / "none.txt"), Error);
}

TEST(NumberText, TumQuaternionIsXyzw) {
  // A quarter turn about z takes x to y.
  const double half = std::sqrt(0.5);
  const double line[] = {1, 2, 3, 0, 0, half, half};
  const Eigen::Matrix4d matrix = matrix_from_tum(line);
  EXPECT_TRUE((matrix * Eigen::Vector4d(1, 0, 0, 1)).isApprox(Eigen::Vector4d(1, 3, 3, 1)));
  EXPECT_EQ(pose_fault(matrix), "");
}

TEST(NumberText, QuaternionThatIsNoRotationStaysAFault) {
  const double rounded[] = {0, 0, 0, 0, 0, 0.7072, 0.7072};
  EXPECT_EQ(pose_fault(matrix_from_tum(rounded)), "");
  const double zero[] = {0, 0, 0, 0, 0, 0, 0};
  EXPECT_NE(pose_fault(matrix_from_tum(zero)), "");
  const double twice[] = {0, 0, 0, 0, 0, 0, 2};
  EXPECT_NE(pose_fault(matrix_from_tum(twice)), "");
  const double broken[] = {0, 0, 0, 0, std::nan(""), 0, 1};
  EXPECT_EQ(pose_fault(matrix_from_tum(broken)), "not finite");
}

TEST(NumberText, TwelveNumbersAreTheUpperRows) {
  std::vector<double> numbers = {1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9};
  const Eigen::Matrix4d matrix = matrix_from_rows(numbers);
  EXPECT_EQ(matrix(2, 3), 9);
  EXPECT_EQ(matrix.row(3), Eigen::RowVector4d(0, 0, 0, 1));
}

}  // namespace
}  // namespace ovimap
