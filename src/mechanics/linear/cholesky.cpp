#include "mechanics/linear/cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "mechanics/linear/lower_columns.hpp"
#ifdef LOOPWRIGHT_HAS_CHOLMOD
#include "mechanics/linear/supernodal_single.hpp"
#else
#include <Eigen/SparseCholesky>
#endif

#ifdef LOOPWRIGHT_HAS_CHOLMOD
// OpenBLAS, if that is the BLAS in use: its threads would fight with ours, and results must not depend on
// their number.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
// CHOLMOD asks for four OpenMP threads at every loop of a factor, whatever OMP_NUM_THREADS says: only a limit
// of no active level holds it to the calling thread (OpenMP 5.0, 3.2.15; weak: a CHOLMOD without OpenMP has
// neither).
extern "C" void omp_set_max_active_levels(int) __attribute__((weak));
extern "C" int omp_get_max_active_levels() __attribute__((weak));
#endif

namespace loopwright {
namespace {

#ifdef LOOPWRIGHT_HAS_CHOLMOD
// While it lives, OpenMP starts no threads for the thread that made it.
class OneOpenMpThread {
 public:
  OneOpenMpThread() {
    if (omp_set_max_active_levels) omp_set_max_active_levels(0);
  }
  ~OneOpenMpThread() {
    if (omp_set_max_active_levels) omp_set_max_active_levels(levels_);
  }
  OneOpenMpThread(const OneOpenMpThread&) = delete;
  OneOpenMpThread& operator=(const OneOpenMpThread&) = delete;

 private:
  int levels_ = omp_get_max_active_levels ? omp_get_max_active_levels() : 1;
};
#endif

}  // namespace

bool invert3(const Block& s, Block& inverse) {
  Block l{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = s[3 * i + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[3 * i + k] * l[3 * j + k];
      if (i == j) {
        if (!(sum > 0)) return false;
        l[3 * i + i] = std::sqrt(sum);
      } else {
        l[3 * i + j] = sum / l[3 * j + j];
      }
    }
  for (std::size_t c = 0; c < 3; ++c) {
    std::array<double, 3> y{};
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = i == c ? 1 : 0;
      for (std::size_t k = 0; k < i; ++k) sum -= l[3 * i + k] * y[k];
      y[i] = sum / l[3 * i + i];
    }
    for (std::size_t i = 3; i-- > 0;) {
      double sum = y[i];
      for (std::size_t k = i + 1; k < 3; ++k) sum -= l[3 * k + i] * inverse[3 * k + c];
      inverse[3 * i + c] = sum / l[3 * i + i];
    }
  }
  return true;
}

struct Cholesky::Factor {
  std::vector<std::int32_t> row_start, column;  // pattern of the analysed matrix
  LowerColumns lower;
  int unknowns = 0;
  std::array<std::vector<double>, 3> border_solution;  // A^-1 C
  std::vector<Block> border;
  Block corner_inverse{};
  std::vector<Unknowns> dyad_solution;  // K^-1 v of every dyad, K: the matrix without them
  Eigen::LLT<Eigen::MatrixXd> capacity;
#ifdef LOOPWRIGHT_HAS_CHOLMOD
  SupernodalSingle single;  // in use after compact()
  cholmod_common common{};
  cholmod_factor* factor = nullptr;
  std::vector<int> order;  // [place in the factor] control point
  double best_entries = 0;
  std::vector<double> right;  // in that order
  Factor() {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    // What it is given is in order already: it then factors that as it lies instead of turning it over twice.
    common.method[0].ordering = CHOLMOD_NATURAL;
    common.postorder = 0;
    common.error_handler = nullptr;
  }
  ~Factor() {
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;

  cholmod_sparse view() {
    cholmod_sparse a{};
    a.nrow = a.ncol = static_cast<std::size_t>(unknowns);
    a.nzmax = lower.row.size();
    a.p = lower.start.data();
    a.i = lower.row.data();
    a.x = lower.value.data();
    a.stype = -1;
    a.itype = CHOLMOD_INT;
    a.xtype = CHOLMOD_REAL;
    a.dtype = CHOLMOD_DOUBLE;
    a.sorted = a.packed = 1;
    return a;
  }
  // Orders control points (not coordinates): three times fewer rows, nine times fewer entries to look at.
  // Contacts come and go between neighbours, which hardly spoils an order, so it is kept until the factor has
  // grown by a quarter.
  void order_nodes(const BlockMatrix& m) {
    std::vector<int> start{0}, row;
    for (int i = 0; i < m.rows(); ++i) {
      for (auto k = static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i) + 1]); ++k)
        if (m.column[k] >= i) row.push_back(m.column[k]);
      start.push_back(static_cast<int>(row.size()));
    }
    cholmod_sparse graph{};
    graph.nrow = graph.ncol = static_cast<std::size_t>(m.rows());
    graph.nzmax = row.size();
    graph.p = start.data();
    graph.i = row.data();
    graph.stype = -1;
    graph.itype = CHOLMOD_INT;
    graph.xtype = CHOLMOD_PATTERN;
    graph.dtype = CHOLMOD_DOUBLE;
    graph.sorted = graph.packed = 1;
    const auto rows = static_cast<std::size_t>(m.rows());
    std::vector<int> first(rows);
    // METIS draws from the C library's one random generator, which it seeds anew at every call: one call at a
    // time, or the order (and the last bits of the solution) depends on what other threads factor meanwhile.
    static std::mutex metis;
    const auto nested_dissection = [&] {
      const std::lock_guard lock(metis);
      return cholmod_metis(&graph, nullptr, 0, 1, first.data(), &common) != 0;
    };
    const bool nested = m.rows() > 2000 && nested_dissection();
    if (!nested && !cholmod_amd(&graph, nullptr, 0, first.data(), &common))
      throw std::runtime_error("ordering the stiffness matrix failed (out of memory?)");
    // Each tree of eliminations in one piece, so that its columns can be taken together.
    std::vector<int> parent(rows), post(rows), count(rows), work(2 * rows);
    if (!cholmod_analyze_ordering(&graph, nested ? CHOLMOD_METIS : CHOLMOD_AMD, first.data(), nullptr, 0,
                                  parent.data(), post.data(), count.data(), work.data(), work.data() + rows,
                                  &common))
      throw std::runtime_error("analysing the stiffness matrix failed (out of memory?)");
    order.resize(rows);
    for (std::size_t i = 0; i < rows; ++i) order[i] = first[static_cast<std::size_t>(post[i])];
    best_entries = 0;
  }
  void clear() {
    single = {};
    cholmod_free_factor(&factor, &common);
    forget_pattern();
  }
  void forget_pattern() {  // assigning {} would keep the memory
    std::vector<std::int32_t>().swap(row_start);
    std::vector<std::int32_t>().swap(column);
  }
  void compact() {
    if (!factor) return;
    single = SupernodalSingle(*factor, order);
    cholmod_free_factor(&factor, &common);
    cholmod_free_work(&common);
    lower = {};
    forget_pattern();
  }
  void analyse(const BlockMatrix& m) {
    for (int attempt = 0; attempt < 2; ++attempt) {
      const bool fresh = order.size() != static_cast<std::size_t>(m.rows()) || attempt == 1;
      if (fresh) order_nodes(m);
      lower.set_pattern(m, order);
      cholmod_free_factor(&factor, &common);
      cholmod_sparse a = view();
      factor = cholmod_analyze(&a, &common);
      if (!factor) throw std::runtime_error("analysing the stiffness matrix failed (out of memory?)");
      if (best_entries == 0) best_entries = common.lnz;
      if (fresh || common.lnz < 1.25 * best_entries) return;
    }
  }
  bool numeric() {
    const OneOpenMpThread no_others;
    single = {};
    cholmod_sparse a = view();
    cholmod_factorize(&a, factor, &common);
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    return common.status == CHOLMOD_OK && factor->minor == factor->n;
  }
  void solve(const double* b, double* x) {
    if (!factor) return single.solve(b, x);
    right.resize(static_cast<std::size_t>(unknowns));
    for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(b + 3 * order[i], 3, &right[3 * i]);
    cholmod_dense rhs{};
    rhs.nrow = rhs.d = rhs.nzmax = static_cast<std::size_t>(unknowns);
    rhs.ncol = 1;
    rhs.x = right.data();
    rhs.xtype = CHOLMOD_REAL;
    rhs.dtype = CHOLMOD_DOUBLE;
    const OneOpenMpThread no_others;
    cholmod_dense* result = cholmod_solve(CHOLMOD_A, factor, &rhs, &common);
    if (!result) throw std::bad_alloc();
    const double* in_order = static_cast<const double*>(result->x);
    for (std::size_t i = 0; i < order.size(); ++i) std::copy_n(in_order + 3 * i, 3, x + 3 * order[i]);
    cholmod_free_dense(&result, &common);
  }
  double entries() const {
    return factor ? static_cast<double>(factor->xsize) : static_cast<double>(single.entries());
  }
#else
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> factorisation;
  Eigen::Map<const Eigen::SparseMatrix<double>> view() {
    return {unknowns,           unknowns,         static_cast<Eigen::Index>(lower.row.size()),
            lower.start.data(), lower.row.data(), lower.value.data()};
  }
  void compact() {}
  void clear() {}
  void analyse(const BlockMatrix& m) {
    lower.set_pattern(m, {});
    factorisation.analyzePattern(view());
  }
  bool numeric() {
    factorisation.factorize(view());
    return factorisation.info() == Eigen::Success;
  }
  void solve(const double* b, double* x) {
    Eigen::Map<Eigen::VectorXd>(x, unknowns) =
        factorisation.solve(Eigen::Map<const Eigen::VectorXd>(b, unknowns));
  }
  double entries() const {
    return static_cast<double>(factorisation.matrixL().nestedExpression().nonZeros());
  }
#endif
};

Cholesky::Cholesky() : factor_(std::make_unique<Factor>()) {}
Cholesky::~Cholesky() = default;

void Cholesky::compact() { factor_->compact(); }

void Cholesky::clear() { factor_->clear(); }

double Cholesky::factor_entries() const { return factor_->entries(); }

bool Cholesky::factor(const BlockMatrix& m, double shift) {
  Factor& f = *factor_;
  const bool known = f.row_start == m.row_start && f.column == m.column;
  f.unknowns = 3 * m.rows();
  if (!known) {
    f.analyse(m);
    f.row_start = m.row_start;
    f.column = m.column;
  }
  f.lower.set_values(m, shift);
  if (!f.numeric()) return false;

  // What has no border keeps none.
  const bool bordered =
      std::any_of(m.border.begin(), m.border.end(), [](const Block& c) { return c != Block{}; });
  f.border = bordered ? m.border : std::vector<Block>{};
  Block s = m.corner;
  std::vector<double> column(bordered ? static_cast<std::size_t>(f.unknowns) : 0);
  for (std::size_t k = 0; k < 3; ++k) {
    s[4 * k] += shift * m.measure_metric[k];
    bool empty = true;
    for (std::size_t i = 0; i < f.border.size(); ++i)
      for (std::size_t d = 0; d < 3; ++d) {
        column[3 * i + d] = f.border[i][3 * d + k];
        empty = empty && column[3 * i + d] == 0;
      }
    f.border_solution[k].assign(column.size(), 0);
    if (!empty) f.solve(column.data(), f.border_solution[k].data());
  }
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      for (std::size_t i = 0; i < f.border.size(); ++i)
        for (std::size_t d = 0; d < 3; ++d)
          s[3 * k + l] -= f.border[i][3 * d + k] * f.border_solution[l][3 * i + d];
  return invert3(s, f.corner_inverse) && factor_dyads(m);
}

// (K + V F V')^-1 = K^-1 - Z (F^-1 + V'Z)^-1 Z',  Z = K^-1 V
bool Cholesky::factor_dyads(const BlockMatrix& m) {
  Factor& f = *factor_;
  f.dyad_solution.clear();
  const auto count = static_cast<Eigen::Index>(m.dyads.size());
  if (count == 0) return true;
  Unknowns v;
  for (const Dyad& dyad : m.dyads) {
    v.u.assign(static_cast<std::size_t>(m.rows()), Vec3{});
    v.g = {};
    dyad.add_to(1, v);
    solve_without_dyads(v, f.dyad_solution.emplace_back());
  }
  Eigen::MatrixXd capacity(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      capacity(i, j) =
          m.dyads[static_cast<std::size_t>(i)].dot(f.dyad_solution[static_cast<std::size_t>(j)]) +
          (i == j ? 1 / m.dyads[static_cast<std::size_t>(i)].factor : 0);
  f.capacity.compute(capacity);
  return f.capacity.info() == Eigen::Success;
}

void Cholesky::solve(const Unknowns& b, Unknowns& x) {
  Factor& f = *factor_;
  const auto count = static_cast<Eigen::Index>(f.dyad_solution.size());
  Eigen::VectorXd share(count);
  for (Eigen::Index i = 0; i < count; ++i) share[i] = dot(f.dyad_solution[static_cast<std::size_t>(i)], b);
  solve_without_dyads(b, x);
  if (count == 0) return;
  share = f.capacity.solve(share);
  for (Eigen::Index i = 0; i < count; ++i) axpy(-share[i], f.dyad_solution[static_cast<std::size_t>(i)], x);
}

void Cholesky::solve_without_dyads(const Unknowns& b, Unknowns& x) {
  Factor& f = *factor_;
  std::vector<double> rhs(static_cast<std::size_t>(f.unknowns)), u(rhs.size());
  for (std::size_t i = 0; i < b.u.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) rhs[3 * i + d] = b.u[i][static_cast<int>(d)];
  f.solve(rhs.data(), u.data());
  Measures r = b.g;
  for (std::size_t i = 0; i < f.border.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d)
      for (std::size_t k = 0; k < 3; ++k) r[k] -= f.border[i][3 * d + k] * u[3 * i + d];
  x.u.resize(b.u.size());
  for (std::size_t k = 0; k < 3; ++k) {
    x.g[k] = 0;
    for (std::size_t l = 0; l < 3; ++l) x.g[k] += f.corner_inverse[3 * k + l] * r[l];
  }
  for (std::size_t i = 0; i < x.u.size(); ++i)
    for (std::size_t d = 0; d < 3; ++d) {
      double v = u[3 * i + d];
      if (!f.border.empty())
        for (std::size_t k = 0; k < 3; ++k) v -= f.border_solution[k][3 * i + d] * x.g[k];
      x.u[i][static_cast<int>(d)] = v;
    }
}

}  // namespace loopwright
