// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "ovimap/hub/catalogue/catalogue.h"

#include <set>

#include <gtest/gtest.h>

#include "ovimap/inference/models/test_support.h"

namespace ovimap {
namespace {

TEST(Catalogue, BuiltInOneIsWhole) {
  const std::vector<CatalogueEntry> catalogue = read_catalogue({});
  std::set<std::string> names;
  std::set<int> preferences;
  for (const CatalogueEntry& entry : catalogue) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_TRUE(entry.documentation.starts_with("https://")) << entry.name;
    EXPECT_EQ(entry.size_mb.size(), model_variants().size()) << entry.name;
    if (entry.kind == "dual_encoder") {
      EXPECT_TRUE(entry.files.contains("image") && entry.files.contains("text")) << entry.name;
      EXPECT_GT(entry.preference, 0) << entry.name;
      EXPECT_TRUE(preferences.insert(entry.preference).second) << entry.name;
    } else {
      EXPECT_TRUE(entry.files.contains("encoder") && entry.files.contains("decoder")) << entry.name;
    }
  }
  for (const char* name :
       {"siglip-base-224", "siglip-base-384", "siglip-large-384", "siglip2-base-224",
        "siglip2-large-384", "clip-b32", "tinyclip", "sam2.1-small", "slimsam-77"})
    EXPECT_TRUE(names.contains(name)) << name;
  EXPECT_EQ(find_entry(catalogue, kFirstEncoder).kind, "dual_encoder");
}

TEST(Catalogue, SaysWhatIsMeant) {
  const std::vector<CatalogueEntry> catalogue = read_catalogue({});
  EXPECT_TRUE(contains(error_of([&] { find_entry(catalogue, "siglip-base-225"); }),
                       "did you mean 'siglip-base-224'?"));
  EXPECT_TRUE(
      contains(error_of([&] { find_entry(catalogue, "resnet"); }), "there are siglip-large-384"));
}

TEST(Catalogue, RefusesWhatIsNotWhole) {
  EXPECT_TRUE(contains(error_of([] { parse_catalogue("models: [{name: a}]", "x.yaml"); }),
                       "catalogue x.yaml: 'kind' is missing of a"));
  EXPECT_TRUE(contains(error_of([] { parse_catalogue("models: [", "x.yaml"); }), "x.yaml"));
}

}  // namespace
}  // namespace ovimap
