// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace ovimap {

struct HttpRequest {
  std::string method, path;                    ///< path: decoded, without the query string
  std::map<std::string, std::string> query;    ///< decoded
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body, remote_address;
  std::map<std::string, std::string> parts;  ///< of a multipart/form-data body, which is then empty
  std::vector<std::string> segments;         ///< what stands in the path for {...} of the route

  /// Empty where there is none.
  std::string header(const std::string& lower_case_name) const;
};

struct HttpReply {
  int status = 200;
  std::string type = "application/json";
  std::shared_ptr<const std::string> body = std::make_shared<std::string>();
  std::map<std::string, std::string> headers;
  /// The request was not read to its end, so that nothing can follow it. Needs a body.
  bool ends_connection = false;
  /// A stream instead of a body: gives the next piece, waiting for it; nothing ends the stream.
  std::function<std::string(bool& ended)> stream;
};

HttpReply text_reply(int status, std::string type, std::string body);
/// {"error": "..."}: every refusal looks like this.
HttpReply fault(int status, const std::string& sentence);

using HttpHandler = std::function<HttpReply(const HttpRequest&)>;

/// Finds the handler of a request. Patterns are paths in which {...} stands for one segment.
class Router {
 public:
  void add(const std::string& method, const std::string& pattern, HttpHandler handler);
  /// 404 where no pattern fits the path, 405 where one fits for another method alone. HEAD is
  /// answered as GET.
  HttpReply answer(HttpRequest request) const;

 private:
  struct Route {
    std::string method;
    std::vector<std::string> parts;
    HttpHandler handler;
  };
  std::vector<Route> routes_;
};

}  // namespace ovimap
