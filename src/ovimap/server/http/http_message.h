// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace ovimap {

struct HttpRequest {
  std::string method, path;                  ///< path: decoded, without the query string
  std::map<std::string, std::string> query;  ///< decoded; of a name that comes again, the first
  std::multimap<std::string, std::string>
      parameters;                              ///< ... all of them, those of a name in order
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body, remote_address;
  std::vector<std::string> segments;  ///< what stands in the path for {...} of the route

  std::optional<std::uint64_t> content_length;  ///< of the body, as the head has it
  bool keep_alive = true;                       ///< another request may follow on the connection
  bool chunks = true;                           ///< the client reads bodies in chunks: HTTP/1.1

  /// Empty where there is none.
  std::string header(const std::string& lower_case_name) const;
};

/// A body that comes in pieces as things happen. Nobody waits for it: who sends it looks what there
/// is, and is woken when there may be more.
class ReplyStream {
 public:
  virtual ~ReplyStream() = default;
  /// What there is to send by now; empty: nothing.
  virtual std::string next() = 0;
  /// What to send when there was nothing for a while, so that a client that vanished is noticed.
  virtual std::string sign_of_life() const = 0;
  /// Nothing more will come.
  virtual bool ended() const = 0;
  /// Calls `wake`, from any thread, whenever next() or ended() may have changed, as long as this
  /// object lives.
  virtual void watch(std::function<void()> wake) = 0;
};

struct HttpReply {
  int status = 200;
  std::string type = "application/json";
  std::shared_ptr<const std::string> body = std::make_shared<std::string>();
  std::map<std::string, std::string> headers;
  /// The request was not read to its end, so that nothing can follow it.
  bool ends_connection = false;
  std::shared_ptr<ReplyStream> stream;  ///< instead of a body; null: none
  std::shared_ptr<void> place;          ///< let go when the reply is sent
};

HttpReply text_reply(int status, std::string type, std::string body);
/// {"error": "..."}: every refusal looks like this.
HttpReply fault(int status, const std::string& sentence);

using HttpHandler = std::function<HttpReply(const HttpRequest&)>;

/// The body that a route takes.
enum class BodyType { kNone, kJson, kFrame };

/// What a route costs: who works on it, and how often one may ask.
enum class RouteCost { kLittle, kLarge, kWork, kFrame };

struct Route {
  std::string method, pattern;  ///< pattern: a path in which {...} stands for one segment
  BodyType body = BodyType::kNone;
  RouteCost cost = RouteCost::kLittle;
  HttpHandler handler;
};

/// Finds the route of a request, for which its head is enough.
class Router {
 public:
  struct Match {
    const Route* route = nullptr;       ///< null: there is none
    std::vector<std::string> segments;  ///< what stands in the path for {...}
    HttpReply refusal;                  ///< where there is no route: 404 where no pattern fits the
                                        ///< path, 405 where one fits for another method alone
  };

  void add(Route route);
  /// HEAD is answered as GET.
  Match find(const HttpRequest& request) const;

 private:
  struct Entry {
    Route route;
    std::vector<std::string> parts;
  };
  std::vector<Entry> routes_;
};

}  // namespace ovimap
