#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <memory>
#include <string>

namespace landing {

struct ElementDeleter {
  void operator()(GstElement* element) const { gst_object_unref(element); }
};
using Element = std::unique_ptr<GstElement, ElementDeleter>;

struct SampleDeleter {
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
};
using Sample = std::unique_ptr<GstSample, SampleDeleter>;

/// A pipeline written as for gst-launch-1.0. It stops with this object.
class Pipeline {
 public:
  /// Throws std::runtime_error where it cannot be made.
  explicit Pipeline(const std::string& line);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// The element that the line gives this name.
  [[nodiscard]] Element element(const char* name) const;

  /// Throws std::runtime_error where an element cannot start.
  void play();

  /// Hands a buffer to an appsrc as soon as few are queued there. Takes the buffer.
  /// Throws the std::runtime_error of what has stopped the pipeline.
  void push(const Element& source, GstBuffer* buffer);

  /// Waits for what an appsink is handed.
  /// Throws the std::runtime_error of what has stopped the pipeline.
  [[nodiscard]] Sample pull(const Element& sink);

  /// Waits for the end of the stream. Throws std::runtime_error where it ends otherwise.
  void await_end();

 private:
  /// Throws the std::runtime_error of what has stopped it.
  [[noreturn]] void fail();
  [[nodiscard]] bool has_ended(GstClockTime patience);

  GstElement* pipeline_ = nullptr;
};

}  // namespace landing
