#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "examples/evaluate/method.hpp"

namespace evaluate {

/// The packaged trackers of boxes that ours is measured against: "kcf" and "csrt".
[[nodiscard]] std::span<const char* const> box_peer_names();

/// One of them, with OpenCV's defaults. It cannot find a target, so it is given one: the truth's
/// box in the first frame that shows at least kLeastToStart of the perimeter, and again after it
/// reported a loss. Its ellipse is the one that it was given, moved and scaled by the box.
///
/// A time is that of its update alone; the frames that are given have none. No content of a picture
/// throws: where OpenCV does, that is a loss. Throws std::invalid_argument that names the peer,
/// where it is unknown.
[[nodiscard]] std::unique_ptr<Method> make_box_method(std::string_view name);

}  // namespace evaluate
