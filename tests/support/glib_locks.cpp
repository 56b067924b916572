// SPDX-License-Identifier: MIT
//
// Tells ThreadSanitizer about GLib's mutexes. GLib builds them on futexes and is not instrumented,
// so the data that they guard would look unguarded. These functions replace GLib's and call them.
// Calls inside GLib bypass them; its asynchronous queues, which carry GstHarness's buffers, are
// therefore reported too.
#include <dlfcn.h>
#include <glib.h>
#include <sanitizer/tsan_interface.h>

namespace {

template <class Function>
Function* next(Function*, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void lets_go_of(GMutex* mutex) {
  __tsan_mutex_pre_unlock(mutex, 0);
  __tsan_mutex_post_unlock(mutex, 0);
}

void holds(GMutex* mutex, unsigned flags = 0) {
  __tsan_mutex_pre_lock(mutex, flags);
  __tsan_mutex_post_lock(mutex, flags, 0);
}

gpointer taken_from(GAsyncQueue* queue, gpointer data) {
  if (data != nullptr) __tsan_acquire(queue);
  return data;
}

}  // namespace

extern "C" {

void g_mutex_lock(GMutex* mutex) {
  static auto* const kNext = next(&g_mutex_lock, "g_mutex_lock");
  __tsan_mutex_pre_lock(mutex, 0);
  kNext(mutex);
  __tsan_mutex_post_lock(mutex, 0, 0);
}

gboolean g_mutex_trylock(GMutex* mutex) {
  static auto* const kNext = next(&g_mutex_trylock, "g_mutex_trylock");
  const gboolean is_locked = kNext(mutex);
  if (is_locked != FALSE) holds(mutex, __tsan_mutex_try_lock);
  return is_locked;
}

void g_mutex_unlock(GMutex* mutex) {
  static auto* const kNext = next(&g_mutex_unlock, "g_mutex_unlock");
  __tsan_mutex_pre_unlock(mutex, 0);
  kNext(mutex);
  __tsan_mutex_post_unlock(mutex, 0);
}

void g_mutex_clear(GMutex* mutex) {
  static auto* const kNext = next(&g_mutex_clear, "g_mutex_clear");
  __tsan_mutex_destroy(mutex, 0);
  kNext(mutex);
}

void g_cond_wait(GCond* cond, GMutex* mutex) {
  static auto* const kNext = next(&g_cond_wait, "g_cond_wait");
  lets_go_of(mutex);
  kNext(cond, mutex);
  holds(mutex);
}

gboolean g_cond_wait_until(GCond* cond, GMutex* mutex, gint64 end_time) {
  static auto* const kNext = next(&g_cond_wait_until, "g_cond_wait_until");
  lets_go_of(mutex);
  const gboolean is_woken = kNext(cond, mutex, end_time);
  holds(mutex);
  return is_woken;
}

void g_async_queue_push(GAsyncQueue* queue, gpointer data) {
  static auto* const kNext = next(&g_async_queue_push, "g_async_queue_push");
  __tsan_release(queue);
  kNext(queue, data);
}

gpointer g_async_queue_pop(GAsyncQueue* queue) {
  static auto* const kNext = next(&g_async_queue_pop, "g_async_queue_pop");
  return taken_from(queue, kNext(queue));
}

gpointer g_async_queue_try_pop(GAsyncQueue* queue) {
  static auto* const kNext = next(&g_async_queue_try_pop, "g_async_queue_try_pop");
  return taken_from(queue, kNext(queue));
}

gpointer g_async_queue_timeout_pop(GAsyncQueue* queue, guint64 timeout) {
  static auto* const kNext = next(&g_async_queue_timeout_pop, "g_async_queue_timeout_pop");
  return taken_from(queue, kNext(queue, timeout));
}

}  // extern "C"
