#pragma once  // SPDX-License-Identifier: MIT

#include <gst/gst.h>

#include <memory>

namespace live {

/// Releases objects of GLib, GStreamer and libsoup.
struct Release {
  void operator()(GstSample* sample) const { gst_sample_unref(sample); }
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
  void operator()(GstCaps* caps) const { gst_caps_unref(caps); }
  void operator()(GstStructure* structure) const { gst_structure_free(structure); }
  void operator()(GBytes* bytes) const { g_bytes_unref(bytes); }
  void operator()(GSource* source) const { g_source_unref(source); }
  void operator()(GError* error) const { g_error_free(error); }
  void operator()(gchar* text) const { g_free(text); }
  void operator()(guchar* bytes) const { g_free(bytes); }
  template <class Object>
  void operator()(Object* object) const {
    g_object_unref(object);
  }
};

/// Owns one reference.
template <class T>
using Ref = std::unique_ptr<T, Release>;

/// Returns a new reference to a GObject.
template <class T>
[[nodiscard]] Ref<T> share(T* object) {
  return Ref<T>(static_cast<T*>(g_object_ref(object)));
}

}  // namespace live
