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

/// A pipeline in gst-launch-1.0 syntax. Stopped by the destructor.
class Pipeline {
 public:
  /// Throws std::runtime_error if the line is invalid or an element is missing.
  explicit Pipeline(const std::string& line);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// The element with this name in the line.
  [[nodiscard]] Element element(const char* name) const;

  /// Throws std::runtime_error if an element cannot start.
  void play();

  /// Pushes a buffer into an appsrc when its queue has space. Takes ownership of the buffer.
  /// Throws std::runtime_error with the error that stopped the pipeline.
  void push(const Element& source, GstBuffer* buffer);

  /// Blocks for the next sample of an appsink.
  /// Throws std::runtime_error with the error that stopped the pipeline.
  [[nodiscard]] Sample pull(const Element& sink);

  /// Blocks until the end of the stream. Throws std::runtime_error on an error.
  void await_end();

 private:
  /// Throws std::runtime_error with the error that stopped the pipeline.
  [[noreturn]] void fail();
  [[nodiscard]] bool has_ended(GstClockTime patience);

  GstElement* pipeline_ = nullptr;
};

}  // namespace landing
