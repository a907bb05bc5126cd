// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <unordered_map>

#include "ovimap/server/front/connection.h"

namespace ovimap {

/// The open connections: so many in all, so many of one client. Where there is no place the one
/// goes that keeps us waiting, so that nobody can keep others out by being slow.
class ConnectionTable {
 public:
  ConnectionTable(std::size_t all, std::size_t of_one) : all_(all), of_one_(of_one) {}

  /// False when all places are at work.
  bool add(std::shared_ptr<Connection> connection);
  void remove(const Connection& connection);
  void end_all();

 private:
  /// Closes one, of that client or of any; false when all are at work.
  bool give_up_one(const std::string* client);

  const std::size_t all_, of_one_;
  std::unordered_map<const Connection*, std::shared_ptr<Connection>> connections_;
  std::unordered_map<std::string, std::size_t> of_client_;
};

}  // namespace ovimap
