// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/hub.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"
#include "ovimap/hub/transfer/git_blob.h"
#include "ovimap/hub/transfer/partial_file.h"
#include "ovimap/inference/models/sha256.h"

namespace ovimap {

namespace fs = std::filesystem;

namespace {

constexpr const char* kStopped = "it was stopped";  // what TransferClient says of a user's wish
constexpr int kMostPages = 100;  // of a list of files; a hub that never ends it is broken

// HTTP statuses that mean something here (RFC 9110).
constexpr long kUnauthorised = 401, kForbidden = 403, kNotFound = 404, kRangeWrong = 416,
               kTimedOut = 408, kTooMany = 429;

bool is_good(const TransferReply& reply) {
  return reply.fault.empty() && reply.head.status / 100 == 2;
}

/// Whether another try may go better.
bool may_pass(const TransferReply& reply) {
  if (reply.fault == kStopped) return false;
  const long status = reply.head.status;
  return !reply.fault.empty() || status == kTimedOut || status == kTooMany || status / 100 == 5;
}

[[noreturn]] void refuse(const std::string& url, const TransferReply& reply, int tries,
                         bool token) {
  const long status = reply.head.status;
  const std::string tried = tries > 1 ? concat(" (tried ", tries, " times)") : "";
  if (reply.fault == kStopped)
    throw Error("the fetch was stopped; run it again, and it goes on where it was");
  if (!reply.fault.empty() && status == 0)
    throw Error(concat("the model hub cannot be reached at ", url, ": ", reply.fault, tried,
                       "; check the network, https_proxy and HF_ENDPOINT"));
  if (!reply.fault.empty())
    throw Error(concat("the transfer of ", url, " broke: ", reply.fault, tried,
                       "; run it again, and it goes on where it was"));
  if (status == kUnauthorised || status == kForbidden)
    throw Error(concat("the model hub answers ", status, " for ", url, "; ",
                       token ? "the token in HF_TOKEN may not read it, or it is gone"
                             : "it is gone, or needs a token in HF_TOKEN"));
  if (status == kNotFound)
    throw Error(concat("the model hub has no ", url, " (404); was it moved or renamed?"));
  if (status == kTooMany)
    throw Error(concat("the model hub answers 429, too many requests, for ", url, tried,
                       reply.retry_after_s ? concat("; try again in ", *reply.retry_after_s, " s")
                                           : std::string("; try again later"),
                       token ? "" : ", or set HF_TOKEN"));
  throw Error(concat("the model hub answers ", status, " for ", url, tried, "; try again later"));
}

/// It becomes part of paths, so nothing else will do.
bool is_commit(const std::string& text) {
  constexpr std::size_t kDigits = 40;
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// False when the user stopped it.
bool wait(double seconds, const std::function<bool()>& keep_going) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kPiece(100);  // a user's Ctrl-C is heard so soon
  const auto end = Clock::now() + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    if (!keep_going()) return false;
    std::this_thread::sleep_for(
        std::min<std::chrono::duration<double>>(kPiece, end - Clock::now()));
  }
  return true;
}

HubFile read_entry(const nlohmann::json& entry) {
  HubFile file;
  file.path = entry.at("path").get<std::string>();
  file.bytes = entry.at("size").get<std::uint64_t>();
  if (entry.contains("lfs") && !entry["lfs"].is_null()) {
    file.sha256 = entry["lfs"].at("oid").get<std::string>();
    file.bytes = entry["lfs"].at("size").get<std::uint64_t>();
    if (const std::size_t colon = file.sha256.find(':'); colon != std::string::npos)
      file.sha256.erase(0, colon + 1);  // "sha256:..."
  } else {
    file.git_blob = entry.at("oid").get<std::string>();
  }
  const fs::path path(file.path);
  if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
    throw Error(concat("the model hub lists a file '", file.path, "', which leaves the folder"));
  return file;
}

/// Digest of what was fetched; "" where it is the listed one.
std::string wrong_digest(const HubFile& file, const fs::path& target) {
  const std::string& expected = file.sha256.empty() ? file.git_blob : file.sha256;
  const std::string found = file.sha256.empty() ? git_blob_of_file(target) : sha256_of_file(target);
  return found == expected ? "" : found;
}

}  // namespace

const HubFile* HubListing::find(const std::string& path) const {
  const auto found = std::find_if(files.begin(), files.end(),
                                  [&path](const HubFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

Hub::Hub(const HubConfig& config, const HubAccess& access)
    : config_(config), access_(access), client_(config, access) {}

bool Hub::answers() const {
  const TransferReply reply =
      client_.get(access_.endpoint + "/", 0, [](const HttpHead&, auto) { return false; });
  return reply.head.status != 0;
}

TransferReply Hub::ask(const std::string& url, const std::function<TransferReply()>& request,
                       const std::function<bool()>& keep_going) const {
  double wait_s = config_.first_wait_s;
  for (int tries = 1;; ++tries, wait_s *= 2) {
    const TransferReply reply = request();
    if (is_good(reply)) return reply;
    const double asked_s = reply.retry_after_s.value_or(0);
    if (!may_pass(reply) || tries >= config_.attempts || asked_s > config_.longest_wait_s)
      refuse(url, reply, tries, !access_.token.empty());
    if (!wait(std::max(wait_s, asked_s), keep_going))
      refuse(url, {reply.head, kStopped, {}, ""}, tries, !access_.token.empty());
  }
}

std::string Hub::get_text(const std::string& url, std::string* next_url) const {
  std::string text;
  const auto request = [&] {
    text.clear();
    return client_.get(url, 0, [&text](const HttpHead&, std::span<const char> bytes) {
      text.append(bytes.data(), bytes.size());
      return text.size() <= kLargeDocument;
    });
  };
  const TransferReply reply = ask(url, request, [] { return true; });
  if (next_url) *next_url = reply.next_url;
  return text;
}

HubListing Hub::list(const std::string& repository, const std::string& revision) const {
  const std::string api = concat(access_.endpoint, "/api/models/", repository);
  std::string url = concat(api, "/revision/", revision);
  try {
    HubListing listing;
    listing.repository = repository;
    listing.commit =
        parse_json(get_text(url, nullptr), url, kLargeDocument).at("sha").get<std::string>();
    if (!is_commit(listing.commit))
      throw Error(concat("the model hub gives '", listing.commit, "' as the commit of ", repository,
                         "; is HF_ENDPOINT a model hub?"));
    url = concat(api, "/tree/", listing.commit, "?recursive=true");
    for (int page = 0; !url.empty() && page < kMostPages; ++page) {
      std::string next;
      for (const auto& entry : parse_json(get_text(url, &next), url, kLargeDocument))
        if (entry.at("type") == "file") listing.files.push_back(read_entry(entry));
      url = next;
    }
    return listing;
  } catch (const nlohmann::json::exception&) {
    throw Error(concat("the model hub's answer for ", url,
                       " is not a list of files; is HF_ENDPOINT a model hub?"));
  }
}

void Hub::transfer(const std::string& url, const HubFile& file, const fs::path& target,
                   const FetchProgress& progress) const {
  std::uint64_t there = 0;
  const auto request = [&] {
    PartialFile partial(target, file.bytes);
    if (partial.bytes() == file.bytes) return TransferReply{{200, 0}, "", {}, ""};
    const TransferReply reply = client_.get(
        url, partial.bytes(),
        [&](const HttpHead& head, std::span<const char> bytes) {
          return partial.write(head.from, bytes) && progress(file, partial.bytes());
        },
        [&] { return progress(file, partial.bytes()); });
    there = partial.bytes();
    if (!partial.fault().empty()) throw Error(partial.fault());
    if (reply.head.status == kRangeWrong) partial.restart();
    if (is_good(reply) && partial.bytes() != file.bytes)
      return TransferReply{
          reply.head, concat("only ", partial.bytes(), " of ", file.bytes, " bytes came"), {}, ""};
    return reply;
  };
  ask(url, request, [&] { return progress(file, there); });
}

void Hub::fetch(const HubListing& listing, const HubFile& file, const fs::path& target,
                const FetchProgress& progress) const {
  const std::string url = concat(access_.endpoint, "/", listing.repository, "/resolve/",
                                 listing.commit, "/", file.path);
  fs::create_directories(target.parent_path());
  const bool resumed = fs::exists(target);
  transfer(url, file, target, progress);
  std::string wrong = wrong_digest(file, target);
  if (!wrong.empty() && resumed) {  // what lay there may have been of another file
    fs::remove(target);
    transfer(url, file, target, progress);
    wrong = wrong_digest(file, target);
  }
  if (wrong.empty()) return;
  fs::remove(target);
  throw Error(concat("what came for ", url, " has the digest ", wrong, ", but the hub lists ",
                     file.sha256.empty() ? file.git_blob : file.sha256,
                     "; run it again, or look at what changes it on the way"));
}

}  // namespace ovimap
