// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/pipeline/report/html_text.h"

#include <limits>

#include <gtest/gtest.h>

namespace ovimap {
namespace {

std::string uri_of(std::initializer_list<std::uint8_t> bytes) {
  return picture_uri({bytes.begin(), bytes.size()});
}

TEST(EscapeHtml, LeavesNothingThatABrowserWouldRead) {
  EXPECT_EQ(escape_html("<b a=\"1\" b='2'> & </b>"),
            "&lt;b a=&quot;1&quot; b=&#39;2&#39;&gt; &amp; &lt;/b&gt;");
  EXPECT_EQ(escape_html("K\xc3\xbc"
                        "che \xf0\x9f\x8d\xb3\n"),
            "K\xc3\xbc"
            "che \xf0\x9f\x8d\xb3\n");
}

TEST(EscapeHtml, ReplacesWhatIsNoText) {
  EXPECT_EQ(escape_html("a\xff"
                        "b"),
            "a\xef\xbf\xbd"
            "b");
  EXPECT_EQ(escape_html(std::string_view("a\0b\x1b\x7f", 5)),
            "a\xef\xbf\xbd"
            "b\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(PictureUri, IsBase64OfPngOrJpeg) {
  EXPECT_EQ(uri_of({}), "data:image/jpeg;base64,");
  EXPECT_EQ(uri_of({0xFF}), "data:image/jpeg;base64,/w==");
  EXPECT_EQ(uri_of({0xFF, 0xD8}), "data:image/jpeg;base64,/9g=");
  EXPECT_EQ(uri_of({0xFF, 0xD8, 0xFF}), "data:image/jpeg;base64,/9j/");
  EXPECT_EQ(uri_of({0x89, 'P', 'N', 'G'}), "data:image/png;base64,iVBORw==");
}

TEST(FixedNumber, RoundsAndHasNoNegativeZero) {
  EXPECT_EQ(fixed_number(1.256, 2), "1.26");
  EXPECT_EQ(fixed_number(-3, 1), "-3.0");
  EXPECT_EQ(fixed_number(-0.001, 2), "0.00");
  EXPECT_EQ(fixed_number(std::numeric_limits<double>::quiet_NaN(), 2), "\xe2\x80\x93");
  EXPECT_EQ(fixed_number(std::numeric_limits<double>::max(), 0).size(), 309u);
}

TEST(GroupedNumber, SeparatesThousands) {
  EXPECT_EQ(grouped_number(0), "0");
  EXPECT_EQ(grouped_number(999), "999");
  EXPECT_EQ(grouped_number(1000), "1,000");
  EXPECT_EQ(grouped_number(12345678), "12,345,678");
}

}  // namespace
}  // namespace ovimap
