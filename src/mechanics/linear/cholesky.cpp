#include "mechanics/linear/cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

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

constexpr int small_order = 3000;  // unknowns

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

// Lower triangle in compressed columns = upper triangle by rows of the symmetric matrix.
struct LowerColumns {
  std::vector<int> start, row;
  std::vector<double> value;
};

void lower_pattern(const BlockMatrix& m, LowerColumns& out) {
  const int n = 3 * m.rows();
  out.start.assign(static_cast<std::size_t>(n) + 1, 0);
  out.row.clear();
  for (int i = 0; i < m.rows(); ++i)
    for (int r = 0; r < 3; ++r) {
      const auto column = static_cast<std::size_t>(3 * i + r);
      for (auto k = static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i) + 1]); ++k) {
        const int j = m.column[k];
        if (j < i) continue;
        for (int c = j == i ? r : 0; c < 3; ++c) out.row.push_back(3 * j + c);
      }
      out.start[column + 1] = static_cast<int>(out.row.size());
    }
  out.value.resize(out.row.size());
}

void lower_values(const BlockMatrix& m, double shift, LowerColumns& out) {
  std::size_t at = 0;
  for (int i = 0; i < m.rows(); ++i)
    for (std::size_t r = 0; r < 3; ++r)
      for (auto k = static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i)]);
           k < static_cast<std::size_t>(m.row_start[static_cast<std::size_t>(i) + 1]); ++k) {
        const int j = m.column[k];
        if (j < i) continue;
        const Block& b = m.block[k];
        for (std::size_t c = j == i ? r : 0; c < 3; ++c)
          out.value[at++] = b[3 * r + c] + (c == r ? shift * m.metric[k] : 0);
      }
}

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
  std::vector<int> order;
  double best_entries = 0;
  Factor() {
    if (openblas_set_num_threads) openblas_set_num_threads(1);
    cholmod_start(&common);
    common.print = 0;
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_AMD;
    common.postorder = 1;
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
    std::vector<int> node_order(static_cast<std::size_t>(m.rows()));
    // METIS draws from the C library's one random generator, which it seeds anew at every call: one call at a
    // time, or the order (and the last bits of the solution) depends on what other threads factor meanwhile.
    static std::mutex metis;
    const auto nested_dissection = [&] {
      const std::lock_guard lock(metis);
      return cholmod_metis(&graph, nullptr, 0, 1, node_order.data(), &common) != 0;
    };
    if (!(m.rows() > 2000 && nested_dissection()) &&
        !cholmod_amd(&graph, nullptr, 0, node_order.data(), &common))
      throw std::runtime_error("ordering the stiffness matrix failed (out of memory?)");
    order.clear();
    order.reserve(3 * node_order.size());
    for (const int i : node_order)
      for (int d = 0; d < 3; ++d) order.push_back(3 * i + d);
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
    single = SupernodalSingle(*factor);
    cholmod_free_factor(&factor, &common);
    cholmod_free_work(&common);
    lower = {};
    forget_pattern();
    // Found again sooner than kept, for the many small factors of a large piece.
    if (unknowns < small_order) std::vector<int>().swap(order);
  }
  void analyse(const BlockMatrix& m) {
    for (int attempt = 0; attempt < 2; ++attempt) {
      const bool fresh = order.size() != static_cast<std::size_t>(unknowns) || attempt == 1;
      if (fresh) order_nodes(m);
      cholmod_free_factor(&factor, &common);
      common.method[0].ordering = CHOLMOD_GIVEN;
      cholmod_sparse a = view();
      factor = cholmod_analyze_p(&a, order.data(), nullptr, 0, &common);
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
    cholmod_dense rhs{};
    rhs.nrow = rhs.d = rhs.nzmax = static_cast<std::size_t>(unknowns);
    rhs.ncol = 1;
    rhs.x = const_cast<double*>(b);
    rhs.xtype = CHOLMOD_REAL;
    rhs.dtype = CHOLMOD_DOUBLE;
    const OneOpenMpThread no_others;
    cholmod_dense* result = cholmod_solve(CHOLMOD_A, factor, &rhs, &common);
    if (!result) throw std::bad_alloc();
    std::copy_n(static_cast<const double*>(result->x), unknowns, x);
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
  void analyse(const BlockMatrix&) { factorisation.analyzePattern(view()); }
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
  if (!known) lower_pattern(m, f.lower);
  lower_values(m, shift, f.lower);
  if (!known) {
    f.analyse(m);
    f.row_start = m.row_start;
    f.column = m.column;
  }
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
