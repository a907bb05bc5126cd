// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace ovimap {

/// How deep JSON and YAML from outside may be nested: the outermost list or object is level 1. Ours
/// have at most 6; what walks a document recursively is safe far beyond.
constexpr std::size_t kDeepestDocument = 32;

/// Bytes of a document that people write or that describes one thing: a camera, settings, a model,
/// a request. Ours have a few thousand.
constexpr std::size_t kSmallDocument = std::size_t{1} << 18;
/// Bytes of a document with an entry per vertex, per frame or per token. An hour of Record3D at 60
/// Hz has some 50 MB, a large scene of ScanNet 10, CLIP's vocabulary 1.
constexpr std::size_t kLargeDocument = std::size_t{1} << 27;

/// The bytes of a file. Throws Error where it cannot be read or has more than `most_bytes`, of
/// which no more are read.
std::string read_bounded_text(const std::filesystem::path& file, std::size_t most_bytes);

/// Throws Error where `text`, which `name` names ("PATH", "the body"), has more than `most_bytes`
/// or a NUL, at which a parser may stop and so overlook the rest.
void check_bounded_text(std::string_view text, const std::string& name, std::size_t most_bytes);

}  // namespace ovimap
