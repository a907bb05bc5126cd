// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace ovimap {

/// One line of a text file that is neither empty nor a '#' comment.
struct TextLine {
  int number = 0;  ///< from 1, as an editor shows it
  std::string text;
};
/// Throws Error when the file cannot be read.
std::vector<TextLine> read_lines(const std::filesystem::path& file);

/// Numbers separated by blanks, commas or semicolons ("nan" and "inf" count); nullopt when
/// something else stands between them.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// All numbers of a file. Throws Error when it cannot be read; nullopt when it holds other text.
std::optional<std::vector<double>> read_numbers(const std::filesystem::path& file);

/// The matrix of 16 numbers row by row, or of 12 (the last row is 0 0 0 1).
Eigen::Matrix4d matrix_from_rows(const std::vector<double>& numbers);

/// The matrix of TUM's "tx ty tz qx qy qz qw"; a quaternion far from unit length gives a
/// pose_fault.
Eigen::Matrix4d matrix_from_tum(const double* seven);

}  // namespace ovimap
