// What one thread sees of a draw, for several who observe it.
#pragma once

#include <memory>
#include <vector>

#include "raster/observe.h"

namespace vitrine::raster {

class DrawWatches : public DrawWatch {
 public:
  /// Null: nobody.
  void add(std::unique_ptr<DrawWatch> watch) {
    if (watch) watches_.push_back(std::move(watch));
  }
  void assembled(std::uint64_t vertices, std::uint64_t primitives) override;
  void emitted(std::uint64_t primitives) override;
  void primitive(std::uint32_t id, std::optional<std::uint32_t> instance, PrimitiveFate fate) override;
  void generated(const FragmentGroup& group, SampleLanes lanes) override;
  void failed(const FragmentGroup& group, FragmentTest test, SampleLanes lost, SampleLanes left) override;
  void testing(const FragmentGroup& group, std::uint32_t sample, const float* depth) override;
  void shading(const FragmentGroup& group) override;
  void shaded(const FragmentGroup& group, base::LaneMask invocations, base::LaneMask helpers) override;
  void coloring(const FragmentGroup& group, std::uint32_t attachment, const ColorRegisters& color) override;
  bool takes_numbers() const override;
  void numbers(const FragmentNumbers& numbers) override;
  void shaded_blocks(base::LaneMask places) override;
  void passed(const FragmentGroup& group, SampleLanes lanes) override;
  void written(const FragmentGroup& group, const texel::ImageView& view, SampleLanes lanes) override;

 private:
  std::vector<std::unique_ptr<DrawWatch>> watches_;
};

}  // namespace vitrine::raster
