// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http_server.h"

#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <set>

#include <httplib.h>

#include "ovimap/base/error.h"
#include "ovimap/server/connection_threads.h"
#include "ovimap/server/request_desk.h"

namespace ovimap {

namespace {

constexpr const char* kEverything = ".*";
constexpr std::size_t kRequestsPerConnection = 10000;
constexpr int kIdleSeconds = 1;  // an idle connection holds a thread, and up the end of the server

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

HttpRequest read(const httplib::Request& from) {
  HttpRequest request;
  request.method = from.method;
  request.path = from.path;
  request.query.insert(from.params.begin(), from.params.end());
  for (const auto& [name, value] : from.headers)
    request.headers.try_emplace(lower_case(name), value);
  request.body = from.body;
  for (const auto& [name, part] : from.files) request.parts.try_emplace(name, part.content);
  request.remote_address = from.remote_addr;
  return request;
}

void send_stream(HttpReply& reply, httplib::Response& to) {
  to.set_chunked_content_provider(
      reply.type, [next = std::move(reply.stream)](std::size_t, httplib::DataSink& sink) {
        bool ended = false;
        const std::string piece = next(ended);
        if (!sink.write(piece.data(), piece.size())) return false;  // the client is gone
        if (ended) sink.done();
        return true;
      });
}

void send(HttpReply reply, httplib::Response& to) {
  to.status = reply.status;
  for (const auto& [name, value] : reply.headers) to.set_header(name, value);
  if (reply.stream) return send_stream(reply, to);
  if (reply.body->empty()) return to.set_content("", reply.type);
  if (reply.ends_connection) to.set_header("Connection", "close");
  // By a provider, which httplib leaves as it is; it would compress a plain body once more. One
  // that fails after the last byte makes httplib hang up, which the header alone does not.
  to.set_content_provider(reply.body->size(), reply.type,
                          [body = reply.body, last = reply.ends_connection](
                              std::size_t offset, std::size_t length, httplib::DataSink& sink) {
                            return sink.write(body->data() + offset, length) && !last;
                          });
}

/// What httplib refuses by itself.
std::string why_refused(int status) {
  switch (status) {
    case 411:
      return "say how long the body is: Content-Length";
    case 413:
      return "the request's body is too large";
    case 414:
      return "the address is too long; /api/openapi.json says what there is";
    default:
      return "the request cannot be read; is it HTTP/1.1?";
  }
}

bool is_unknown_method(const std::string& method) {
  static const std::set<std::string> kKnown = {"GET",    "HEAD",    "POST",  "PUT",    "PATCH",
                                               "DELETE", "OPTIONS", "TRACE", "CONNECT"};
  const auto is_capital = [](char letter) { return letter >= 'A' && letter <= 'Z'; };
  return !method.empty() && std::all_of(method.begin(), method.end(), is_capital) &&
         !kKnown.contains(method);
}

/// In our words what httplib refuses by itself. What is left of the request may still be on its
/// way, so that the connection cannot be used again.
HttpReply refusal(const httplib::Request& request, int status) {
  HttpReply reply = fault(status, why_refused(status));
  if (status == 400 && is_unknown_method(request.method)) {
    reply = fault(405, "nothing here takes " + request.method);
    reply.headers["Allow"] = "GET, HEAD, POST";
  }
  reply.ends_connection = true;
  return reply;
}

/// Bodies must say beforehand how long they are: a body in chunks is read whole, however long.
bool needs_length(const httplib::Request& request) {
  const bool has_body =
      request.method == "POST" || request.method == "PUT" || request.method == "PATCH";
  return request.has_header("Transfer-Encoding") ||
         (has_body && !request.has_header("Content-Length"));
}

}  // namespace

struct HttpServer::Sockets {
  Sockets(ServedMap& map, const ServerConfig& given, FrameIntake* intake)
      : events(map.events()), config(given), desk(map, given, intake) {
    set_limits(intake != nullptr);
    set_handlers();
    bind();
  }

  void set_limits(bool takes_frames) {
    const auto most = static_cast<std::size_t>(config.max_connections);
    http.new_task_queue = [most] { return new ConnectionThreads(most); };
    http.set_payload_max_length(takes_frames ? config.max_frame_bytes : config.max_body_bytes);
    http.set_keep_alive_max_count(kRequestsPerConnection);
    http.set_keep_alive_timeout(kIdleSeconds);
    http.set_read_timeout(config.patience_s);
    http.set_write_timeout(config.patience_s);
    http.set_tcp_nodelay(true);
    // httplib's own choice lets a second server bind the same port and take half of the requests.
    http.set_socket_options([this](socket_t socket) {
      listener = socket;
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }

  void set_handlers() {
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
      send(desk.answer(read(request)), response);
    };
    http.Get(kEverything, handle).Post(kEverything, handle).Put(kEverything, handle);
    http.Patch(kEverything, handle).Delete(kEverything, handle).Options(kEverything, handle);
    http.set_pre_routing_handler(
        [this, handle](const httplib::Request& request, httplib::Response& response) {
          // We send whole bodies alone; httplib would cut them to whatever was asked for.
          const_cast<httplib::Request&>(request).ranges.clear();
          if (needs_length(request)) {
            response.status = 411;
            return httplib::Server::HandlerResponse::Handled;
          }
          if (auto refused = desk.early_refusal(read(request))) {
            send(std::move(*refused), response);
            return httplib::Server::HandlerResponse::Handled;
          }
          const bool unknown_to_httplib = request.method == "TRACE" || request.method == "CONNECT";
          if (!unknown_to_httplib) return httplib::Server::HandlerResponse::Unhandled;
          handle(request, response);
          return httplib::Server::HandlerResponse::Handled;
        });
    const httplib::Server::HandlerWithResponse explain = [](const httplib::Request& request,
                                                            httplib::Response& response) {
      if (response.has_header("Content-Type")) return httplib::Server::HandlerResponse::Unhandled;
      send(refusal(request, response.status), response);
      return httplib::Server::HandlerResponse::Handled;
    };
    http.set_error_handler(explain);
    http.set_exception_handler(
        [](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
          send(fault(500, "internal defect; the server goes on"), response);
        });
  }

  void bind() {
    if (config.token.empty() && !is_loopback(config.host))
      throw Error(concat("'", config.host, "' lets other machines in; set a token"));
    const bool any = config.port == 0;
    port = any ? http.bind_to_any_port(config.host) : config.port;
    if (any ? port > 0 : http.bind_to_port(config.host, config.port)) {
      // httplib lets five clients wait to be accepted; a browser or two have more connections.
      ::listen(listener, config.max_connections);
      return;
    }
    throw Error(concat("cannot listen at ", config.host, ":", config.port,
                       "; the port is taken, or the host is none of this machine's: try --port 0 "
                       "for a free one"));
  }

  EventHub& events;
  const ServerConfig config;
  RequestDesk desk;
  httplib::Server http;
  socket_t listener = INVALID_SOCKET;
  int port = 0;
};

HttpServer::HttpServer(ServedMap& map, const ServerConfig& config, FrameIntake* intake)
    : sockets_(std::make_unique<Sockets>(map, config, intake)) {}

HttpServer::~HttpServer() = default;

int HttpServer::port() const {
  return sockets_->port;
}

std::string HttpServer::address() const {
  const std::string& host = sockets_->config.host;
  const bool everywhere = host == "0.0.0.0" || host == "::";
  const bool six = host.find(':') != std::string::npos && !host.starts_with('[');
  const std::string shown = everywhere ? "localhost" : six ? "[" + host + "]" : host;
  const std::string& token = sockets_->config.token;
  return concat("http://", shown, ":", sockets_->port, "/", token.empty() ? "" : "?token=" + token);
}

void HttpServer::run() {
  if (!sockets_->http.listen_after_bind())
    throw Error("the server ended by itself; are there too many open files?");
}

void HttpServer::stop() {
  sockets_->events.close();
  sockets_->http.stop();
}

}  // namespace ovimap
