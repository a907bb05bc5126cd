// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/frames/recording/number_text.h"

#include <charconv>
#include <cmath>

#include <Eigen/Geometry>

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace {
constexpr std::string_view kBlanks = " \t\r\n,;";
constexpr double kQuaternionTolerance = 0.01;  // text files carry few digits

std::string read_text(const std::filesystem::path& file) {
  const Bytes bytes = read_file(file);
  return std::string(bytes.begin(), bytes.end());
}
}  // namespace

std::vector<TextLine> read_lines(const std::filesystem::path& file) {
  const std::string text = read_text(file);
  std::vector<TextLine> lines;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == std::string_view::npos || line[first] == '#') continue;
    line = line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
    lines.push_back({number, std::string(line)});
  }
  return lines;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return numbers;
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    const std::string_view digits = word.substr(word.front() == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
    numbers.push_back(value);
  }
}

std::optional<std::vector<double>> read_numbers(const std::filesystem::path& file) {
  return parse_numbers(read_text(file));
}

Eigen::Matrix4d matrix_from_rows(const std::vector<double>& numbers) {
  OVIMAP_ASSERT(numbers.size() == 16 || numbers.size() == 12);
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  for (std::size_t i = 0; i < numbers.size(); ++i)
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) = numbers[i];
  return matrix;
}

Eigen::Matrix4d matrix_from_tum(const double* seven) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  const Eigen::Quaterniond rotation(seven[6], seven[3], seven[4], seven[5]);
  // Few digits are mended; what is no rotation keeps its scale, so that pose_fault sees it.
  const double norm = rotation.norm();
  const double scale = std::abs(norm - 1) <= kQuaternionTolerance ? 1 : norm;
  const Eigen::Quaterniond unit = norm > 0 ? rotation.normalized() : Eigen::Quaterniond::Identity();
  matrix.topLeftCorner<3, 3>() = scale * unit.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = Eigen::Vector3d(seven[0], seven[1], seven[2]);
  return matrix;
}

}  // namespace ovimap
