// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/connection_table.h"

#include <tuple>
#include <vector>

namespace ovimap {

bool ConnectionTable::add(std::shared_ptr<Connection> connection) {
  const std::string& client = connection->client();
  const auto own = of_client_.find(client);
  if (own != of_client_.end() && own->second >= of_one_ && !give_up_one(&client)) return false;
  if (connections_.size() >= all_ && !give_up_one(nullptr)) return false;
  std::size_t& count = of_client_[client];
  ++count;
  const Connection* key = connection.get();
  connections_.emplace(key, Entry{std::move(connection), &count});
  return true;
}

void ConnectionTable::remove(const Connection& connection) {
  const auto client = of_client_.find(connection.client());
  if (connections_.erase(&connection) > 0 && --client->second == 0) of_client_.erase(client);
}

void ConnectionTable::end_all() {
  std::vector<std::shared_ptr<Connection>> all;
  for (const auto& [key, entry] : connections_) all.push_back(entry.connection);
  for (const auto& connection : all) connection->end();
}

bool ConnectionTable::give_up_one(const std::string* client) {
  // The one that does the least; of these one of the client that has the most; of these the oldest.
  const auto order = [this](const Entry& entry) {
    const Connection& connection = *entry.connection;
    return std::tuple(connection.state(), all_ - *entry.of_its_client, connection.since());
  };
  const Entry* least = nullptr;
  for (const auto& [key, entry] : connections_) {
    if (client && entry.connection->client() != *client) continue;
    if (!least || order(entry) < order(*least)) least = &entry;
  }
  if (!least || least->connection->state() >= Connection::State::kWorking) return false;
  const auto given_up = least->connection;  // close() takes the entry away
  given_up->close();
  return true;
}

}  // namespace ovimap
