// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/server/http/multipart.h"

#include <gtest/gtest.h>

#include "ovimap/server/http/request_body.h"

namespace ovimap {
namespace {

const std::string kType = "multipart/form-data; boundary=b";

std::string part(const std::string& name, const std::string& content) {
  return "--b\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" + content + "\r\n";
}

TEST(MultipartTest, FindsParts) {
  const std::string body =
      "--b\r\ncontent-type: image/png\r\nContent-DISPOSITION: form-data; filename=\"a; name=x\"; "
      "name=\"color\"\r\n\r\n" +
      std::string("\r\n--\0--c\r\n", 10) + "\r\n" + part("frame", "") + "--b--\r\n";
  const auto parts = parse_multipart(kType, body);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts.at("color"), std::string_view("\r\n--\0--c\r\n", 10));
  EXPECT_EQ(parts.at("frame"), "");
  EXPECT_EQ(parse_multipart("multipart/form-data; charset=x; Boundary=\"b\"", body), parts);
  EXPECT_TRUE(parse_multipart(kType, "--b--").empty());
}

TEST(MultipartTest, RefusesWhatIsNone) {
  const std::string good = part("a", "1");
  for (const std::string& body :
       {std::string(), std::string("--b"), std::string("--b\r\n"), good, good + "--b",
        good + "--bc--", "x" + good + "--b--", good + good + "--b--",
        std::string("--b\r\nContent-Disposition: form-data\r\n\r\n1\r\n--b--"),
        std::string("--b\r\n\r\n1\r\n--b--"),
        "--b\r\nX: " + std::string(5000, 'a') + "\r\n\r\n1\r\n--b--"})
    EXPECT_THROW(parse_multipart(kType, body), BadRequest) << body.substr(0, 80);
  for (const char* type : {"multipart/form-data", "multipart/form-data; boundary=",
                           "multipart/form-data; boundary=\"", ""})
    EXPECT_THROW(parse_multipart(type, good + "--b--"), BadRequest) << type;
  std::string many;
  for (int i = 0; i < 9; ++i) many += part(std::to_string(i), "1");
  EXPECT_THROW(parse_multipart(kType, many + "--b--"), BadRequest);
}

TEST(MultipartTest, HostileBodiesCostNoMoreThanOthers) {
  // Each would take hours where the cost grew with the square of the length.
  const std::size_t bytes = 8 << 20;
  std::string near;
  while (near.size() < bytes) near += "\r\n--";
  const std::string boundary(70, '-');
  const std::string type = "multipart/form-data; boundary=" + boundary;
  const std::string head = "--" + boundary + "\r\nContent-Disposition: form-data; name=a\r\n\r\n";
  EXPECT_THROW(parse_multipart(type, head + near), BadRequest);
  EXPECT_THROW(parse_multipart(type, head + std::string(bytes, '-')), BadRequest);
  EXPECT_TRUE(parse_multipart(type, std::string(bytes, '-')).empty());  // ends at once
  EXPECT_THROW(parse_multipart("multipart/form-data;" + std::string(8000, ';'), "--b--"),
               BadRequest);
}

}  // namespace
}  // namespace ovimap
