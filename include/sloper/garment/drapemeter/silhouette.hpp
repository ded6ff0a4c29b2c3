#pragma once
/// A picture from above of cloth that hangs over a disc, measured.
#include <sloper/io/png.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

struct SilhouetteSetup {
  double disc_m = 0.18, specimen_m = 0.30; ///< diameters
  double m_per_pixel = 0; ///< 0: from the disc, which shows in another grey than the cloth
};

struct Silhouette {
  double coefficient = 0; ///< drape coefficient, 0..1
  int folds = 0;          ///< of the outline
  double m_per_pixel = 0;
  std::vector<double> radius_m; ///< 360: of the outline around its middle, by degrees from the
                                ///< picture's right, counter-clockwise
};

/// Cloth and ground are parted by Otsu's threshold of the grey (1979); the ground is what the
/// picture's border mostly is, as is all that is transparent. The largest connected piece of the
/// rest is the cloth, holes filled. Where m_per_pixel is 0, the cloth's middle must be a round
/// piece of another grey: the disc on top.
/// @param name  of the picture, for messages
/// @throws Error INPUT for a picture without cloth, cloth that reaches the border, no disc to be
/// seen, or cloth that is larger than the specimen or smaller than the disc
Silhouette measure_silhouette(const io::Image& picture, const std::string& name,
                              const SilhouetteSetup& setup);

/// The picture that measure_silhouette() reads: ground white, cloth dark, the disc on top grey.
/// @param position  m, the disc's middle at the origin
/// @param side_px  of the square picture   @param side_m  of what it shows
io::Image draw_silhouette(const std::vector<Triangle>& triangles, const std::vector<Vec3>& position,
                          double disc_m, int side_px, double side_m);

} // namespace sloper::garment
