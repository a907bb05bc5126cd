// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/http_message.h"

#include <nlohmann/json.hpp>
#include <optional>

namespace ovimap {

namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at < path.size();) {
    const std::size_t end = std::min(path.find('/', at + 1), path.size());
    parts.push_back(path.substr(at + 1, end - at - 1));
    at = end;
  }
  return parts;
}

std::optional<std::vector<std::string>> match(const std::vector<std::string>& pattern,
                                              const std::vector<std::string>& path) {
  if (pattern.size() != path.size()) return std::nullopt;
  std::vector<std::string> segments;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (pattern[i].front() == '{')
      segments.push_back(path[i]);
    else if (pattern[i] != path[i])
      return std::nullopt;
  }
  return segments;
}

}  // namespace

std::string HttpRequest::header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? "" : found->second;
}

HttpReply text_reply(int status, std::string type, std::string body) {
  HttpReply reply;
  reply.status = status;
  reply.type = std::move(type);
  reply.body = std::make_shared<std::string>(std::move(body));
  return reply;
}

HttpReply fault(int status, const std::string& sentence) {
  const nlohmann::json body = {{"error", sentence}};
  return text_reply(status, "application/json",
                    body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void Router::add(Route route) {
  std::vector<std::string> parts = split(route.pattern);
  routes_.push_back({std::move(route), std::move(parts)});
}

Router::Match Router::find(const HttpRequest& request) const {
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  const std::vector<std::string> path = split(request.path);
  std::string allowed;
  for (const auto& [route, parts] : routes_) {
    auto segments = match(parts, path);
    if (!segments) continue;
    if (route.method == method) return {&route, std::move(*segments), {}};
    allowed += (allowed.empty() ? "" : ", ") + route.method;
    if (route.method == "GET") allowed += ", HEAD";
  }
  if (allowed.empty())
    return {nullptr,
            {},
            fault(404, "there is nothing at '" + request.path +
                           "'; GET /api/openapi.json says what there is")};
  HttpReply reply = fault(
      405, "'" + request.path + "' does not take " + request.method + "; it takes " + allowed);
  reply.headers["Allow"] = allowed;
  return {nullptr, {}, std::move(reply)};
}

}  // namespace ovimap
