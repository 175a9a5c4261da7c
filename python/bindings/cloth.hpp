// Cloth as Python holds it: a piece that never changes, so that arrays over it stay true and threads may
// share it.
#pragma once
#include <memory>
#include <mutex>
#include <optional>

#include "piece.hpp"

namespace loopwright::python {

class Cloth {
 public:
  explicit Cloth(Piece piece) : piece_(std::move(piece)) {}
  // At rest, or as near to it as the run came from the state before, whose notation it keeps.
  Cloth(RelaxRun run, const State& before);

  const Piece& piece() const { return piece_; }
  const State& state() const { return piece_.state; }
  const Fabric& fabric() const { return piece_.state.fabric; }
  bool stopped() const { return stopped_; }
  const std::string& message() const { return message_; }
  std::optional<double> number(const char* key) const;  // of the state

  // Measured once, when somebody asks first.
  const Assessment& assessment() const;
  // The run's result, for who goes on from it; nothing for a first geometry or a state that was read.
  std::optional<RelaxResult> at_rest() const;
  // Every interlacing there, no yarn through another, rings linked as before.
  bool whole() const;

 private:
  Piece piece_;
  std::optional<RelaxResult> rest_;  // without its fabric and history, which are the piece's
  std::vector<LinkedPair> linked_before_;
  std::string message_;
  bool stopped_ = false;
  mutable std::once_flag measured_;
  mutable std::optional<Assessment> assessment_;
};

using ClothPointer = std::shared_ptr<Cloth>;

}  // namespace loopwright::python
