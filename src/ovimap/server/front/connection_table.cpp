// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/connection_table.h"

#include <utility>
#include <vector>

namespace ovimap {

bool ConnectionTable::add(std::shared_ptr<Connection> connection) {
  const std::string& client = connection->client();
  const auto own = of_client_.find(client);
  if (own != of_client_.end() && own->second >= of_one_ && !give_up_one(&client)) return false;
  if (connections_.size() >= all_ && !give_up_one(nullptr)) return false;
  ++of_client_[client];
  const Connection* key = connection.get();
  connections_.emplace(key, std::move(connection));
  return true;
}

void ConnectionTable::remove(const Connection& connection) {
  const auto client = of_client_.find(connection.client());
  if (connections_.erase(&connection) > 0 && --client->second == 0) of_client_.erase(client);
}

void ConnectionTable::end_all() {
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [key, connection] : connections_) all.push_back(connection);
  for (const auto& connection : all) connection->end();
}

bool ConnectionTable::give_up_one(const std::string* client) {
  // One that asks for nothing, which its client takes for usual; else the one whose client has kept
  // us waiting the longest: who has just come is served before who does not read.
  const auto order = [](const Connection& connection) {
    return std::pair(connection.state() != Connection::State::kIdle, connection.since());
  };
  std::shared_ptr<Connection> least;
  for (const auto& [key, connection] : connections_) {
    if (connection->state() >= Connection::State::kWorking) continue;
    if (client && connection->client() != *client) continue;
    if (!least || order(*connection) < order(*least)) least = connection;
  }
  if (!least) return false;
  least->close();
  return true;
}

}  // namespace ovimap
