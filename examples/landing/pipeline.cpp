// SPDX-License-Identifier: MIT
#include "examples/landing/pipeline.hpp"

#include <stdexcept>

namespace landing {
namespace {

constexpr GstClockTime kPatience = 60 * GST_SECOND;

[[noreturn]] void raise(GError* error) {
  const std::runtime_error failure(error->message);
  g_error_free(error);
  throw failure;
}

}  // namespace

Pipeline::Pipeline(const std::string& line) {
  GError* error = nullptr;
  pipeline_ = gst_parse_launch_full(line.c_str(), nullptr, GST_PARSE_FLAG_FATAL_ERRORS, &error);
  if (error != nullptr) raise(error);
}

Pipeline::~Pipeline() {
  gst_element_set_state(pipeline_, GST_STATE_NULL);
  gst_object_unref(pipeline_);
}

Element Pipeline::element(const char* name) const {
  return Element(gst_bin_get_by_name(GST_BIN(pipeline_), name));
}

void Pipeline::play() {
  gst_element_set_state(pipeline_, GST_STATE_PLAYING);
}

void Pipeline::await_end() {
  GstBus* bus = gst_element_get_bus(pipeline_);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, kPatience, static_cast<GstMessageType>(GST_MESSAGE_EOS | GST_MESSAGE_ERROR));
  gst_object_unref(bus);
  if (message == nullptr) throw std::runtime_error("the pipeline does not end");
  GError* error = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message, &error, nullptr);
  }
  gst_message_unref(message);
  if (error != nullptr) raise(error);
}

void Pipeline::fail() {
  await_end();
  throw std::runtime_error("the pipeline has ended");
}

}  // namespace landing
