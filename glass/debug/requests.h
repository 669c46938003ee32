// Requests of the other end of the socket, as lines of JSON. Each has an "id", which the answer repeats.
//
//   command      text                                            -> text
//   breakpoints  file, list of {line, condition, hits, message}  -> list of {number, verified, line}: all of the file
//   functions    list of {name, condition, hits}                 -> the same
//   placed                                                       -> list of {number, line}: breakpoints that shaders
//   have catch        list of printf, nan, finding: what else is a reason to stop lanes -> list of {lane, name, where}
//   frames       lane                                            -> list of {name, file, line, column}
//   variables    lane, frame, which: locals or globals           -> list of {name, type, value, children}
//   evaluate     lane, frame, text                               -> name, type, value, children
//   set          lane, frame, text, value: an expression           -> the same, of what `text` names
//   watches      list of {lane, frame, text}                     -> list of {number, verified, message}: all of them
//   source       file                                            -> text
//   go           how: continue, step, next, finish, detach; backward; lane
//   pause
//
// An answer has "error" where a request makes no sense.
#pragma once

#include <string>

#include "glass/debug/engine.h"

namespace vitrine::glass::debug {

/// `stopped`: the shader waits; else only what needs no shader is answered.
std::string answer_to(Engine& engine, const std::string& line, bool stopped);
/// The event of a stop.
std::string describe(Engine& engine, const Stop& stop);

}  // namespace vitrine::glass::debug
