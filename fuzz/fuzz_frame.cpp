// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// Frames that clients push: multipart bodies with a description in JSON and two images. The first
// line of the input is the Content-Type, the rest the body.
#include <string>

#include "ovimap/base/error.h"
#include "ovimap/server/api/frame_api.h"
#include "ovimap/server/http/request_body.h"

namespace {

constexpr const char* kCamera =
    R"({"camera": {"width": 8, "height": 6, "fx": 8, "fy": 8, "cx": 4, "cy": 3, "depth_scale": 1000}})";

ovimap::HttpRequest request_of(const std::string& type, const std::string& body) {
  ovimap::HttpRequest request;
  request.method = "POST";
  request.headers["content-type"] = type;
  request.body = body;
  return request;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t line = std::min(input.find('\n'), input.size());
  const std::string body = input.substr(std::min(line + 1, input.size()));
  ovimap::FrameIntake intake(1);
  ovimap::FrameApi api(&intake, {});
  api.camera(request_of("application/json", kCamera));
  const auto attempt = [](auto&& ask) {
    try {
      ask();
    } catch (const ovimap::BadRequest& refused) {
      if (refused.status < 400 || refused.status >= 500) __builtin_trap();
    } catch (const ovimap::Error&) {
    }
  };
  attempt([&] { api.frame(request_of(input.substr(0, line), body)); });
  attempt([&] { api.camera(request_of("application/json", body)); });
  return 0;
}
