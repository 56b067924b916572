#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <optional>

#include "core/image/image_view.hpp"
#include "examples/landing/eye.hpp"

namespace landing {

/// Standard deviation of an edge rounded to whole pixels [px]: a uniform error.
inline const double kPixelError_px = 1.0 / std::sqrt(12.0);

/// The pad's position as located by a peer.
struct Sighting {
  Eigen::Vector3d position;  ///< Pad centre in the camera frame [m].
  double half_size_px;       ///< Half the marker's size in the picture.

  /// Standard deviation of each coordinate [m]. Distance is inversely proportional to the marker's
  /// size, so both have the same relative error: that of one edge.
  [[nodiscard]] double error() const { return position.norm() * kPixelError_px / half_size_px; }
};

/// Another method to locate a landing pad. Not thread-safe.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// @param gravity  Direction of gravity in the camera frame.
  /// @return nullopt if the marker is not found.
  [[nodiscard]] virtual std::optional<Sighting> find(const ellipse::ImageView& picture,
                                                     const Eigen::Vector3d& gravity) = 0;

  /// Discards everything learned from earlier pictures.
  virtual void forget() {}
};

/// Runs a peer without a pipeline. A peer detects its marker completely or not at all.
class PeerEye : public Eye {
 public:
  PeerEye(const PictureFormat& format, std::unique_ptr<Peer> peer);

  [[nodiscard]] Look look(const Eigen::Vector3d& gravity, const Draw& draw) override;
  void forget() override { peer_->forget(); }

 private:
  PictureFormat format_;
  std::unique_ptr<Peer> peer_;
  std::uint64_t frame_ = 0;
};

}  // namespace landing
