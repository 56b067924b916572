#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <functional>

namespace live {

/// Calls a function in the main loop at the request of any thread. Requests that arrive before the
/// loop handles them share one call, so a slow loop is not flooded.
class Wakeup {
 public:
  explicit Wakeup(std::function<void()> action);
  ~Wakeup();
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  /// Thread-safe; never blocks.
  void raise();

 private:
  static gboolean on_dispatch(gpointer data);

  std::function<void()> action_;
  GSource* source_;
};

}  // namespace live
