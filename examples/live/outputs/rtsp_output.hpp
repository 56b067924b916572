#pragma once  // SPDX-License-Identifier: MIT

#include <gst/rtsp-server/rtsp-server.h>

#include <memory>
#include <optional>
#include <string>

#include "examples/live/outputs/rtsp_proxy.hpp"
#include "examples/live/pipeline/frame.hpp"

namespace live {

/// Serves rtsp://ADDRESS:PORT/live: H.264 with the ellipses drawn in. Encodes once for all clients,
/// and only while there are clients.
class RtspOutput {
 public:
  struct Settings {
    std::string address = "127.0.0.1";
    int port = 8554;    ///< 0 = any free port.
    std::string token;  ///< Password of the user "ellipse"; empty = none required.
  };

  /// Throws std::runtime_error if it cannot listen or no H.264 encoder is installed.
  explicit RtspOutput(const Settings& settings);
  ~RtspOutput();
  RtspOutput(const RtspOutput&) = delete;
  RtspOutput& operator=(const RtspOutput&) = delete;

  /// Thread-safe; never blocks on a client.
  void put(const FramePtr& frame);

  [[nodiscard]] int port() const { return proxy_->port(); }

 private:
  struct Inlets;

  static gboolean on_tick(gpointer data);

  void require_token(const std::string& token, GstRTSPMediaFactory* factory);

  std::shared_ptr<Inlets> inlets_;  // shared with media that the server's threads destroy later
  Ref<GstRTSPServer> server_;
  guint tick_ = 0;
  std::optional<RtspProxy> proxy_;  // last: destroyed before the inlets and the server
};

}  // namespace live
