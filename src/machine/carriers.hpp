// Carriers: which yarns are in, where they stand, and what the yarn inserting hook holds.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "machine/knitting_record.hpp"

namespace loopwright {

struct Carrier {
  enum class State : std::uint8_t {
    out,
    pending,  // named by in or inhook, moves at its next use
    active
  };
  State state = State::out;
  int in_instruction = -1;           // what brought it in, -1 if a faulty programme never did
  YarnId yarn;                       // the yarn that it lays while active
  std::optional<Needle> at;          // it stands beside this needle ...
  Direction side = Direction::none;  // ... on this side of it
  bool in_hook = false;
  bool missed = false;  // has gone past needles since its last loop: its yarn lies across them
};

class Carriers {
 public:
  Carriers(const Program& program, Diagnostics& diagnostics)
      : program_(program),
        diagnostics_(diagnostics),
        carriers_(program.carriers.size()),
        last_places_(program.carriers.size()) {}

  void bring_in(const Instruction& instruction, int index);
  void take_out(const Instruction& instruction, int index, std::vector<YarnRecord>& yarns);
  void release_hook(const Instruction& instruction);
  // The carriers of a yarn-carrying instruction, active and with a yarn each. A carrier that is not in is
  // told, once, and used all the same, so that the rest of a faulty programme can still be shown.
  const std::vector<CarrierId>& use(const Instruction& instruction, std::vector<YarnRecord>& yarns);
  // Motion rule: carriers beside a needle whose loops move go with them, except those of `but`.
  void follow(Needle from, Needle to, const std::vector<CarrierId>& but);
  // What must be out at the end and is not.
  void finish() const;
  // Carriers that have been used and not taken out, in the order in which they came in.
  const std::vector<CarrierId>& active() const { return active_; }
  // Where every carrier is, or was when it was taken out.
  std::vector<CarrierPlace> places() const;
  // What the hook holds; empty while it is free.
  const std::vector<CarrierId>& hook() const { return hook_.holds; }

  Carrier& operator[](CarrierId id) { return carriers_[id.position()]; }

 private:
  struct Hook {
    std::vector<CarrierId> holds;  // sorted; empty: the hook is free
    int instruction = -1;
    bool used = false;  // a loop or a miss was made since
  };

  const std::vector<CarrierId>& known(
      const Instruction& instruction);  // told and left out: unknown or double names
  // A set that comes in comes in whole: its first use names just the carriers that `in` or `inhook` named.
  void require_whole_set(const Instruction& instruction);
  bool hook_holds_exactly(std::vector<CarrierId> set) const;
  void empty_hook();
  std::string name(CarrierId id) const { return program_.carriers[id.position()]; }
  std::string names(const std::vector<CarrierId>& set) const;
  std::string line_of(int instruction) const;  // "line 12"
  SourceLocation at(int instruction) const;

  const Program& program_;
  Diagnostics& diagnostics_;
  std::vector<Carrier> carriers_;
  std::vector<CarrierPlace> last_places_;  // of carriers that were taken out
  std::vector<CarrierId> active_;          // in the order in which they became active
  std::vector<CarrierId> set_;             // answer of known()
  Hook hook_;
};

}  // namespace loopwright
