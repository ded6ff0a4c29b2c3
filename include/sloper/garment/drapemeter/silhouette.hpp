#pragma once
/// A picture from above of cloth that hangs over a disc, measured.
/// Test: tests/garment/drapemeter/test_drapemeter.cpp
#include <sloper/geometry/types.hpp>
#include <sloper/io/png.hpp>

#include <string>
#include <vector>

namespace sloper::garment {

/// Dimensions of the disc and the specimen in the picture, and its scale.
struct SilhouetteSetup {
  double disc_m = 0.18, specimen_m = 0.30; ///< diameters
  double m_per_pixel = 0; ///< 0: from the disc, which shows in another grey than the cloth
};

/// The outline of the cloth in the picture, and what follows from it.
struct Silhouette {
  double coefficient = 0; ///< drape coefficient, 0..1
  int folds = 0;          ///< of the outline
  double m_per_pixel = 0; ///< as given or found
  /// 360 radii of the outline around its middle, by degrees from the picture's right,
  /// counter-clockwise.
  std::vector<double> radius_m;
};

/// Measures a picture. Otsu's threshold of the grey (1979) separates cloth and ground;
/// the ground is the majority of the picture's border, and all transparent pixels. The
/// largest connected piece of the rest is the cloth, holes filled. Where m_per_pixel is
/// 0, the cloth's middle must be a round piece of another grey: the disc on top.
/// @param name  of the picture, for messages
/// @param setup  diameters and scale
/// @throws Error INPUT for a picture without cloth, cloth that reaches the border, no
/// visible disc, or cloth that is larger than the specimen or smaller than the disc
Silhouette measure_silhouette(const io::Image& picture, const std::string& name,
                              const SilhouetteSetup& setup);

/// A picture that measure_silhouette() reads: ground white, cloth dark, the disc on top
/// grey.
/// @param position  m, the disc's middle at the origin
/// @param disc_m  diameter of the disc, m
/// @param side_px  of the square picture, pixels
/// @param side_m  of the area that it shows, m
io::Image draw_silhouette(const std::vector<Triangle>& triangles, const std::vector<Vec3>& position,
                          double disc_m, int side_px, double side_m);

} // namespace sloper::garment
