#pragma once  // SPDX-License-Identifier: MIT

#include <glib.h>

#include <functional>

namespace live {

/// Calls a function in the main loop, soon after any thread has asked for it. However often it is
/// asked before the loop gets there, it is called once: a slow loop is never flooded.
class Wakeup {
 public:
  explicit Wakeup(std::function<void()> action);
  ~Wakeup();
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  /// Any thread; never waits.
  void raise();

 private:
  static gboolean on_dispatch(gpointer data);

  std::function<void()> action_;
  GSource* source_;
};

}  // namespace live
