// Places of inlined functions: a call makes every place of its callee another one, whose scope tells of the call.
#include "spirv/front/context.h"

namespace vitrine::spirv::front {
namespace {

std::uint32_t inlined_scope(Translator& t, std::uint32_t scope) {
  const auto [at, added] = t.inlined_scopes.try_emplace({scope, t.call}, 0);
  if (!added) return at->second;
  // What the module says that was inlined into the callee stays in front of the call.
  SourceScope made = t.sources.scopes[scope];
  made.call = made.call == 0 ? t.call : inlined_place(t, made.call);
  t.sources.scopes.push_back(made);
  return t.inlined_scopes[{scope, t.call}] = static_cast<std::uint32_t>(t.sources.scopes.size() - 1);
}

}  // namespace

std::uint32_t entry_place(const Module& module) {
  const auto entry = module.definition.find(module.entry_function);
  if (entry == module.definition.end()) return 0;
  for (std::size_t i = entry->second; i < module.code.size() && module.code[i].op != spv::Op::OpFunctionEnd; ++i)
    if (module.code[i].origin.place != 0) return module.code[i].origin.place;
  return 0;
}

std::uint32_t inlined_place(Translator& t, std::uint32_t place) {
  if (t.call == 0 || place == 0) return place;
  const auto [at, added] = t.inlined_places.try_emplace({place, t.call}, 0);
  if (!added) return at->second;
  SourcePlace made = t.sources.places[place];
  made.scope = inlined_scope(t, made.scope);
  t.sources.places.push_back(made);
  return t.inlined_places[{place, t.call}] = static_cast<std::uint32_t>(t.sources.places.size() - 1);
}

ir::Origin origin_here(Translator& t) {
  if (t.inst == nullptr) return t.fallback;
  const std::uint32_t place = inlined_place(t, t.inst->origin.place);
  return {t.inst->origin.spirv_id, place != 0 ? place : t.fallback.place, t.interest.order ? order_of(t, *t.inst) : 0};
}

}  // namespace vitrine::spirv::front
