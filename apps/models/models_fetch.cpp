// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "models_fetch.h"

#include <cstdio>
#include <utility>

#include "ovimap/base/config.h"
#include "ovimap/hub/model_fetch.h"
#include "ovimap/inference/encoders/image_text_encoder.h"

namespace ovimap::apps {

namespace {

constexpr std::uint64_t kBytesPerMb = 1'000'000;

HubConfig read_hub_config(const std::vector<std::string>& settings) {
  HubConfig config;
  ConfigFields fields;
  fields.group("hub", [&](ConfigFields& f) { list_fields(config, f); });
  apply_settings(settings, fields);
  return config;
}

std::string folder_name(const FetchOptions& options) {
  const std::string name = !options.as.empty()         ? options.as
                           : options.variant == "full" ? options.name
                                                       : options.name + "-" + options.variant;
  if (name.find('/') != std::string::npos || name.starts_with('.'))
    throw Error(concat("--as is '", name, "'; a name without slash or dot in front is accepted"));
  return name;
}

void print_fetched(const FetchOptions& options, const FetchTarget& target,
                   const FetchedModel& fetched) {
  const std::string folder = fetched.folder.string();
  if (options.json) {
    print_json({{"name", fetched.folder.filename().string()},
                {"folder", folder},
                {"repository", target.listing.repository},
                {"revision", target.listing.commit},
                {"variant", target.variant},
                {"bytes", bytes_of(target)},
                {"was_there", fetched.was_there},
                {"self_test", fetched.test.summary},
                {"warnings", fetched.test.warnings}});
    return;
  }
  if (fetched.was_there) {
    std::printf("%s: is there already, and whole\n", folder.c_str());
    return;
  }
  std::printf("%s: %s, %s at commit %.12s, licence %s\n", folder.c_str(), target.variant.c_str(),
              target.listing.repository.c_str(), target.listing.commit.c_str(),
              target.entry.license.c_str());
  std::printf("self-test: %s\n", fetched.test.summary.c_str());
  const std::string name = fetched.folder.filename().string();
  if (target.entry.kind == "sam")
    std::printf("use it: ovimap run RECORDING --masks %s -o MAP\n", name.c_str());
  else
    std::printf(
        "use it: ovimap run RECORDING --masks sam --encoder %s -o MAP; or for a map that "
        "there is: ovimap reembed MAP --encoder %s\n",
        name.c_str(), name.c_str());
}

}  // namespace

std::string fetch_line(const CatalogueEntry& entry) {
  const auto size = entry.size_mb.find("full");
  return concat("ovimap models fetch ", entry.name, "   (",
                size == entry.size_mb.end() ? 0 : size->second, " MB; ", entry.good_for, ")");
}

int fetch(const FetchOptions& options) {
  if (options.name == kDefaultModels) return fetch_default(options);
  const std::vector<CatalogueEntry> catalogue = read_catalogue(options.catalogue);
  const CatalogueEntry& entry = find_entry(catalogue, options.name);
  const std::string name = folder_name(options);
  const Hub hub(read_hub_config(options.settings), hub_access_from_environment());
  const FetchTarget target = find_target(hub, entry, options.variant);
  watch_for_interrupt();
  FetchedModel fetched;
  {
    Progress progress("fetching " + name + ", MB:");
    const std::uint64_t total = bytes_of(target);
    std::uint64_t shown = total;
    fetched = fetch_model(hub, target, fetch_place(options.model_dirs), name,
                          [&](std::uint64_t bytes, const std::string& file) {
                            if (bytes / kBytesPerMb != std::exchange(shown, bytes / kBytesPerMb))
                              progress.show(bytes / kBytesPerMb, total / kBytesPerMb, file);
                            return !interrupted();
                          });
  }
  print_fetched(options, target, fetched);
  for (const std::string& warning : fetched.test.warnings)
    warn(concat("WARNING: ", name, ": ", warning));
  return kDone;
}

std::string better_encoder() {
  if (preferred_encoder({}) != kDefaultEncoder) return {};  // one is here
  const HubConfig config = read_hub_config({"hub.connect_timeout_s=3", "hub.stall_timeout_s=3"});
  if (!Hub(config, hub_access_from_environment()).answers()) return {};
  return fetch_line(find_entry(read_catalogue({}), kFirstEncoder));
}

int hub_answers(const FetchOptions& options) {
  HubConfig config = read_hub_config(options.settings);
  const HubAccess access = hub_access_from_environment();
  const bool answers = Hub(config, access).answers();
  const std::vector<CatalogueEntry> catalogue = read_catalogue(options.catalogue);
  if (options.json)
    print_json({{"endpoint", access.endpoint}, {"answers", answers}});
  else if (answers)
    std::printf("%s answers; better words: %s\n", access.endpoint.c_str(),
                fetch_line(find_entry(catalogue, kFirstEncoder)).c_str());
  else
    std::printf("%s does not answer\n", access.endpoint.c_str());
  return answers ? kDone : kAnswerIsNo;
}

}  // namespace ovimap::apps
