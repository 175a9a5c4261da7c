#include "outputs/exchange/write_beams.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/beam_chains.hpp"
#include "outputs/state_material.hpp"

namespace loopwright {
namespace {

// Twelve digits: fields of these programs have room for twenty characters.
std::string real(double value) {
  std::array<char, 40> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value + 0.0, std::chars_format::general, 12).ptr;
  std::string out(text.data(), end);
  if (out.find_first_of(".e") == std::string::npos) out += '.';
  return out;
}

// CalculiX has round beams of three nodes only.
ExportOptions in_dialect(ExportOptions options, BeamDialect dialect) {
  options.quadratic_beams = options.quadratic_beams || dialect == BeamDialect::calculix;
  return options;
}

class BeamWriter {
 public:
  BeamWriter(std::ostream& out, const State& state, BeamDialect dialect, const ExportOptions& options)
      : out_(out),
        state_(state),
        fabric_(state.fabric),
        dialect_(dialect),
        quadratic_(options.quadratic_beams),
        model_(beam_chains(state.fabric, options)) {
    std::size_t next = 1;
    for (const BeamChain& chain : model_.chains) {
      first_node_.push_back(next);
      next += chain.places.size();
    }
    last_node_ = next - 1;
  }

  void write() {
    put_heading();
    put_nodes();
    put_elements();
    put_node_sets();
    put_sections();
    if (dialect_ == BeamDialect::abaqus) put_surfaces();
    if (!model_.cuts.empty()) put_periodicity();
  }

 private:
  void put_heading() {
    out_ << "** Loopwright: yarns as beams. Units: mm, N, t, s, MPa.\n"
         << "** x along a course, y along a wale, z toward the front bed.\n"
         << "** Include this file in the one that has the steps: *INCLUDE, INPUT=...\n";
    if (fabric_.periodic)
      out_ << "** One cell of a periodic fabric, cut at its faces: a1 = (" << real(mm(fabric_.width))
           << ", 0, 0), a2 = (" << real(mm(fabric_.skew)) << ", " << real(mm(fabric_.height)) << ", 0)\n";
  }

  // In one block: some readers (meshio 5) keep only the last one.
  void put_nodes() {
    out_ << "*NODE\n";
    for (std::size_t c = 0; c < model_.chains.size(); ++c)
      for (std::size_t k = 0; k < model_.chains[c].places.size(); ++k)
        put_node(first_node_[c] + k, model_.chains[c].places[k]);
    if (!model_.cuts.empty()) {
      // beside the cell, so that they are found in a picture
      put_node(last_node_ + 1, fabric_.lattice(1, 0));
      put_node(last_node_ + 2, fabric_.lattice(0, 1));
    }
    out_ << "*NSET, NSET=NODES, GENERATE\n1, " << last_node_ << ", 1\n";
    if (model_.cuts.empty()) return;
    put_set("CELL_X", {last_node_ + 1});
    put_set("CELL_Y", {last_node_ + 2});
  }

  void put_node(std::size_t number, const Vec3& place) {
    const Vec3 p = place * fabric_.diameter_mm;
    out_ << number << ", " << real(p.x) << ", " << real(p.y) << ", " << real(p.z) << '\n';
  }

  void put_elements() {
    std::size_t element = 1, yarn = std::numeric_limits<std::size_t>::max();
    for (std::size_t c = 0; c < model_.chains.size(); ++c) {
      const BeamChain& chain = model_.chains[c];
      if (chain.yarn != yarn) {
        yarn = chain.yarn;
        out_ << "*ELEMENT, TYPE=" << (quadratic_ ? "B32" : "B31") << ", ELSET=YARN_" << yarn << '\n';
      }
      const std::size_t n = chain.places.size(), step = quadratic_ ? 2 : 1;
      const std::size_t end = chain.closed ? n : n - 1;
      for (std::size_t k = 0; k < end; k += step) {
        out_ << element++;
        for (std::size_t j = 0; j <= step; ++j) out_ << ", " << first_node_[c] + (k + j) % n;
        out_ << '\n';
      }
    }
    out_ << "*ELSET, ELSET=YARNS\n";
    for (std::size_t y = 0; y < fabric_.yarns.size(); ++y) out_ << "YARN_" << y << ",\n";
  }

  void put_set(const char* name, const std::vector<std::size_t>& nodes, bool sorted = true) {
    if (nodes.empty()) return;
    out_ << "*NSET, NSET=" << name;
    if (!sorted && dialect_ == BeamDialect::abaqus) out_ << ", UNSORTED";
    out_ << '\n';
    for (std::size_t k = 0; k < nodes.size(); ++k)
      out_ << nodes[k] << (k + 1 == nodes.size() ? "\n" : k % 8 == 7 ? ",\n" : ", ");
  }

  void put_node_sets() {
    std::array<std::vector<std::size_t>, 4> edges;
    const auto edge = [&edges](CellFace face) -> std::vector<std::size_t>& {
      return edges[static_cast<std::size_t>(face)];
    };
    if (fabric_.periodic) {
      for (const auto& [out, in] : model_.cuts) {
        edge(out.face).push_back(node(out));
        edge(in.face).push_back(node(in));
      }
    } else {
      each_node([&](std::size_t number, const Vec3& p) {
        if (p.x <= low_.x + band_.x) edge(CellFace::left).push_back(number);
        if (p.x >= high_.x - band_.x) edge(CellFace::right).push_back(number);
        if (p.y <= low_.y + band_.y) edge(CellFace::bottom).push_back(number);
        if (p.y >= high_.y - band_.y) edge(CellFace::top).push_back(number);
      });
    }
    constexpr std::array<const char*, 4> names{"EDGE_LEFT", "EDGE_RIGHT", "EDGE_BOTTOM", "EDGE_TOP"};
    for (std::size_t k = 0; k < 4; ++k) put_set(names[k], edges[k], !fabric_.periodic);
    if (fabric_.periodic) return;
    std::vector<std::size_t> ends, held;
    for (std::size_t c = 0; c < model_.chains.size(); ++c) {
      const BeamChain& chain = model_.chains[c];
      if (!chain.closed) {
        ends.push_back(first_node_[c]);
        ends.push_back(first_node_[c] + chain.places.size() - 1);
      }
      add_held(c, held);
    }
    put_set("YARN_ENDS", ends);
    put_set("HELD", held);
  }

  // Control point i acts most at parameter i - 1; nodes are at equal steps of the parameter.
  void add_held(std::size_t c, std::vector<std::size_t>& held) const {
    const BeamChain& chain = model_.chains[c];
    const FabricYarn& yarn = fabric_.yarns[chain.yarn];
    const std::size_t steps = chain.closed ? chain.places.size() : chain.places.size() - 1;
    std::vector<std::size_t> nodes;
    for (std::size_t i = 0; i < yarn.held.size(); ++i) {
      if (yarn.held[i] == 0) continue;
      const double t = std::clamp(static_cast<double>(i) - 1, 0.0, static_cast<double>(yarn.segments()));
      const auto k = static_cast<std::size_t>(std::lround(t / yarn.segments() * static_cast<double>(steps)));
      nodes.push_back(first_node_[c] + std::min(k, chain.places.size() - 1));
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    held.insert(held.end(), nodes.begin(), nodes.end());
  }

  template <class Visit>
  void each_node(Visit visit) {
    constexpr double inf = std::numeric_limits<double>::infinity();
    low_ = {inf, inf, inf}, high_ = -low_;
    for (const BeamChain& chain : model_.chains)
      for (const Vec3& p : chain.places)
        for (int k = 0; k < 3; ++k) low_[k] = std::min(low_[k], p[k]), high_[k] = std::max(high_[k], p[k]);
    band_ = {fabric_.wales > 0 ? 0.5 * fabric_.width / fabric_.wales : 1,
             fabric_.courses > 0 ? 0.5 * fabric_.height / fabric_.courses : 1, 0};
    for (std::size_t c = 0; c < model_.chains.size(); ++c)
      for (std::size_t k = 0; k < model_.chains[c].places.size(); ++k)
        visit(first_node_[c] + k, model_.chains[c].places[k]);
  }

  // A direction that no element of the yarn comes near to: the section's first axis must not lie along a
  // beam.
  Vec3 first_axis(std::size_t yarn) const {
    Vec3 best{0, 0, 1};
    double most = -1;
    constexpr int tries = 64;
    for (int k = 0; k < tries; ++k) {
      // a spiral over the half sphere, evenly
      const double z = 1 - (k + 0.5) / tries, angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
      const double across = std::sqrt(1 - z * z);
      const Vec3 axis{across * std::cos(angle), across * std::sin(angle), z};
      double least = 1;
      for (const BeamChain& chain : model_.chains) {
        if (chain.yarn != yarn) continue;
        for (std::size_t j = 0; j + 1 < chain.places.size(); ++j) {
          const Vec3 along = chain.places[j + 1] - chain.places[j];
          const double length = norm(along);
          if (length > 0) least = std::min(least, norm(cross(axis, along)) / length);
        }
      }
      if (least > most) most = least, best = axis;
    }
    return best;
  }

  void put_sections() {
    const std::optional<YarnMaterial> material = state_material(state_);
    const double reference = material ? material->reference_bend_N_m2 * 1e6 : 0;  // N mm^2
    for (std::size_t y = 0; y < fabric_.yarns.size(); ++y) {
      const FabricYarn& yarn = fabric_.yarns[y];
      const double radius = mm(yarn.diameter) / 2, area = std::numbers::pi * radius * radius;
      const double share = yarn.diameter * yarn.diameter;  // stiffness grows with the section (YarnModel)
      double modulus = 1;
      if (reference > 0) {
        const double bend = reference * material->bend_stiffness * share;
        modulus = bend / (area * radius * radius / 4);
        const double stretch =
            reference * material->stretch_stiffness * share / (fabric_.diameter_mm * fabric_.diameter_mm);
        out_ << "** yarn " << y << ": bending stiffness " << real(bend) << " N mm^2, as this section has it. "
             << "Stretch stiffness " << real(stretch) << " N; this section's is " << real(modulus * area)
             << " N.\n";
      } else {
        out_ << "** yarn " << y << ": its bending stiffness is not known; the modulus stands for any.\n";
      }
      const bool calculix = dialect_ == BeamDialect::calculix;
      out_ << "*MATERIAL, NAME=YARN_" << y << "\n*ELASTIC\n" << real(modulus) << ", 0.3\n";
      if (yarn.linear_density_tex > 0)  // 1 tex = 1e-12 t/mm
        out_ << "*DENSITY\n" << real(yarn.linear_density_tex * 1e-12 / area) << '\n';
      out_ << "*BEAM SECTION, ELSET=YARN_" << y << ", MATERIAL=YARN_" << y << ", SECTION=CIRC\n";
      // Abaqus takes the radius, CalculiX both diameters of an ellipse
      if (calculix)
        out_ << real(2 * radius) << ", " << real(2 * radius) << '\n';
      else
        out_ << real(radius) << '\n';
      const Vec3 axis = first_axis(y);
      out_ << real(axis.x) << ", " << real(axis.y) << ", " << real(axis.z) << '\n';
    }
  }

  void put_surfaces() {
    for (std::size_t y = 0; y < fabric_.yarns.size(); ++y)
      out_ << "*SURFACE, TYPE=ELEMENT, NAME=SURFACE_YARN_" << y << "\nYARN_" << y << ",\n";
  }

  // What leaves through one face moves like what comes in opposite, plus the change of the lattice vector.
  void put_periodicity() {
    out_ << "** opposite cuts: u(right) - u(left) = u(CELL_X), u(top) - u(bottom) = u(CELL_Y); rotations are "
            "equal\n";
    for (const auto& [out, in] : model_.cuts) {
      const bool forward = out.face == CellFace::right || out.face == CellFace::top;
      const std::size_t far = node(forward ? out : in), near = node(forward ? in : out);
      const bool along_x = out.face == CellFace::left || out.face == CellFace::right;
      const std::size_t carrier = last_node_ + (along_x ? 1 : 2);
      for (int dof = 1; dof <= 6; ++dof) {
        out_ << "*EQUATION\n" << (dof <= 3 ? 3 : 2) << '\n';
        out_ << far << ", " << dof << ", 1., " << near << ", " << dof << ", -1.";
        if (dof <= 3) out_ << ", " << carrier << ", " << dof << ", -1.";
        out_ << '\n';
      }
    }
  }

  std::size_t node(const FaceNode& at) const { return first_node_[at.chain] + at.node; }
  double mm(double d) const { return d * fabric_.diameter_mm; }

  std::ostream& out_;
  const State& state_;
  const Fabric& fabric_;
  BeamDialect dialect_;
  bool quadratic_;
  BeamChains model_;
  std::vector<std::size_t> first_node_;
  std::size_t last_node_ = 0;
  Vec3 low_, high_, band_;
};

}  // namespace

void write_beams(const std::filesystem::path& path, const State& state, BeamDialect dialect,
                 const ExportOptions& options) {
  AtomicFile file(path);
  BeamWriter(file.stream(), state, dialect, in_dialect(options, dialect)).write();
  file.commit();
}

}  // namespace loopwright
