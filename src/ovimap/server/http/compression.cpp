// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/compression.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstdlib>

#include "ovimap/base/error.h"

namespace ovimap {

namespace {

// Fast ones: at a room's size stronger ones cost more time than they save on a local network.
constexpr int kZstdLevel = 1, kGzipLevel = 1;
constexpr int kGzipWindow = 15 + 16;  // zlib's way to ask for a gzip header
constexpr int kMemoryLevel = 8;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool accepts(const std::string& list, const std::string& encoding) {
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t end = std::min(list.find(',', at), list.size());
    const std::string entry = list.substr(at, end - at);
    const std::size_t semicolon = std::min(entry.find(';'), entry.size());
    if (trimmed(entry.substr(0, semicolon)) == encoding) {
      const std::size_t weight = entry.find("q=", semicolon);
      return weight == std::string::npos || std::atof(entry.c_str() + weight + 2) > 0;
    }
    at = end + 1;
  }
  return false;
}

std::string zstd(const std::string& body) {
  std::string result(ZSTD_compressBound(body.size()), '\0');
  const std::size_t size =
      ZSTD_compress(result.data(), result.size(), body.data(), body.size(), kZstdLevel);
  if (ZSTD_isError(size)) throw DefectError(concat("zstd: ", ZSTD_getErrorName(size)));
  result.resize(size);
  return result;
}

std::string gzip(const std::string& body) {
  z_stream stream{};
  if (deflateInit2(&stream, kGzipLevel, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw DefectError("zlib cannot start");
  std::string result(deflateBound(&stream, body.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(body.data()));
  stream.avail_in = static_cast<uInt>(body.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  const int status = deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw DefectError(concat("zlib: ", status));
  return result;
}

}  // namespace

std::string choose_encoding(const std::string& accept_encoding) {
  for (const char* encoding : {"zstd", "gzip"})
    if (accepts(accept_encoding, encoding)) return encoding;
  return {};
}

std::string compressed(const std::string& body, const std::string& encoding) {
  if (encoding == "zstd") return zstd(body);
  if (encoding == "gzip") return gzip(body);
  throw DefectError("no such encoding: " + encoding);
}

}  // namespace ovimap
