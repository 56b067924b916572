#pragma once  // SPDX-License-Identifier: MIT

#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "core/camera/camera.hpp"
#include "core/geometry/ellipse.hpp"
#include "core/scene/pad.hpp"
#include "core/scene/sheet.hpp"
#include "examples/landing/peer_eye.hpp"

namespace landing {

/// Locates a black ring with a white disc inside by the method of [Krajnik2014], written from the
/// paper: an adaptive threshold, connected segments, a concentric pair of a black and a white one
/// in the ring's proportion, the ellipse of their second moments, and the position from the known
/// diameter.
///
/// Deviations: the paper searches from the last position to save time; here the whole picture is
/// segmented. Gravity resolves the ambiguity between the two tilts.
class WhyCon : public Peer {
 public:
  /// @param inner_ratio  Radius of the white disc / radius of the ring. Above 0, below 1.
  /// @param radius       Of the ring [m].
  WhyCon(const ellipse::Camera& camera, double inner_ratio, double radius);

  [[nodiscard]] std::optional<Sighting> find(const ellipse::ImageView& picture,
                                             const Eigen::Vector3d& gravity) override;
  void forget() override;

 private:
  struct Segments;
  struct Ring;

  // The ring's outer edge [px].
  [[nodiscard]] std::optional<ellipse::Ellipse> find_ring(const ellipse::ImageView& picture);
  [[nodiscard]] double threshold() const;
  [[nodiscard]] std::optional<Ring> ring_of(const Segments& segments, int black) const;
  [[nodiscard]] std::optional<Ring> measured(const Segments& segments,
                                             const cv::Rect& box,
                                             int black,
                                             int white) const;
  [[nodiscard]] bool is_ring(const Ring& ring) const;
  [[nodiscard]] ellipse::Ellipse compensated(const Ring& ring) const;

  ellipse::Camera camera_;
  double inner_ratio_;
  double radius_;
  std::optional<double> last_threshold_;  // of the last picture with a detected ring
  unsigned failures_ = 1;                 // pictures since then
};

/// The marker painted inside a pad's ring: a smaller ring of the same proportion, as wide as the
/// tag of tag36h11 that fits there. Throws std::invalid_argument if the pad has no ring.
[[nodiscard]] ellipse::Sheet roundel_sheet(const ellipse::Pad& pad);

/// Locates that marker. @param radius  Of the pad [m].
[[nodiscard]] std::unique_ptr<Peer> make_whycon(const ellipse::Camera& camera,
                                                const ellipse::Pad& pad,
                                                double radius);

}  // namespace landing
