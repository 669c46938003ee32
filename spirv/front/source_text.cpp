// OpSource, DebugSource and their continuations (SPIR-V 3.52.2, Debug Instructions); SPIRV-Tools' disassembler.
#include "spirv/front/source_text.h"

#include <spirv-tools/libspirv.h>

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Operands of OpSource.
constexpr std::uint32_t kSourceFile = 2, kSourceText = 3;
/// Arguments of DebugSource and DebugSourceContinued.
constexpr std::uint32_t kDebugText = 1, kDebugContinuedText = 0;

/// What glslang puts in front of the text for SPIR-V 1.0: comments, and the line that the text begins with. Its length.
std::size_t preamble(std::string_view text) {
  static constexpr std::string_view kComment = "// OpModuleProcessed", kFirstLine = "#line 1\n";
  std::size_t at = 0;
  while (text.substr(at, kComment.size()) == kComment) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string_view::npos) return 0;
    at = end + 1;
  }
  return at != 0 && text.substr(at, kFirstLine.size()) == kFirstLine ? at + kFirstLine.size() : 0;
}

/// Gathers a text that continues over several instructions.
class Texts {
 public:
  Texts(const Module& module, SourceTables& tables) : module_(module), tables_(tables) {}

  /// A text begins. The first of a file counts.
  void begin(std::uint32_t file, std::string_view text) {
    current_ = file != 0 && module_.sources.files[file].text.empty() ? file : 0;
    text.remove_prefix(preamble(text));
    go_on(text);
  }
  void go_on(std::string_view text) {
    if (current_ != 0) tables_.append_text(current_, text);
  }

 private:
  const Module& module_;
  SourceTables& tables_;
  std::uint32_t current_ = 0;
};

}  // namespace

void read_texts(const Module& module, SourceTables& tables, DebugInfo& debug) {
  Texts plain(module, tables), extended(module, tables);
  for (const Inst& inst : module.code) {
    if (inst.op == Op::OpFunction) return;
    if (inst.op == Op::OpSource && inst.has(kSourceText))
      plain.begin(tables.file(inst.operand(kSourceFile)), string_at(inst, kSourceText));
    if (inst.op == Op::OpSourceContinued) plain.go_on(string_at(inst, 0));
    const auto kind = debug.instruction(inst);
    if (kind == NonSemanticShaderDebugInfo100DebugSource)
      extended.begin(debug.file(inst.result), tables.string(DebugInfo::argument(inst, kDebugText)));
    if (kind == NonSemanticShaderDebugInfo100DebugSourceContinued)
      extended.go_on(tables.string(DebugInfo::argument(inst, kDebugContinuedText)));
  }
}

namespace {

/// The disassembler's text with "; 0x0000abcd", the byte offset, behind each instruction; empty: it gives none.
std::string text_with_offsets(std::span<const std::uint32_t> words) {
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  spv_text text = nullptr;
  const std::uint32_t options = SPV_BINARY_TO_TEXT_OPTION_INDENT | SPV_BINARY_TO_TEXT_OPTION_SHOW_BYTE_OFFSET;
  std::string result;
  if (spvBinaryToText(context, words.data(), words.size(), options, &text, nullptr) == SPV_SUCCESS)
    result.assign(text->str, text->length);
  spvTextDestroy(text);
  spvContextDestroy(context);
  return result;
}

/// Byte offset of the first word of every instruction.
std::vector<std::size_t> offsets(std::span<const std::uint32_t> words) {
  constexpr std::size_t kHeader = 5;
  std::vector<std::size_t> result;
  for (std::size_t at = kHeader; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16)
    result.push_back(at * sizeof(std::uint32_t));
  return result;
}

/// Takes "; 0x0000abcd" off the end of a line. False: it does not end so.
bool drop_offset(std::string_view& line, std::size_t offset) {
  char mark[32];
  std::snprintf(mark, sizeof mark, " ; 0x%08zx", offset);
  if (line.size() < std::string_view(mark).size()) return false;
  const std::size_t at = line.size() - std::string_view(mark).size();
  if (line.substr(at) != mark) return false;
  line = line.substr(0, at);
  return true;
}

}  // namespace

Disassembly disassemble(std::span<const std::uint32_t> words, std::size_t instructions) {
  const std::string marked = text_with_offsets(words);
  const std::vector<std::size_t> at = offsets(words);
  Disassembly result;
  std::uint32_t line = 1;
  for (std::size_t begin = 0, end; begin < marked.size(); begin = end + 1, ++line) {
    end = std::min(marked.find('\n', begin), marked.size());
    std::string_view text = std::string_view(marked).substr(begin, end - begin);
    // A string may have several lines: its instruction is told of at the last.
    if (result.lines.size() < at.size() && drop_offset(text, at[result.lines.size()])) result.lines.push_back(line);
    result.text.append(text).append("\n");
  }
  if (result.lines.size() != instructions) return {};
  return result;
}

}  // namespace vitrine::spirv::front
