// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/transfer/http_client.h"

#include <curl/curl.h>

#include "ovimap/base/error.h"
#include "ovimap/base/version.h"

namespace ovimap {

namespace {

constexpr int kMostRedirects = 10;
constexpr const char* kProtocols = "http,https";

/// libcurl's global state, once a process.
void start_library() {
  static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
  if (started != CURLE_OK)
    throw Error(concat("libcurl cannot start (", curl_easy_strerror(started), ")"));
}

std::string part_of(CURLU* url, CURLUPart part, unsigned flags) {
  char* text = nullptr;
  if (curl_url_get(url, part, &text, flags) != CURLUE_OK) return "";
  std::string found = text;
  curl_free(text);
  return found;
}

std::string header(CURL* handle, const char* name) {
  curl_header* found = nullptr;
  return curl_easy_header(handle, name, 0, CURLH_HEADER, -1, &found) == CURLHE_OK ? found->value
                                                                                  : "";
}

/// The address of the next page, as `Link: <URL>; rel="next"` gives it (RFC 8288).
std::string next_page(const std::string& link) {
  const std::size_t begin = link.find('<'), end = link.find('>');
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  return link.find("rel=\"next\"", end) == std::string::npos
             ? ""
             : link.substr(begin + 1, end - begin - 1);
}

/// "bytes 100-199/200": 100.
std::uint64_t range_start(const std::string& content_range) {
  const std::size_t digits = content_range.find_first_of("0123456789");
  return digits == std::string::npos ? 0 : std::strtoull(&content_range[digits], nullptr, 10);
}

/// What libcurl's callbacks see of a transfer.
struct Transfer {
  CURL* handle;
  const ByteSink& sink;
  const std::function<bool()>& keep_going;
  std::optional<HttpHead> head;  ///< once the first byte of the body is there
  bool stopped = false;          ///< by the sink or by the user
};

HttpHead head_of(CURL* handle) {
  HttpHead head;
  curl_easy_getinfo(handle, CURLINFO_RESPONSE_CODE, &head.status);
  constexpr long kPartial = 206;
  if (head.status == kPartial) head.from = range_start(header(handle, "Content-Range"));
  return head;
}

std::size_t on_bytes(char* data, std::size_t, std::size_t size, void* user) {
  auto& transfer = *static_cast<Transfer*>(user);
  if (!transfer.head) transfer.head = head_of(transfer.handle);
  if (transfer.head->status / 100 != 2) return size;  // the text of a refusal or a redirect
  if (transfer.sink(*transfer.head, {data, size})) return size;
  transfer.stopped = true;
  return 0;
}

int on_progress(void* user, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  auto& transfer = *static_cast<Transfer*>(user);
  if (transfer.keep_going()) return 0;
  transfer.stopped = true;
  return 1;
}

void set_up(CURL* handle, const HubConfig& config, const std::string& url, Transfer& transfer) {
  curl_easy_reset(handle);  // keeps connections
  curl_easy_setopt(handle, CURLOPT_URL, url.c_str());
  curl_easy_setopt(handle, CURLOPT_PROTOCOLS_STR, kProtocols);
  curl_easy_setopt(handle, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(handle, CURLOPT_CONNECTTIMEOUT, long{config.connect_timeout_s});
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_LIMIT, 1L);
  curl_easy_setopt(handle, CURLOPT_LOW_SPEED_TIME, long{config.stall_timeout_s});
  curl_easy_setopt(handle, CURLOPT_USERAGENT, concat("ovimap/", version()).c_str());
  curl_easy_setopt(handle, CURLOPT_WRITEFUNCTION, on_bytes);
  curl_easy_setopt(handle, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_XFERINFOFUNCTION, on_progress);
  curl_easy_setopt(handle, CURLOPT_XFERINFODATA, &transfer);
  curl_easy_setopt(handle, CURLOPT_NOPROGRESS, 0L);
}

}  // namespace

std::string origin_of(const std::string& url) {
  const std::unique_ptr<CURLU, void (*)(CURLU*)> parsed(curl_url(), curl_url_cleanup);
  if (curl_url_set(parsed.get(), CURLUPART_URL, url.c_str(), 0) != CURLUE_OK) return "";
  const std::string scheme = part_of(parsed.get(), CURLUPART_SCHEME, 0);
  const std::string host = part_of(parsed.get(), CURLUPART_HOST, 0);
  if ((scheme != "http" && scheme != "https") || host.empty()) return "";
  return concat(scheme, "://", host, ":",
                part_of(parsed.get(), CURLUPART_PORT, CURLU_DEFAULT_PORT));
}

TransferClient::TransferClient(const HubConfig& config, const HubAccess& access)
    : config_(config),
      token_origin_(origin_of(access.endpoint)),
      token_(access.token),
      handle_((start_library(), curl_easy_init()), curl_easy_cleanup) {
  if (!handle_) throw Error("libcurl cannot start; is there memory left?");
}

TransferClient::~TransferClient() = default;

TransferReply TransferClient::get(const std::string& url, std::uint64_t first_byte,
                                  const ByteSink& sink,
                                  const std::function<bool()>& keep_going) const {
  std::string at = url;
  for (int i = 0; i <= kMostRedirects; ++i) {
    std::string redirect;
    TransferReply reply = request(at, first_byte, sink, keep_going, redirect);
    if (redirect.empty()) return reply;
    if (origin_of(at).starts_with("https:") && !origin_of(redirect).starts_with("https:")) {
      reply.fault = "it redirects from https to an address without";
      return reply;
    }
    at = redirect;
  }
  return {{}, concat("it redirects more than ", kMostRedirects, " times"), {}, ""};
}

TransferReply TransferClient::request(const std::string& url, std::uint64_t first_byte,
                                      const ByteSink& sink, const std::function<bool()>& keep_going,
                                      std::string& redirect) const {
  CURL* handle = handle_.get();
  Transfer transfer{handle, sink, keep_going, {}, false};
  set_up(handle, config_, url, transfer);
  if (first_byte > 0) curl_easy_setopt(handle, CURLOPT_RANGE, concat(first_byte, "-").c_str());
  if (!token_.empty() && origin_of(url) == token_origin_) {
    curl_easy_setopt(handle, CURLOPT_HTTPAUTH, CURLAUTH_BEARER);
    curl_easy_setopt(handle, CURLOPT_XOAUTH2_BEARER, token_.c_str());
  }
  const CURLcode done = curl_easy_perform(handle);

  TransferReply reply;
  reply.head = head_of(handle);
  if (done != CURLE_OK)
    reply.fault = transfer.stopped ? "it was stopped" : curl_easy_strerror(done);
  curl_off_t wait_s = 0;
  if (curl_easy_getinfo(handle, CURLINFO_RETRY_AFTER, &wait_s) == CURLE_OK && wait_s > 0)
    reply.retry_after_s = static_cast<double>(wait_s);
  reply.next_url = next_page(header(handle, "Link"));
  char* location = nullptr;
  curl_easy_getinfo(handle, CURLINFO_REDIRECT_URL, &location);
  if (location && done == CURLE_OK) redirect = location;
  return reply;
}

}  // namespace ovimap
