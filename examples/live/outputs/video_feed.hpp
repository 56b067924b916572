#pragma once  // SPDX-License-Identifier: MIT

#include <deque>
#include <list>
#include <memory>

#include "examples/live/http/http_stream.hpp"
#include "examples/live/http/web_socket.hpp"
#include "examples/live/outputs/jpeg_encoder.hpp"
#include "examples/live/pipeline/frame_store.hpp"

namespace live {

/// Somebody who watches the video.
class Viewer {
 public:
  virtual ~Viewer() = default;
  /// Whether another picture may be sent now.
  [[nodiscard]] virtual bool is_ready() const = 0;
  virtual void send(const Picture& picture) = 0;
  /// Once a second: ends what has taken nothing for long, sends again what is not shown yet.
  virtual void take_glance(const Picture& newest) = 0;

  static constexpr guint64 kNothing = G_MAXUINT64;
  guint64 last = kNothing;  ///< The number of the frame that it was sent last.
};

/// Sends each viewer the newest frame whenever it can take one. A frame is encoded once for all of
/// them, and only where one of them is ready for it: no viewer, no encoding. For the main loop's
/// thread.
class VideoFeed {
 public:
  VideoFeed(FrameStore& store, int quality);
  ~VideoFeed();
  VideoFeed(const VideoFeed&) = delete;
  VideoFeed& operator=(const VideoFeed&) = delete;

  /// Binary messages of PTS and JPEG; the client answers {"ack":pts} when it has painted one.
  void add(std::unique_ptr<WebSocket> socket);
  /// multipart/x-mixed-replace, for what knows no WebSocket.
  void add_stream(SoupServerMessage* request);

  /// Looks at what is new in the store.
  void update();

  [[nodiscard]] std::size_t viewers() const { return viewers_.size(); }
  [[nodiscard]] guint64 encoded() const { return encoder_.encoded(); }
  /// From a frame's arrival at the tracker until a viewer had painted it and said so, of the last
  /// 256 [ns]: `share` 0.5 = the median. NONE where there were none.
  [[nodiscard]] GstClockTime paint_delay(double share) const;
  [[nodiscard]] guint64 sent() const { return sent_; }
  [[nodiscard]] guint64 sent_bytes() const { return sent_bytes_; }

 private:
  static gboolean on_glance(gpointer data);
  void deliver(Picture picture);
  void send(Viewer& viewer);
  void remove(const Viewer* viewer);
  void note_painted(gint64 delay_us);

  FrameStore& store_;
  JpegEncoder encoder_;
  Picture picture_;
  std::list<std::unique_ptr<Viewer>> viewers_;
  std::deque<GstClockTime> paint_delays_;
  guint glance_;
  guint64 sent_ = 0;
  guint64 sent_bytes_ = 0;
};

}  // namespace live
