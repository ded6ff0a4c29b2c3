#pragma once
/// Frames of cloth as they come, of follow() and of drape_in_motion().
#include <garment/drape/follow.hpp>
#include <garment/drape/motion.hpp>

#include <fstream>

namespace sloper::garment {

/// Writes each frame as an OBJ with its line in an index, or as a line of JSON.
class FrameWriter {
public:
  /// @param where   a folder, made when it is not there, for an OBJ each and frames.jsonl; "-" for
  /// JSON lines with positions to `stream`; empty: nowhere
  /// @param stamp   first line of each OBJ
  /// @param after   in a folder that has frames, so many lines of frames.jsonl stay: those of a run
  /// that goes on   @throws Error OUTPUT
  FrameWriter(std::string where, std::string stamp, std::ostream& stream, std::size_t after = 0);
  void operator()(const FollowFrame& frame, const Garment& garment);
  void operator()(const MotionFrame& frame, const Garment& garment);

private:
  void write(int number, io::Json line, const Garment& garment);

  std::string m_where, m_stamp;
  std::ostream& m_stream;
  std::ofstream m_index;
};

} // namespace sloper::garment
