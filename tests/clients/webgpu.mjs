// A small program in WebGPU: a compute shader makes a texture, a draw filters it. The picture's SHA-256 is its result.
const SIZE = 256;

const SHADERS = `
@group(0) @binding(0) var made: texture_storage_2d<rgba8unorm, write>;
@compute @workgroup_size(8, 8) fn make(@builtin(global_invocation_id) id: vec3u) {
  let p = vec2f(id.xy) / 32.0;
  let v = vec4f(fract(p.x * p.y), sin(p.x * 3.0) * 0.5 + 0.5, f32((id.x ^ id.y) & 15u) / 15.0, 1.0);
  textureStore(made, id.xy, v);
}

struct Out { @builtin(position) position: vec4f, @location(0) at: vec2f }
@vertex fn vertex(@builtin(vertex_index) i: u32, @builtin(instance_index) n: u32) -> Out {
  let corner = vec2f(f32(i % 2u), f32(i / 2u));
  let turn = f32(n) * 0.7;
  let p = (corner - 0.4) * mat2x2f(cos(turn), sin(turn), -sin(turn), cos(turn)) * 1.3;
  return Out(vec4f(p, f32(n) * 0.2, 1.0), corner);
}
@group(0) @binding(0) var shown: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;
@fragment fn fragment(in: Out) -> @location(0) vec4f {
  return textureSample(shown, linear, in.at * 1.5) * vec4f(1.0, 0.9, 0.8, 0.75);
}`;

function make_texture(device, module) {
  const texture = device.createTexture({
    size: [64, 64], format: 'rgba8unorm',
    usage: GPUTextureUsage.STORAGE_BINDING | GPUTextureUsage.TEXTURE_BINDING });
  const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'make' } });
  const group = device.createBindGroup({
    layout: pipeline.getBindGroupLayout(0), entries: [{ binding: 0, resource: texture.createView() }] });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginComputePass();
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, group);
  pass.dispatchWorkgroups(8, 8);
  pass.end();
  device.queue.submit([encoder.finish()]);
  return texture;
}

function draw(device, module, texture, target, depth) {
  const blend = { color: { srcFactor: 'src-alpha', dstFactor: 'one-minus-src-alpha' }, alpha: {} };
  const pipeline = device.createRenderPipeline({
    layout: 'auto',
    vertex: { module, entryPoint: 'vertex' },
    primitive: { topology: 'triangle-strip' },
    depthStencil: { format: 'depth24plus', depthWriteEnabled: true, depthCompare: 'less' },
    fragment: { module, entryPoint: 'fragment', targets: [{ format: 'rgba8unorm', blend }] } });
  const sampler = device.createSampler({ magFilter: 'linear', minFilter: 'linear', addressModeU: 'mirror-repeat' });
  const group = device.createBindGroup({
    layout: pipeline.getBindGroupLayout(0),
    entries: [{ binding: 0, resource: texture.createView() }, { binding: 1, resource: sampler }] });
  const encoder = device.createCommandEncoder();
  const pass = encoder.beginRenderPass({
    colorAttachments: [
      { view: target.createView(), loadOp: 'clear', storeOp: 'store', clearValue: [0.1, 0.2, 0.3, 1] }],
    depthStencilAttachment: {
      view: depth.createView(), depthLoadOp: 'clear', depthStoreOp: 'discard', depthClearValue: 1 } });
  pass.setPipeline(pipeline);
  pass.setBindGroup(0, group);
  pass.draw(4, 4);
  pass.end();
  const buffer = device.createBuffer({
    size: SIZE * SIZE * 4, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  encoder.copyTextureToBuffer({ texture: target }, { buffer, bytesPerRow: SIZE * 4 }, [SIZE, SIZE]);
  device.queue.submit([encoder.finish()]);
  return buffer;
}

/// Returns "SHA-256 of the picture, number of its colours, the adapter".
export async function picture(gpu) {
  const adapter = await gpu.requestAdapter();
  if (!adapter) return 'no adapter';
  const device = await adapter.requestDevice();
  const module = device.createShaderModule({ code: SHADERS });
  const attachment = (format, usage) => device.createTexture({ size: [SIZE, SIZE], format, usage });
  const target = attachment('rgba8unorm', GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC);
  const depth = attachment('depth24plus', GPUTextureUsage.RENDER_ATTACHMENT);
  const buffer = draw(device, module, make_texture(device, module), target, depth);
  await buffer.mapAsync(GPUMapMode.READ);
  const texels = buffer.getMappedRange().slice(0);
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', texels));
  const hash = [...digest].map(byte => byte.toString(16).padStart(2, '0')).join('');
  return `${hash} ${new Set(new Uint32Array(texels)).size} ${adapter.info.description || adapter.info.device}`;
}
