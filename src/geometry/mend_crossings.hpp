// Crossings that the template leaves wrong are drawn anew until they are right.
//
// The template has shares that nothing fixes exactly: how far a crossing tilts with its legs, how high and
// wide it is where there is little room, how it turns where cloth is folded sharply. One choice serves nearly
// all crossings of a piece; at the few where the interlacing check says no, others are tried.
#pragma once
#include "geometry/type_points.hpp"

namespace loopwright {

struct MendedLayout {
  Layout layout;
  int wrong_before = 0, wrong = 0;  // interlacings that are not as the machine knitted them
  int rounds = 0;                   // of trials that were needed
};

// Only the template's tilt, height, width and turn at binding points of wrong interlacings change, no place.
// The same every time. One check of the piece where nothing is wrong; else up to `most_rounds` rounds of
// trials, each O(loops), until 40 or a quarter of them were in vain.
MendedLayout mended_layout(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                           Layout layout, int most_rounds = 120);

// How many interlacings of the whole piece are not as the machine knitted them.
int wrong_interlacings(const YarnGraph& graph, const GeometryOptions& options, const Layout& flat,
                       const Layout& layout);

// place_type_points() with the flat layout mended.
PlacedPiece mended_piece(const YarnGraph& graph, const GeometryOptions& options);

}  // namespace loopwright
