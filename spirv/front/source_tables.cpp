// See source_tables.h.
#include "spirv/front/source_tables.h"

namespace vitrine::spirv::front {
namespace {

/// Texts that may be copied, in sizes of the module: an honest one is copied twice, as a name and as a file's text.
constexpr std::size_t kCopies = 4;
constexpr std::uint32_t kMaxLine = 1u << 24;

template <class Row>
std::uint32_t append(std::vector<Row>& table, Row row) {
  table.push_back(std::move(row));
  return static_cast<std::uint32_t>(table.size() - 1);
}

}  // namespace

SourceTables::SourceTables(Module& module) : module_(module), sources_(module.sources) {
  if (!module.code.empty()) {
    const auto words = module.code.back().words.data() + module.code.back().words.size();
    left_ = static_cast<std::size_t>(words - module.code.front().words.data()) * sizeof(std::uint32_t) * kCopies;
  }
}

std::string SourceTables::string(std::uint32_t id) {
  const auto found = module_.definition.find(id);
  if (found == module_.definition.end() || module_.code[found->second].op != spv::Op::OpString) return {};
  const Inst& inst = module_.code[found->second];
  const std::size_t size = inst.words.size() * sizeof(std::uint32_t);
  if (size > left_) return {};
  left_ -= size;
  return string_at(inst, 0);
}

std::uint32_t SourceTables::file(std::uint32_t id) {
  const auto found = module_.definition.find(id);
  if (found == module_.definition.end() || module_.code[found->second].op != spv::Op::OpString) return 0;
  const auto [at, added] = files_by_id_.try_emplace(id, 0);
  if (!added) return at->second;
  std::string name = string(id);
  const auto [named, is_new] = files_by_name_.try_emplace(name, 0);
  if (is_new) named->second = append(sources_.files, {std::move(name), {}});
  return at->second = named->second;
}

std::uint32_t SourceTables::function(SourceFunction function) {
  if (function.line > kMaxLine) function.line = 0;
  return append(sources_.functions, std::move(function));
}

std::uint32_t SourceTables::scope(SourceScope scope) {
  const auto [at, added] = scopes_.try_emplace({scope.function, scope.call}, 0);
  if (added) at->second = append(sources_.scopes, scope);
  return at->second;
}

std::uint32_t SourceTables::place(SourcePlace place) {
  return place.line == 0 || place.line > kMaxLine ? 0 : call(place);
}

std::uint32_t SourceTables::call(SourcePlace place) {
  if (place.line > kMaxLine) place.line = 0;
  if (place.line == 0 || place.column > kMaxLine) place.column = 0;
  const auto [at, added] = places_.try_emplace({place.file, place.line, place.column, place.scope}, 0);
  if (added) at->second = append(sources_.places, place);
  return at->second;
}

void SourceTables::append_text(std::uint32_t file, std::string_view text) {
  if (text.size() > left_) return;
  left_ -= text.size();
  sources_.files[file].text += text;
}

}  // namespace vitrine::spirv::front
