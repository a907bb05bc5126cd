// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace ovimap {

/// One client's connection as bytes, plain or encrypted. What is asked of it is done later: each
/// `done` is called once, by the loop's thread, never within the call, and must keep the wire
/// alive. One reading and one writing may be under way at once.
class Wire {
 public:
  using Done = std::function<void(bool ok, std::size_t bytes)>;

  virtual ~Wire() = default;
  /// Comes before all else; nothing to do where nothing is encrypted.
  virtual void shake_hands(Done done) = 0;
  /// Reads at least one byte; not `ok`: the client has ended, or is gone.
  virtual void read_some(std::span<char> into, Done done) = 0;
  /// Calls `gone` if the client ends, or is gone, before it sends anything more.
  virtual void wait_for_end(std::function<void()> gone) = 0;
  /// Writes all of both, which must stay until then.
  virtual void write(std::string_view first, std::string_view second, Done done) = 0;
  /// Tells the client that nothing more is sent; reading goes on.
  virtual void end_sending(Done done) = 0;
  /// Ends what is under way, not `ok`.
  virtual void close() = 0;
  /// Calls `late` after that time, unless this is called again before, or the wire closed.
  virtual void set_deadline(std::chrono::milliseconds time, std::function<void()> late) = 0;
  virtual void clear_deadline() = 0;
  virtual const std::string& remote_address() const = 0;
};

struct IoConfig {
  std::string host;
  int port = 0;                       ///< 0: any free one
  std::filesystem::path certificate;  ///< PEM, with its chain; empty: nothing is encrypted
  std::filesystem::path key;          ///< PEM
};

/// Sockets, and the thread that waits for all of them at once.
class IoLoop {
 public:
  /// Listens from now on. Throws Error when the port is taken, the host is none of this machine's,
  /// or the certificate cannot be used.
  explicit IoLoop(const IoConfig& config);
  ~IoLoop();
  IoLoop(const IoLoop&) = delete;
  IoLoop& operator=(const IoLoop&) = delete;

  int port() const;
  /// Gives each new connection to `accepted` until stop_accepting(); returns when there is nothing
  /// left to wait for.
  void run(std::function<void(std::unique_ptr<Wire>)> accepted);
  /// Has run()'s thread call `job`. From any thread.
  void post(std::function<void()> job);
  /// post() comes from elsewhere as long as the result lives: run() does not return.
  std::shared_ptr<void> stay();
  /// By run()'s thread alone.
  void stop_accepting();

 private:
  struct Sockets;
  std::unique_ptr<Sockets> sockets_;
};

}  // namespace ovimap
