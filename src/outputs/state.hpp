// Saved state: a fabric and what is known of the run that made it, in one HDF5 file that can be read back to
// the bit.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "geometry/fabric.hpp"
#include "mechanics/contact_history.hpp"

namespace loopwright {

struct State {
  Fabric fabric;
  std::map<std::string, double> numbers;     // e.g. "residual"; any double, NaN included
  std::map<std::string, std::string> texts;  // e.g. "source": the notation; UTF-8 without zero bytes
  ContactHistory history{};                  // friction's, so that a run can go on where this one ended
};

// The file is a user block of 512 bytes (format, version, length and checksum of the rest, as text) and an
// HDF5 file with the groups fabric, yarns, control_points, loops, interlacings, run and, where friction has
// one, history; docs/outputs.md names the columns. Numbers are compressed (shuffle, deflate). The same state
// gives the same bytes. Throws FileError, and std::invalid_argument for a fabric that could not be read back
// (see fabric_fault).
void write_state(const std::filesystem::path& path, const State& state);

// Checks length and checksum before HDF5 sees a byte, then every size, range and number. Throws FileError.
State read_state(const std::filesystem::path& path);

// What makes a fabric unfit to be saved or drawn (sizes that disagree, numbers out of range or not finite),
// in words; empty if it is sound.
std::string fabric_fault(const Fabric& fabric);

// What makes a history no history of a fabric's contacts, in words; empty if it is sound.
std::string history_fault(const Fabric& fabric, const ContactHistory& history);

}  // namespace loopwright
