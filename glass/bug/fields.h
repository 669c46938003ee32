// The members of a Bug by their names in the file: fields(visitor, value) calls visitor(name, member) for each, and
// visitor.newer() for those that older files of this version lack. Reading and writing are two visitors
// (glass/bug/file.cpp); there is no other list of members.
#pragma once

#include "glass/bug/bug.h"

namespace vitrine::glass::bug {

template <class V>
void fields(V& v, VkSpecializationMapEntry& e) {
  v("id", e.constantID);
  v("offset", e.offset);
  v("size", e.size);
}
template <class V>
void fields(V& v, VkPushConstantRange& r) {
  v("stages", r.stageFlags);
  v("offset", r.offset);
  v("size", r.size);
}
template <class V>
void fields(V& v, VkImageSubresourceRange& r) {
  v("aspects", r.aspectMask);
  v("level", r.baseMipLevel);
  v("levels", r.levelCount);
  v("layer", r.baseArrayLayer);
  v("layers", r.layerCount);
}
template <class V>
void fields(V& v, VkRect2D& r) {
  v("x", r.offset.x);
  v("y", r.offset.y);
  v("width", r.extent.width);
  v("height", r.extent.height);
}
template <class V>
void fields(V& v, VkViewport& p) {
  v("x", p.x);
  v("y", p.y);
  v("width", p.width);
  v("height", p.height);
  v("minDepth", p.minDepth);
  v("maxDepth", p.maxDepth);
}
template <class V>
void fields(V& v, texel::Extent& e) {
  v("width", e.width);
  v("height", e.height);
  v("depth", e.depth);
}
template <class V>
void fields(V& v, Stage& s) {
  v("stage", s.stage);
  v("entryPoint", s.entry_point);
  v("subgroupSize", s.subgroup_size);
  v("constants", s.constants);
  v("constantData", s.constant_data);
  v("words", s.words);
}
template <class V>
void fields(V& v, Piece& p) {
  v("offset", p.offset);
  v("unwritten", p.unwritten);
  v("before", p.before);
  v("after", p.after);
}
template <class V>
void fields(V& v, Memory& m) {
  v("size", m.size);
  v("address", m.address);
  v("pieces", m.pieces);
}
template <class V>
void fields(V& v, Buffer& b) {
  v("name", b.name);
  v("size", b.size);
  v("usage", b.usage);
  v("memory", b.memory);
  v("offset", b.offset);
  v("gone", b.gone);
}
template <class V>
void fields(V& v, Texels& t) {
  v("aspect", t.aspect);
  v("level", t.level);
  v("layer", t.layer);
  v("layers", t.layers);
  v("unwritten", t.unwritten);
  v("before", t.before);
  v("after", t.after);
  v("written", t.written);
}
template <class V>
void fields(V& v, Image& i) {
  v("name", i.name);
  v("flags", i.flags);
  v("usage", i.usage);
  v("type", i.type);
  v("format", i.format);
  v("tiling", i.tiling);
  v("extent", i.extent);
  v("levels", i.levels);
  v("layers", i.layers);
  v("samples", i.samples);
  v("texels", i.texels);
}
template <class V>
void fields(V& v, View& w) {
  v("name", w.name);
  v("image", w.image);
  v("type", w.type);
  v("format", w.format);
  v("usage", w.usage);
  v("swizzle", w.swizzle);
  v("range", w.range);
}
template <class V>
void fields(V& v, BufferView& w) {
  v("name", w.name);
  v("buffer", w.buffer);
  v("format", w.format);
  v("offset", w.offset);
  v("range", w.range);
}
template <class V>
void fields(V& v, texel::YcbcrConversion& y) {
  v("enabled", y.enabled);
  v("model", y.model);
  v("range", y.range);
  v("swizzle", y.swizzle);
  v("xCosited", y.x_cosited);
  v("yCosited", y.y_cosited);
  v("chromaFilter", y.chroma_filter);
}
template <class V>
void fields(V& v, texel::Sampler& s) {
  v("magFilter", s.mag_filter);
  v("minFilter", s.min_filter);
  v("mipMode", s.mip_mode);
  v("address", s.address);
  v("mipLodBias", s.mip_lod_bias);
  v("minLod", s.min_lod);
  v("maxLod", s.max_lod);
  v("maxAnisotropy", s.max_anisotropy);
  v("compare", s.compare);
  v("compareOp", s.compare_op);
  v("border", s.border);
  v("unnormalized", s.unnormalized);
  v("seams", s.seams);
  v("reduction", s.reduction);
  v("conversion", s.conversion);
}
template <class V>
void fields(V& v, Sampler& s) {
  v("name", s.name);
  v("state", s.state);
}
template <class V>
void fields(V& v, Binding& b) {
  v("binding", b.binding);
  v("type", b.type);
  v("stages", b.stages);
  v("count", b.count);
  v("flags", b.flags);
  v("samplers", b.samplers);
  v.newer("types", b.types);
}
template <class V>
void fields(V& v, SetLayout& s) {
  v("used", s.used);
  v("bindings", s.bindings);
}
template <class V>
void fields(V& v, Descriptor& d) {
  v("set", d.set);
  v("binding", d.binding);
  v("element", d.element);
  v("buffer", d.buffer);
  v("view", d.view);
  v("texels", d.texels);
  v("sampler", d.sampler);
  v("offset", d.offset);
  v("range", d.range);
  v("bytes", d.bytes);
  v("gone", d.gone);
  v.newer("type", d.type);
}
template <class V>
void fields(V& v, Stream& s) {
  v("binding", s.binding);
  v("buffer", s.buffer);
  v("offset", s.offset);
  v("size", s.size);
  v("stride", s.stride);
  v("divisor", s.divisor);
  v("perInstance", s.per_instance);
}
template <class V>
void fields(V& v, Rendering& r) {
  v("colors", r.colors);
  v("depth", r.depth);
  v("stencil", r.stencil);
  v("area", r.area);
  v("layers", r.layers);
  v("viewMask", r.view_mask);
  v.newer("rate", r.rate);
  v.newer("rateTexelWidth", r.rate_texel.width);
  v.newer("rateTexelHeight", r.rate_texel.height);
}
template <class V>
void fields(V& v, Draw& d) {
  v("count", d.count);
  v("first", d.first);
  v("vertexOffset", d.vertex_offset);
}
template <class V>
void fields(V& v, Command& c) {
  v("base", c.base);
  v("groups", c.groups);
  v("draws", c.draws);
  v("instances", c.instances);
  v("firstInstance", c.first_instance);
  v("indexed", c.indexed);
  v("indexType", c.index_type);
  v("indices", c.indices);
  v("arguments", c.arguments);
  v("argumentsOffset", c.arguments_offset);
  v("countBuffer", c.count_buffer);
  v("countOffset", c.count_offset);
  v("drawCount", c.draw_count);
  v("stride", c.stride);
}
template <class V>
void fields(V& v, Found& f) {
  v("rule", f.rule);
  v("message", f.message);
  v("place", f.place);
  v("function", f.function);
}
template <class V>
void fields(V& v, raster::VertexAttribute& a) {
  v("location", a.location);
  v("binding", a.binding);
  v("format", a.format);
  v("offset", a.offset);
}
template <class V>
void fields(V& v, raster::StencilFace& f) {
  v("fail", f.fail);
  v("pass", f.pass);
  v("depthFail", f.depth_fail);
  v("compare", f.compare);
  v("compareMask", f.compare_mask);
  v("writeMask", f.write_mask);
  v("reference", f.reference);
}
template <class V>
void fields(V& v, raster::BlendAttachment& b) {
  v("enable", b.enable);
  v("srcColor", b.src_color);
  v("dstColor", b.dst_color);
  v("srcAlpha", b.src_alpha);
  v("dstAlpha", b.dst_alpha);
  v("colorOp", b.color_op);
  v("alphaOp", b.alpha_op);
  v("writeMask", b.write_mask);
  v("srcPremultiplied", b.src_premultiplied);
  v("dstPremultiplied", b.dst_premultiplied);
  v("clamped", b.clamped);
  v("overlap", b.overlap);
}
template <class V>
void fields(V& v, raster::SampleLocations& l) {
  v("count", l.count);
  v("x", l.x);
  v("y", l.y);
}

template <class V>
void before_rasterization(V& v, raster::State& s) {
  v("topology", s.topology);
  v("primitiveRestart", s.primitive_restart);
  v("provokingVertexLast", s.provoking_vertex_last);
  v("patchControlPoints", s.patch_control_points);
  v("domainOriginLowerLeft", s.domain_origin_lower_left);
  v("attributeCount", s.attribute_count);
  v("attributes", s.attribute);
  v("viewportCount", s.viewport_count);
  v("viewports", s.viewport);
  v("scissors", s.scissor);
  v("negativeOneToOne", s.negative_one_to_one);
  v("discardCount", s.discard_count);
  v("discardInside", s.discard_inside);
  v("discardRectangles", s.discard);
  v("rasterizedStream", s.rasterized_stream);
  v("rasterizerDiscard", s.rasterizer_discard);
  v("depthClamp", s.depth_clamp);
  v("depthClip", s.depth_clip);
  v("unrestrictedDepth", s.unrestricted_depth);
  v("polygonMode", s.polygon_mode);
  v("cullMode", s.cull_mode);
  v("frontFace", s.front_face);
  v("depthBias", s.depth_bias);
  v("depthBiasConstant", s.depth_bias_constant);
  v("depthBiasClamp", s.depth_bias_clamp);
  v("depthBiasSlope", s.depth_bias_slope);
  v("overestimates", s.overestimates);
  v("lineWidth", s.line_width);
  v("lineMode", s.line_mode);
  v("lineStipple", s.line_stipple);
  v("lineStippleFactor", s.line_stipple_factor);
  v("lineStipplePattern", s.line_stipple_pattern);
}

template <class V>
void fields(V& v, raster::State& s) {
  before_rasterization(v, s);
  v("samples", s.samples);
  v("sampleShading", s.sample_shading);
  v("minSampleShading", s.min_sample_shading);
  v("sampleMask", s.sample_mask);
  v("alphaToCoverage", s.alpha_to_coverage);
  v("alphaToOne", s.alpha_to_one);
  v("customLocations", s.custom_locations);
  v("locations", s.locations);
  v("orderedAttachmentAccess", s.ordered_attachment_access);
  v("fragmentWidth", s.fragment_size.width);
  v("fragmentHeight", s.fragment_size.height);
  v("rateCombiners", s.rate_combiners);
  v("depthTest", s.depth_test);
  v("depthWrite", s.depth_write);
  v("depthBoundsTest", s.depth_bounds_test);
  v("stencilTest", s.stencil_test);
  v("depthCompare", s.depth_compare);
  v("minDepthBounds", s.min_depth_bounds);
  v("maxDepthBounds", s.max_depth_bounds);
  v("front", s.front);
  v("back", s.back);
  v("logicOpEnable", s.logic_op_enable);
  v("logicOp", s.logic_op);
  v("blendConstants", s.blend_constants);
  v("blend", s.blend);
}

template <class V>
void fields(V& v, Bug& b) {
  v("device", b.device);
  v("commandName", b.command_name);
  v("pipeline", b.pipeline);
  v("submission", b.submission);
  v("commandNumber", b.command_number);
  v("labels", b.labels);
  v("nullDescriptors", b.null_descriptors);
  v("robustAccess2", b.robust_access2);
  v("lost", b.lost);
  v("findings", b.findings);
  v("notes", b.notes);
  v("stages", b.stages);
  v("memories", b.memories);
  v("buffers", b.buffers);
  v("images", b.images);
  v("views", b.views);
  v("bufferViews", b.buffer_views);
  v("samplers", b.samplers);
  v("sets", b.sets);
  v("pushRanges", b.push_ranges);
  v("pushConstants", b.push_constants);
  v("pushed", b.pushed);
  v("descriptors", b.descriptors);
  v("addressed", b.addressed);
  if (!b.dispatches()) v("state", b.state);
  v("streams", b.streams);
  v("feedback", b.feedback);
  if (!b.dispatches()) v("rendering", b.rendering);
  v("command", b.command);
}

}  // namespace vitrine::glass::bug
