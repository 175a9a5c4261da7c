// Sizes at which what pays changes, in control points.
#pragma once

namespace loopwright {

constexpr int many_nodes = 8000;         // above: a whole factor costs too much, see linear/schwarz.hpp
constexpr int very_many_nodes = 400000;  // some two gigabytes: what is given back must be fetched anew

}  // namespace loopwright
