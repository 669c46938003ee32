// The front end's order of work: parse, build the tree of the entry point, lower exits, repair scopes, build SSA.
#include "spirv/front/translate.h"

#include "spirv/front/context.h"
#include "spirv/ir_passes.h"

namespace vitrine::spirv {
namespace {

using namespace front;

ir::Function run(std::span<const std::uint32_t> words, const CompileOptions& options) {
  const Module module = parse_module(words, options);
  Translator t(module, options);
  read_modes(t);
  try {
    prepare_stage(t);
    translate_entry(t);
    connect_interface(t);
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
  t.function.files = module.files;
  return std::move(t.function);
}

}  // namespace

base::Result<ir::Function> translate(std::span<const std::uint32_t> words, const CompileOptions& options) {
  try {
    return run(words, options);
  } catch (const Failure& failure) {
    return base::Error{failure.what()};
  }
}

}  // namespace vitrine::spirv
