// Control flow as a compiler of HLSL gives it: nested loops, fall-through, early returns and discard, in every stage.
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kSide = 64;  ///< invocations: its square

struct Body {
  const char* name;
  const char* work;  ///< `uint work(uint x, uint y)` and what it calls
};

const Body kBodies[] = {
    {"nested_loops", R"(
uint work(uint x, uint y) {
  uint r = x;
  for (uint i = 0; i < (x & 7); i++) {
    [loop] while ((r & 3) != 0) {
      r = r * 5 + i;
      if ((r & 0x30) == 0x10) break;
      for (int j = int(y & 3); j >= 0; --j) {
        if (((r >> j) & 5) == 5) continue;
        r ^= uint(j) << 4;
        if ((r & 0x700) == 0x300) break;
      }
      r >>= 1;
    }
    if (i == 5) continue;
    r += i * 77;
  }
  return r;
})"},
    {"fall_through", R"(
uint work(uint x, uint y) {
  uint r = 0;
  for (uint i = 0; i < 4; i++) {
    switch ((x >> (i * 4)) & 7) {
      case 0:
      case 1:
        r += 1;
        break;
      case 2:
        if (y & 1) break;
        r += 10;
        break;
      case 3:
      case 4: {
        switch (y & 3) {
          case 0: r ^= 5; break;
          case 1: continue;
          default: r += 3;
        }
        break;
      }
      case 5:
        return r * 3 + i;
      default:
        r = r * 7 + x;
        break;
    }
    r += 100;
  }
  return r;
})"},
    {"early_return", R"(
float find(float v, int n) {
  if (v < 0) return -v;
  [loop] for (int i = 0; i < n; i++) {
    v = v * 0.75 + 1;
    if (v > 3.5) return v - i;
    if (v > 3.0 && (i & 1)) return v;
  }
  return v * 2;
}
uint work(uint x, uint y) {
  float v = (x & 1023) * (1.0 / 128) - 1;
  if (y % 7 == 0) return asuint(v);
  float f = find(v, int(y & 15));
  [branch] if (f < 0.5) {
    return x;
  } else if (f > 3) {
    f = find(f * 0.25, int(x & 7));
  }
  return asuint(f);
})"},
    {"do_while", R"(
uint work(uint x, uint y) {
  uint r = x, n = 0;
  do {
    n++;
    if (r & 1) {
      r = r * 3 + 1;
      if (n > 12) break;
      continue;
    }
    r >>= 1;
  } while (n < 20 && r > 1);
  return r + n * 65536;
})"},
    {"short_circuit", R"(
bool odd(uint v, inout uint n) { n += 3; return (v & 1) != 0; }
uint work(uint x, uint y) {
  uint n = 0;
  bool a = odd(x, n) && odd(y, n);
  bool b = odd(x >> 1, n) || odd(y >> 1, n);
  uint r = a ? odd(x >> 2, n) ? 1 : 2 : b ? 4 : 8;
  return r + n * 16;
})"},
    {"arrays_and_inout", R"(
void turn(inout uint v[6], uint by) {
  [unroll] for (int i = 0; i < 6; i++) {
    if (v[i] % 5 == by) return;
    v[i] += v[(i + by) % 6];
  }
}
uint work(uint x, uint y) {
  uint v[6];
  for (int i = 0; i < 6; i++) v[i] = x >> i;
  for (uint k = 0; k < (y & 3) + 1; k++) {
    turn(v, k);
    if (v[k] & 1) { v[x % 6] = y; } else [flatten] if (v[k] & 2) v[y % 6] ^= x;
  }
  uint r = 0;
  for (int j = 5; j >= 0; j--) r = r * 31 + v[j];
  return r;
})"},
    {"infinite_loops", R"(
uint work(uint x, uint y) {
  uint r = x & 255, n = 0;
  for (;;) {
    if (++n > 30) return r;
    while (true) {
      r += n;
      if (r > 300) { r -= 290; break; }
      if ((r & 15) == 3) break;
    }
    if ((r & 31) == (y & 31)) break;
    for (;;) { if ((r ^= n) & 4) break; r += 9; if (r & 8) return r * 1000; }
  }
  return r + n * 256;
})"},
};

const std::string kBuffers =
    "// target: hlsl\n"
    "[[vk::binding(0, 0)]] StructuredBuffer<uint> a;\n";

/// Words of which low bits, high bits and small values matter.
Buffer make_input(Run& run) {
  std::vector<uint32_t> words(kSide * kSide);
  for (uint32_t& word : words) word = run.random.bits() >> run.random.below(28);
  return run.buffer_of(words);
}

void in_compute(Run& run, const Body& body) {
  const std::string code = kBuffers + "[[vk::binding(1, 0)]] RWStructuredBuffer<uint> o;\n" + body.work +
                           "\n[numthreads(8, 8, 1)]\n"
                           "void main(uint3 id : SV_DispatchThreadID) {\n"
                           "  uint at = id.y * 64 + id.x;\n"
                           "  o[at] = work(a[at], at);\n"
                           "}\n";
  run.note("shader", code);
  const Buffer in = make_input(run), out = run.buffer(in.size);
  const Resources res = run.resources({storage_buffer(0, in), storage_buffer(1, out)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.dispatch(res, pipeline, kSide / 8, kSide / 8);
  run.out("result", out);
}

void draw(Run& run, GraphicsSpec& spec, uint32_t vertices) {
  const Target target = make_target(run, {.colors = {VK_FORMAT_R32_UINT}, .width = kSide, .height = kSide});
  const Resources res = run.resources({storage_buffer(0, make_input(run))});
  spec.layout = res.layout;
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res, vertices);
  out_target(run, target);
}

constexpr char kResultFragment[] =
    "layout(location = 0) flat in uint result;\nlayout(location = 0) out uint color;\n"
    "void main() { color = result; }\n";

void in_vertex(Run& run, const Body& body) {
  GraphicsSpec spec;
  spec.vertex = kBuffers + body.work + R"(
struct Vertex {
  float4 position : SV_Position;
  [[vk::builtin("PointSize")]] float size : PSIZE;
  [[vk::location(0)]] nointerpolation uint result : RESULT;
};
Vertex main(uint id : SV_VertexID) {
  Vertex v;
  v.position = float4((float2(id % 64, id / 64) + 0.5) / 32 - 1, 0.5, 1);
  v.size = 1;
  v.result = work(a[id], id);
  return v;
}
)";
  spec.fragment = kResultFragment;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  run.note("shader", spec.vertex);
  draw(run, spec, kSide * kSide);
}

void in_fragment(Run& run, const Body& body) {
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = kBuffers + body.work + R"(
uint main(float4 position : SV_Position) : SV_Target0 {
  uint id = uint(position.y) * 64 + uint(position.x);
  if (id % 11 == 3) discard;
  uint result = work(a[id], id);
  [branch] if ((result & 0x18) == 0x18) {
    if (id & 1) discard;
    result += 5;
  }
  return result;
}
)";
  run.note("shader", spec.fragment);
  draw(run, spec, 3);
}

/// Passes a vertex its place and number on.
constexpr char kPassingVertex[] = R"(// target: hlsl
struct Vertex {
  float4 position : SV_Position;
  [[vk::location(0)]] nointerpolation uint id : ID;
};
Vertex main(uint id : SV_VertexID) {
  Vertex v;
  v.position = float4((float2(id % 64, id / 64) + 0.5) / 32 - 1, 0.5, 1);
  v.id = id;
  return v;
}
)";

/// Triangles of three neighbouring numbers in, up to three points of each out, or none.
void in_geometry(Run& run, const Body& body) {
  GraphicsSpec spec;
  spec.vertex = kPassingVertex;
  spec.geometry = kBuffers + body.work + R"(
struct Vertex {
  float4 position : SV_Position;
  [[vk::location(0)]] nointerpolation uint id : ID;
};
struct Point {
  float4 position : SV_Position;
  [[vk::builtin("PointSize")]] float size : PSIZE;
  [[vk::location(0)]] nointerpolation uint result : RESULT;
};
[maxvertexcount(3)]
void main(triangle Vertex v[3], inout PointStream<Point> points) {
  if (a[v[0].id] % 13 == 5) return;
  for (uint i = 0; i < 3; i++) {
    uint result = work(a[v[i].id], v[i].id);
    if ((result & 0x18) == 0x18 && i == 1) continue;
    Point p;
    p.position = v[i].position;
    p.size = 1;
    p.result = result + 1;
    points.Append(p);
    if ((result & 7) == 7) break;
  }
}
)";
  spec.fragment = kResultFragment;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  run.note("shader", spec.geometry);
  draw(run, spec, kSide * kSide);
}

/// Patches of one control point become quads of points, one pixel each. `hull`: the hull shader works, else the domain.
void in_patches(Run& run, const Body& body, bool hull) {
  constexpr char kControlPoint[] = R"(
struct Vertex {
  float4 position : SV_Position;
  [[vk::location(0)]] nointerpolation uint id : ID;
};
struct Patch {
  float edges[4] : SV_TessFactor;
  float inside[2] : SV_InsideTessFactor;
  [[vk::location(2)]] uint result : RESULT;
};
)";
  GraphicsSpec spec;
  spec.vertex = kPassingVertex;
  spec.control = kBuffers + (hull ? body.work : "uint work(uint x, uint y) { return x; }") + kControlPoint + R"(
Patch constants(InputPatch<Vertex, 1> v) {
  Patch p;
  p.result = work(a[v[0].id * 4 + 1], v[0].id);
  bool cull = p.result % 11 == 3;
  for (int i = 0; i < 4; i++) p.edges[i] = cull && i == 2 ? 0 : 1;
  p.inside[0] = p.inside[1] = 1;
  return p;
}
[domain("quad")] [partitioning("integer")] [outputtopology("point")] [outputcontrolpoints(1)]
[patchconstantfunc("constants")]
Vertex main(InputPatch<Vertex, 1> v, uint i : SV_OutputControlPointID) {
  Vertex r = v[i];
  r.id = work(a[r.id * 4], r.id);
  return r;
}
)";
  spec.evaluation = kBuffers + (hull ? "uint work(uint x, uint y) { return x ^ y; }" : body.work) + kControlPoint + R"(
struct Point {
  float4 position : SV_Position;
  [[vk::builtin("PointSize")]] float size : PSIZE;
  [[vk::location(0)]] nointerpolation uint result : RESULT;
};
[domain("quad")]
Point main(Patch patch, float2 at : SV_DomainLocation, const OutputPatch<Vertex, 1> v) {
  uint corner = uint(at.x + at.y * 2 + 0.5);
  Point p;
  p.position = v[0].position + float4(corner * (1.0 / 32), 0, 0, 0);
  p.size = 1;
  p.result = work(patch.result, v[0].id * 4 + corner) + 1;
  return p;
}
)";
  // Every fourth pixel is a patch, whose points fill up to the next.
  spec.vertex.replace(spec.vertex.find("float2(id % 64, id / 64)"), 24, "float2(id % 16 * 4, id / 16)");
  spec.fragment = kResultFragment;
  spec.assembly.topology = VK_PRIMITIVE_TOPOLOGY_PATCH_LIST;
  spec.tessellation.patchControlPoints = 1;
  run.note("control", spec.control);
  run.note("evaluation", spec.evaluation);
  draw(run, spec, kSide * kSide / 4);
}

const bool kCases = [] {
  for (const Body& body : kBodies) {
    AddCase("glsl", std::string("hlsl.compute.") + body.name, [&](Run& run) { in_compute(run, body); });
    AddCase("glsl", std::string("hlsl.vertex.") + body.name, [&](Run& run) { in_vertex(run, body); });
    AddCase("glsl", std::string("hlsl.fragment.") + body.name, [&](Run& run) { in_fragment(run, body); });
    AddCase("glsl", std::string("hlsl.geometry.") + body.name, [&](Run& run) { in_geometry(run, body); });
    AddCase("glsl", std::string("hlsl.hull.") + body.name, [&](Run& run) { in_patches(run, body, true); });
    AddCase("glsl", std::string("hlsl.domain.") + body.name, [&](Run& run) { in_patches(run, body, false); });
  }
  return true;
}();

}  // namespace
}  // namespace vitrine::cts
