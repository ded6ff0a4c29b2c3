#pragma once
/// A skirt at rest on the figure that it was drafted for, for tests of retargeting.
#include <gtest/gtest.h>
#include <mannequin.hpp>
#include <measures.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/measure_scan.hpp>
#include <sloper/garment/bind/bind.hpp>
#include <sloper/garment/drape/drape.hpp>
#include <sloper/garment/scene/scene.hpp>
#include <sloper/io/json.hpp>
#include <sloper/pattern/mesh/mesh_pattern.hpp>
#include <sloper/pattern/place/place_panels.hpp>
#include <sloper/pattern/read/read_pattern.hpp>
#include <support/made_figure.hpp>

namespace sloper::garment {

struct Figure {
  body::Body body;
  io::Json truth;

  explicit Figure(const std::string& preset) {
    const test::MadeFigure made = test::made_figure(preset);
    body = body::measure_scan(made.mesh, preset, "", {}, silent_reporter()).body;
    truth = made.truth;
  }
};

/// The skirt; its draft is that of `make-pattern skirt`. @param edge_m  of its mesh, m
inline Garment worn_skirt(const Figure& figure, double edge_m) {
  const pattern::Pattern source =
      pattern::read_pattern_json(samples::pattern_document(samples::draft_skirt(
                                     samples::measures_from_body(figure.truth, "figure"))),
                                 "skirt");
  Garment garment;
  garment.panels = pattern::mesh_pattern(source, edge_m, "skirt");
  garment.panels.source = std::make_shared<pattern::Pattern>(source);
  pattern::place_panels(source, figure.body, garment.panels);
  const DrapeReport report =
      drape(garment, &figure.body, preset_settings("standard"), silent_reporter());
  EXPECT_TRUE(report.converged);
  bind_garment(garment, figure.body);
  return garment;
}

} // namespace sloper::garment
