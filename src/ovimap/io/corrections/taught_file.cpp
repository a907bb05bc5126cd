// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/io/corrections/taught_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"

namespace ovimap {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kFormat = 1;
constexpr float kLookSteps = 127.f;  // of the largest number of a look
constexpr std::size_t kMostNumbers = 1 << 16, kLongestTaughtName = 1000;

[[noreturn]] void fail_to_keep(const fs::path& file, int error) {
  throw Error(concat("cannot keep what was taught in '", file.string(),
                     "': ", std::generic_category().message(error),
                     "; name another file with --teach FILE"));
}

json json_of(const TaughtThing& thing) {
  const float step = thing.look.cwiseAbs().maxCoeff() / kLookSteps;
  json numbers = json::array();
  for (const float number : thing.look)
    numbers.push_back(step > 0.f ? static_cast<int>(std::lround(number / step)) : 0);
  return {{"name", thing.name},
          {"map", thing.map},
          {"object", thing.object},
          {"encoder", {{"name", thing.encoder.name}, {"digest", thing.encoder.digest}}},
          {"look", std::move(numbers)}};
}

TaughtThing thing_of(const json& line) {
  TaughtThing thing;
  thing.name = line.at("name").get<std::string>();
  thing.map = line.at("map").get<std::string>();
  thing.object = line.at("object").get<InstanceId>();
  thing.encoder.name = line.at("encoder").at("name").get<std::string>();
  thing.encoder.digest = line.at("encoder").at("digest").get<std::string>();
  const auto numbers = line.at("look").get<std::vector<int>>();
  if (thing.name.empty() || thing.name.size() > kLongestTaughtName || numbers.empty() ||
      numbers.size() > kMostNumbers)
    throw Error("a thing without a name or a look");
  thing.encoder.dimension = static_cast<int>(numbers.size());
  thing.look.resize(thing.encoder.dimension);
  for (Eigen::Index i = 0; i < thing.look.size(); ++i)
    thing.look[i] = static_cast<float>(numbers[static_cast<std::size_t>(i)]);
  if (thing.look.isZero(0.f)) throw Error("a look of zeros");
  thing.look.normalize();
  return thing;
}

/// Holds others off until it goes out of scope.
class WriteLock {
 public:
  explicit WriteLock(const fs::path& file)
      : descriptor_(
            ::open(concat(file.string(), ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0) fail_to_keep(file, errno);
    while (::flock(descriptor_, LOCK_EX) != 0)
      if (errno != EINTR) {
        const int error = errno;
        ::close(descriptor_);
        fail_to_keep(file, error);
      }
  }
  ~WriteLock() { ::close(descriptor_); }
  WriteLock(const WriteLock&) = delete;
  WriteLock& operator=(const WriteLock&) = delete;

 private:
  int descriptor_;
};

void write_whole(const fs::path& file, const std::string& text) {
  const fs::path partial = concat(file.string(), ".", ::getpid(), ".partial");
  errno = 0;
  std::ofstream out(partial, std::ios::binary);
  out << text;
  out.close();
  std::error_code fault;
  if (!out) fault = {errno == 0 ? EIO : errno, std::generic_category()};
  if (!fault) fs::rename(partial, file, fault);
  if (!fault) return;
  std::error_code ignored;
  fs::remove(partial, ignored);
  fail_to_keep(file, fault.value());
}

}  // namespace

std::vector<TaughtThing> read_taught_file(const fs::path& file) {
  std::error_code fault;
  if (!fs::exists(file, fault)) return {};
  const json document = read_json(file, kLargeDocument);
  std::vector<TaughtThing> things;
  try {
    if (document.at("format").get<int>() != kFormat)
      throw Error(
          concat("format ", document.at("format").dump(), ", this program reads ", kFormat));
    for (const json& line : document.at("things")) things.push_back(thing_of(line));
  } catch (const std::exception& fault_of_file) {
    throw Error(concat("'", file.string(), "' holds nothing that was taught (",
                       fault_of_file.what(),
                       "); name another file with --teach FILE, or delete it"));
  }
  return things;
}

void replace_taught_things(const fs::path& file, const std::string& map,
                           const std::vector<TaughtThing>& things) {
  std::error_code fault;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), fault);
  if (fault) fail_to_keep(file, fault.value());
  const WriteLock lock(file);
  json lines = json::array();
  for (const TaughtThing& known : read_taught_file(file))
    if (known.map != map) lines.push_back(json_of(known));
  for (const TaughtThing& thing : things) lines.push_back(json_of(thing));
  // A line a thing, so that people can look through it and delete what they like.
  std::string text = concat("{\"format\":", kFormat, ",\"things\":[");
  constexpr int kOneLine = -1;
  for (std::size_t i = 0; i < lines.size(); ++i)  // paths need not be UTF-8
    text += concat(i == 0 ? "\n" : ",\n",
                   lines[i].dump(kOneLine, ' ', false, json::error_handler_t::replace));
  write_whole(file, text + "\n]}\n");
}

}  // namespace ovimap
