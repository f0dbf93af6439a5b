// Asks the server for work, runs it on this browser's GPU and sends back what came of it.
//
// One request for work is under way at a time. Pieces of one executor are begun in order, those of several side by side. What could not be sent is sent again,
// and what came of a piece twice is counted once by the server. After a lost device or a reload the server hands out again what is needed.

import { decode } from "./cbor.js";
import { Executors, Refused } from "./executor.js";
import { endPlayground, openPlayground } from "./playground.js";

// The protocol's version.
const PROTOCOL = 1;
// Pieces whose results are awaited at once.
const UNDER_WAY = 12;
const PATIENCE = 60_000;
const FEATURES = ["float32-blendable", "dual-source-blending", "timestamp-query", "shader-f16"];

const shown = (id) => document.getElementById(id);
const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

// Something that the page cannot go on after, in words for people.
class Stopped extends Error {}

function notice(text) {
  const place = shown("notice");
  place.textContent = text;
  place.hidden = false;
}

async function openDevice() {
  if (!navigator.gpu) {
    const why = globalThis.isSecureContext
      ? "This browser has no WebGPU. Chrome and Edge have it from version 113 on, Safari from 26, Firefox from 141 on Windows. On Linux Chrome may need --enable-unsafe-webgpu."
      : "Browsers give WebGPU to secure pages alone. Open this page by https, or by the address 127.0.0.1 on the machine itself.";
    throw new Stopped(why);
  }
  const adapter = await navigator.gpu.requestAdapter({ powerPreference: "high-performance" });
  if (!adapter) throw new Stopped("WebGPU is there, but the browser gives no adapter: its GPU may be blocked. See chrome://gpu or about:support.");
  const requiredFeatures = FEATURES.filter((name) => adapter.features.has(name));
  const requiredLimits = {};
  for (const name of ["maxBufferSize", "maxStorageBufferBindingSize", "maxTextureDimension2D", "maxComputeWorkgroupsPerDimension", "maxStorageBuffersPerShaderStage"]) {
    requiredLimits[name] = adapter.limits[name];
  }
  const device = await adapter.requestDevice({ label: "lightmeter", requiredFeatures, requiredLimits });
  return { adapter, device };
}

function browser() {
  const brands = navigator.userAgentData?.brands ?? [];
  const named = brands.find(({ brand }) => !/Not.?A.?Brand|^Chromium$/i.test(brand)) ?? brands.find(({ brand }) => brand === "Chromium");
  const [, name, version] = /(Firefox|Edg|Chrome|Version)\/([\d.]+)/.exec(navigator.userAgent) ?? [null, "browser", ""];
  const known = { Edg: "Edge", Version: "Safari" };
  return named ? { browser: named.brand, version: named.version } : { browser: known[name] ?? name, version };
}

function hello({ adapter, device }) {
  const { vendor = "", architecture = "", device: model = "", description = "", isFallbackAdapter } = adapter.info;
  const isCpu = Boolean(isFallbackAdapter ?? adapter.isFallbackAdapter) || /swiftshader|llvmpipe|basic render/i.test(`${architecture} ${description}`);
  return {
    protocol: PROTOCOL,
    session: sessionStorage.getItem("lightmeter-session"),
    vendor,
    architecture,
    model,
    description,
    platform: navigator.userAgentData?.platform ?? navigator.platform ?? "",
    ...browser(),
    abilities: {
      is_cpu: isCpu,
      most_pixels: device.limits.maxTextureDimension2D,
      features: FEATURES.filter((name) => device.features.has(name)),
    },
  };
}

// Sends a request until the server has answered it. A server that is gone for long has ended.
async function persistently(path, options, patience = PATIENCE) {
  const until = performance.now() + patience;
  for (let pause = 100; ; pause = Math.min(2 * pause, 2000)) {
    try {
      const response = await fetch(path, { ...options, cache: "no-store" });
      if (pause > 100) shown("notice").hidden = true;
      if (response.ok) return response;
      const text = await response.text();
      if (response.status === 409) throw new Stopped("Another page has taken over, so this one is idle. Load it again to take over from there.");
      throw new Stopped(response.status === 410 ? text : `The server refuses a message: ${text}`);
    } catch (error) {
      if (error instanceof Stopped) throw error;
      if (performance.now() > until) throw new Stopped("lightmeter does not answer. Look at the terminal where it was started; where it still runs, load this page again.");
      notice("lightmeter does not answer. It is asked again …");
    }
    await wait(pause);
  }
}

const post = (path, body, headers = {}) => persistently(path, { method: "POST", body, headers });

// The pieces of a reply: an id of 64 bits, a length of 32, and so many bytes; little endian.
function* pieces(reply) {
  const view = new DataView(reply);
  for (let at = 0; at < reply.byteLength; ) {
    const length = view.getUint32(at + 8, true);
    yield { id: Number(view.getBigUint64(at, true)), bytes: new Uint8Array(reply, at + 12, length) };
    at += 12 + length;
  }
}

async function serve(page) {
  const { device, session } = page;
  const executors = new Executors(device);
  const underWay = new Set();
  let after = 0;
  const send = async (id, promise) => {
    let [kind, body] = ["done", null];
    try {
      body = await promise;
    } catch (error) {
      if (page.isLost) return;
      [kind, body] = [error instanceof Refused ? "refused" : "failed", String(error.message)];
    }
    if (page.isLost) return;
    await post(`answer?${session}&id=${id}&kind=${kind}`, body);
  };
  while (!page.isLost && !page.isOver) {
    const response = await persistently(`next?${session}&after=${after}`, {});
    if (response.status === 204) continue;
    if (response.status === 205) throw new Stopped("This session has ended: nothing is judged any more. Load the page again, or start lightmeter again.");
    for (const { id, bytes } of pieces(await response.arrayBuffer())) {
      if (page.isLost) return;
      after = id;
      const piece = decode(bytes);
      if ("destroy" in piece || piece === "destroy") {
        device.destroy();
        return;
      }
      const done = executors.run(piece);
      if ("forget-pipelines" in piece || "drop" in piece) continue;
      const sent = send(id, done).catch((error) => page.stop(error)).finally(() => underWay.delete(sent));
      underWay.add(sent);
      while (underWay.size >= UNDER_WAY) await Promise.race(underWay);
    }
  }
}

// What went wrong in a group: why, and the pictures of a scene. They are kept in the page, since the server may end with the run.
async function failure({ id, stage, why, picture }, page) {
  const card = document.createElement("article");
  const title = document.createElement("h3");
  title.textContent = `${id} (${stage})`;
  card.append(title);
  if (why) {
    const text = document.createElement("p");
    text.textContent = why;
    card.append(text);
  }
  shown("failures").append(card);
  shown("failed").hidden = false;
  if (picture === null) return;
  const row = document.createElement("div");
  row.className = "pictures";
  card.append(row);
  for (const [k, what] of ["the reference", "the result", "the error map: the brighter, the farther from what is legal"].entries()) {
    const response = await fetch(`picture.png?${page.session}&number=${picture + k}`);
    if (!response.ok) return;
    const [figure, image, caption] = ["figure", "img", "figcaption"].map((name) => document.createElement(name));
    image.src = URL.createObjectURL(await response.blob());
    image.alt = `${id}: ${what}`;
    caption.textContent = what;
    figure.append(image, caption);
    row.append(figure);
  }
}

function row({ id, stage, verdicts, failed }) {
  const line = document.createElement("tr");
  for (const [text, name] of [[id], [stage], [verdicts.toLocaleString("en"), "number"], [failed.toLocaleString("en"), failed > 0 ? "number failed" : "number"]]) {
    const cell = document.createElement("td");
    cell.textContent = text;
    if (name) cell.className = name;
    line.append(cell);
  }
  return line;
}

// Keeps the report in the page, since the server may end with the run.
async function offer(page) {
  for (const [place, name] of [["report", "report.html"], ["json", "report.json"]]) {
    const response = await fetch(`${name}?${page.session}`);
    if (!response.ok) return;
    shown(place).href = URL.createObjectURL(await response.blob());
  }
  shown("end").hidden = false;
}

// Shows what the server tells of the run, once a second.
async function tell(page) {
  const play = (shader) => post(`play?${page.session}`, JSON.stringify(shader));
  let groups = 0;
  let last = null;
  while (!page.isOver) {
    const response = await persistently(`state?${page.session}&groups=${groups}`, {});
    const state = await response.json();
    for (const group of state.groups) {
      shown("groups").append(row(group));
      if (group.failed > 0 || group.why) await failure(group, page);
    }
    groups += state.groups.length;
    if (state.playground.length > 0) openPlayground(state.playground, play);
    const { done, of, failed } = state;
    const verdict = shown("verdict");
    verdict.textContent = state.says || "Waiting for work.";
    verdict.className = failed > 0 ? "failed" : state.is_over ? "passed" : "";
    const bar = shown("bar");
    bar.hidden = !(of > 0) || state.is_over;
    if (of > 0) [bar.max, bar.value] = [of, done];
    const now = performance.now();
    if (last && done > last.done) shown("rate").textContent = `${Math.round((1000 * (done - last.done)) / (now - last.now)).toLocaleString("en")} cases a second`;
    last = { done, now };
    if (state.is_over) {
      page.isOver = true;
      if (state.playground.length === 0) await offer(page);
      else endPlayground(state.says);
      shown("rate").textContent = "";
      return;
    }
    await wait(1000);
  }
}

async function run() {
  for (;;) {
    const opened = await openDevice();
    const said = hello(opened);
    const response = await post("hello", JSON.stringify(said), { "content-type": "application/json" });
    const { session, page: number } = await response.json();
    sessionStorage.setItem("lightmeter-session", session);
    const page = { device: opened.device, session: `session=${session}&page=${number}`, isLost: false, isOver: false };
    const words = [said.description || said.model, said.vendor, said.architecture].filter((word) => word);
    shown("device").textContent = `${words.join(" · ")} · ${said.browser} ${said.version} on ${said.platform}`;
    let over;
    const stopped = new Promise((resolve, reject) => {
      over = resolve;
      page.stop = (error) => { page.isOver = true; reject(error); };
    });
    const lost = opened.device.lost.then(async ({ message, reason }) => {
      page.isLost = true;
      await post(`lost?${page.session}`, message || reason).catch(() => {});
    });
    addEventListener("pagehide", () => { if (!page.isOver) navigator.sendBeacon(`bye?${page.session}`); });
    // What fails because the device is lost is no news.
    const told = (error) => { if (!page.isLost && !page.isOver) page.stop(error); };
    tell(page).then(over, told);
    serve(page).catch(told);
    await Promise.race([lost, stopped]);
    if (!page.isLost) return;
    page.isOver = true;
    notice("The device was lost. What it had not answered is asked again.");
  }
}

run().catch((error) => {
  const text = error instanceof Stopped ? error.message : `This page failed: ${error.message}`;
  notice(text);
  endPlayground(text);
});
