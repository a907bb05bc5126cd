// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/api/viewer_files.h"

#include "ovimap/base/error.h"
#include "ovimap/image/codec.h"

namespace ovimap {

namespace {

const char* type_of(const std::string& extension) {
  static const std::map<std::string, const char*> kTypes = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".json", "application/json"},
      {".txt", "text/plain; charset=utf-8"}};
  const auto found = kTypes.find(extension);
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

// Files under assets/ carry a hash of their content in their name.
const char* caching_of(const std::string& path) {
  return path.starts_with("/assets/") ? "public, max-age=31536000, immutable" : "no-cache";
}

HttpReply no_viewer() {
  HttpReply reply = text_reply(
      200, "text/html; charset=utf-8",
      "<!doctype html><html lang=\"en\"><title>ovimap</title><p>The server runs, but the viewer "
      "was "
      "not built. Install Node.js 18 with npm, run <code>make build</code> and start <code>ovimap "
      "serve</code> again. The programming interface works without: <a "
      "href=\"/api/openapi.json\">/api/openapi.json</a>.</p></html>");
  reply.headers["Cache-Control"] = "no-store";
  return reply;
}

}  // namespace

ViewerFiles::ViewerFiles(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  if (!std::filesystem::exists(folder / "index.html"))
    throw Error(concat("'", folder.string(),
                       "' holds no built viewer (no index.html); run `make "
                       "build`, which needs Node.js with npm"));
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = "/" + entry.path().lexically_relative(folder).generic_string();
    const Bytes bytes = read_file(entry.path());
    HttpReply reply = text_reply(200, type_of(entry.path().extension().string()),
                                 std::string(bytes.begin(), bytes.end()));
    reply.headers["Cache-Control"] = caching_of(path);
    files_[path] = std::move(reply);
  }
  files_["/"] = files_.at("/index.html");
}

std::optional<HttpReply> ViewerFiles::find(const std::string& path) const {
  const auto found = files_.find(path);
  if (found != files_.end()) return found->second;
  if (files_.empty() && path == "/") return no_viewer();
  return std::nullopt;
}

std::filesystem::path find_viewer(const std::filesystem::path& program) {
  const std::filesystem::path prefix = program.parent_path().parent_path();
  for (const auto& folder : {prefix / "share/ovimap/viewer", prefix / "viewer"})
    if (std::filesystem::exists(folder / "index.html")) return folder;
  return {};
}

}  // namespace ovimap
