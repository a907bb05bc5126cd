// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/corrections.h"

#include <algorithm>
#include <array>

#include "ovimap/base/error.h"
#include "ovimap/io/map_file.h"

namespace ovimap {

namespace {

constexpr std::ptrdiff_t kLongestName = 200;  // letters
constexpr std::array<const char*, 5> kNames = {"rename", "merge", "hide", "lock", "delete"};

class MapFileNames : public CorrectionStore {
 public:
  explicit MapFileNames(std::filesystem::path map) : map_(std::move(map)) {}

  std::vector<CorrectionKind> kinds() const override { return {CorrectionKind::kRename}; }

  /// The file is read anew, so that what another program changed in it stays.
  void append(const Correction& correction) override {
    MapDocument document = load_map(map_);
    if (correction.name.empty())
      document.names.erase(correction.instance);
    else
      document.names[correction.instance] = correction.name;
    save_map(map_, document);
  }

 private:
  std::filesystem::path map_;
};

}  // namespace

void check_name(const std::string& name) {
  const auto begins_letter = [](char byte) { return (byte & 0xc0) != 0x80; };  // of UTF-8
  const std::ptrdiff_t letters = std::count_if(name.begin(), name.end(), begins_letter);
  if (letters > kLongestName)
    throw Error(
        concat("a name of ", letters, " letters is too long; ", kLongestName, " are allowed"));
  if (std::any_of(name.begin(), name.end(),
                  [](unsigned char letter) { return letter < 0x20 || letter == 0x7f; }))
    throw Error("a name must not hold control characters such as line breaks; leave them out");
}

const char* correction_name(CorrectionKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

std::optional<CorrectionKind> correction_kind(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i]) return static_cast<CorrectionKind>(i);
  return std::nullopt;
}

std::unique_ptr<CorrectionStore> corrections_in_map_file(const std::filesystem::path& map) {
  return std::make_unique<MapFileNames>(map);
}

}  // namespace ovimap
