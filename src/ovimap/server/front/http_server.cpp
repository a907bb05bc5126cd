// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/front/http_server.h"

#include "ovimap/base/error.h"
#include "ovimap/server/front/connection_table.h"
#include "ovimap/server/http/worker_pool.h"

namespace ovimap {

namespace {

// Threads for each cost. What costs little must not stand behind what costs more, be it a piece of
// surface that is packed; frames are decoded one at a time; a query may have to wait for its
// encoder, a correction not for queries. Of work one thread is left to others than who keeps them
// all busy.
constexpr int kLittleThreads = 2, kLargeThreads = 2, kWorkThreads = 4, kFrameThreads = 1;
constexpr std::size_t kMostWaiting = 64;  // requests, for work and frames each

ConnectionConfig connection_config_of(const ServerConfig& config) {
  ConnectionConfig connection;
  connection.patience = std::chrono::seconds(config.patience_s);
  connection.idle = std::chrono::seconds(config.idle_s);
  return connection;
}

/// Encrypted connections keep buffers of their own before anybody said a word.
std::size_t allowed(int connections, const ServerConfig& config) {
  return static_cast<std::size_t>(config.encrypted() ? connections / 2 : connections);
}

const ServerConfig& checked(const ServerConfig& config) {
  if (!config.token.empty()) check_token(config.token);
  if (config.token.empty() && !is_loopback(config.host))
    throw Error(concat("'", config.host, "' lets other machines in; set a token"));
  if (config.tls_certificate.empty() != config.tls_key.empty())
    throw Error("an encrypted server needs both, --tls-cert and --tls-key");
  return config;
}

}  // namespace

struct HttpServer::Parts : ConnectionHost {
  Parts(ServedMap& map, const ServerConfig& given, FrameIntake* intake)
      : events(map.events()),
        config(checked(given)),
        connection(connection_config_of(given)),
        requests(map, given, intake),
        loop({given.host, given.port, given.tls_certificate, given.tls_key}),
        table(allowed(given.max_connections, given), allowed(given.max_connections_of_one, given)),
        // Each connection asks for one thing at a time.
        little(kLittleThreads, static_cast<std::size_t>(given.max_connections), kLittleThreads),
        large(kLargeThreads, static_cast<std::size_t>(given.max_connections), kLargeThreads),
        much(kWorkThreads, kMostWaiting, kWorkThreads - 1),
        frames(kFrameThreads, kMostWaiting, kFrameThreads) {}

  const ConnectionConfig& connection_config() const override { return connection; }
  RequestDesk& desk() override { return requests; }
  bool work(RouteCost cost, const std::string& client, std::function<void()> job) override {
    return pool_of(cost).offer(client, [job = std::move(job), stay = loop.stay()] { job(); });
  }
  WorkerPool& pool_of(RouteCost cost) {
    switch (cost) {
      case RouteCost::kLittle:
        return little;
      case RouteCost::kLarge:
        return large;
      case RouteCost::kWork:
        return much;
      case RouteCost::kFrame:
        break;
    }
    return frames;
  }
  void post(std::function<void()> job) override { loop.post(std::move(job)); }
  void closed(Connection& gone) override { table.remove(gone); }

  void accept(std::unique_ptr<Wire> wire) {
    auto fresh = std::make_shared<Connection>(std::move(wire), *this);
    if (table.add(fresh)) fresh->start();
  }
  void stop() {
    loop.stop_accepting();
    table.end_all();
  }

  EventHub& events;
  const ServerConfig config;
  const ConnectionConfig connection;
  RequestDesk requests;
  IoLoop loop;
  ConnectionTable table;
  WorkerPool little, large, much, frames;
};

HttpServer::HttpServer(ServedMap& map, const ServerConfig& config, FrameIntake* intake)
    : parts_(std::make_unique<Parts>(map, config, intake)) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return parts_->loop.port();
}

std::string HttpServer::address() const {
  const std::string& host = parts_->config.host;
  const bool everywhere = host == "0.0.0.0" || host == "::";
  const bool six = host.find(':') != std::string::npos && !host.starts_with('[');
  const std::string shown = everywhere ? "localhost" : six ? "[" + host + "]" : host;
  const std::string& token = parts_->config.token;
  return concat(parts_->config.encrypted() ? "https://" : "http://", shown, ":", port(), "/",
                token.empty() ? "" : "?token=" + percent_encoded(token));
}

void HttpServer::run() {
  parts_->loop.run([this](std::unique_ptr<Wire> wire) { parts_->accept(std::move(wire)); });
}

void HttpServer::stop() {
  parts_->events.close();
  parts_->loop.post([this] { parts_->stop(); });
}

}  // namespace ovimap
