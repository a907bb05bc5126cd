// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/base/bounded_text.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <system_error>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;  // bytes read at once

[[noreturn]] void refuse_large(const std::string& name, std::size_t most_bytes) {
  throw Error(concat(name, " is larger than ", most_bytes, " bytes, the most that is accepted"));
}

}  // namespace

std::string read_bounded_text(const std::filesystem::path& file, std::size_t most_bytes) {
  if (std::filesystem::is_directory(file))
    throw Error(concat(file.string(), " is a folder, expected a file"));
  if (std::filesystem::is_fifo(file))  // would hold us up
    throw Error(concat(file.string(), " is a pipe, expected a file"));
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw Error(
        concat("cannot open ", file.string(), ": ", std::generic_category().message(errno)));
  std::string text;  // grows with what is there: devices do not tell their size
  std::size_t got = 0;
  do {
    const std::size_t wanted = std::min(kPiece, most_bytes + 1 - text.size());
    const std::size_t before = text.size();
    text.resize(before + wanted);
    in.read(text.data() + before, static_cast<std::streamsize>(wanted));
    got = static_cast<std::size_t>(in.gcount());
    text.resize(before + got);
  } while (in && text.size() <= most_bytes);
  if (in.bad()) throw Error(concat("cannot read ", file.string()));
  if (text.size() > most_bytes) refuse_large(file.string(), most_bytes);
  return text;
}

void check_bounded_text(std::string_view text, const std::string& name, std::size_t most_bytes) {
  if (text.size() > most_bytes) refuse_large(name, most_bytes);
  if (const std::size_t at = text.find('\0'); at != std::string_view::npos)
    throw Error(concat(name, " is no text: byte ", at + 1, " is NUL"));
}

}  // namespace ovimap
