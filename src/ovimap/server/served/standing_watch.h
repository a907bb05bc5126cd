// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "ovimap/instance/instance_summary.h"

namespace ovimap {

/// What a standing query found: the best match, as it was then.
struct StandingObject {
  InstanceId id = 0;
  std::string title;   ///< its name, else what it clearly is, else "object"
  bool named = false;  ///< a person named it
  Eigen::AlignedBox3f box;
  std::optional<double> probability;
};

/// What a map says to a standing query.
struct StandingVerdict {
  std::optional<StandingObject> object;  ///< nothing: it is not in the map
  std::string fault;                     ///< why it could not be asked; empty: it was
};

struct StandingEvent {
  enum class Kind { kFound, kGone, kFault };
  Kind kind = Kind::kFault;
  std::string query;                     ///< empty: of all
  std::optional<StandingObject> object;  ///< what was found, or last found
  std::string fault;
};

/// One client's standing queries: what it was told, and what there is to tell by now. It is told
/// once when a query is found and once when it is not any more; a client that is slow misses that a
/// thing came and went, never how things are. Thread-safe.
class StandingWatch {
 public:
  using Clock = std::chrono::steady_clock;

  /// `hold`: how long a verdict on a map that is being made must stand. `place`: kept as long as
  /// this.
  StandingWatch(std::vector<std::string> queries, Clock::duration hold,
                std::shared_ptr<void> place);

  const std::vector<std::string>& queries() const { return queries_; }

  /// What was told, four queries a hexadecimal digit, the first in the highest bit.
  std::string mark() const;
  /// Goes on where a mark was taken, of this watch or of one with the same queries. What is no such
  /// mark changes nothing.
  void go_on(const std::string& mark);

  /// Takes the latest verdicts, in the order of the queries; null: not known yet.
  void take(const std::vector<const StandingVerdict*>& verdicts, Clock::time_point now);
  /// Lets verdicts be told: of a finished map all, else those that have stood long enough.
  void settle(bool live, Clock::time_point now);
  /// Why nothing can be asked of this map; empty: it can.
  void take_fault(const std::string& fault);

  /// What there is to tell, which counts as told from then on.
  std::optional<StandingEvent> next();
  /// Calls `wake`, which must not wait, whenever there may be more to tell.
  void call(std::function<void()> wake);

 private:
  struct Entry {
    bool told = false, settled = false;  ///< found: as the client heard, and as it may hear
    bool found = false, known = false;   ///< as the map says; whether it was asked
    Clock::time_point since;             ///< when that last changed
    std::optional<StandingObject> last;  ///< the latest that was found
    std::string fault, fault_told;
  };
  void wake() const;

  const std::vector<std::string> queries_;
  const Clock::duration hold_;
  const std::shared_ptr<void> place_;
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::string fault_, fault_told_;
  std::function<void()> wake_;
};

}  // namespace ovimap
