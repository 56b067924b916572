#pragma once  // SPDX-License-Identifier: MIT

#include <deque>
#include <list>
#include <memory>

#include "examples/live/http/http_stream.hpp"
#include "examples/live/http/web_socket.hpp"
#include "examples/live/outputs/jpeg_encoder.hpp"
#include "examples/live/pipeline/frame_store.hpp"

namespace live {

/// A client that watches the video.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Whether another picture may be sent now.
  [[nodiscard]] virtual bool is_ready() const = 0;
  virtual void send(const Picture& picture) = 0;
  /// Called once a second. Disconnects a client that has read nothing for too long. Repeats a
  /// picture that a browser does not show yet.
  virtual void tick(const Picture& newest) = 0;

  static constexpr guint64 kNothing = G_MAXUINT64;
  guint64 last = kNothing;  ///< Number of the frame sent last.
};

/// Sends each viewer the newest frame whenever it is ready. A frame is encoded once for all
/// viewers, and only if a viewer is ready. Main loop only.
class VideoFeed {
 public:
  VideoFeed(FrameStore& store, int quality);
  ~VideoFeed();
  VideoFeed(const VideoFeed&) = delete;
  VideoFeed& operator=(const VideoFeed&) = delete;

  /// Sends binary messages of PTS and JPEG; the client answers {"ack":pts} after painting one.
  void add(std::unique_ptr<WebSocket> socket);
  /// Sends multipart/x-mixed-replace, for clients without WebSocket.
  void add_stream(SoupServerMessage* request);

  /// Sends or encodes the store's newest frame where needed.
  void update();

  [[nodiscard]] std::size_t viewers() const { return viewers_.size(); }
  [[nodiscard]] guint64 encoded() const { return encoder_.encoded(); }
  /// Quantile of the last 256 delays [ns] from a frame's arrival at the tracker to its
  /// acknowledgement; `share` 0.5 is the median. GST_CLOCK_TIME_NONE if there are none.
  [[nodiscard]] GstClockTime paint_delay(double share) const;
  [[nodiscard]] guint64 sent() const { return sent_; }
  [[nodiscard]] guint64 sent_bytes() const { return sent_bytes_; }

 private:
  static gboolean on_tick(gpointer data);
  void deliver(Picture picture);
  void send(Viewer& viewer);
  void remove(const Viewer* viewer);
  void add_paint_delay(gint64 delay_us);

  FrameStore& store_;
  JpegEncoder encoder_;
  Picture picture_;
  std::list<std::unique_ptr<Viewer>> viewers_;
  std::deque<GstClockTime> paint_delays_;
  guint tick_;
  guint64 sent_ = 0;
  guint64 sent_bytes_ = 0;
};

}  // namespace live
