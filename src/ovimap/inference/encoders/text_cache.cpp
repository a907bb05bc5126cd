// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/inference/encoders/text_cache.h"

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "ovimap/base/error.h"
#include "ovimap/base/memory/recently_used.h"
#include "ovimap/image/codec.h"
#include "ovimap/inference/models/sha256.h"

namespace ovimap {

namespace {

constexpr std::size_t kDigestLength = 64;

/// Names the rows that an encoder gives a list.
std::string key_of(const EncoderIdentity& identity, std::span<const std::string> texts) {
  std::string all =
      concat("texts 1\n", identity.name, "\n", identity.dimension, "\n", identity.digest, "\n");
  for (const std::string& text : texts) all += concat(text.size(), ":", text);
  return sha256_of(all);
}

/// The digest of the numbers, then the numbers.
std::optional<Embeddings> read_rows(const std::filesystem::path& file, Eigen::Index rows,
                                    Eigen::Index columns) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::size_t size = static_cast<std::size_t>(rows * columns) * sizeof(float);
  if (bytes.size() != kDigestLength + size) return std::nullopt;
  if (sha256_of(bytes.substr(kDigestLength)) != bytes.substr(0, kDigestLength)) return std::nullopt;
  Embeddings result(rows, columns);
  std::memcpy(result.data(), bytes.data() + kDigestLength, size);
  return result;
}

void write_rows(const std::filesystem::path& file, const Embeddings& rows) {
  std::error_code fault;
  std::filesystem::create_directories(file.parent_path(), fault);
  const std::string bytes(reinterpret_cast<const char*>(rows.data()),
                          static_cast<std::size_t>(rows.size()) * sizeof(float));
  try {
    write_text(file, sha256_of(bytes) + bytes);
  } catch (const Error&) {  // the next process encodes them again
  }
}

class ListKeeper : public ImageTextEncoder {
 public:
  ListKeeper(std::unique_ptr<ImageTextEncoder> encoder, std::filesystem::path folder)
      : encoder_(std::move(encoder)), folder_(std::move(folder)) {}

  const EncoderIdentity& identity() const override { return encoder_->identity(); }
  std::optional<MatchCalibration> calibration() const override { return encoder_->calibration(); }
  std::string prompt_template() const override { return encoder_->prompt_template(); }
  Embeddings encode_images(std::span<const RgbImage> images) override {
    return encoder_->encode_images(images);
  }

  Embeddings encode_texts(std::span<const std::string> texts) override {
    return recent_or([&] { return encoder_->encode_texts(texts); }, texts);
  }
  Embeddings encode_vocabulary(std::span<const std::string> texts) override {
    return recent_or([&] { return read_or_encode(texts); }, texts);
  }

 private:
  template <typename Encode>
  Embeddings recent_or(const Encode& encode, std::span<const std::string> texts) {
    std::string key;
    for (const std::string& text : texts) key += concat(text.size(), ":", text);
    if (auto known = recent_.find(key)) return std::move(*known);
    Embeddings rows = encode();
    recent_.keep(key, rows, key.size() + static_cast<std::size_t>(rows.size()) * sizeof(float));
    return rows;
  }

  Embeddings read_or_encode(std::span<const std::string> texts) {
    if (folder_.empty()) return encoder_->encode_vocabulary(texts);
    const std::filesystem::path file = folder_ / (key_of(identity(), texts) + ".embeddings");
    if (auto stored =
            read_rows(file, static_cast<Eigen::Index>(texts.size()), identity().dimension))
      return std::move(*stored);
    Embeddings rows = encoder_->encode_vocabulary(texts);
    write_rows(file, rows);
    return rows;
  }

  const std::unique_ptr<ImageTextEncoder> encoder_;
  const std::filesystem::path folder_;
  /// Whole lists, since a text encoded beside others may differ in its last bits.
  RecentlyUsed<std::string, Embeddings> recent_{kRecentTextBytes};
};

}  // namespace

std::unique_ptr<ImageTextEncoder> remember_text_lists(std::unique_ptr<ImageTextEncoder> encoder,
                                                      std::filesystem::path folder) {
  return std::make_unique<ListKeeper>(std::move(encoder), std::move(folder));
}

std::filesystem::path user_cache_folder() {
  const auto folder_in = [](const char* variable) -> std::filesystem::path {
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
  };
  if (const auto cache = folder_in("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "ovimap";
  if (const auto home = folder_in("HOME"); home.is_absolute()) return home / ".cache" / "ovimap";
  return {};
}

}  // namespace ovimap
