// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <iostream>

#include "command.h"
#include "ovimap/base/text/printable.h"

namespace ovimap::apps {

namespace {
volatile std::sig_atomic_t interrupts_seen = 0, interrupts_taken = 1;

void on_interrupt(int signal) {
  interrupts_seen = signal == SIGTERM ? interrupts_taken : interrupts_seen + 1;
  if (interrupts_seen >= interrupts_taken) std::signal(signal, SIG_DFL);
}
}  // namespace

Progress::Progress(std::string what) : what_(std::move(what)), terminal_(isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (shown_) std::fputc('\n', stderr);
}

void Progress::show(std::size_t done, std::size_t total, const std::string& detail) {
  if (!terminal_) return;
  std::fprintf(stderr, "\r%s %zu/%zu %s\x1b[K", what_.c_str(), done, total, detail.c_str());
  std::fflush(stderr);
  shown_ = true;
}

void warn(std::string_view text) {
  constexpr std::size_t kLongest = 4000;
  const bool cut = text.size() > kLongest;
  std::fprintf(stderr, "ovimap: %s%s\n", printable(text.substr(0, kLongest)).c_str(),
               cut ? " ..." : "");
}

std::string json_text(const nlohmann::json& value) {
  // Paths and names may hold bytes that are no UTF-8; the rest is worth having all the same.
  return value.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_json(const nlohmann::json& value) {
  std::cout << json_text(value) << std::endl;
}

nlohmann::json stages_json(const StageTimers& timers) {
  nlohmann::json stages = nlohmann::json::object();
  for (const auto& [stage, summary] : timers.summary())
    stages[stage] = {{"p50_ms", summary.p50_ms},
                     {"p95_ms", summary.p95_ms},
                     {"p99_ms", summary.p99_ms},
                     {"count", summary.count}};
  return stages;
}

TileTraffic tile_traffic(const std::map<std::string, StageSummary>& stages) {
  const auto count = [&](const char* stage) {
    const auto found = stages.find(stage);
    return found == stages.end() ? 0 : found->second.count;
  };
  return {count("evict_tile"), count("load_tile")};
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

bool interrupted() {
  return interrupts_seen != 0;
}

bool interrupted_again() {
  return interrupts_seen > 1;
}

void watch_for_interrupt(int taken) {
  interrupts_taken = taken;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);  // who reads what is printed may go; what is mapped must not
}

}  // namespace ovimap::apps
