#pragma once  // SPDX-License-Identifier: MIT

#include <gio/gio.h>

#include <functional>
#include <span>

#include "examples/live/ref.hpp"

namespace live {

/// Looks at the bytes that a client has sent before a library parses them. Called for each piece,
/// in their order, in the thread that reads.
/// @return false where no more may be read.
using InputGuard = std::function<bool(std::span<const guint8>)>;

/// The same stream, whose input is behind a guard: it has ended where the guard says so, and the
/// piece that it refused is not handed on.
/// @param base  Its input has to be pollable. It is closed with the last reference to the result.
[[nodiscard]] Ref<GIOStream> guard_stream(Ref<GIOStream> base, InputGuard guard);

}  // namespace live
