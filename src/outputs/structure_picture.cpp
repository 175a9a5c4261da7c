#include "outputs/structure_picture.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "loop_scale/nurbs.hpp"
#include "outputs/canvas.hpp"
#include "outputs/gl_program.hpp"
#include "outputs/headless_gl.hpp"

namespace loopwright {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour red{205, 45, 40}, green{40, 150, 70}, blue{45, 85, 200}, grey{150, 150, 150},
    black{20, 20, 20}, floor_colour{214, 218, 222}, white{252, 252, 250};

// The NURBS curve through the type value points, as a polyline.
std::vector<Vec3> curve_points(const std::vector<Vec3>& points, int steps) {
  const NurbsCurve curve = interpolate(points, {3, Parametrisation::chord_length, NurbsEnds::natural, {}});
  std::vector<Vec3> line;
  for (std::size_t k = 3; k < curve.control_points.size(); ++k)
    for (int i = 0; i < steps; ++i)
      line.push_back(position(curve, curve.knots[k] + (curve.knots[k + 1] - curve.knots[k]) * i / steps));
  line.push_back(points.back());
  return line;
}

void add_curves(const LoopModel& model, const NetState& state, StructureStyle style, const Vec3& aside,
                StructureScene& scene) {
  const YarnCurves curves = curves_at(model, state);
  constexpr int steps = 6;
  const double dash = 0.6 * model.geometry.shape_radius();
  for (const CurveYarn& yarn : curves.yarns) {
    std::vector<Vec3> points;
    for (const TypePoint& p : yarn.points)
      if (points.empty() || distance(points.back(), p.position + aside) > 1e-9)
        points.push_back(p.position + aside);
    if (points.size() < 2) continue;
    const std::vector<Vec3> line = curve_points(points, steps);
    if (style == StructureStyle::net || points.size() != yarn.points.size()) {
      scene.add_line(line, black, dash, 1);
      continue;
    }
    // one line as long as the side stays the same
    const auto colour_of = [&](std::size_t k) {
      return model.side[yarn.points[k].loop.position()] == StitchSide::front ? green : blue;
    };
    for (std::size_t k = 0; k + 1 < yarn.points.size();) {
      std::size_t end = k + 1;
      while (end + 1 < yarn.points.size() && colour_of(end) == colour_of(k)) ++end;
      scene.add_line(std::span(line).subspan(k * steps, (end - k) * steps + 1), colour_of(k), 0, 3);
      k = end;
    }
  }
}

}  // namespace

void StructureScene::add_line(std::span<const Vec3> way, std::array<std::uint8_t, 3> colour, double dash,
                              double width) {
  lines.push_back({points.size(), way.size(), colour, dash, width});
  points.insert(points.end(), way.begin(), way.end());
}

StructureScene structure_scene(const LoopModel& model, const NetState& state, StructureStyle style,
                               const Vec3& aside) {
  StructureScene scene;
  add_curves(model, state, style, aside, scene);
  if (style == StructureStyle::sides) return scene;
  const double r = model.geometry.shape_radius(), side = 0.7 * r;
  for (std::size_t i = 0; i < model.points.points.size(); ++i) {
    const Vec3 at = state.position(i) + aside;
    const BindingPoint& point = model.points.points[i];
    scene.cubes.push_back({at, side, red});
    if (!point.lower_of.empty()) scene.cubes.push_back({at + Vec3{0, side, 0}, side, blue});
    if (!point.upper_of.empty()) scene.cubes.push_back({at - Vec3{0, side, 0}, side, green});
  }
  for (const Spring& s : model.net.springs)
    if (s.kind == SpringKind::weft || s.kind == SpringKind::warp)
      scene.add_line(std::array{state.position(static_cast<std::size_t>(s.a)) + aside,
                                state.position(static_cast<std::size_t>(s.b)) + aside},
                     grey, 0, 1.3);
  return scene;
}

void append(StructureScene& scene, const StructureScene& other) {
  scene.cubes.insert(scene.cubes.end(), other.cubes.begin(), other.cubes.end());
  for (const StructureScene::Line& l : other.lines)
    scene.add_line(std::span(other.points).subspan(l.first, l.count), l.colour, l.dash, l.width);
}

Bounds bounds_of(const StructureScene& scene) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
  const auto take = [&](const Vec3& p, double reach) {
    if (!is_finite(p)) throw std::invalid_argument("structure picture: a place is not finite");
    for (int i = 0; i < 3; ++i) {
      bounds.lower[i] = std::min(bounds.lower[i], p[i] - reach);
      bounds.upper[i] = std::max(bounds.upper[i], p[i] + reach);
    }
  };
  for (const StructureScene::Cube& c : scene.cubes) take(c.centre, c.side / 2);
  for (const Vec3& p : scene.points) take(p, 0);
  if (bounds.lower.x > bounds.upper.x)
    throw std::invalid_argument("structure picture: there is nothing to draw");
  return bounds;
}

void add_floor(StructureScene& scene, const Bounds& bounds) {
  const Vec3 size = bounds.upper - bounds.lower, centre = bounds.centre();
  const double wide = std::max(std::max(size.x, size.z), 1.0), y = bounds.lower.y - 0.04 * size.y;
  // about twelve squares across, as deep as a third of its width
  const double square = wide * 1.15 / 12;
  const int across = 6, deep = std::max(3, static_cast<int>(std::ceil(size.z / square / 2)) + 1);
  const double x_reach = across * square, z_reach = deep * square;
  const auto line = [&](Vec3 a, Vec3 b) { scene.add_line(std::array{a, b}, floor_colour, 0, 0.8); };
  for (int i = -across; i <= across; ++i)
    line({centre.x + i * square, y, centre.z - z_reach}, {centre.x + i * square, y, centre.z + z_reach});
  for (int i = -deep; i <= deep; ++i)
    line({centre.x - x_reach, y, centre.z + i * square}, {centre.x + x_reach, y, centre.z + i * square});
}

namespace {

struct Vertex {
  std::array<float, 4> place;  // in clip space
  std::array<float, 3> colour;
};

constexpr const char* vertex_shader = R"(#version 330 core
layout(location = 0) in vec4 place;
layout(location = 1) in vec3 colour;
out vec3 shade;
void main() { gl_Position = place; shade = colour; }
)";
constexpr const char* fragment_shader = R"(#version 330 core
in vec3 shade;
out vec4 pixel;
void main() { pixel = vec4(shade, 1); }
)";

// Projects on the processor, so that lines can be made as wide as they should be on the screen.
class Projector {
 public:
  Projector(const Camera& camera, int width, int height)
      : matrix_(camera.projection(static_cast<double>(width) / height) * camera.view()),
        width_(width),
        height_(height) {}

  std::array<float, 4> operator()(const Vec3& p) const {
    std::array<float, 4> out{};
    for (std::size_t row = 0; row < 4; ++row)
      out[row] = static_cast<float>(matrix_[row] * p.x + matrix_[4 + row] * p.y + matrix_[8 + row] * p.z +
                                    matrix_[12 + row]);
    return out;
  }

  void line(const Vec3& a, const Vec3& b, double pixels, const Colour& colour,
            std::vector<Vertex>& out) const {
    const std::array<float, 4> p = (*this)(a), q = (*this)(b);
    if (p[3] <= 0 || q[3] <= 0) return;
    const double dx = (q[0] / q[3] - p[0] / p[3]) * width_, dy = (q[1] / q[3] - p[1] / p[3]) * height_;
    const double length = std::hypot(dx, dy);
    // a point seen end on: a square
    const double ux = length > 1e-9 ? dx / length : 1, uy = length > 1e-9 ? dy / length : 0;
    const auto corner = [&](const std::array<float, 4>& at, double across, double along) {
      std::array<float, 4> moved = at;
      moved[0] += static_cast<float>((ux * along - uy * across) * pixels / width_ * at[3]);
      moved[1] += static_cast<float>((uy * along + ux * across) * pixels / height_ * at[3]);
      return Vertex{moved, shade(colour, 1)};
    };
    const Vertex a0 = corner(p, -1, -0.3), a1 = corner(p, 1, -0.3), b0 = corner(q, -1, 0.3),
                 b1 = corner(q, 1, 0.3);
    out.insert(out.end(), {a0, b0, a1, a1, b0, b1});
  }

  void cube(const StructureScene::Cube& cube, std::vector<Vertex>& out) const {
    const double h = cube.side / 2;
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        // light from the upper left in front
        Vec3 normal;
        normal[axis] = sign;
        const double light = 0.72 + 0.28 * dot(normal, normalized({-0.4, 0.7, 0.8}));
        std::array<Vertex, 4> face;
        for (int k = 0; k < 4; ++k) {
          Vec3 corner = cube.centre + normal * h;
          corner[(axis + 1) % 3] += (k % 2 == 0 ? -h : h);
          corner[(axis + 2) % 3] += (k / 2 == 0 ? -h : h);
          face[static_cast<std::size_t>(k)] = {(*this)(corner), shade(cube.colour, light)};
        }
        out.insert(out.end(), {face[0], face[1], face[2], face[2], face[1], face[3]});
      }
  }

 private:
  static std::array<float, 3> shade(const Colour& colour, double light) {
    std::array<float, 3> out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = static_cast<float>(std::min(1.0, colour[i] / 255.0 * light));
    return out;
  }
  Matrix4 matrix_;
  int width_, height_;
};

void draw_line(const StructureScene& scene, const StructureScene::Line& line, const Projector& projector,
               double pixels, std::vector<Vertex>& out) {
  double gone = 0;
  for (std::size_t k = line.first + 1; k < line.first + line.count; ++k) {
    const Vec3 a = scene.points[k - 1], b = scene.points[k];
    const double length = distance(a, b);
    if (line.dash <= 0) {
      projector.line(a, b, pixels * line.width, line.colour, out);
      continue;
    }
    // dashes run on over the corners of the polyline
    for (double s = 0; s < length - 1e-12;) {
      const double phase = std::fmod(gone + s, 2 * line.dash);
      const bool drawn = phase < line.dash;
      const double end = std::min(length, s + std::max((drawn ? line.dash : 2 * line.dash) - phase, 1e-9));
      if (drawn)
        projector.line(a + (b - a) * (s / length), a + (b - a) * (end / length), pixels * line.width,
                       line.colour, out);
      s = end;
    }
    gone += length;
  }
}

}  // namespace

struct StructurePainter::Gl {
  Gl() {
    program = linked_program(vertex_shader, fragment_shader);
    glGenVertexArrays(1, &array);
    glGenBuffers(1, &buffer);
    glBindVertexArray(array);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offsetof(Vertex, colour)));
    glBindVertexArray(0);
  }
  ~Gl() {
    glDeleteBuffers(1, &buffer);
    glDeleteVertexArrays(1, &array);
    glDeleteProgram(program);
  }
  Gl(const Gl&) = delete;
  Gl& operator=(const Gl&) = delete;

  GLuint program = 0, array = 0, buffer = 0;
  std::vector<Vertex> vertices;
};

StructurePainter::StructurePainter() : gl_(std::make_unique<Gl>()) {}
StructurePainter::~StructurePainter() = default;

void StructurePainter::clear(std::array<std::uint8_t, 3> background, int width, int height) {
  glViewport(0, 0, width, height);
  glDisable(GL_SCISSOR_TEST);
  glDepthMask(GL_TRUE);
  glClearColor(background[0] / 255.0F, background[1] / 255.0F, background[2] / 255.0F, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void StructurePainter::draw(const StructureScene& scene, const Camera& camera, int width, int height,
                            double line_pixels) {
  const Projector projector(camera, width, height);
  std::vector<Vertex>& vertices = gl_->vertices;
  vertices.clear();
  for (const StructureScene::Cube& cube : scene.cubes) projector.cube(cube, vertices);
  for (const StructureScene::Line& line : scene.lines)
    draw_line(scene, line, projector, line_pixels, vertices);
  glViewport(0, 0, width, height);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glUseProgram(gl_->program);
  glBindVertexArray(gl_->array);
  glBindBuffer(GL_ARRAY_BUFFER, gl_->buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
               GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices.size()));
  glBindVertexArray(0);
  glUseProgram(0);
  glDisable(GL_DEPTH_TEST);
}

struct StructureRenderer::Gl {
  Gl(int width, int height) : canvas(width, height) {}

  HeadlessGl context;  // current before what follows is made
  Canvas canvas;
  StructurePainter painter;
};

StructureRenderer::StructureRenderer(int width, int height) : width_(width), height_(height) {
  if (width < 16 || height < 16 || width > 16384 || height > 16384)
    throw std::invalid_argument("a picture has 16 to 16384 pixels a side");
  gl_ = std::make_unique<Gl>(width, height);
}

StructureRenderer::~StructureRenderer() = default;

Image StructureRenderer::draw(const StructureScene& scene, const Camera& camera) {
  gl_->canvas.bind();
  gl_->painter.clear(white, width_, height_);
  gl_->painter.draw(scene, camera, width_, height_, std::max(1.0, height_ / 600.0));
  return gl_->canvas.pixels();
}

}  // namespace loopwright
