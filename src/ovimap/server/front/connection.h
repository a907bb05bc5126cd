// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "ovimap/server/front/request_desk.h"
#include "ovimap/server/http/http_head.h"
#include "ovimap/server/http/http_io.h"

namespace ovimap {

class Connection;

struct ConnectionConfig {
  std::chrono::milliseconds patience{5000};  ///< for a whole head, and for each piece of a body
  std::chrono::milliseconds idle{5000};      ///< between two requests
  HeadLimits head;
};

/// What a connection needs of its server.
class ConnectionHost {
 public:
  virtual ~ConnectionHost() = default;
  virtual const ConnectionConfig& connection_config() const = 0;
  virtual RequestDesk& desk() = 0;
  /// Has a worker call `job`, for that client; false when too many wait.
  virtual bool work(RouteCost cost, const std::string& client, std::function<void()> job) = 0;
  /// Has the loop's thread call `job`. From any thread.
  virtual void post(std::function<void()> job) = 0;
  virtual void closed(Connection& connection) = 0;
};

/// One client's requests, one after another: head, decision, body, work, reply. Everything but the
/// work happens in the loop's thread, and nothing waits.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Clock = std::chrono::steady_clock;
  /// From kWorking on a connection is not given up for a new one.
  enum class State { kIdle, kHead, kBody, kWriting, kWorking, kStreaming, kClosed };

  Connection(std::unique_ptr<Wire> wire, ConnectionHost& host);

  void start();
  /// No more requests; what is answered already is sent.
  void end();
  void close();

  State state() const { return state_; }
  /// When it came to its state, or something was last read or written of a body.
  Clock::time_point since() const { return since_; }
  const std::string& client() const { return client_; }

 private:
  using Step = void (Connection::*)();
  Wire::Done then(Step step);
  void enter(State state);
  void be_done_in(std::chrono::milliseconds time);

  void read_head();
  void more_head(std::size_t bytes);
  void take_head(std::size_t bytes);
  void take_body();
  void read_body();
  void more_body(std::size_t bytes);
  void work();
  void send(HttpReply reply);
  void write_piece();
  void sent();
  void linger();
  void drain();

  void stream();
  void wake();
  void pump();
  void write_chunk(std::string_view text);

  const std::unique_ptr<Wire> wire_;
  ConnectionHost& host_;
  const ConnectionConfig& config_;
  const std::string client_;
  State state_ = State::kHead;
  Clock::time_point since_ = Clock::now();
  bool ending_ = false;
  std::atomic<bool> unwanted_ = false;  ///< nobody waits for what has not been begun

  std::array<char, 1 << 14> buffer_;
  std::string in_;  ///< read, but not used yet
  HttpRequest request_;
  RequestDesk::Decision decision_;
  std::uint64_t body_left_ = 0, piece_left_ = 0;

  HttpReply reply_;
  std::string out_;            ///< head, or piece of a stream
  std::string_view body_out_;  ///< what is left of the body
  bool writing_ = false;       ///< ... a piece of a stream
  /// The stream's sign is on its way. Who gives the sign must hold no more of a connection.
  const std::shared_ptr<std::atomic<bool>> woken_ = std::make_shared<std::atomic<bool>>(false);
};

}  // namespace ovimap
