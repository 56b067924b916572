// SPDX-License-Identifier: MIT
#include "examples/live/pipeline/wakeup.hpp"

#include <utility>

namespace live {
namespace {

gboolean dispatch(GSource* source, GSourceFunc callback, gpointer data) {
  g_source_set_ready_time(source, -1);  // before the call, which may request the next one
  return callback(data);
}

GSourceFuncs kFuncs = {nullptr, nullptr, dispatch, nullptr, nullptr, nullptr};

}  // namespace

Wakeup::Wakeup(std::function<void()> action)
    : action_(std::move(action)), source_(g_source_new(&kFuncs, sizeof(GSource))) {
  g_source_set_callback(source_, on_dispatch, this, nullptr);
  g_source_attach(source_, nullptr);
}

Wakeup::~Wakeup() {
  g_source_destroy(source_);
  g_source_unref(source_);
}

void Wakeup::raise() {
  g_source_set_ready_time(source_, 0);
}

gboolean Wakeup::on_dispatch(gpointer data) {
  static_cast<Wakeup*>(data)->action_();
  return G_SOURCE_CONTINUE;
}

}  // namespace live
