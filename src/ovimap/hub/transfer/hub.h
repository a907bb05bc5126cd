// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "ovimap/hub/transfer/http_client.h"

namespace ovimap {

/// A file as the hub lists it. Of a large one the hub knows the SHA-256, of a small one the digest
/// that git gives it.
struct HubFile {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;    ///< 64 hexadecimal digits, or empty
  std::string git_blob;  ///< 40, where sha256 is empty
};

/// The files of a repository at one commit.
struct HubListing {
  std::string repository, commit;
  std::vector<HubFile> files;

  /// Null where there is none of that path.
  const HubFile* find(const std::string& path) const;
};

/// Bytes of one file so far. False stops the fetch; what came stays and is gone on with.
using FetchProgress = std::function<bool(const HubFile& file, std::uint64_t bytes)>;

/// A model hub with the interface of huggingface.co: `api/models/NAME/revision/R`, `.../tree/R`,
/// `NAME/resolve/R/PATH`. All calls try again, as HubConfig says, where the network or the hub may
/// only be busy, and throw Error, one line, where trying is no use.
class Hub {
 public:
  Hub(const HubConfig& config, const HubAccess& access);

  /// `revision` is a branch, a tag or a commit; what it stands for now is kept as the commit.
  HubListing list(const std::string& repository, const std::string& revision) const;

  /// Puts a file at `target`, whole and with the digest that the listing gives. What lies there
  /// already is gone on with.
  void fetch(const HubListing& listing, const HubFile& file, const std::filesystem::path& target,
             const FetchProgress& progress) const;

  /// Whether it answers at all, asked once.
  bool answers() const;

 private:
  std::string get_text(const std::string& url, std::string* next_url) const;
  TransferReply ask(const std::string& url, const std::function<TransferReply()>& request,
                    const std::function<bool()>& keep_going) const;
  void transfer(const std::string& url, const HubFile& file, const std::filesystem::path& target,
                const FetchProgress& progress) const;

  HubConfig config_;
  HubAccess access_;
  TransferClient client_;
};

}  // namespace ovimap
