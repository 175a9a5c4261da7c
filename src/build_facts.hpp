// What this build is: version, commit, compiler, libraries. `loopwright --version` prints it, and a report of
// a fault should carry it.
#pragma once
#include <string>
#include <vector>

#include "outputs/write_json.hpp"

namespace loopwright {

// Versions of what is linked are asked of the library that runs; those of header-only libraries and of
// libraries that do not tell are the build's.
struct LibraryVersion {
  std::string name, version;
};

struct BuildFacts {
  std::string version;     // of Loopwright
  std::string commit;      // of its source, "unknown" without a repository
  std::string compiler;    // name and version
  std::string build_type;  // Release, Debug; with the sanitizers if there are any
  std::string numbers;     // type of the state and of indices
  std::string licence;     // of this binary
  int threads = 1;         // used if nobody says how many
  std::vector<LibraryVersion> libraries;
};
BuildFacts build_facts();

// The first line is "loopwright VERSION", then one line a fact; ends without a newline.
std::string text_of(const BuildFacts& facts);
JsonObject json_of(const BuildFacts& facts);

}  // namespace loopwright
