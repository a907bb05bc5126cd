// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tsl/robin_map.h>

#include <cstdint>
#include <map>
#include <utility>

namespace ovimap {

/// A std::map by number with a hash table beside it: gone through in order, as files need it, and
/// asked at a cost that does not grow with it, as every frame needs it.
template <class Value>
class IndexedMap {
 public:
  using Number = std::uint32_t;
  using Ordered = std::map<Number, Value>;

  IndexedMap() = default;
  explicit IndexedMap(Ordered values) : ordered_(std::move(values)) {
    for (auto& [number, value] : ordered_) index_[number] = &value;
  }
  IndexedMap(const IndexedMap& other) : IndexedMap(other.ordered_) {}
  IndexedMap(IndexedMap&&) noexcept = default;  // values of a std::map stay where they are
  IndexedMap& operator=(IndexedMap other) noexcept {
    ordered_.swap(other.ordered_);
    index_.swap(other.index_);
    return *this;
  }
  ~IndexedMap() = default;

  /// Null where there is none.
  const Value* find(Number number) const {
    const auto found = index_.find(number);
    return found == index_.end() ? nullptr : found->second;
  }
  Value* find(Number number) { return const_cast<Value*>(std::as_const(*this).find(number)); }

  /// Valid until it is erased.
  Value& operator[](Number number) {
    if (Value* const known = find(number)) return *known;
    Value& added = ordered_[number];
    index_[number] = &added;
    return added;
  }

  void erase(Number number) {
    if (index_.erase(number) > 0) ordered_.erase(number);
  }

  const Ordered& ordered() const { return ordered_; }

 private:
  Ordered ordered_;
  tsl::robin_map<Number, Value*> index_;
};

}  // namespace ovimap
