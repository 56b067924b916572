// SPDX-License-Identifier: MIT
#include "examples/live/http/guarded_input.hpp"

#include <utility>

namespace live {
namespace {

struct GuardedInput {
  GFilterInputStream parent;
  InputGuard* guard;
  bool has_ended;
};

struct GuardedInputClass {
  GFilterInputStreamClass parent;
};

void guarded_input_pollable_init(GPollableInputStreamInterface* interface);

G_DEFINE_TYPE_WITH_CODE(GuardedInput,
                        guarded_input,
                        G_TYPE_FILTER_INPUT_STREAM,
                        G_IMPLEMENT_INTERFACE(G_TYPE_POLLABLE_INPUT_STREAM,
                                              guarded_input_pollable_init))

GuardedInput* guarded(gpointer stream) {
  return reinterpret_cast<GuardedInput*>(stream);
}

GInputStream* base_of(gpointer stream) {
  return g_filter_input_stream_get_base_stream(G_FILTER_INPUT_STREAM(stream));
}

// Returns 0 (end of stream) if the guard rejects the bytes.
gssize passed(GuardedInput* self, const void* buffer, gssize size) {
  if (size <= 0) return size;
  const auto* bytes = static_cast<const guint8*>(buffer);
  self->has_ended = !(*self->guard)({bytes, static_cast<std::size_t>(size)});
  return self->has_ended ? 0 : size;
}

gssize guarded_input_read(
    GInputStream* stream, void* buffer, gsize count, GCancellable* cancellable, GError** error) {
  GuardedInput* self = guarded(stream);
  if (self->has_ended) return 0;
  return passed(
      self, buffer, g_input_stream_read(base_of(stream), buffer, count, cancellable, error));
}

gssize guarded_input_read_nonblocking(GPollableInputStream* stream,
                                      void* buffer,
                                      gsize count,
                                      GError** error) {
  GuardedInput* self = guarded(stream);
  if (self->has_ended) return 0;
  GPollableInputStream* base = G_POLLABLE_INPUT_STREAM(base_of(stream));
  return passed(
      self, buffer, g_pollable_input_stream_read_nonblocking(base, buffer, count, nullptr, error));
}

gboolean guarded_input_is_readable(GPollableInputStream* stream) {
  return guarded(stream)->has_ended ||
         g_pollable_input_stream_is_readable(G_POLLABLE_INPUT_STREAM(base_of(stream)));
}

GSource* guarded_input_create_source(GPollableInputStream* stream, GCancellable* cancellable) {
  const Ref<GSource> base(guarded(stream)->has_ended
                              ? g_timeout_source_new(0)
                              : g_pollable_input_stream_create_source(
                                    G_POLLABLE_INPUT_STREAM(base_of(stream)), nullptr));
  return g_pollable_source_new_full(stream, base.get(), cancellable);
}

void guarded_input_finalize(GObject* object) {
  delete guarded(object)->guard;
  G_OBJECT_CLASS(guarded_input_parent_class)->finalize(object);
}

void guarded_input_init(GuardedInput* /*self*/) {}

void guarded_input_class_init(GuardedInputClass* type) {
  G_OBJECT_CLASS(type)->finalize = guarded_input_finalize;
  G_INPUT_STREAM_CLASS(type)->read_fn = guarded_input_read;
}

void guarded_input_pollable_init(GPollableInputStreamInterface* interface) {
  interface->is_readable = guarded_input_is_readable;
  interface->read_nonblocking = guarded_input_read_nonblocking;
  interface->create_source = guarded_input_create_source;
}

Ref<GInputStream> guard_input(GInputStream* base, InputGuard guard) {
  auto* self = guarded(g_object_new(
      guarded_input_get_type(), "base-stream", base, "close-base-stream", TRUE, nullptr));
  self->guard = new InputGuard(std::move(guard));
  return Ref<GInputStream>(G_INPUT_STREAM(self));
}

}  // namespace

Ref<GIOStream> guard_stream(Ref<GIOStream> base, InputGuard guard) {
  const Ref<GInputStream> input =
      guard_input(g_io_stream_get_input_stream(base.get()), std::move(guard));
  Ref<GIOStream> result(
      g_simple_io_stream_new(input.get(), g_io_stream_get_output_stream(base.get())));
  g_object_set_data_full(G_OBJECT(result.get()), "live-base", base.release(), g_object_unref);
  return result;
}

}  // namespace live
