// SPDX-FileCopyrightText: 2026 The ovimap authors
// SPDX-License-Identifier: Apache-2.0
#include "serve_live.h"

#include <thread>

#include "apps/command/save_again.h"
#include "ovimap/io/map_file/map_file.h"
#include "ovimap/server/served/live_feed.h"

namespace ovimap::apps {

namespace {

constexpr std::chrono::milliseconds kLook{50};  // between looks at what was interrupted

/// Serves the map of a live run from its first frame on.
class Service : public LiveAudience {
 public:
  Service(const LiveService& options, const Announce& announce)
      : options_(options), announce_(announce) {}

  void begin(const MapperConfig& config, const EncoderIdentity& encoder,
             const std::map<InstanceId, std::string>& names, const MapEdits& edits) override {
    FoundMap begun;
    begun.record.names = names;
    begun.record.edits = edits;
    begun.record.semantics.encoder = encoder;
    begun.info.voxel_size_m = config.map.voxel_size_m;
    map_ = std::make_unique<ServedMap>(options_.target.map, std::move(begun), options_.served);
    server_ = std::make_unique<ServerThread>(*map_, options_.server,
                                             options_.camera ? nullptr : options_.intake);
    feed_ = std::make_unique<LiveFeed>(*map_);
    announce_(server_->server());
  }
  void after_frame(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                   const PinholeCamera& depth_camera) override {
    feed_->after_frame(mapper, frames, depth_camera);
  }
  void while_waiting(Mapper& mapper, const std::vector<FrameLogEntry>& frames,
                     const PinholeCamera& depth_camera) override {
    feed_->while_waiting(mapper, frames, depth_camera);
  }
  void after_tracking(const TrackedFrame& frame) override { feed_->after_tracking(frame); }
  MapEdits edits() const override { return map_->snapshot()->record->edits; }
  MapEdits end() override {
    feed_.reset();
    return map_->close_log();
  }

  void saved(std::size_t loops) {
    map_->saved();
    if (loops > 0) map_->loops_closed(loops);
  }
  void serve_on() {
    while (!interrupted() && server_->runs()) std::this_thread::sleep_for(kLook);
  }

 private:
  const LiveService& options_;
  const Announce& announce_;
  std::unique_ptr<ServedMap> map_;
  std::unique_ptr<ServerThread> server_;
  std::unique_ptr<LiveFeed> feed_;
};

}  // namespace

ServerThread::ServerThread(ServedMap& map, const ServerConfig& config, FrameIntake* intake)
    : server_(map, config, intake),
      running_(std::async(std::launch::async, [this] { server_.run(); })) {}

ServerThread::~ServerThread() {
  while (running_.valid() && running_.wait_for(kLook) != std::future_status::ready) server_.stop();
}

bool ServerThread::runs() {
  if (running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return true;
  running_.get();
  return false;
}

void LiveService::run(const Announce& announce,
                      const std::function<void(const MappingRun&)>& saved) const {
  check_map_target(target.map);
  Service service(*this, announce);
  MappingRun mapped = map_live(mapping, fps, target, &service, intake, camera);
  save_again(target.continued, target.map, mapped.document);
  saved(mapped);
  const std::size_t loops = mapped.tracking ? mapped.tracking->loops.closed : 0;
  mapped.document = MapDocument();  // what is served from here on is the file
  mapped.checkpoints->remove();
  if (interrupted()) return;
  service.saved(loops);
  service.serve_on();
}

}  // namespace ovimap::apps
