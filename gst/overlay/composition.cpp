// SPDX-License-Identifier: MIT
#include "gst/overlay/composition.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <utility>
#include <vector>

namespace {

// Sinks upload each rectangle separately: few rectangles, none of them mostly empty.
constexpr int kBlockSize = 256;
static_assert(kBlockSize % Canvas::kTileSize == 0);

struct Block {
  std::vector<const Canvas::Tile*> tiles;
  int left = G_MAXINT;
  int top = G_MAXINT;
  int right = 0;
  int bottom = 0;

  void add(const Canvas::Tile& tile) {
    tiles.push_back(&tile);
    for (int row = 0; row < Canvas::kTileSize; ++row) {
      const Canvas::Span& span = tile.drawn[static_cast<std::size_t>(row)];
      if (span.begin >= span.end) continue;
      left = std::min(left, tile.x + span.begin);
      right = std::max(right, tile.x + span.end);
      top = std::min(top, tile.y + row);
      bottom = std::max(bottom, tile.y + row + 1);
    }
  }
};

using Blocks = std::map<std::pair<int, int>, Block>;

Blocks blocks_of(const Canvas& canvas) {
  Blocks blocks;
  for (const auto& tile : canvas.tiles()) {
    blocks[{tile->y / kBlockSize, tile->x / kBlockSize}].add(*tile);
  }
  return blocks;
}

void copy_pixels(const Block& block, guint8* to) {
  const std::ptrdiff_t stride = std::ptrdiff_t{4} * (block.right - block.left);
  for (const Canvas::Tile* tile : block.tiles) {
    for (int row = 0; row < Canvas::kTileSize; ++row) {
      const Canvas::Span& span = tile->drawn[static_cast<std::size_t>(row)];
      if (span.begin >= span.end) continue;
      std::memcpy(to + (tile->y + row - block.top) * stride +
                      std::ptrdiff_t{4} * (tile->x + span.begin - block.left),
                  &tile->pixels[Canvas::Tile::index(span.begin, row)],
                  4U * static_cast<std::size_t>(span.end - span.begin));
    }
  }
}

GstVideoOverlayRectangle* rectangle_of(const Block& block) {
  const auto width = static_cast<guint>(block.right - block.left);
  const auto height = static_cast<guint>(block.bottom - block.top);
  const gsize size = gsize{4} * width * height;
  GstBuffer* pixels = gst_buffer_new_wrapped(g_malloc0(size), size);
  GstMapInfo map;
  gst_buffer_map(pixels, &map, GST_MAP_WRITE);
  copy_pixels(block, map.data);
  gst_buffer_unmap(pixels, &map);
  gst_buffer_add_video_meta(
      pixels, GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_OVERLAY_COMPOSITION_FORMAT_RGB, width, height);
  GstVideoOverlayRectangle* rectangle =
      gst_video_overlay_rectangle_new_raw(pixels,
                                          block.left,
                                          block.top,
                                          width,
                                          height,
                                          GST_VIDEO_OVERLAY_FORMAT_FLAG_PREMULTIPLIED_ALPHA);
  gst_buffer_unref(pixels);
  return rectangle;
}

}  // namespace

void attach_composition(GstBuffer* buffer, const Canvas& canvas) {
  const Blocks blocks = blocks_of(canvas);
  GstVideoOverlayCompositionMeta* below = gst_buffer_get_video_overlay_composition_meta(buffer);
  GstVideoOverlayComposition* composition = below != nullptr
                                                ? gst_video_overlay_composition_copy(below->overlay)
                                                : gst_video_overlay_composition_new(nullptr);
  for (const auto& [position, block] : blocks) {
    if (block.left >= block.right) continue;
    GstVideoOverlayRectangle* rectangle = rectangle_of(block);
    gst_video_overlay_composition_add_rectangle(composition, rectangle);
    gst_video_overlay_rectangle_unref(rectangle);
  }
  if (below != nullptr) {
    gst_video_overlay_composition_unref(std::exchange(below->overlay, composition));
  } else {
    if (gst_video_overlay_composition_n_rectangles(composition) > 0) {
      gst_buffer_add_video_overlay_composition_meta(buffer, composition);
    }
    gst_video_overlay_composition_unref(composition);
  }
}
