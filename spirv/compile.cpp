// The pipeline from SPIR-V words to an executable shader.
#include "spirv/compile.h"

#include <spirv-tools/libspirv.h>
#include <spirv/unified1/spirv.hpp11>

#include <string>
#include <utility>
#include <vector>

#include "spirv/capabilities.h"
#include "spirv/diagnosis.h"
#include "spirv/exec/observe.h"
#include "spirv/exec/trace.h"
#include "spirv/front/translate.h"
#include "spirv/ir_passes.h"
#include "spirv/lower/lower.h"
#include "spirv/program.h"
#include "spirv/rewrite/rewrite.h"

namespace vitrine::spirv {
namespace {

/// The module as SPIRV-Tools prints it, with the ids by number, which the other representations name.
std::string module_text(std::span<const std::uint32_t> words) {
  const spv_context context = spvContextCreate(SPV_ENV_UNIVERSAL_1_6);
  spv_text text = nullptr;
  std::string result;
  if (spvBinaryToText(context, words.data(), words.size(), SPV_BINARY_TO_TEXT_OPTION_INDENT, &text, nullptr) ==
      SPV_SUCCESS)
    result.assign(text->str, text->length);
  spvTextDestroy(text);
  spvContextDestroy(context);
  return result;
}

/// A refusal with what the validator says of the module, if it dislikes it too.
base::Error explained(std::string why, std::span<const std::uint32_t> words) {
  if (const std::string message = validator_message(words); !message.empty()) why += " (SPIRV-Tools: " + message + ")";
  return base::Error{std::move(why)};
}

/// Numbers the forms that the rewrites give a shader: the same step may change it in several rounds.
StepListener keep_steps(std::vector<Representation>& kept) {
  return [&kept, number = 0](const char* step, const std::string& place, const std::string& text) mutable {
    kept.push_back({"IR " + std::to_string(++number) + ": " + step, "the shader in SSA form, " + place, text});
  };
}

/// Of a program that no wave runs by itself.
class Rehearsed : public exec::Observer {
 public:
  explicit Rehearsed(const exec::Interest& interest) : interest_(interest) {}
  exec::Interest interest() const override { return interest_; }
  std::unique_ptr<exec::Watch> watch(const Wave&, const Instruction*) const override { return nullptr; }

 private:
  exec::Interest interest_;
};

/// Nothing: there is none, as where it takes too many registers. `homes`: variables lie where they can be changed.
std::shared_ptr<const Shader> compile_rehearsal(std::span<const std::uint32_t> words, const CompileOptions& options,
                                                exec::Interest interest, bool homes) {
  interest.rehearsal = homes;
  base::Result<ir::Function> function = translate(words, options, interest);
  if (!function) return nullptr;
  rewrite(function.value(), {}, Steps::kNeeded);
  ir::make_joins_whole(function.value());
  interest.rehearsal = true;
  auto shader = lower(function.take(), std::make_shared<Rehearsed>(interest));
  return shader ? std::shared_ptr<const Shader>(shader.take()) : nullptr;
}

std::shared_ptr<const Shader> compile_rehearsal(std::span<const std::uint32_t> words, const CompileOptions& options,
                                                const exec::Observer& observer) {
  auto shader = compile_rehearsal(words, options, observer.rehearsed(), true);
  return shader ? shader : compile_rehearsal(words, options, observer.rehearsed(), false);
}

/// An observer who wanted a rehearsal where there is none: he sees the program itself with the rehearsal's probes.
class WithoutRehearsal : public exec::Observer {
 public:
  explicit WithoutRehearsal(std::shared_ptr<const exec::Observer> observer)
      : observer_(std::move(observer)), interest_(observer_->interest()) {
    const exec::Interest rehearsed = observer_->rehearsed();
    interest_.rehearsal = false;
    interest_.numbers |= rehearsed.numbers;
    interest_.printf |= rehearsed.printf;
    interest_.debug |= rehearsed.debug;
  }
  exec::Interest interest() const override { return interest_; }
  void made(const Program& program) const override { observer_->made(program); }
  void apart(const Wave& wave) const override { observer_->apart(wave); }
  bool in_order() const override { return observer_->in_order(); }
  exec::Watch* lasting_watch() const override { return observer_->lasting_watch(); }
  std::unique_ptr<exec::Watch> watch(const Wave& wave, const Instruction* start) const override {
    return observer_->watch(wave, start);
  }

 private:
  std::shared_ptr<const exec::Observer> observer_;
  exec::Interest interest_;
};

}  // namespace

std::string check_module(std::span<const std::uint32_t> words) {
  if (words.size() < 5) return "shader module is too short";
  if (words[0] != spv::MagicNumber) return "shader module has the wrong magic number";
  const std::uint32_t version = words[1];
  if ((version >> 16) != 1 || (version >> 8 & 0xff) > 6 || (version & 0xff) != 0)
    return "SPIR-V version is not supported";
  if (words[3] == 0 || words[3] > 0x3fffff) return "SPIR-V id bound is out of range";
  for (std::size_t at = 5; at < words.size();) {
    const std::uint32_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) return "SPIR-V instruction runs past the end of the module";
    at += length;
  }
  return {};
}

base::Result<std::unique_ptr<Shader>> compile(std::span<const std::uint32_t> words, const CompileOptions& options) {
  if (std::string error = check_module(words); !error.empty()) return base::Error{error};
  if (std::string error = missing_device_capability(words); !error.empty()) return base::Error{error};
  auto observer = options.observer ? options.observer : exec::requested_tracer(options.stage);
  std::shared_ptr<const Shader> rehearsal;
  if (observer && observer->interest().rehearsal) {
    rehearsal = compile_rehearsal(words, options, *observer);
    if (!rehearsal) observer = std::make_shared<WithoutRehearsal>(std::move(observer));
  }
  base::Result<ir::Function> function = translate(words, options, observer ? observer->interest() : exec::Interest{});
  if (!function) return explained(function.message(), words);
  log_diagnosis(words);
  std::vector<Representation>* const kept = options.representations;
  if (kept) kept->push_back({"SPIR-V", "the module as the application gave it, disassembled", module_text(words)});
  rewrite(function.value(), kept ? keep_steps(*kept) : StepListener());
  ir::make_joins_whole(function.value());
  base::Result<std::unique_ptr<Shader>> shader = lower(function.take(), observer, std::move(rehearsal));
  if (kept && shader)
    kept->push_back(
        {"program", "the instructions that run, with their registers", disassemble(shader.value()->program())});
  return shader;
}

}  // namespace vitrine::spirv
