// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace ovimap::fixture {

/// A connection that says whatever a test wants it to, HTTP or not. `from`: the address of this
/// machine that it comes from.
class RawConnection {
 public:
  explicit RawConnection(int port, const char* from = "127.0.0.1")
      : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const timeval patience{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const sockaddr_in own = address(from, 0), server = address("127.0.0.1", port);
    connected_ = ::bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0 &&
                 ::connect(socket_, reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0;
  }
  ~RawConnection() { ::close(socket_); }
  RawConnection(const RawConnection&) = delete;
  RawConnection& operator=(const RawConnection&) = delete;

  bool connected() const { return connected_; }
  void send(const std::string& bytes) const {
    for (std::size_t at = 0; at < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (count <= 0) return;
      at += static_cast<std::size_t>(count);
    }
  }
  /// What comes first, at most 64 KiB; empty: nothing, or the connection was closed.
  std::string receive() const {
    std::string bytes(1 << 16, '\0');
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
  }
  /// All that comes until the connection is closed.
  std::string receive_all() const {
    std::string all;
    for (std::string piece = receive(); !piece.empty(); piece = receive()) all += piece;
    return all;
  }

 private:
  static sockaddr_in address(const char* host, int port) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, host, &result.sin_addr);
    return result;
  }

  int socket_;
  bool connected_ = false;
};

using HttpFields = std::map<std::string, std::string>;

struct HttpAnswer {
  int status = 0;
  HttpFields fields;  ///< names in lower case
  std::string body;

  std::string field(const std::string& lower_case_name) const {
    const auto found = fields.find(lower_case_name);
    return found == fields.end() ? "" : found->second;
  }
};

/// What the bytes of a whole answer say; nothing where they are none.
inline std::optional<HttpAnswer> parsed_answer(const std::string& bytes) {
  const std::size_t end = bytes.find("\r\n\r\n");
  if (!bytes.starts_with("HTTP/1.1 ") || end == std::string::npos) return std::nullopt;
  HttpAnswer answer;
  answer.status = std::atoi(bytes.c_str() + 9);
  answer.body = bytes.substr(end + 4);
  for (std::size_t at = bytes.find("\r\n") + 2; at < end;) {
    const std::size_t line_end = bytes.find("\r\n", at);
    const std::size_t colon = bytes.find(": ", at);
    std::string name = bytes.substr(at, colon - at);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    answer.fields[name] = bytes.substr(colon + 2, line_end - colon - 2);
    at = line_end + 2;
  }
  return answer;
}

struct FormPart {
  std::string name, content, type;
};

/// Asks a server on this machine, each time on a connection of its own.
class HttpClient {
 public:
  explicit HttpClient(int port, std::string from = "127.0.0.1")
      : port_(port), from_(std::move(from)) {}

  std::optional<HttpAnswer> get(const std::string& path, const HttpFields& fields = {}) const {
    return ask("GET", path, fields, "");
  }
  std::optional<HttpAnswer> head(const std::string& path) const {
    return ask("HEAD", path, {}, "");
  }
  std::optional<HttpAnswer> post(const std::string& path, const std::string& body = "",
                                 const std::string& type = "", HttpFields fields = {}) const {
    if (!type.empty()) fields["Content-Type"] = type;
    fields["Content-Length"] = std::to_string(body.size());
    return ask("POST", path, fields, body);
  }
  std::optional<HttpAnswer> post(const std::string& path, const std::vector<FormPart>& form) const {
    std::string body;
    for (const FormPart& part : form)
      body += "--border\r\nContent-Disposition: form-data; name=\"" + part.name +
              "\"\r\nContent-Type: " + part.type + "\r\n\r\n" + part.content + "\r\n";
    return post(path, body + "--border--\r\n", "multipart/form-data; boundary=border");
  }

 private:
  std::optional<HttpAnswer> ask(const std::string& method, const std::string& path,
                                HttpFields fields, const std::string& body) const {
    fields.try_emplace("Host", "127.0.0.1:" + std::to_string(port_));
    fields["Connection"] = "close";
    std::string head = method + " " + path + " HTTP/1.1\r\n";
    for (const auto& [name, value] : fields) head += name + ": " + value + "\r\n";
    const RawConnection connection(port_, from_.c_str());
    connection.send(head + "\r\n" + body);
    return parsed_answer(connection.receive_all());
  }

  int port_;
  std::string from_;
};

}  // namespace ovimap::fixture
