// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "wording.h"

#include <algorithm>
#include <regex>
#include <utility>

namespace ovimap::python {

namespace {

const std::pair<const char*, const char*> kArguments[] = {
    {"classes", "classes"},      {"encoder", "encoder"}, {"frames", "frames"}, {"masks", "masks"},
    {"model-dir", "model_dirs"}, {"not", "negatives"},   {"preset", "preset"},
};

/// --set a.b=true: settings={'a.b': True}
std::string with_settings(const std::string& text) {
  std::string said = std::regex_replace(text, std::regex(R"(--set ([\w.]+)=(true|false)\b)"),
                                        "settings={'$1': $2}");
  said = std::regex_replace(said, std::regex(R"(: true\})"), ": True}");
  said = std::regex_replace(said, std::regex(R"(: false\})"), ": False}");
  said =
      std::regex_replace(said, std::regex(R"(--set ([\w.]+)=([-\d.]*\d))"), "settings={'$1': $2}");
  return std::regex_replace(said, std::regex(R"(--set ([\w.]+)=([^\s;,)]+))"),
                            "settings={'$1': '$2'}");
}

std::string with_arguments(std::string text) {
  text = with_settings(text);
  for (const auto& [option, argument] : kArguments)
    text =
        std::regex_replace(text, std::regex(std::string("--") + option + R"((?![\w-]))"), argument);
  return text;
}

}  // namespace

std::string in_python_words(const std::string& line) {
  std::string said;
  bool shell = false;
  for (std::size_t begin = 0; begin <= line.size(); shell = !shell) {
    const std::size_t end = std::min(line.find('`', begin), line.size());
    const std::string part = line.substr(begin, end - begin);
    said += shell ? part : with_arguments(part);
    if (end < line.size()) said += '`';
    begin = end + 1;
  }
  return said;
}

}  // namespace ovimap::python
