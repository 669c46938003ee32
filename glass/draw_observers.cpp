// The watches of several observers of a draw.
#include "glass/draw_observers.h"

#include <algorithm>

namespace vitrine::glass {
namespace {

using base::LaneMask;
using raster::DrawWatch;
using raster::FragmentGroup;
using raster::SampleLanes;

class Watches : public DrawWatch {
 public:
  void add(std::unique_ptr<DrawWatch> watch) {
    if (watch) watches_.push_back(std::move(watch));
  }
  void assembled(std::uint64_t vertices, std::uint64_t primitives) override {
    for (const auto& watch : watches_) watch->assembled(vertices, primitives);
  }
  void emitted(std::uint64_t primitives) override {
    for (const auto& watch : watches_) watch->emitted(primitives);
  }
  void primitive(std::uint32_t id, raster::PrimitiveFate fate) override {
    for (const auto& watch : watches_) watch->primitive(id, fate);
  }
  void generated(const FragmentGroup& group, SampleLanes lanes) override {
    for (const auto& watch : watches_) watch->generated(group, lanes);
  }
  void failed(const FragmentGroup& group, raster::FragmentTest test, SampleLanes lost, SampleLanes left) override {
    for (const auto& watch : watches_) watch->failed(group, test, lost, left);
  }
  void shaded(const FragmentGroup& group, LaneMask invocations, LaneMask helpers) override {
    for (const auto& watch : watches_) watch->shaded(group, invocations, helpers);
  }
  bool takes_whole_blocks() const override {
    return std::all_of(watches_.begin(), watches_.end(), [](const auto& watch) { return watch->takes_whole_blocks(); });
  }
  void whole_blocks(const raster::WholeBlocks& whole) override {
    for (const auto& watch : watches_) watch->whole_blocks(whole);
  }
  void passed(const FragmentGroup& group, SampleLanes lanes) override {
    for (const auto& watch : watches_) watch->passed(group, lanes);
  }
  void written(const FragmentGroup& group, const texel::ImageView& view, SampleLanes lanes) override {
    for (const auto& watch : watches_) watch->written(group, view, lanes);
  }

 private:
  std::vector<std::unique_ptr<DrawWatch>> watches_;
};

}  // namespace

std::unique_ptr<DrawWatch> DrawObservers::watch_chunk(const spirv::ObservedCommand* command) {
  auto watches = std::make_unique<Watches>();
  for (raster::DrawObserver* observer : observers_) watches->add(observer->watch_chunk(command));
  return watches;
}

std::unique_ptr<DrawWatch> DrawObservers::watch_tile(const spirv::ObservedCommand* command, std::uint32_t tile) {
  auto watches = std::make_unique<Watches>();
  for (raster::DrawObserver* observer : observers_) watches->add(observer->watch_tile(command, tile));
  return watches;
}

}  // namespace vitrine::glass
