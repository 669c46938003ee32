// See primitives.h.
#include "glass/pixel/primitives.h"

namespace vitrine::glass::pixel {
namespace {

class PrimitiveWatch final : public raster::DrawWatch {
 public:
  PrimitiveWatch(Pixels& pixels, const spirv::ObservedCommand& command, const PrimitiveRequest& asked)
      : pixels_(pixels), command_(command), asked_(asked) {}
  void primitive(std::uint32_t id, std::optional<std::uint32_t> instance, raster::PrimitiveFate fate) override {
    if (id != asked_.primitive || (asked_.instance && *asked_.instance != instance.value_or(0))) return;
    pixels_.add_primitive(command_, instance, static_cast<std::size_t>(fate));
  }

 private:
  Pixels& pixels_;
  const spirv::ObservedCommand& command_;
  const PrimitiveRequest asked_;
};

}  // namespace

std::unique_ptr<raster::DrawWatch> PrimitiveObserver::watch_chunk(const spirv::ObservedCommand* command) {
  const std::optional<PrimitiveRequest>& asked = pixels_.primitive();
  if (!asked || command == nullptr) return nullptr;
  return std::make_unique<PrimitiveWatch>(pixels_, *command, *asked);
}

}  // namespace vitrine::glass::pixel
