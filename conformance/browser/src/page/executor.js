// Runs descriptions of work on a device of WebGPU. It knows no formula: shaders are text, inputs and results are bytes.
//
// The descriptions are those of the crate `lightmeter-gpu`, module `work`: resources that an executor keeps are named as
// {kept: PLACE}, those of one submission as {own: PLACE}.

const BYTES_LEAST = 16;
const ROW = 256;

// Bytes of a pixel of the formats that the suite draws to, reads from or samples.
const PIXEL_BYTES = {
  r32uint: 4, rgba32uint: 16, rgba32float: 16, rgba16float: 8, rgba8unorm: 4, "rgba8unorm-srgb": 4, bgra8unorm: 4,
};

// What the device refuses of a shader or a pipeline.
export class Refused extends Error {}

const nothing = () => ({ shaders: [], pipelines: [], buffers: [], textures: [], groups: [] });
const roundUp = (bytes, to) => Math.ceil(bytes / to) * to;

// What an executor keeps, and what it has made for one submission.
class Scope {
  constructor(kept, own) {
    this.kept = kept;
    this.own = own;
  }

  named(kind, handle) {
    const [place, among] = "kept" in handle ? [handle.kept, this.kept] : [handle.own, this.own];
    const found = among[kind][place];
    if (found === undefined) throw new Error(`no resource among ${kind} is described as ${JSON.stringify(handle)}`);
    return found;
  }
}

export class Executors {
  constructor(device) {
    this.device = device;
    this.kept = new Map();
    this.staging = [];
    // What an executor was asked last. The next thing waits for it; what others are asked goes on beside it.
    this.last = new Map();
  }

  // Runs a piece of work after those of the same executor, and resolves to the bytes that come back; `null` where nothing does.
  run(piece) {
    const [kind] = Object.keys(piece);
    const asked = piece[kind];
    const before = kind === "time" ? Promise.allSettled(this.last.values()) : this.last.get(asked.executor);
    const begun = Promise.resolve(before).then(() => this.begin(kind, asked));
    const quiet = begun.catch(() => {});
    this.last.set(asked.executor, quiet);
    if (kind === "drop") quiet.then(() => { if (this.last.get(asked.executor) === quiet) this.last.delete(asked.executor); });
    return begun.then((done) => done());
  }

  // Begins a piece of work. Resolves once the next one of its executor may begin, to what gives a promise of the bytes.
  async begin(kind, asked) {
    switch (kind) {
      case "make": {
        if (!this.kept.has(asked.executor)) this.kept.set(asked.executor, nothing());
        const kept = this.kept.get(asked.executor);
        await this.make(asked.resources, new Scope(kept, kept), kept);
        return async () => new Uint8Array();
      }
      case "forget-pipelines":
        if (this.kept.has(asked.executor)) this.kept.get(asked.executor).pipelines = [];
        return async () => null;
      case "drop":
        release(this.kept.get(asked.executor));
        this.kept.delete(asked.executor);
        return async () => null;
      case "submit":
        return this.submit(asked);
      case "time": {
        const bytes = await this.time(asked);
        return async () => bytes;
      }
      default:
        throw new Error(`there is no work of the kind ${kind}`);
    }
  }

  // Does something at once, and resolves to what the device objects to in it, or to `null`. Scopes are a stack that all share, so nothing may wait in between.
  guarded(act) {
    const { device } = this;
    device.pushErrorScope("out-of-memory");
    device.pushErrorScope("validation");
    let thrown = null;
    try {
      act();
    } catch (error) {
      thrown = error;
    }
    const scopes = Promise.all([device.popErrorScope(), device.popErrorScope()]);
    return scopes.then((errors) => {
      if (thrown) throw thrown;
      return errors.find((error) => error !== null) ?? null;
    });
  }

  // The same, where an objection is an error.
  async checked(act) {
    const error = await this.guarded(act);
    if (error) throw new Error(error.message);
  }

  // Makes resources at the ends of the lists in `into`.
  async make(described, scope, into) {
    await this.compile(described, scope, into);
    await this.checked(() => this.fill(described, scope, into));
  }

  async compile(described, scope, into) {
    if (described.shaders.length > 0) into.shaders.push(...(await Promise.all(described.shaders.map((shader) => this.shader(shader)))));
    if (described.pipelines.length > 0) into.pipelines.push(...(await Promise.all(described.pipelines.map((pipeline) => this.pipeline(pipeline, scope)))));
  }

  fill(described, scope, into) {
    for (const buffer of described.buffers) into.buffers.push(this.buffer(buffer));
    for (const texture of described.textures) into.textures.push(this.texture(texture));
    for (const group of described.groups) into.groups.push(this.group(group, scope));
  }

  async shader({ label, source }) {
    let module;
    const objection = this.guarded(() => { module = this.device.createShaderModule({ label, code: source }); });
    const { messages } = await module.getCompilationInfo();
    const errors = messages.filter(({ type }) => type === "error");
    if (errors.length > 0) {
      throw new Refused(errors.map(({ lineNum, linePos, message }) => `${lineNum}:${linePos}: ${message}`).join("\n"));
    }
    const error = await objection;
    if (error) throw new Refused(error.message);
    return module;
  }

  async pipeline(described, scope) {
    try {
      return "compute" in described
        ? await this.device.createComputePipelineAsync(computePipeline(described.compute, scope))
        : await this.device.createRenderPipelineAsync(this.renderPipeline(described.render, scope));
    } catch (error) {
      throw new Refused(error.message);
    }
  }

  renderPipeline(pipeline, scope) {
    const module = scope.named("shaders", pipeline.shader);
    const layout = pipeline.layout === null ? "auto" : this.device.createPipelineLayout({
      bindGroupLayouts: [this.device.createBindGroupLayout({ entries: pipeline.layout.map(layoutEntry) })],
    });
    const { topology, stripIndexFormat, frontFace, cullMode } = pipeline.primitive;
    return {
      label: pipeline.label,
      layout,
      vertex: {
        module,
        entryPoint: pipeline.vertex,
        buffers: pipeline.buffers.map(({ stride, step, attributes }) => ({ arrayStride: stride, stepMode: step, attributes })),
      },
      primitive: { topology, stripIndexFormat: stripIndexFormat ?? undefined, frontFace, cullMode: cullMode ?? "none" },
      depthStencil: pipeline.depth === null ? undefined : depthStencil(pipeline.depth),
      fragment: {
        module,
        entryPoint: pipeline.fragment,
        targets: pipeline.targets.map(({ format, blend, writeMask }) => ({ format, blend: blend ?? undefined, writeMask })),
      },
    };
  }

  buffer({ usage, contents }) {
    const { device } = this;
    if ("unwritten" in contents) return device.createBuffer({ size: contents.unwritten.bytes, usage });
    const bytes = "bytes" in contents
      ? contents.bytes
      : new Uint8Array(new Uint32Array(contents.repeated.count).fill(contents.repeated.word).buffer);
    const size = Math.max(bytes.length, BYTES_LEAST);
    const made = device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(made, 0, bytes);
    return made;
  }

  texture({ width, height, format, usage, contents }) {
    const texture = this.device.createTexture({ size: [width, height], format, usage });
    const pixel = PIXEL_BYTES[format];
    const bytesPerRow = width * pixel;
    const whole = Math.floor(contents.length / bytesPerRow) * bytesPerRow;
    let y = 0;
    for (const part of [contents.subarray(0, whole), contents.subarray(whole)]) {
      if (part.length === 0) continue;
      const rows = Math.ceil(part.length / bytesPerRow);
      const columns = Math.min(part.length, bytesPerRow) / pixel;
      this.device.queue.writeTexture({ texture, origin: [0, y] }, part, { bytesPerRow }, [columns, rows]);
      y += rows;
    }
    return { texture, view: texture.createView() };
  }

  group({ pipeline, bindings }, scope) {
    const entries = Object.entries(bindings).map(([binding, bound]) => ({
      binding: Number(binding),
      resource: resource(bound, scope),
    }));
    return this.device.createBindGroup({ layout: scope.named("pipelines", pipeline).getBindGroupLayout(0), entries });
  }

  // What a submission names. Shaders and pipelines that end with it are compiled; all else is made by `fill`.
  async named({ executor, work }) {
    const own = nothing();
    const scope = new Scope(this.kept.get(executor) ?? nothing(), own);
    await this.compile(work.own, scope, own);
    return scope;
  }

  // Makes what else ends with a submission, and writes what is to be written before it.
  prepare(work, scope) {
    this.fill(work.own, scope, scope.own);
    for (const { buffer, contents } of work.writes) this.device.queue.writeBuffer(scope.named("buffers", buffer), 0, contents);
  }

  // Submits. Resolves once that is done, to what gives a promise of the bytes.
  async submit(asked) {
    const scope = await this.named(asked);
    let read;
    const objection = this.guarded(() => { read = this.submitted(asked.work, scope); });
    const done = objection.then((error) => {
      if (error) throw new Error(error.message);
      return this.finish(read, scope);
    });
    done.catch(() => {});
    return () => done;
  }

  // Submits the work, and asks for what is read back.
  submitted(work, scope) {
    const { device } = this;
    this.prepare(work, scope);
    const encoder = device.createCommandEncoder();
    for (const step of work.steps) encode(encoder, step, scope);
    const parts = work.reads.map((read) => part(read, scope));
    const bytes = parts.reduce((sum, { rows, stride }) => sum + rows * stride, 0);
    const staging = this.stagingOf(bytes);
    let offset = 0;
    for (const part of parts) {
      part.copy(encoder, staging, offset);
      part.offset = offset;
      offset += part.rows * part.stride;
    }
    device.queue.submit([encoder.finish()]);
    const mapped = staging.mapAsync(GPUMapMode.READ, 0, roundUp(bytes, 4));
    mapped.catch(() => {});
    return { parts, bytes, staging, mapped };
  }

  // Waits for what is read back, row by row.
  async finish({ parts, bytes, staging, mapped }, scope) {
    await mapped;
    const range = new Uint8Array(staging.getMappedRange(0, roundUp(bytes, 4)));
    const result = new Uint8Array(parts.reduce((sum, { rows, rowBytes }) => sum + rows * rowBytes, 0));
    let to = 0;
    for (const { rows, stride, rowBytes, offset } of parts) {
      for (let row = 0; row < rows; row++, to += rowBytes) {
        result.set(range.subarray(offset + row * stride, offset + row * stride + rowBytes), to);
      }
    }
    staging.unmap();
    this.staging.push(staging);
    release(scope.own);
    return result;
  }

  // A buffer to read back through, used again once it is free; those that are much too long are left for longer reads.
  stagingOf(bytes) {
    const size = roundUp(Math.max(bytes, BYTES_LEAST), 4096);
    const place = this.staging.findIndex((buffer) => buffer.size >= size && buffer.size <= 4 * size);
    if (place >= 0) return this.staging.splice(place, 1)[0];
    if (this.staging.length > 16) this.staging.shift().destroy();
    return this.device.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  }

  // Two timestamps in nanoseconds, and the seconds that went by on the wall.
  async time(asked) {
    const { device } = this;
    const scope = await this.named(asked);
    const stamps = device.features.has("timestamp-query") ? device.createQuerySet({ type: "timestamp", count: 2 }) : null;
    const resolved = device.createBuffer({ size: 16, usage: GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC });
    const staging = device.createBuffer({ size: 16, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    let commands;
    await this.checked(() => { commands = this.repeated(asked, scope, { stamps, resolved, staging }); });
    await device.queue.onSubmittedWorkDone();
    const start = performance.now();
    const submitted = this.checked(() => device.queue.submit([commands]));
    await device.queue.onSubmittedWorkDone();
    const seconds = (performance.now() - start) / 1000;
    await submitted;
    const result = new Uint8Array(24);
    if (stamps) {
      await staging.mapAsync(GPUMapMode.READ);
      result.set(new Uint8Array(staging.getMappedRange()));
      staging.unmap();
    }
    new DataView(result.buffer).setFloat64(16, seconds, true);
    for (const object of [stamps, resolved, staging]) object?.destroy();
    release(scope.own);
    return result;
  }

  // The commands of a submission's steps, repeated between two timestamps.
  repeated({ work, repeats }, scope, { stamps, resolved, staging }) {
    this.prepare(work, scope);
    const encoder = this.device.createCommandEncoder();
    const { steps } = work;
    for (let turn = 0; turn < repeats; turn++) {
      steps.forEach((step, k) => {
        const begins = stamps && turn === 0 && k === 0;
        const ends = stamps && turn + 1 === repeats && k + 1 === steps.length;
        const writes = begins || ends ? { querySet: stamps } : undefined;
        if (begins) writes.beginningOfPassWriteIndex = 0;
        if (ends) writes.endOfPassWriteIndex = 1;
        encode(encoder, step, scope, writes);
      });
    }
    if (stamps) {
      encoder.resolveQuerySet(stamps, 0, 2, resolved, 0);
      encoder.copyBufferToBuffer(resolved, 0, staging, 0, 16);
    }
    return encoder.finish();
  }
}

function release(objects) {
  for (const buffer of objects?.buffers ?? []) buffer.destroy();
  for (const { texture } of objects?.textures ?? []) texture.destroy();
}

function computePipeline({ label, shader, entry, constants }, scope) {
  return { label, layout: "auto", compute: { module: scope.named("shaders", shader), entryPoint: entry, constants } };
}

function depthStencil({ format, depth_write_enabled: writes, depth_compare: compare, bias }) {
  return {
    format,
    depthWriteEnabled: writes ?? undefined,
    depthCompare: compare ?? undefined,
    depthBias: bias.constant,
    depthBiasSlopeScale: bias.slope_scale,
    depthBiasClamp: bias.clamp,
  };
}

// A layout's entry, as wgpu writes it, in WebGPU's words.
function layoutEntry({ binding, visibility, ty }) {
  if ("Buffer" in ty) {
    const { ty: kind, has_dynamic_offset: hasDynamicOffset, min_binding_size: least } = ty.Buffer;
    const type = kind === "Uniform" ? "uniform" : kind.Storage.read_only ? "read-only-storage" : "storage";
    return { binding, visibility, buffer: { type, hasDynamicOffset, minBindingSize: least ?? 0 } };
  }
  const { sample_type: sample, view_dimension: viewDimension, multisampled } = ty.Texture;
  const sampleType = typeof sample === "string" ? sample.toLowerCase() : sample.Float.filterable ? "float" : "unfilterable-float";
  return { binding, visibility, texture: { sampleType, viewDimension, multisampled } };
}

function resource(bound, scope) {
  if ("buffer" in bound) return { buffer: scope.named("buffers", bound.buffer) };
  if ("texture" in bound) return scope.named("textures", bound.texture).view;
  const { buffer, offset, bytes } = bound.part;
  return { buffer: scope.named("buffers", buffer), offset, size: bytes };
}

function encode(encoder, step, scope, timestampWrites) {
  if ("copy" in step) {
    const { from, to, bytes } = step.copy;
    encoder.copyBufferToBuffer(scope.named("buffers", from), 0, scope.named("buffers", to), 0, bytes);
  } else if ("compute" in step) {
    const { pipeline, group, workgroups } = step.compute;
    const pass = encoder.beginComputePass({ timestampWrites });
    pass.setPipeline(scope.named("pipelines", pipeline));
    pass.setBindGroup(0, scope.named("groups", group));
    pass.dispatchWorkgroups(...workgroups);
    pass.end();
  } else {
    render(encoder, step.render, scope, timestampWrites);
  }
}

function render(encoder, { colors, depth, commands }, scope, timestampWrites) {
  const pass = encoder.beginRenderPass({
    timestampWrites,
    colorAttachments: colors.map(({ texture, operations }) => ({
      view: scope.named("textures", texture).view,
      ...operation(operations, "loadOp", "clearValue", "storeOp"),
    })),
    depthStencilAttachment: depth === null ? undefined : {
      view: scope.named("textures", depth.texture).view,
      ...operation(depth.operations, "depthLoadOp", "depthClearValue", "depthStoreOp"),
    },
  });
  for (const command of commands) draw(pass, command, scope);
  pass.end();
}

function operation({ load, store }, loadOp, clearValue, storeOp) {
  if (typeof load === "string") return { [loadOp]: load, [storeOp]: store };
  return { [loadOp]: "clear", [clearValue]: load.clear, [storeOp]: store };
}

function draw(pass, command, scope) {
  const [kind] = Object.keys(command);
  const asked = command[kind];
  switch (kind) {
    case "pipeline": pass.setPipeline(scope.named("pipelines", asked)); break;
    case "group": pass.setBindGroup(0, scope.named("groups", asked)); break;
    case "vertices": pass.setVertexBuffer(asked.slot, scope.named("buffers", asked.buffer)); break;
    case "indices": pass.setIndexBuffer(scope.named("buffers", asked.buffer), asked.format); break;
    case "blend-constant": pass.setBlendConstant(asked); break;
    case "scissor": pass.setScissorRect(...asked); break;
    case "draw": {
      const { vertices, instances } = asked;
      pass.draw(vertices.end - vertices.start, instances.end - instances.start, vertices.start, instances.start);
      break;
    }
    case "draw-indexed": pass.drawIndexed(asked.indices.end - asked.indices.start, 1, asked.indices.start); break;
    default: throw new Error(`there is no command ${kind}`);
  }
}

// Where a read lies in the buffer that it comes back through: rows with gaps.
function part(read, scope) {
  if ("buffer" in read) {
    const { buffer, bytes } = read.buffer;
    const copy = (encoder, staging, offset) => encoder.copyBufferToBuffer(scope.named("buffers", buffer), 0, staging, offset, bytes);
    return { rows: 1, stride: bytes, rowBytes: bytes, copy };
  }
  const { texture } = scope.named("textures", read.texture);
  const rowBytes = texture.width * PIXEL_BYTES[texture.format];
  const stride = roundUp(rowBytes, ROW);
  const copy = (encoder, staging, offset) =>
    encoder.copyTextureToBuffer({ texture }, { buffer: staging, offset, bytesPerRow: stride }, [texture.width, texture.height]);
  return { rows: texture.height, stride, rowBytes, copy };
}
