#pragma once  // SPDX-License-Identifier: MIT

#include <gst/rtsp-server/rtsp-server.h>

#include <memory>
#include <optional>
#include <string>

#include "examples/live/outputs/rtsp_door.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// rtsp://ADDRESS:PORT/live: H.264 with the ellipses drawn in. Encodes once for all clients, and
/// only while there is one.
class RtspOutput {
 public:
  struct Settings {
    std::string address = "127.0.0.1";
    int port = 8554;    ///< 0 = one that is free.
    std::string token;  ///< Password of the user "ellipse"; empty = none is asked for.
  };

  /// Throws std::runtime_error where it cannot listen there, or no encoder is installed.
  explicit RtspOutput(const Settings& settings);
  ~RtspOutput();
  RtspOutput(const RtspOutput&) = delete;
  RtspOutput& operator=(const RtspOutput&) = delete;

  /// Any thread; never waits for a client.
  void put(const FramePtr& frame);

  [[nodiscard]] int port() const { return door_->port(); }

 private:
  struct Inlets;

  static gboolean on_glance(gpointer data);

  void ask_for(const std::string& token, GstRTSPMediaFactory* factory);

  std::shared_ptr<Inlets> inlets_;  // also of media that outlive this in the server's threads
  Ref<GstRTSPServer> server_;
  guint glance_ = 0;
  std::optional<RtspDoor> door_;  // last: its clients go before what their media write to
};

}  // namespace live
