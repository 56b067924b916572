// SPDX-License-Identifier: MIT
#include "core/edges/chains.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>

namespace ellipse {
namespace {

constexpr int kClosingGap = 3;  // between the ends of a closed chain [pixels]

// For each octant of an edge, the codes that may follow, as a bit set: free gradient maxima whose
// edge direction differs by at most one octant.
constexpr std::array<std::uint32_t, 8> kOpen = [] {
  std::array<std::uint32_t, 8> open{};
  for (unsigned octant = 0; octant < 8; ++octant) {
    for (const unsigned turn : {7U, 0U, 1U}) {
      open[octant] |= 1U << (maximum::kFree | ((octant + turn) & maximum::kOctant));
    }
  }
  return open;
}();

}  // namespace

// Walks along an edge, or against it, over unvisited gradient maxima.
class ChainTracer::Walk {
 public:
  Walk(GradientMap& map, bool is_forward) : maxima_(map.maxima()), gradients_(map.gradients()) {
    const int stride = map.stride();
    const std::array<std::int32_t, 8> steps = {
        1, stride + 1, stride, stride - 1, -1, -stride - 1, -stride, -stride + 1};
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      steps_[k] = steps[(k + (is_forward ? 7U : 3U)) & 7U];
    }
  }

  // Writes the pixels after the seed to [out, last); returns their end.
  std::int32_t* run(std::int32_t seed, std::int32_t* out, const std::int32_t* last) const {
    std::int32_t at = seed;
    unsigned octant = maxima_[seed] & maximum::kOctant;
    while (out != last) {
      at = next_of(at, octant);
      if (at < 0) break;
      const unsigned code = maxima_[at];
      octant = code & maximum::kOctant;
      maxima_[at] = static_cast<std::uint8_t>(octant | maximum::kChained);
      *out++ = at;
    }
    return out;
  }

 private:
  // Whether a pixel's code is in the bit set `open`.
  [[nodiscard]] bool is_open(std::int32_t pixel, std::uint32_t open) const {
    return ((open >> (maxima_[pixel] & (maximum::kFree | maximum::kOctant))) & 1U) != 0;
  }

  [[nodiscard]] int strength(std::int32_t pixel) const {
    return std::abs(gradients_[pixel].x) + std::abs(gradients_[pixel].y);
  }

  // Prefers straight ahead, then the stronger side, then a gap of one pixel. -1 at the end.
  [[nodiscard]] std::int32_t next_of(std::int32_t at, unsigned octant) const {
    const std::uint32_t open = kOpen[octant];
    const std::int32_t ahead = at + steps_[octant + 1U];
    if (is_open(ahead, open)) return ahead;
    const std::int32_t left = at + steps_[octant];
    const std::int32_t right = at + steps_[octant + 2U];
    const bool has_right = is_open(right, open);
    if (is_open(left, open)) return has_right && strength(right) >= strength(left) ? right : left;
    if (has_right) return right;
    for (const std::size_t side : {1U, 2U, 0U}) {
      const std::int32_t beyond = ahead + steps_[octant + side];
      if (is_open(beyond, open)) return beyond;
    }
    return -1;
  }

  std::uint8_t* maxima_;
  const Gradient* gradients_;
  std::array<std::int32_t, 10> steps_;  // from k on: left of octant k, ahead, right
};

namespace {

bool are_near(std::int32_t a, std::int32_t b, int stride) {
  return std::abs(a % stride - b % stride) <= kClosingGap &&
         std::abs(a / stride - b / stride) <= kClosingGap;
}

// Calls use(index) for each unvisited seed until it returns false. Skips words of eight pixels
// without seeds, which are most of them.
template <class Use>
void for_each_seed(const GradientMap& map, const Use& use) {
  constexpr std::uint64_t kAllSeeds = 0x0101010101010101U * maximum::kSeed;
  const std::uint8_t* maxima = map.maxima();
  for (const std::int32_t block : map.blocks()) {
    std::array<std::uint64_t, GradientMap::kBlock / sizeof(std::uint64_t)> words;
    std::memcpy(words.data(), maxima + block, sizeof words);
    std::int32_t i = block;
    for (const std::uint64_t word : words) {
      const std::int32_t end = i + static_cast<std::int32_t>(sizeof word);
      if ((word & kAllSeeds) == 0) i = end;
      for (; i < end; ++i) {
        if ((maxima[i] & maximum::kSeed) != 0 && !use(i)) return;
      }
    }
  }
}

}  // namespace

// Walks against the edge first and reverses these pixels, so that the walk along it follows them.
void ChainTracer::add_chain(std::int32_t seed,
                            std::uint8_t* maxima,
                            const Walk& against,
                            const Walk& along) {
  maxima[seed] = static_cast<std::uint8_t>((maxima[seed] & maximum::kOctant) | maximum::kChained);
  std::int32_t* const begin = pixels_.data() + count_;
  const std::int32_t* const last = pixels_.data() + pixels_.size();
  std::int32_t* out = against.run(seed, begin, last - 1);
  std::reverse(begin, out);
  *out++ = seed;
  out = along.run(seed, out, last);
  const auto length = static_cast<std::size_t>(out - begin);
  if (length < kMinLength) {
    for (const std::int32_t* pixel = begin; pixel != out; ++pixel) {
      maxima[*pixel] &= maximum::kOctant;
    }
    return;
  }
  count_ += length;
  begins_.push_back(count_);
  is_closed_.push_back(are_near(*begin, *(out - 1), stride_));
}

void ChainTracer::reserve(std::size_t chains) {
  begins_.reserve(chains + 1);
  is_closed_.reserve(chains);
}

void ChainTracer::trace(GradientMap& map) {
  const auto pixels =
      static_cast<std::size_t>(map.stride()) * static_cast<std::size_t>(map.height());
  pixels_.resize(pixels / 4 + 64);
  count_ = 0;
  begins_.assign(1, 0);
  is_closed_.clear();
  stride_ = map.stride();
  const Walk against(map, false);
  const Walk along(map, true);
  for_each_seed(map, [&](std::int32_t pixel) {
    add_chain(pixel, map.maxima(), against, along);
    return count_ < pixels_.size();
  });
}

Chain ChainTracer::chain(std::size_t i) const {
  return {pixels().subspan(begins_[i], begins_[i + 1] - begins_[i]), is_closed_[i] != 0};
}

}  // namespace ellipse
