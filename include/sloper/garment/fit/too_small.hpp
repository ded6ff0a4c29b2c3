#pragma once
/// Why cloth that did not come to rest is stretched: it is smaller than the body by more than its
/// fabric gives. Test: tests/garment/fit/test_too_small.cpp
#include <sloper/base/message.hpp>
#include <sloper/base/progress.hpp>
#include <sloper/body/body.hpp>
#include <sloper/garment/inputs.hpp>
#include <sloper/garment/simulate/report.hpp>

namespace sloper::garment {

/// A finding, which is a warning too, on a drape that has ended without a rest, its cloth stretched
/// beyond any fabric's wear (Stretch::bound), around a body that is wider at some girth than this
/// fabric reaches at 100 N/m. It says by how much, at which girth, what the fabric gives, and which
/// presets give enough, or which one gives most. Nothing where the cloth came to rest
/// (judge_stretch() tells of that), or without a body. Cost: that of a fit report.
/// @param garment  on `body`; its binding is not used
/// @param start  of the garment, for its files' names
void judge_too_small(const Garment& garment, const body::Body& body, const DrapeReport& report,
                     const Start& start, std::vector<Message>& findings, Reporter& reporter);

} // namespace sloper::garment
