// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// The format is that of OpenNI 2.2: a header, and records of fields and a payload, each of one node
// (Source/Drivers/OniFile of the library reads, Source/Core/OniRecorder.cpp writes it).
#include "ovimap/frames/recording/oni_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>

#include "ovimap/base/error.h"
#include "ovimap/image/size_limits.h"

namespace ovimap {

namespace {

static_assert(std::endian::native == std::endian::little, ".oni files are little-endian");

constexpr std::string_view kFileMagic = "NI10";
constexpr std::uint32_t kRecordMagic = 0x0052494E;  ///< "NIR"
constexpr std::uint32_t kMostFields = 1u << 16;     ///< bytes that are read of a record's fields
constexpr std::size_t kMostImages = std::size_t{1} << 22;
constexpr double kOniTicksPerSecond = 1e6;

enum RecordType : std::uint32_t {
  kNodeAddedOldest = 0x02,
  kIntProperty = 0x03,
  kGeneralProperty = 0x06,
  kNewData = 0x0A,
  kEnd = 0x0B,
  kNodeAddedOld = 0x0C,
  kNodeAdded = 0x0D,
};
enum NodeType : std::uint32_t { kDepthNode = 2, kColorNode = 3 };

struct Version {
  std::uint8_t major, minor;
  std::uint16_t maintenance;
  std::uint32_t build;
};

struct RecordHeader {
  std::uint32_t magic, type, node, fields_size, payload_size;
};

struct Record {
  RecordHeader header;
  std::vector<char> fields;
  std::uint64_t payload = 0;  ///< where it begins
};

/// Values one after another, of a record's fields; nothing where they end.
class Fields {
 public:
  explicit Fields(const std::vector<char>& bytes) : bytes_(bytes.data(), bytes.size()) {}

  template <class Value>
  std::optional<Value> value() {
    if (bytes_.size() < sizeof(Value)) return std::nullopt;
    Value value;
    std::memcpy(&value, bytes_.data(), sizeof(Value));
    bytes_.remove_prefix(sizeof(Value));
    return value;
  }
  /// Of a length that stands before it; what follows the first NUL is left out.
  std::optional<std::string> text() {
    const auto size = value<std::uint32_t>();
    if (!size || *size > bytes_.size()) return std::nullopt;
    const std::string_view text = bytes_.substr(0, *size);
    bytes_.remove_prefix(*size);
    return std::string(text.substr(0, text.find('\0')));
  }

 private:
  std::string_view bytes_;
};

/// Walks over the records.
class RecordReader {
 public:
  explicit RecordReader(const std::filesystem::path& path)
      : path_(path), stream_(path, std::ios::binary), size_(std::filesystem::file_size(path)) {
    std::string magic(kFileMagic.size(), '\0');
    Version version{};
    if (!read(magic.data(), magic.size()) || !read(&version, sizeof(version)) ||
        magic != kFileMagic)
      throw Error(concat(path.string(), " is no OpenNI recording"));
    if (version.major != 1 || version.minor != 0)
      throw Error(concat(path.string(), " has version ", int{version.major}, ".",
                         int{version.minor}, "; accepted are .oni files of version 1.0"));
    position_ = 24;  // a time and a count follow
    wide_ = version.maintenance > 0;
  }

  /// The next record; nothing where the file ends or is broken.
  std::optional<Record> next() {
    Record record;
    stream_.seekg(static_cast<std::streamoff>(position_));
    if (!read(&record.header, sizeof(record.header)) || record.header.magic != kRecordMagic)
      return std::nullopt;
    const std::uint64_t begin = sizeof(record.header) + (wide_ ? 8 : 4);  // where an undone one is
    if (record.header.fields_size < begin) return std::nullopt;
    record.payload = position_ + record.header.fields_size;
    if (record.payload > size_ || record.header.payload_size > size_ - record.payload)
      return std::nullopt;
    record.fields.resize(std::min<std::uint64_t>(record.header.fields_size - begin, kMostFields));
    stream_.seekg(static_cast<std::streamoff>(position_ + begin));
    if (!read(record.fields.data(), record.fields.size())) return std::nullopt;
    position_ = record.payload + record.header.payload_size;
    return record;
  }

 private:
  bool read(void* data, std::size_t bytes) {
    stream_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
    return static_cast<bool>(stream_);
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t size_ = 0, position_ = 0;
  bool wide_ = true;  ///< positions have 64 bits
};

void take_property(Fields fields, OniStream& stream) {
  const auto name = fields.text();
  const auto size = fields.value<std::uint32_t>();
  if (!name || !size) return;
  if (*name == "xnMapOutputMode") {
    const auto width = fields.value<std::uint32_t>(), height = fields.value<std::uint32_t>();
    if (!width || !height || !plausible_size(*width, *height)) return;
    stream.width = static_cast<int>(*width);
    stream.height = static_cast<int>(*height);
  } else if (*name == "xnFOV") {
    stream.horizontal_fov_rad = fields.value<double>().value_or(0);
    stream.vertical_fov_rad = fields.value<double>().value_or(0);
  } else if (*name == "oniPixelFormat") {
    stream.pixel_format = fields.value<std::int32_t>().value_or(0);
  } else if (*name == "xnMirror") {
    stream.mirrored = fields.value<std::uint32_t>().value_or(0) != 0;
  } else if (*name == "xnCropping") {
    stream.cropped = fields.value<std::uint32_t>().value_or(0) != 0;
  }
}

void take_image(const Record& record, OniStream& stream) {
  const auto ticks = Fields(record.fields).value<std::uint64_t>();
  if (!ticks || stream.images.size() == kMostImages) return;
  const double time_s = static_cast<double>(*ticks) / kOniTicksPerSecond;
  if (!stream.images.empty() && time_s <= stream.images.back().time_s) return;
  stream.images.push_back({time_s, {record.payload, record.header.payload_size}});
}

/// The node's stream where it is the first one of depth or colour, else null.
OniStream* stream_of(const Record& record, OniFile& file) {
  Fields fields(record.fields);
  if (!fields.text()) return nullptr;
  const auto type = fields.value<std::uint32_t>();
  const auto codec = fields.value<std::array<char, 4>>();
  if (!type || !codec || (*type != kDepthNode && *type != kColorNode)) return nullptr;
  OniStream& stream = *type == kDepthNode ? file.depth : file.color;
  if (!stream.codec.empty()) return nullptr;
  stream.codec.assign(codec->data(), codec->size());
  return &stream;
}

}  // namespace

OniFile list_oni_file(const std::filesystem::path& path) {
  OniFile file;
  std::map<std::uint32_t, OniStream*> nodes;  // null: one that is passed over
  RecordReader reader(path);
  while (const std::optional<Record> record = reader.next()) {
    const RecordHeader& header = record->header;
    if (header.type == kEnd) break;
    if (header.type == kNodeAdded || header.type == kNodeAddedOld ||
        header.type == kNodeAddedOldest)
      nodes.emplace(header.node, stream_of(*record, file));
    const auto node = nodes.find(header.node);
    if (node == nodes.end() || !node->second) continue;
    if (header.type == kIntProperty || header.type == kGeneralProperty)
      take_property(Fields(record->fields), *node->second);
    else if (header.type == kNewData)
      take_image(*record, *node->second);
  }
  return file;
}

}  // namespace ovimap
