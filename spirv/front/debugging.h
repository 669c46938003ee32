// What a debugger is told of a shader: a probe where a line begins, and one where a variable gets a value. The shader
// that runs is the one that always runs; the probes, and what only they read, are beside it
// (spirv/rewrite/graph/attached.h). Functions do nothing where nobody asks (Translator::debugging).
#pragma once

#include <memory>

#include "spirv/front/context.h"
#include "spirv/source_variables.h"

namespace vitrine::spirv::front {

/// Names that a module gives its variables. `sources`: the module's.
std::shared_ptr<Debugging> begin_debugging(const Module& module, const SourceInfo& sources);
/// The whole shader is translated: the tables of its variables go to t.sources.
void end_debugging(Translator& t);

/// What the module calls the inputs of the shader.
std::vector<SourceInput> input_names(Translator& t);

/// A block begins: so does a line.
void begin_lines(Translator& t);
/// An instruction comes next.
void step_to(Translator& t, const Inst& inst);
/// Behind a call.
void step_back(Translator& t, const Inst& call);
/// The blocks of a function instance come next, with its parameters.
void enter_function(Translator& t, const Function& function);

/// An OpVariable of a function.
void show_variable(Translator& t, const Pointer& pointer, std::uint32_t id);
/// Something is stored to a variable; other memory is looked at where it lies.
void show_assignment(Translator& t, const Pointer& pointer, const Value& value);
/// The same of an input that is read.
void show_input(Translator& t, const Pointer& pointer, const Value& value);
/// The result of an instruction of a module that names no variables.
void show_result(Translator& t, const Inst& inst);
/// DebugValue of NonSemantic.Shader.DebugInfo.100; others say nothing here.
void show_debug_value(Translator& t, const Inst& inst);
/// NonSemantic.DebugBreak, if it is that.
void show_break(Translator& t, const Inst& inst);

}  // namespace vitrine::spirv::front
