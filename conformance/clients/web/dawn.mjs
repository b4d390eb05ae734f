// WebGPU outside of browsers: Dawn for Node. A compute shader and a multisampled triangle, both checked here.
//   node dawn.mjs PICTURE.pam
import fs from 'node:fs';
import { create, globals } from 'webgpu';

Object.assign(globalThis, globals);

function must(condition, text) {
    if (condition) return;
    console.log(text);
    process.exit(1);
}

async function readBack(device, encoder, source, bytes, copy) {
    const mapped = device.createBuffer({ size: bytes, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
    copy(encoder, source, mapped);
    device.queue.submit([encoder.finish()]);
    await mapped.mapAsync(GPUMapMode.READ);
    return mapped.getMappedRange().slice(0);
}

/// Each invocation adds its square to the sum that its work-group makes in memory of its own.
async function compute(device) {
    const count = 512, group = 32;
    const module = device.createShaderModule({ code: `
        @group(0) @binding(0) var<storage, read_write> values: array<u32>;
        var<workgroup> sum: atomic<u32>;
        @compute @workgroup_size(${group})
        fn main(@builtin(global_invocation_id) id: vec3u) {
            atomicAdd(&sum, id.x);
            workgroupBarrier();
            values[id.x] = id.x * id.x + atomicLoad(&sum);
        }` });
    const pipeline = device.createComputePipeline({ layout: 'auto', compute: { module, entryPoint: 'main' } });
    const buffer = device.createBuffer({ size: count * 4, usage: GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC });
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({
        layout: pipeline.getBindGroupLayout(0), entries: [{ binding: 0, resource: { buffer } }] }));
    pass.dispatchWorkgroups(count / group);
    pass.end();
    const bytes = await readBack(device, encoder, buffer, count * 4,
        (e, from, to) => e.copyBufferToBuffer(from, 0, to, 0, count * 4));
    new Uint32Array(bytes).forEach((value, id) => {
        const first = id - id % group;
        const sum = group * first + group * (group - 1) / 2;
        must(value === id * id + sum, `compute: value ${id} is ${value}`);
    });
}

/// A triangle whose colour is interpolated, four samples a pixel, with depth and stencil; its middle is grey.
async function draw(device) {
    const size = 256;
    const texture = (format, sampleCount, usage) =>
        device.createTexture({ size: [size, size], format, sampleCount, usage: GPUTextureUsage.RENDER_ATTACHMENT | usage });
    const resolved = texture('rgba8unorm', 1, GPUTextureUsage.COPY_SRC);
    const samples = texture('rgba8unorm', 4, 0), depth = texture('depth24plus-stencil8', 4, 0);
    const module = device.createShaderModule({ code: `
        struct Corner { @builtin(position) place: vec4f, @location(0) color: vec3f }
        @vertex fn corner(@builtin(vertex_index) n: u32) -> Corner {
            var places = array(vec2f(0, 0.9), vec2f(-0.9, -0.9), vec2f(0.9, -0.9));
            var colors = array(vec3f(1, 0, 0), vec3f(0, 1, 0), vec3f(0, 0, 1));
            return Corner(vec4f(places[n], 0.5, 1), colors[n]);
        }
        @fragment fn shade(in: Corner) -> @location(0) vec4f { return vec4f(in.color, 1); }` });
    const pipeline = device.createRenderPipeline({
        layout: 'auto',
        vertex: { module, entryPoint: 'corner' },
        fragment: { module, entryPoint: 'shade', targets: [{ format: 'rgba8unorm' }] },
        multisample: { count: 4 },
        depthStencil: { format: 'depth24plus-stencil8', depthWriteEnabled: true, depthCompare: 'less' },
    });
    const encoder = device.createCommandEncoder();
    const pass = encoder.beginRenderPass({
        colorAttachments: [{ view: samples.createView(), resolveTarget: resolved.createView(), loadOp: 'clear',
            storeOp: 'discard', clearValue: [0.2, 0.2, 0.2, 1] }],
        depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: 'clear',
            depthStoreOp: 'discard', stencilLoadOp: 'clear', stencilStoreOp: 'discard' },
    });
    pass.setPipeline(pipeline);
    pass.draw(3);
    pass.end();
    const bytes = new Uint8Array(await readBack(device, encoder, resolved, size * size * 4,
        (e, from, to) => e.copyTextureToBuffer({ texture: from }, { buffer: to, bytesPerRow: size * 4 }, [size, size])));
    const header = `P7\nWIDTH ${size}\nHEIGHT ${size}\nDEPTH 4\nMAXVAL 255\nTUPLTYPE RGB_ALPHA\nENDHDR\n`;
    fs.writeFileSync(process.argv[2], Buffer.concat([Buffer.from(header), Buffer.from(bytes)]));
    const pixel = (x, y) => [...bytes.subarray((y * size + x) * 4, (y * size + x) * 4 + 4)];
    const near = (found, wanted) => found.every((value, n) => Math.abs(value - wanted[n]) <= 2);
    must(near(pixel(0, 0), [51, 51, 51, 255]), `the corner is ${pixel(0, 0)}`);
    // A third of the way up every colour counts the same.
    must(near(pixel(128, 166), [85, 85, 85, 255]), `the middle is ${pixel(128, 166)}`);
}

const gpu = create(['backend=vulkan']);  // which must outlive what comes from it
const adapter = await gpu.requestAdapter();
must(adapter, 'no adapter');
const device = await adapter.requestDevice();
device.addEventListener('uncapturederror', (event) => must(false, event.error.message));
await compute(device);
await draw(device);
console.log(`${adapter.info.device}: compute and triangle, ${adapter.features.size} features`);
device.destroy();
