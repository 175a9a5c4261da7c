#include "build_facts.hpp"

#include <hdf5.h>
#include <png.h>

#include <array>
#include <cstdint>

#include "base/index.hpp"
#include "base/parallel.hpp"
#ifdef LOOPWRIGHT_HAS_CHOLMOD
#include <cholmod.h>
#endif

namespace loopwright {

const char* built_commit();  // in a file that the build writes

namespace {

std::string dotted(int major, int minor, int release) {
  return std::to_string(major) + '.' + std::to_string(minor) + '.' + std::to_string(release);
}

std::string hdf5_version() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return dotted(static_cast<int>(major), static_cast<int>(minor), static_cast<int>(release));
}

// Bits of a type, as people say it.
std::string bits(std::size_t bytes) { return std::to_string(8 * bytes) + " bits"; }

}  // namespace

BuildFacts build_facts() {
  BuildFacts facts;
  facts.version = LOOPWRIGHT_VERSION;
  facts.commit = built_commit();
  facts.compiler = LOOPWRIGHT_COMPILER;
  facts.build_type = LOOPWRIGHT_BUILD_TYPE;
  facts.numbers = "double (" + bits(sizeof(double)) + "), indices of " + bits(sizeof(LoopId));
  facts.threads = thread_count();
  facts.libraries = {{"Eigen", LOOPWRIGHT_EIGEN_VERSION},
                     {"HDF5", hdf5_version()},
                     {"libpng", png_get_libpng_ver(nullptr)},
                     {"nlohmann-json", LOOPWRIGHT_JSON_VERSION},
                     {"libepoxy", LOOPWRIGHT_EPOXY_VERSION}};
#ifdef LOOPWRIGHT_HAS_CHOLMOD
  std::array<int, 3> cholmod{};
  cholmod_version(cholmod.data());
  facts.libraries.insert(facts.libraries.begin() + 1,
                         {"CHOLMOD", dotted(cholmod[0], cholmod[1], cholmod[2])});
  facts.licence = "GPL-3 or later, as it links CHOLMOD's supernodal module; the source: Apache-2.0";
#else
  facts.licence = "Apache-2.0";
#endif
  return facts;
}

std::string text_of(const BuildFacts& facts) {
  std::string libraries;
  for (const LibraryVersion& library : facts.libraries) {
    libraries += (libraries.empty() ? "" : ", ") + library.name + ' ' + library.version;
  }
  return "loopwright " + facts.version + "\ncommit: " + facts.commit + "\ncompiler: " + facts.compiler +
         "\nbuild type: " + facts.build_type + "\nlibraries: " + libraries + "\nnumbers: " + facts.numbers +
         "\nthreads: " + std::to_string(facts.threads) + "\nlicence of this binary: " + facts.licence;
}

JsonObject json_of(const BuildFacts& facts) {
  JsonObject libraries;
  for (const LibraryVersion& library : facts.libraries) libraries.emplace_back(library.name, library.version);
  return {{"version", facts.version},       {"commit", facts.commit},  {"compiler", facts.compiler},
          {"build_type", facts.build_type}, {"libraries", libraries},  {"numbers", facts.numbers},
          {"threads", facts.threads},       {"licence", facts.licence}};
}

}  // namespace loopwright
