// The front end's order of work: parse, build the tree of the entry point, lower exits, repair scopes, build SSA.
#include "spirv/front/translate.h"

#include "spirv/front/context.h"
#include "spirv/front/debugging.h"
#include "spirv/front/initialization.h"
#include "spirv/front/parse.h"
#include "spirv/ir_passes.h"

namespace vitrine::spirv {
namespace {

using namespace front;

/// For who observes fragments.
void name_inputs(Translator& t) {
  SourceVariables tables;
  tables.inputs_alone = true;
  if (t.sources.variables) tables = *t.sources.variables;
  tables.inputs = input_names(t);
  t.sources.variables = std::make_shared<const SourceVariables>(std::move(tables));
}

ir::Function run(std::span<const std::uint32_t> words, const CompileOptions& options, const exec::Interest& interest) {
  const bool observed = interest != exec::Interest{};
  Module module = parse_module(words, options, observed ? SourceTexts::kKeep : SourceTexts::kDrop);
  Translator t(module, options, interest, std::move(module.sources));
  if (interest.initialization) t.initialization = begin_initialization(module);
  if (interest.debug) t.debugging = begin_debugging(module, t.sources);
  read_modes(t);
  t.fallback.place = entry_place(module);
  try {
    prepare_stage(t);
    const ir::Origin entry = std::exchange(t.fallback, {});
    translate_entry(t);
    end_debugging(t);
    if (observed && options.stage == VK_SHADER_STAGE_FRAGMENT_BIT) name_inputs(t);
    drop_idle_writes(t);
    t.fallback = entry;
    connect_interface(t);
    t.fallback = {};
    repair_scopes(t);
    resolve_arrays(t);
    build_ssa(t);
  } catch (const Failure& failure) {
    // A message without a place gets that of the instruction at hand.
    if (t.inst == nullptr || std::string_view(failure.what()).starts_with("Op")) throw;
    fail(*t.inst, failure.what());
  } catch (const std::out_of_range&) {
    if (t.inst == nullptr) throw Failure("malformed module");
    fail(*t.inst, "operand does not fit its type");
  }
  t.constants.insert(t.constants.end(), std::make_move_iterator(t.function.body.begin()),
                     std::make_move_iterator(t.function.body.end()));
  t.function.body = std::move(t.constants);
  ir::propagate_copies(t.function);
  ir::remove_dead(t.function, ir::Loads::kKeep);
  propagate_invariant(t.function);
  t.function.sources = std::make_shared<const SourceInfo>(std::move(t.sources));
  return std::move(t.function);
}

}  // namespace

base::Result<ir::Function> translate(std::span<const std::uint32_t> words, const CompileOptions& options,
                                     const exec::Interest& interest) {
  try {
    return run(words, options, interest);
  } catch (const Failure& failure) {
    return base::Error{failure.what()};
  }
}

}  // namespace vitrine::spirv
