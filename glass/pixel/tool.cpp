// The tool `pixel`: what happened to the texels that VITRINE_PIXEL names, as JSON in VITRINE_PIXEL_HISTORY ("%p" is the
// process; default pixel.json). VITRINE_PIXEL_UNTIL: "frame=N" or "submission=N", after which nothing is recorded.
// VITRINE_PIXEL_PRIMITIVE: a gl_PrimitiveID, "@" and a gl_InstanceIndex behind it if only that is meant; what becomes
// of such primitives is told, too.
#include <cstdlib>
#include <cstring>

#include "glass/output.h"
#include "glass/pixel/shader_watch.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace pixel {
namespace {

Pixels* watched = nullptr;  ///< the tool's, while there is one

std::uint64_t limit(const char* text, const char* key) {
  const std::size_t length = std::strlen(key);
  return text != nullptr && std::strncmp(text, key, length) == 0 ? std::strtoull(text + length, nullptr, 10) : 0;
}

std::unique_ptr<Pixels> make_pixels() {
  const char* const text = std::getenv("VITRINE_PIXEL");
  std::string error;
  auto requests = parse_requests(text != nullptr ? text : "", error);
  if (!requests) {
    complain("VITRINE_PIXEL: " + error + "; \"320,240:image=NAME\" would");
    requests.emplace();
  }
  const char* const until = std::getenv("VITRINE_PIXEL_UNTIL");
  PixelLimits limits{limit(until, "frame="), limit(until, "submission="), std::nullopt};
  const char* const primitive = std::getenv("VITRINE_PIXEL_PRIMITIVE");
  if (primitive != nullptr && *primitive != 0) {
    limits.primitive = parse_primitive(primitive);
    if (!limits.primitive) complain("VITRINE_PIXEL_PRIMITIVE names no primitive; \"7\" or \"7@3\" would");
  }
  return std::make_unique<Pixels>(std::move(*requests), limits);
}

class PixelTool final : public Tool {
 public:
  PixelTool() : pixels_(make_pixels()) { watched = pixels_.get(); }
  ~PixelTool() override { watched = nullptr; }
  PixelTool(const PixelTool&) = delete;
  PixelTool& operator=(const PixelTool&) = delete;

  /// Messages are nothing to it, but who wants some observes shaders that do no more than compute: for their inputs.
  spirv::exec::Interest interest() const override { return {.images = true, .discards = true, .printf = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    return std::make_shared<PixelProgram>(*pixels(), shader, program);
  }
  bool needs_every_fragment() const override { return false; }
  void commands_done(const void* owner) override { pixels()->commands_done(owner); }
  void write() override { write_output("VITRINE_PIXEL_HISTORY", "pixel.json", pixels()->to_json()); }

 private:
  std::unique_ptr<Pixels> pixels_;
};

}  // namespace

Pixels* pixels() { return watched; }

}  // namespace pixel

std::unique_ptr<Tool> make_pixel() { return std::make_unique<pixel::PixelTool>(); }

}  // namespace vitrine::glass
