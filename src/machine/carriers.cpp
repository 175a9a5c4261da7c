#include "machine/carriers.hpp"

#include <algorithm>

namespace loopwright {
namespace {

bool contains(const std::vector<CarrierId>& set, CarrierId id) {
  return std::find(set.begin(), set.end(), id) != set.end();
}

}  // namespace

void Carriers::bring_in(const Instruction& instruction, int index) {
  const bool by_hook = instruction.op == Op::inhook;
  if (by_hook && !hook_.holds.empty()) {
    diagnostics_.error(instruction.at, "the yarn inserting hook still holds " + names(hook_.holds) +
                                           " from " + line_of(hook_.instruction) + ": write 'releasehook " +
                                           names(hook_.holds) + "' before this 'inhook'");
  }
  for (CarrierId id : known(instruction)) {
    Carrier& carrier = carriers_[id.position()];
    if (carrier.state != Carrier::State::out) {
      diagnostics_.error(instruction.at, "carrier " + name(id) + " is already in, since " +
                                             line_of(carrier.in_instruction) +
                                             ": take it out first or leave this out");
      continue;
    }
    carrier.state = Carrier::State::pending;
    carrier.in_instruction = index;
    carrier.at.reset();
  }
  // A second inhook was told; the hook stays with the first, so that its releasehook is right.
  if (by_hook && hook_.holds.empty() && !set_.empty()) {
    hook_ = {set_, index, false};
    std::sort(hook_.holds.begin(), hook_.holds.end());
    for (CarrierId id : set_) carriers_[id.position()].in_hook = true;
  }
}

void Carriers::take_out(const Instruction& instruction, int index, std::vector<YarnRecord>& yarns) {
  const std::vector<CarrierId>& set = known(instruction);
  const bool takes_hooked =
      std::any_of(set.begin(), set.end(), [&](CarrierId id) { return carriers_[id.position()].in_hook; });
  if (takes_hooked || (instruction.op == Op::outhook && !hook_.holds.empty())) {
    diagnostics_.error(instruction.at, "the yarn inserting hook still holds " + names(hook_.holds) +
                                           " from " + line_of(hook_.instruction) + ": write 'releasehook " +
                                           names(hook_.holds) + "' before this");
    if (takes_hooked) empty_hook();
  }
  for (CarrierId id : set) {
    Carrier& carrier = carriers_[id.position()];
    if (carrier.state == Carrier::State::out) {
      diagnostics_.error(instruction.at, "carrier " + name(id) +
                                             " is not in, so it cannot be taken out: leave this out, "
                                             "or bring it in and use it first");
    } else if (carrier.state == Carrier::State::pending) {
      diagnostics_.error(instruction.at,
                         "carrier " + name(id) + " was brought in at " + line_of(carrier.in_instruction) +
                             " but has not been used, so it cannot be taken out: knit or tuck with it "
                             "first, or leave both out");
    } else {
      yarns[carrier.yarn.position()].out_instruction = index;
      active_.erase(std::find(active_.begin(), active_.end(), id));
      last_places_[id.position()] = {carrier.at, carrier.side, false};
    }
    carrier = Carrier();
  }
}

void Carriers::release_hook(const Instruction& instruction) {
  const std::vector<CarrierId>& set = known(instruction);
  if (hook_.holds.empty()) {
    diagnostics_.error(instruction.at,
                       "the yarn inserting hook holds nothing: leave this 'releasehook' out, or bring " +
                           names(set) + " in with 'inhook'");
    return;
  }
  if (!hook_holds_exactly(set)) {
    diagnostics_.error(instruction.at, "the yarn inserting hook holds " + names(hook_.holds) + " since " +
                                           line_of(hook_.instruction) + ", not " + names(set) +
                                           ": write 'releasehook " + names(hook_.holds) + "'");
  } else if (!hook_.used) {
    diagnostics_.error(instruction.at, "the yarn inserting hook lets go of " + names(set) +
                                           " before it has been used: knit or tuck with it first");
  }
  empty_hook();
}

const std::vector<CarrierId>& Carriers::use(const Instruction& instruction, std::vector<YarnRecord>& yarns) {
  known(instruction);
  require_whole_set(instruction);
  for (CarrierId id : set_) {
    Carrier& carrier = carriers_[id.position()];
    if (carrier.in_hook) hook_.used = true;
    if (carrier.state == Carrier::State::active) continue;
    if (carrier.state == Carrier::State::out) {
      diagnostics_.error(instruction.at, "carrier " + name(id) + " is not in: write 'in " + name(id) +
                                             "' or 'inhook " + name(id) + "' before its first use");
    }
    carrier.state = Carrier::State::active;
    carrier.yarn = YarnId(yarns.size());
    yarns.push_back({id, {}, carrier.in_instruction, -1});
    active_.push_back(id);
  }
  return set_;
}

void Carriers::follow(Needle from, Needle to, const std::vector<CarrierId>& but) {
  for (CarrierId id : active_) {
    Carrier& carrier = carriers_[id.position()];
    if (carrier.at == from && !contains(but, id)) carrier.at = to;
  }
}

void Carriers::require_whole_set(const Instruction& instruction) {
  for (CarrierId id : set_) {
    const Carrier& carrier = carriers_[id.position()];
    if (carrier.state != Carrier::State::pending) continue;
    std::vector<CarrierId> named =
        program_.instructions[static_cast<std::size_t>(carrier.in_instruction)].carriers;
    std::vector<CarrierId> used = set_;
    std::sort(named.begin(), named.end());
    named.erase(std::unique(named.begin(), named.end()), named.end());
    std::sort(used.begin(), used.end());
    if (named == used) continue;
    diagnostics_.error(instruction.at, "the first use of carrier " + name(id) + " names " + names(set_) +
                                           ", but " + line_of(carrier.in_instruction) + " brings in " +
                                           names(named) + ": use just these, or bring in just " +
                                           names(set_));
    return;
  }
}

void Carriers::finish() const {
  for (std::size_t k = 0; k < carriers_.size(); ++k) {
    const Carrier& carrier = carriers_[k];
    if (carrier.state == Carrier::State::pending) {
      diagnostics_.error(at(carrier.in_instruction),
                         "carrier " + name(CarrierId(k)) + " is brought in and never used: leave this out");
    } else if (carrier.state == Carrier::State::active) {
      const std::string hooked = carrier.in_hook ? "'releasehook' and " : "";
      diagnostics_.error(at(carrier.in_instruction),
                         "carrier " + name(CarrierId(k)) + " is still in at the end: end with " + hooked +
                             "'out " + name(CarrierId(k)) + "' or 'outhook " + name(CarrierId(k)) + "'");
    }
  }
}

std::vector<CarrierPlace> Carriers::places() const {
  std::vector<CarrierPlace> places = last_places_;
  for (CarrierId id : active_) {
    const Carrier& carrier = carriers_[id.position()];
    places[id.position()] = {carrier.at, carrier.side, true};
  }
  return places;
}

const std::vector<CarrierId>& Carriers::known(const Instruction& instruction) {
  set_.clear();
  for (CarrierId id : instruction.carriers) {
    if (!id.valid() || id.position() >= carriers_.size()) {
      diagnostics_.error(instruction.at, "this names a carrier that the programme does not have");
    } else if (contains(set_, id)) {
      diagnostics_.error(instruction.at, "carrier " + name(id) + " is named twice: name it once");
    } else {
      set_.push_back(id);
    }
  }
  return set_;
}

bool Carriers::hook_holds_exactly(std::vector<CarrierId> set) const {
  std::sort(set.begin(), set.end());
  return !set.empty() && set == hook_.holds;
}

void Carriers::empty_hook() {
  for (CarrierId id : hook_.holds) carriers_[id.position()].in_hook = false;
  hook_ = Hook();
}

std::string Carriers::names(const std::vector<CarrierId>& set) const {
  std::string text;
  for (CarrierId id : set)
    if (id.valid() && id.position() < program_.carriers.size()) text += (text.empty() ? "" : " ") + name(id);
  return text;
}

std::string Carriers::line_of(int instruction) const {
  return instruction < 0 ? "its first use" : "line " + std::to_string(at(instruction).line);
}

SourceLocation Carriers::at(int instruction) const {
  return instruction < 0 ? SourceLocation() : program_.instructions[static_cast<std::size_t>(instruction)].at;
}

}  // namespace loopwright
