#pragma once
/// One row of a fit report: a line of cloth around the body, measured.
#include <garment/fit/fit_places.hpp>
#include <garment/fit/fit_section.hpp>
#include <sloper/garment/fit/cloth_strain.hpp>
#include <sloper/garment/fit/fit_report.hpp>

namespace sloper::garment {

/// What is known of a garment's triangles, once for all rows.
struct ClothState {
  const Garment& garment;
  const collision::BodyCollider& skin;
  std::vector<TriangleStrain> strains;
  std::vector<double> pressures; ///< Pa
  ClothState(const Garment& draped, const collision::BodyCollider& body)
      : garment(draped), skin(body), strains(triangle_strains(draped, draped.position)),
        pressures(contact_pressures(draped, strains, body)) {}
};

/// Strain of the triangles of one row.
struct StrainFigures {
  std::size_t n = 0; ///< triangles
  double p50 = 0, p99 = 0;
  double max = 0; ///< of a place, the triangles around one particle: a single one that is flat may
                  ///< be high by a third, and its edges as they were
  std::string
      direction; ///< "warp" or "weft": of what is strained as much as the 99th percentile or more
};
/// Strain (cloth_strain.hpp) of some triangles, by area.
StrainFigures strain_of(const ClothState& cloth, const std::vector<int>& triangles);

/// The innermost line of cloth that goes round the place, or nothing and why.
/// @param shift  m along its normal   @param elsewhere  other positions of the particles in which
/// the line is measured too
std::optional<SectionLine> line_around(const Garment& garment, const std::vector<char>& use,
                                       const FitPlace& place, double shift, std::string& why,
                                       const std::vector<Vec3>* elsewhere = nullptr);

constexpr double GOES_ROUND = 0.99; // of the body's girth: as long as cloth is that goes round it

/// Whether the straight bridges over a line's openings pass through the body: with them it is
/// shorter than the taut girth, so its ease is not known. A top edge that dips below a level does
/// so.
bool is_bridged_through(const FitPlace& place, const SectionLine& line);

/// A girth of the body where the garment goes round it, or nothing and why. @param convergence  m
/// that the cloth may still move   @param source  where the particles are on the body that the
/// garment comes from, for FitRow::worn_strain, or nullptr
std::optional<FitRow> measure_place(const ClothState& cloth, const FitPlace& place,
                                    double convergence, std::string& why,
                                    const std::vector<Vec3>* source = nullptr);

/// A free edge as a closed line of cloth, and the place that it goes round.
struct EdgeLine {
  FitPlace place; ///< its plane, and the girth of the skin there
  SectionLine line;
  std::vector<body::Part> parts; ///< of the skin that it goes round
  std::vector<int> particles;    ///< in order
};
/// @param garment bound   @param hem of fit_lines()   @return nothing, and why, for an edge that
/// goes round nothing that is measured
std::optional<EdgeLine> edge_line(const Garment& garment, const body::Body& body, const FitHem& hem,
                                  std::string& why);

/// A free edge that goes round the neck, an arm, a leg or the trunk at its top, against the skin in
/// its plane; nothing, and why, for another one. Its row is "neck_edge", "sleeve_hem_l",
/// "leg_hem_r", "top_edge"; its strain that of the triangles along it.
std::optional<FitRow> measure_edge(const ClothState& cloth, const body::Body& body,
                                   const FitHem& hem, double convergence, std::string& why,
                                   const std::vector<Vec3>* source = nullptr);

} // namespace sloper::garment
