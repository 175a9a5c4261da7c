// Yarns in motion: material splines, what binds them to each other, and steps in time.
//
// Explicit (symplectic Euler; constraints on velocities):
//   M v+ = M v + dt (Q(q) + J' lambda),   J v+ = -beta C / dt,   q+ = q + dt v+
// M is factored once; with barycentric bindings so is [M J'; J -eps], one scalar matrix for x, y and z. beta
// is Baumgarte's stabilisation.
//
// Implicit (Euler): q+ is a stationary point of the incremental potential under the constraints,
//   1/(2 dt^2) |q - q_n - dt v_n|_M^2 + c/(2 dt) |q - q_n|_M^2 + U(q) - F . q,   C(q) = 0,   v+ = (q+ - q_n)
//   / dt
// found by Newton's method on q and lambda, with the second derivatives of C and a line search on an exact
// penalty; a step that does not come to its tolerance is taken in halves. Constraints hold at its end to
// rounding: nothing is left to stabilise.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "dynamics/bindings.hpp"
#include "dynamics/spline_model.hpp"
#include "dynamics/yarn_energy.hpp"
#include "mechanics/newton.hpp"

namespace loopwright {

enum class MotionStepper : std::uint8_t { explicit_euler, implicit_euler };

struct MotionOptions {
  MotionStepper stepper = MotionStepper::implicit_euler;
  double tolerance = 1e-4;             // implicit: largest force on a control point that is left
  double constraint_tolerance = 1e-8;  // implicit: largest |C|
  int most_newton = 12;                // before a step is halved
  int most_halvings = 5;               // down to this power of two of a step
  double baumgarte = 0.2;              // explicit: share of C that one step takes back
};

// Contact of src/mechanics: shell, core and friction between any two pieces of yarn of a fabric of B-splines.
struct FabricContact {
  YarnModel model;         // its stretch and bend are not used
  ContactHistory history;  // friction's, of the run that this one goes on from
  double width = 0, height = 0;
  // The yarn's own core; the model's is smaller where the start has yarns nearer than that, and grows as room
  // is made.
  double full_core = 0.5;
};

struct MotionEnergy {
  double kinetic = 0, stretch = 0, bend = 0, bindings = 0, contact = 0;
  double load = 0;  // of gravity and the external forces: minus their work from the origin
  double total() const { return kinetic + stretch + bend + bindings + contact + load; }
};

struct StepReport {
  int newton = 0, factorisations = 0, halvings = 0;
  bool converged = true;  // to the tolerances
  int pass_throughs = 0;  // contact: steps that could not be certified
};

class YarnMotion {
 public:
  // Throws std::invalid_argument for models that are not sound and for an explicit step with contact (its
  // shell is too stiff for that).
  YarnMotion(SplineModel model, MotionState state, Bindings bindings, const MotionOptions& options = {},
             std::optional<FabricContact> contact = std::nullopt);
  ~YarnMotion();
  YarnMotion(YarnMotion&&) noexcept;

  // One step of dt. `held_place`, if not empty, is where held points are at its end ([points]; others are not
  // looked at).
  StepReport step(double dt, std::span<const Vec3> held_place = {});

  const MotionState& state() const { return state_; }
  const SplineModel& model() const { return model_; }
  const Bindings& bindings() const { return bindings_; }
  // Loads may change while the yarn moves.
  void set_gravity(const Vec3& gravity) { model_.gravity = gravity; }
  void set_force(std::vector<Vec3> force);
  void set_drag(double drag) { model_.drag = drag; }

  MotionEnergy energy() const;
  Vec3 momentum() const;
  Vec3 angular_momentum() const;    // about the origin
  double constraint_error() const;  // largest |C|
  // Force of everything elastic and of the bindings on each control point; held ones: what the holder
  // carries, with its sign turned. Contact is not in it.
  std::vector<Vec3> forces() const;
  // dU/de if all control points were carried along affinely, x -> x (1 + e) about x = 0, divided by `width`:
  // the force that a frame which is now of that width carries at rest, contact included.
  double course_force(double width) const;
  double contact_core() const;  // 0 without contact

 private:
  struct Solver;
  StepReport explicit_step(double dt);
  bool let_go();
  bool implicit_step(double dt, StepReport& report, bool smallest);
  bool contact_step(double dt, StepReport& report);
  void grow_core();
  void prepare_friction(double dt);
  bool can_move(const ShortestConnection& connection) const;
  bool holds(std::size_t k, const ShortestConnection& connection) const {
    return pressing_[k] != 0 && can_move(connection);
  }
  double mobility(const ShortestConnection& connection) const;
  void accept_friction();
  double potential(const std::vector<Vec3>& place) const;
  double gradient(const std::vector<Vec3>& place, std::vector<Vec3>& g, BandHessian* band) const;
  std::vector<Vec3> inertial_place(double dt) const;
  double incremental(const std::vector<Vec3>& place, const std::vector<Vec3>& inertial, double dt) const;
  void weigh(std::span<const Vec3> x, std::vector<Vec3>& y) const;  // y = M x

  SplineModel model_;
  MotionState state_;
  Bindings bindings_;
  MotionOptions options_;
  std::optional<FabricContact> contact_;
  double part_ = 1;  // of a step that went well last
  std::vector<BandMatrix> mass_;
  std::vector<double> lumped_;             // row sums of M
  std::vector<Vec3> multiplier_;           // of barycentric bindings
  std::vector<Friction> friction_;         // of sliding bindings, as the step began
  std::vector<std::uint8_t> pressing_;     // 0: a guard whose yarns are apart
  std::vector<ShortestConnection> start_;  // of sliding bindings, as the step began
  std::unique_ptr<Solver> solver_;
};

// How the unit system of a fabric (d, B/d, rho d) reads in SI.
struct MotionUnits {
  double length_m = 1, time_s = 1, force_N = 1;
  double acceleration(double m_s2) const { return m_s2 * time_s * time_s / length_m; }
};
// `bend_N_m2`: B of the reference yarn. Throws std::invalid_argument if it or the linear density of the
// thickest yarn is not known.
MotionUnits motion_units(const Fabric& fabric, double bend_N_m2);

// The yarns of a finite fabric (its control points in a row) with the material's stiffness. `set`: share of
// their curvature that they keep as natural curvature. Throws std::invalid_argument for periodic fabrics:
// a cell's lattice has no place in motion. `drawn_lengths`: every segment is unstretched as it is (first
// curves are drawn longer or shorter than their yarn); else it has the yarn's own length.
SplineModel spline_model(const Fabric& fabric, const YarnMaterial& material, double set = 0,
                         bool drawn_lengths = false);
MotionState motion_state(const Fabric& fabric);
// Contact for the same fabric, with a core that fits between its yarns; `history` and plates of the
// equilibrium that the motion starts from.
FabricContact fabric_contact(const Fabric& fabric, const ModelOptions& options, ContactHistory history = {});
// The fabric with these places.
Fabric with_places(const Fabric& fabric, std::span<const Vec3> place);

}  // namespace loopwright
