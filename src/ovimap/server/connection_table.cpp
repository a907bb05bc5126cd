// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/connection_table.h"

#include <tuple>
#include <vector>

namespace ovimap {

bool ConnectionTable::add(std::shared_ptr<Connection> connection) {
  const std::string& client = connection->client();
  if (count_of(client) >= of_one_ && !give_up_one(&client)) return false;
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

std::size_t ConnectionTable::count_of(const std::string& client) const {
  const auto found = of_client_.find(client);
  return found == of_client_.end() ? 0 : found->second;
}

bool ConnectionTable::give_up_one(const std::string* client) {
  // The one that does the least; of these one of the client that has the most; of these the oldest.
  const auto order = [this](const Connection& c) {
    return std::tuple(c.state(), all_ - count_of(c.client()), c.since());
  };
  std::shared_ptr<Connection> least;
  for (const auto& [key, connection] : connections_) {
    if (client && connection->client() != *client) continue;
    if (!least || order(*connection) < order(*least)) least = connection;
  }
  if (!least || least->state() >= Connection::State::kWorking) return false;
  least->close();
  return true;
}

}  // namespace ovimap
