#pragma once
/// Whether a garment hangs far below where its panels were placed.
/// Test: tests/garment/fit/test_slid_down.cpp
#include <sloper/base/message.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/drape/drape_job.hpp>
#include <sloper/garment/inputs.hpp>

#include <optional>

namespace sloper::garment {

/// The upper edge of a garment about trunk and legs: vertices that were placed within 3 cm of the
/// highest.
struct UpperEdge {
  double placed_m = 0; ///< their mean height as placed, m
  double height_m = 0; ///< and at the garment's present positions, m
};

/// Measures it; nothing where the panels were not placed around a body.
std::optional<UpperEdge> upper_edge(const Garment& garment);

/// A finding, which is a warning too, on a drape from panels that came to rest with its upper edge
/// 25 cm or more below where it was placed: it slid down as it was sewn, or is too wide to stay
/// up. What slid to below the crotch is not worn: the drape counts as failed (converged is false in
/// garment, report and document; StopReason::MISFIT, Misfit::SLIDES_DOWN).
/// @param start  of the garment, for its files' names
/// @param outcome  of do_drape(), in and out
void judge_slid_down(Garment& garment, const body::Body& body, DrapeOutcome& outcome,
                     const Start& start, std::vector<Message>& findings, Reporter& reporter);

} // namespace sloper::garment
