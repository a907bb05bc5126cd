// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
// JSON from outside. What is accepted must be what nlohmann's own parser makes of it.
#include <string>

#include <nlohmann/json.hpp>

#include "ovimap/base/bounded_json.h"
#include "ovimap/base/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const nlohmann::json read = ovimap::parse_json(text, "input", std::size_t{1} << 20);
    if (read != nlohmann::json::parse(text, nullptr, false)) __builtin_trap();
    (void)read.dump();
  } catch (const ovimap::Error& fault) {
    const std::string line = fault.what();
    if (line.size() > 200 || line.find('\n') != std::string::npos) __builtin_trap();
  }
  return 0;
}
