#pragma once  // SPDX-License-Identifier: MIT

#include <gst/video/video.h>

#include <optional>
#include <span>

#include "core/tracker.hpp"
#include "gst/ellipse/gstellipsemeta.h"

/// "detected", "tracked", "predicted"; "lost" where there is no target.
[[nodiscard]] const gchar* state_nick(const std::optional<ellipse::Target>& target);

/// Attaches a target to the buffer that it was found in. @return Owned by the buffer.
const GstEllipseMeta* attach_target_meta(GstBuffer* buffer,
                                         const ellipse::Target& target,
                                         const GstVideoInfo& info,
                                         GstClockTime processing_time);

/// Attaches all of these but the target, with the role "candidate".
void attach_candidate_metas(GstBuffer* buffer,
                            std::span<const ellipse::Detection> candidates,
                            const std::optional<ellipse::Target>& target,
                            const GstVideoInfo& info);

/// The standard metadata for a region of interest: the target's upright box inside the frame, with
/// the target's structure as its parameter. Nothing where no pixel of the box is inside.
void attach_roi_meta(GstBuffer* buffer, const GstEllipseMeta& meta);
