// Steps of our own: from what the front end makes to the form that the rewrites keep, and from that to what the shader
// core runs. They change no number.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Gives every loop the form that the rewrites keep (graph/loops.h).
void straighten_loops(Graph& graph);

/// What runs from the second iteration on, and has stayed at the top of the body, becomes the continue construct.
void close_continues(Graph& graph);

/// Doubles that are made of the same words become one value: to the reference each is one from the beginning.
void merge_doubles(Graph& graph);

/// Selections of both words of a double become one selection of doubles.
bool join_doubles(Graph& graph);

/// Operations on numbers of 16 and 64 bits become what they consist of. Nothing else reads them after that.
bool expand_sized(Graph& graph);

/// Spelling that the executor likes and that keeps every bit: subtractions.
void choose_spelling(Graph& graph);

}  // namespace vitrine::spirv::rewriting
