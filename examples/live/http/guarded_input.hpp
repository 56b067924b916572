#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>

#include <functional>
#include <span>

#include "examples/live/ref.hpp"

namespace live {

/// Checks a client's bytes before a library parses them. Called for each piece in order, in the
/// reading thread.
/// @return false to end the stream.
using InputGuard = std::function<bool(std::span<const guint8>)>;

/// Wraps a stream so that its input passes a guard. When the guard rejects a piece, the piece is
/// dropped and the stream ends.
/// @param base  Its input must be pollable. Closed with the last reference to the result.
[[nodiscard]] Ref<GIOStream> guard_stream(Ref<GIOStream> base, InputGuard guard);

}  // namespace live
