// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "ovimap/io/map_file/map_file_fixture.h"
#include "ovimap/server/front/http_server.h"
#include "ovimap/server/front/server_fixture.h"

namespace ovimap {

/// A server over a small map of its own folder.
class HttpServerTest : public MapFolder {
 protected:
  HttpServerTest() {
    MapDocument document = random_document(40, 3);
    const LabelForest& forest = document.map.labels();
    std::vector<Label>& own = document.instances[1].super_points;
    for (Label label = 5; own.size() < 2; ++label)
      if (forest.root(label) == label) own.push_back(label);
    save_map(map_, document);
  }

  fixture::RunningServer& serve(ServerConfig config = {}) {
    ServedMapConfig served;
    served.encoder = "none";
    running_ = std::make_unique<fixture::RunningServer>(map_, std::move(config), served);
    return *running_;
  }

  nlohmann::json get(const std::string& path, int status = 200) {
    const auto reply = running_->client().get(path);
    EXPECT_TRUE(reply) << path;
    if (!reply) return {};
    EXPECT_EQ(reply->status, status) << path << reply->body;
    return nlohmann::json::parse(reply->body, nullptr, false);
  }

  nlohmann::json post(const std::string& path, const std::string& body, int status,
                      const std::string& type = "application/json") {
    const auto reply = running_->client().post(path, body, type);
    EXPECT_TRUE(reply) << path;
    if (!reply) return {};
    EXPECT_EQ(reply->status, status) << body << reply->body;
    const nlohmann::json parsed = nlohmann::json::parse(reply->body, nullptr, false);
    if (status >= 400) {
      EXPECT_FALSE(parsed.value("error", "").empty()) << reply->body;
    }
    return parsed;
  }

  const std::filesystem::path map_ = root_ / "room.ovimap";
  std::unique_ptr<fixture::RunningServer> running_;
};

}  // namespace ovimap
