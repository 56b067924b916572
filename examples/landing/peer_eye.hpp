#pragma once  // SPDX-License-Identifier: MIT

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <optional>

#include "core/image/image_view.hpp"
#include "examples/landing/eye.hpp"

namespace landing {

/// Standard deviation of an edge located to the nearest pixel [px]: a uniform error.
inline const double kPixelError_px = 1.0 / std::sqrt(12.0);

/// Where a peer sees the pad.
struct Sighting {
  Eigen::Vector3d position;  ///< Of its centre in the camera's frame [m].
  double half_size_px;       ///< Of the marker in the picture.

  /// Standard deviation of the position [m]: the distance is inversely proportional to the
  /// marker's size, whose relative error is that of one edge.
  [[nodiscard]] double error() const { return position.norm() * kPixelError_px / half_size_px; }
};

/// Another way to locate a landing pad. Serves one thread.
class Peer {
 public:
  Peer() = default;
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// @param gravity  Down in the camera's frame.
  /// nullopt where the marker is not found.
  [[nodiscard]] virtual std::optional<Sighting> find(const ellipse::ImageView& picture,
                                                     const Eigen::Vector3d& gravity) = 0;

  /// Drops everything learned from earlier pictures.
  virtual void forget() {}
};

/// Looks by a peer, without a pipeline. A peer sees its marker whole or not at all.
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
