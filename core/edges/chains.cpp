// SPDX-License-Identifier: MIT
#include "core/edges/chains.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>

namespace ellipse {
namespace {

// For each octant of an edge, the codes that may follow, as a bit set: free gradient maxima whose
// edge direction differs by at most one octant.
constexpr std::array<std::uint32_t, 8> kOpen = [] {
  std::array<std::uint32_t, 8> open{};
  for (unsigned octant = 0; octant < 8; ++octant) {
    for (const unsigned turn : {7U, 0U, 1U}) {
      const unsigned next = maximum::kFree | ((octant + turn) & maximum::kOctant);
      open[octant] |= 1U << next | 1U << (next | maximum::kSeed);
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
      octant = maxima_[at] & maximum::kOctant;
      maxima_[at] = static_cast<std::uint8_t>(octant);
      *out++ = at;
    }
    return out;
  }

 private:
  // Whether a pixel's code is in the bit set `open`.
  [[nodiscard]] bool is_open(std::int32_t pixel, std::uint32_t open) const {
    const unsigned code = maxima_[pixel] & (maximum::kOctant | maximum::kFree | maximum::kSeed);
    return ((open >> code) & 1U) != 0;
  }

  [[nodiscard]] int strength(std::int32_t pixel) const {
    return std::abs(gradients_[pixel].x) + std::abs(gradients_[pixel].y);
  }

  // Prefers straight ahead, then the stronger side, then a gap of one pixel. -1 at the end. Selects
  // the neighbour without branches, since texture makes it unpredictable.
  [[nodiscard]] std::int32_t next_of(std::int32_t at, unsigned octant) const {
    const std::uint32_t open = kOpen[octant];
    const std::int32_t left = at + steps_[octant];
    const std::int32_t ahead = at + steps_[octant + 1U];
    const std::int32_t right = at + steps_[octant + 2U];
    const bool has_left = is_open(left, open);
    const bool has_ahead = is_open(ahead, open);
    const bool has_right = is_open(right, open);
    if (!(has_left | has_ahead | has_right)) return beyond(ahead, octant);
    if (!has_ahead & has_left & has_right) return strength(right) >= strength(left) ? right : left;
    const std::int32_t side = has_right ? right : left;
    return has_ahead ? ahead : side;
  }

  [[nodiscard]] std::int32_t beyond(std::int32_t gap, unsigned octant) const {
    for (const std::size_t side : {1U, 2U, 0U}) {
      const std::int32_t pixel = gap + steps_[octant + side];
      if (is_open(pixel, kOpen[octant])) return pixel;
    }
    return -1;
  }

  std::uint8_t* maxima_;
  const Gradient* gradients_;
  std::array<std::int32_t, 10> steps_;  // from k on: left of octant k, ahead, right
};

namespace {

// Index of the first byte in memory that is not 0.
int first_byte_of(std::uint64_t word) {
  const bool is_little = std::endian::native == std::endian::little;
  return (is_little ? std::countr_zero(word) : std::countl_zero(word)) / 8;
}

// Calls visit(index) for each seed until it returns false. visit() must clear the seed's bit.
// Skips words of eight pixels without seeds, which are most of them.
template <class Visit>
void for_each_seed(const GradientMap& map, const Visit& visit) {
  using Word = std::uint64_t;
  constexpr Word kAllSeeds = 0x0101010101010101U * maximum::kSeed;
  const auto seeds_at = [&](std::int32_t pixel) {
    Word word = 0;
    std::memcpy(&word, map.maxima() + pixel, sizeof word);
    return word & kAllSeeds;
  };
  for (const std::int32_t block : map.blocks()) {
    for (std::int32_t i = block; i < block + GradientMap::kBlock; i += sizeof(Word)) {
      while (const Word seeds = seeds_at(i)) {
        if (!visit(i + first_byte_of(seeds))) return;
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
  maxima[seed] &= maximum::kOctant;
  std::int32_t* const begin = pixels_.data() + count_;
  const std::int32_t* const last = pixels_.data() + capacity_;
  std::int32_t* const middle = against.run(seed, begin, last - 1);
  *middle = seed;
  std::int32_t* const end = along.run(seed, middle + 1, last);
  const auto length = static_cast<std::size_t>(end - begin);
  if (length < kMinLength) return;
  std::reverse(begin, middle);
  for (const std::int32_t* pixel = begin; pixel != end; ++pixel) {
    maxima[*pixel] |= maximum::kChained;
  }
  count_ += length;
  begins_.push_back(count_);
}

void ChainTracer::reserve(std::size_t chains) {
  begins_.reserve(chains + 1);
}

void ChainTracer::trace(GradientMap& map) {
  const auto pixels =
      static_cast<std::size_t>(map.stride()) * static_cast<std::size_t>(map.height());
  capacity_ = pixels / 4 + 64;
  if (pixels_.size() < capacity_) pixels_.resize(capacity_);  // two sizes may alternate
  count_ = 0;
  begins_.assign(1, 0);
  const Walk against(map, false);
  const Walk along(map, true);
  for_each_seed(map, [&](std::int32_t pixel) {
    add_chain(pixel, map.maxima(), against, along);
    return count_ < capacity_;
  });
}

std::span<const std::int32_t> ChainTracer::chain(std::size_t i) const {
  return pixels().subspan(begins_[i], begins_[i + 1] - begins_[i]);
}

}  // namespace ellipse
