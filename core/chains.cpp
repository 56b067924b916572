// SPDX-License-Identifier: MIT
#include "core/chains.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

namespace ellipse {
namespace {

constexpr std::size_t kLeastLength = 10;     // pixels
constexpr std::size_t kLongestWalk = 16384;  // pixels
constexpr std::size_t kLeastClosed = 16;     // pixels
constexpr int kClosingGap = 3;               // pixels

// One walk along an edge, or against it, over crests that no chain has yet.
class Walk {
 public:
  Walk(GradientMap& map, bool is_forward)
      : crests_(map.crests()), gradients_(map.gradients()), turned_(is_forward ? 0 : 4) {
    const int stride = map.stride();
    steps_ = {1, stride + 1, stride, stride - 1, -1, -stride - 1, -stride, -stride + 1};
  }

  // The pixels after the seed, into `out`; how many.
  std::size_t run(std::int32_t seed, std::vector<std::int32_t>& out) {
    std::int32_t at = seed;
    direction_ = octant(crests_[seed]);
    std::size_t n = 0;
    while (n < kLongestWalk) {
      const std::int32_t next = next_of(at);
      if (next < 0) break;
      crests_[next] =
          static_cast<std::uint8_t>((crests_[next] & crest::kDirection) | crest::kVisited);
      out[n++] = next;
      at = next;
    }
    return n;
  }

 private:
  [[nodiscard]] int octant(std::uint8_t code) const {
    return (crest::octant_of(code) + turned_) & 7;
  }

  // Whether a walk may go on at a pixel: a free crest whose edge turns by an eighth at most.
  [[nodiscard]] bool is_open(std::int32_t pixel) const {
    const std::uint8_t code = crests_[pixel];
    if ((code & crest::kFree) == 0) return false;
    return ((octant(code) - direction_ + 1) & 7) <= 2;
  }

  [[nodiscard]] int strength(std::int32_t pixel) const {
    return std::abs(gradients_[pixel].x) + std::abs(gradients_[pixel].y);
  }

  // Straight on, else to the stronger side, else over a gap of one pixel. -1: the end.
  std::int32_t next_of(std::int32_t at) {
    const std::int32_t ahead = at + steps_[direction_];
    const std::int32_t right = at + steps_[(direction_ + 1) & 7];
    const std::int32_t left = at + steps_[(direction_ + 7) & 7];
    if (is_open(ahead)) return turn_to(ahead);
    const bool has_right = is_open(right);
    const bool has_left = is_open(left);
    if (has_right && has_left) return turn_to(strength(right) >= strength(left) ? right : left);
    if (has_right) return turn_to(right);
    if (has_left) return turn_to(left);
    for (const std::int32_t step :
         {steps_[direction_], steps_[(direction_ + 1) & 7], steps_[(direction_ + 7) & 7]}) {
      if (is_open(ahead + step)) return turn_to(ahead + step);
    }
    return -1;
  }

  std::int32_t turn_to(std::int32_t pixel) {
    direction_ = octant(crests_[pixel]);
    return pixel;
  }

  std::uint8_t* crests_;
  const Gradient* gradients_;
  int turned_;
  std::array<std::int32_t, 8> steps_;
  int direction_ = 0;
};

bool are_near(std::int32_t a, std::int32_t b, int stride) {
  return std::abs(a % stride - b % stride) <= kClosingGap &&
         std::abs(a / stride - b / stride) <= kClosingGap;
}

// Calls use(index) for each free crest, eight pixels at a look.
template <class Use>
void for_each_free(const GradientMap& map, const Use& use) {
  constexpr std::uint64_t kAllFree = 0x0101010101010101U * crest::kFree;
  const std::uint8_t* crests = map.crests();
  const std::int32_t pixels = map.stride() * map.height();
  for (std::int32_t begin = 0; begin < pixels; begin += 8) {
    std::uint64_t codes = 0;
    std::memcpy(&codes, crests + begin, sizeof codes);
    if ((codes & kAllFree) == 0) continue;
    for (std::int32_t i = begin; i < begin + 8; ++i) {
      if ((crests[i] & crest::kFree) != 0 && !use(i)) return;
    }
  }
}

}  // namespace

void ChainTracer::add_chain(std::int32_t seed, GradientMap& map) {
  std::uint8_t* crests = map.crests();
  crests[seed] = static_cast<std::uint8_t>((crests[seed] & crest::kDirection) | crest::kVisited);
  const std::size_t after = Walk(map, true).run(seed, forward_);
  const std::size_t before = Walk(map, false).run(seed, backward_);
  const std::size_t length = before + 1 + after;
  if (length < kLeastLength) return;
  std::int32_t* out = pixels_.data() + count_;
  out = std::reverse_copy(backward_.begin(), backward_.begin() + std::ptrdiff_t(before), out);
  *out++ = seed;
  out = std::copy(forward_.begin(), forward_.begin() + std::ptrdiff_t(after), out);
  for (std::int32_t* pixel = out - length; pixel != out; ++pixel) {
    crests[*pixel] |= crest::kChained;
  }
  count_ += length;
  begins_.push_back(count_);
  is_closed_.push_back(length > kLeastClosed &&
                       are_near(*(out - length), *(out - 1), map.stride()));
}

void ChainTracer::trace(GradientMap& map) {
  const auto pixels =
      static_cast<std::size_t>(map.stride()) * static_cast<std::size_t>(map.height());
  const std::size_t most = pixels / 4 + 64;
  forward_.resize(kLongestWalk);
  backward_.resize(kLongestWalk);
  pixels_.resize(most + 2 * kLongestWalk + 1);
  count_ = 0;
  begins_.assign(1, 0);
  is_closed_.clear();
  for_each_free(map, [&](std::int32_t pixel) {
    add_chain(pixel, map);
    return count_ < most;
  });
}

Chain ChainTracer::chain(std::size_t i) const {
  return {pixels().subspan(begins_[i], begins_[i + 1] - begins_[i]), is_closed_[i] != 0};
}

}  // namespace ellipse
