// Judges Chromium's GPU by `lightmeter serve`, as a person would, and as nobody should: SwiftShader computes, as nothing else is here.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { connect } from "node:tls";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { chromium } from "playwright-core";
import axe from "axe-core";
import { limit, pause, until } from "./limit.mjs";

// The folder for screenshots, and the part of a test's name that is run alone.
const [, , shots, only] = process.argv;
const lightmeter = process.env.LIGHTMETER;
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--enable-unsafe-webgpu", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--use-webgpu-adapter=swiftshader"],
});

// Starts `lightmeter serve`; gives its page's address, and a promise of how it ends.
function serve(...args) {
  return served(lightmeter, ["serve", ...args]);
}

async function served(program, args) {
  const child = spawn(program, args, { stdio: ["ignore", "pipe", "pipe"] });
  let [out, err] = ["", ""];
  child.stdout.on("data", (data) => { out += data; });
  const url = await new Promise((resolve, reject) => {
    child.stderr.on("data", (data) => {
      err += data;
      const found = /https?:\/\/\S+/.exec(err);
      if (found && err.endsWith("\n")) resolve(found[0]);
    });
    child.on("exit", (code) => reject(new Error(`ended with ${code}: ${err}`)));
  });
  const ended = new Promise((resolve) => child.on("close", (code) => resolve({ code, out, err })));
  return { url, ended, child };
}

// A page of a context of its own, whose console must stay empty.
async function open(url) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 800 } });
  const page = await context.newPage();
  page.on("console", (message) => { if (message.type() === "error") page.problems.push(message.text()); });
  page.on("pageerror", (error) => page.problems.push(error.message));
  page.problems = [];
  await page.goto(url);
  return page;
}

const isOver = (page) => page.waitForFunction(() => /right|wrong|before its time/.test(document.querySelector("#verdict").textContent), null, limit);
const verdict = (page) => page.textContent("#verdict");

async function aRunIsShownAndItsReportIsKept() {
  const served = await serve("fog/*", "scene/phong", "blend/add/one/one", "--format", "json");
  const page = await open(served.url);
  await isOver(page);
  assert.match(await verdict(page), /This GPU computes all of it right: [\d,]+ verdicts, 0 failed/);
  const { code, out } = await served.ended;
  assert.equal(code, 0);
  const report = JSON.parse(out);
  assert.equal(report.adapters[0].backend, "webgpu");
  assert.equal(report.totals.failed, 0);
  // The server has ended; what it gave stays.
  for (const [link, file, holds] of [["#report", "lightmeter.html", "<!DOCTYPE html>"], ["#json", "lightmeter.json", "lightmeter.report/2"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.click(link)]);
    assert.equal(download.suggestedFilename(), file);
    const text = readFileSync(await download.path(), "utf8");
    assert.ok(text.includes(holds), text.slice(0, 200));
  }
  const rows = await page.locator("#groups tr").count();
  assert.ok(rows >= 30, `${rows} rows`);
  const { violations } = await page.evaluate(`${axe.source}; axe.run()`);
  assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes[0].html]), []);
  if (shots) {
    await page.screenshot({ path: `${shots}/serve-desktop.png` });
    await page.emulateMedia({ colorScheme: "dark" });
    await page.setViewportSize({ width: 390, height: 800 });
    await page.screenshot({ path: `${shots}/serve-phone-dark.png` });
  }
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  assert.equal(wide, false, "nothing is wider than a phone");
  assert.deepEqual(page.problems, []);
  await page.context().close();
}

async function aReloadLosesNothing() {
  const served = await serve("lighting/*", "--format", "json");
  const page = await open(served.url);
  await page.waitForFunction(() => document.querySelectorAll("#groups tr").length > 4, null, limit);
  await page.reload();
  await isOver(page);
  const { code, out } = await served.ended;
  assert.equal(code, 0);
  const [{ totals }, undisturbed] = [JSON.parse(out), JSON.parse((await run({}, "lighting/*", "--format", "json")).out)];
  assert.deepEqual(totals, undisturbed.totals, "a reload changes no count");
  await page.context().close();
}

// What `run` gives of the same by the browser that it starts itself.
async function run(variables, ...args) {
  const env = { ...process.env, ...variables };
  const child = spawn(lightmeter, ["run", "--adapter", "chromium", ...args], { env, stdio: ["ignore", "pipe", "pipe"] });
  let [out, err] = ["", ""];
  child.stdout.on("data", (data) => { out += data; });
  child.stderr.on("data", (data) => { err += data; });
  return new Promise((resolve) => child.on("close", (code) => resolve({ code, out, err })));
}

async function aClosedTabEndsTheRun() {
  const served = await serve("lighting/*");
  const page = await open(served.url);
  await page.waitForFunction(() => document.querySelectorAll("#groups tr").length > 4, null, limit);
  await page.close({ runBeforeUnload: false });
  const { code, err } = await served.ended;
  assert.equal(code, 4, err);
  assert.match(err, /its page was closed/);
}

async function twoBrowsersAtOnceAreJudgedEachByItself() {
  const served = await serve("fog/*", "--keep", "--groups");
  const pages = await Promise.all([open(served.url), open(served.url)]);
  await Promise.all(pages.map(isOver));
  const verdicts = await Promise.all(pages.map(verdict));
  assert.equal(verdicts[0], verdicts[1]);
  served.child.kill("SIGINT");
  const { out } = await served.ended;
  assert.match(out, /chromium: /);
  assert.match(out, /chromium-2: /);
  await Promise.all(pages.map((page) => page.context().close()));
}

// Asks for work as the page does, and answers what it likes.
async function impostor(url, answer) {
  const post = (path, body) => fetch(url + path, { method: "POST", body });
  const hello = await post("hello", JSON.stringify({
    protocol: 1, session: null, vendor: "", architecture: "", model: "", description: "", platform: "", browser: "impostor", version: "0",
    abilities: { is_cpu: false, most_pixels: 8192, features: [] },
  }));
  const { session, page } = await hello.json();
  let after = 0;
  for (;;) {
    const response = await fetch(`${url}next?session=${session}&page=${page}&after=${after}`).catch(() => null);
    if (!response?.ok) return;
    const reply = await response.arrayBuffer();
    const view = new DataView(reply);
    for (let at = 0; at < reply.byteLength; at += 12 + view.getUint32(at + 8, true)) {
      after = Number(view.getBigUint64(at, true));
      await post(`answer?session=${session}&page=${page}&id=${after}&kind=done`, answer()).catch(() => null);
    }
  }
}

async function rubbishIsToldAndNothingIsJudgedByIt() {
  const served = await serve("fog/exp");
  await impostor(served.url, () => new Uint8Array(5));
  const { code, err } = await served.ended;
  assert.equal(code, 4);
  assert.match(err, /5 bytes came back, where \d+ were asked for/);
}

async function aSlowBrowserIsWaitedFor() {
  const served = await serve("fog/exp", "--cases", "64");
  const context = await browser.newContext();
  await context.route("**/answer*", async (route) => {
    await pause(500);
    await route.continue();
  });
  const page = await context.newPage();
  await page.goto(served.url);
  const { code } = await served.ended;
  assert.equal(code, 0);
  await context.close();
}

async function aBrowserWithoutWebGpuIsToldWhatToDo() {
  const served = await serve("fog/exp");
  const context = await browser.newContext();
  await context.addInitScript(() => Object.defineProperty(Navigator.prototype, "gpu", { value: undefined }));
  const page = await context.newPage();
  await page.goto(served.url);
  await page.waitForFunction(() => !document.querySelector("#notice").hidden);
  assert.match(await page.textContent("#notice"), /This browser has no WebGPU/);
  served.child.kill("SIGINT");
  assert.equal((await served.ended).code, 3);
  await context.close();
}

// What fails is shown with its cause, and a scene with its pictures, which stay once the server has ended.
async function aSceneThatFailsIsShownWithItsPictures() {
  const copy = shaders("scene_lighting.wgsl", "return sum.diffuse + sum.specular;", "return sum.diffuse + 0.8 * sum.specular;");
  const images = mkdtempSync(join(tmpdir(), "lightmeter-images-"));
  const served = await serve("scene/phong", "fog/exp", "--shaders", copy, "--images", images);
  const page = await open(served.url);
  await isOver(page);
  const { code, err } = await served.ended;
  assert.equal(code, 1, err);
  assert.match(await page.textContent("#failures"), /scene\/phong \(/);
  await page.waitForFunction(() => document.querySelectorAll("#failures img").length >= 3);
  const sizes = await page.$$eval("#failures img", (images) => images.map((image) => [image.naturalWidth, image.naturalHeight, image.alt]));
  for (const [width, height, alt] of sizes) assert.ok(width > 32 && height > 32 && alt.startsWith("scene/phong"), `${width} × ${height}: ${alt}`);
  const { violations } = await page.evaluate(`${axe.source}; axe.run()`);
  assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes[0].html]), []);
  if (shots) {
    await page.screenshot({ path: `${shots}/serve-failing.png`, fullPage: true });
    await page.emulateMedia({ colorScheme: "dark" });
    await page.setViewportSize({ width: 390, height: 800 });
    await page.screenshot({ path: `${shots}/serve-failing-phone-dark.png`, fullPage: true });
  }
  const wide = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
  assert.equal(wide, false, "nothing is wider than a phone");
  assert.deepEqual(page.problems, []);
  await page.context().close();
  for (const folder of [copy, images]) rmSync(folder, { recursive: true });
}

// Any command takes a browser that opens a page.
async function aBenchWaitsForABrowserAndTellsTheStepsOfItsClock() {
  const bench = await served(lightmeter, ["bench", "fog/exp", "--quick", "--adapter", "browser", "--format", "json"]);
  const page = await open(bench.url);
  const { code, out, err } = await bench.ended;
  assert.equal(code, 0, err);
  const [{ adapter, clock }] = JSON.parse(out).adapters;
  assert.equal(adapter, "browser");
  assert.ok(clock.grain_ns >= 1 && clock.grain_ns <= 1e6, `a step of ${clock.grain_ns} ns`);
  await page.waitForFunction(() => /The command has ended/.test(document.querySelector("#verdict").textContent));
  await page.context().close();
}

// A copy of the shaders with a mistake in one file.
function shaders(file, right, wrong) {
  const copy = mkdtempSync(join(tmpdir(), "lightmeter-shaders-"));
  cpSync(new URL("../../gpu/src/shaders", import.meta.url), copy, { recursive: true });
  const text = readFileSync(join(copy, file), "utf8");
  assert.equal(text.split(right).length, 2, `${right} stands once in ${file}`);
  writeFileSync(join(copy, file), text.replace(right, wrong));
  return copy;
}

// Ten mistakes in a copy of the shaders: the formula that shows each, the file, what stands there, what takes its place, and the mistake's name.
const MISTAKES = [
  ["fog/exp-radial", "fog.wgsl", "return length(p);", "return abs(p.z);", "fog-planar"],
  ["fog/exp", "fog.wgsl", "return clamp(exp(-(density * distance)), 0.0, 1.0);", "return 1.0 - clamp(exp(-(density * distance)), 0.0, 1.0);", "fog-inverted"],
  ["fog/exp2-opengl", "fog.wgsl", "return clamp(exp(-(t * t)), 0.0, 1.0);", "return clamp(exp(-t), 0.0, 1.0);", "fog-exp-for-exp2"],
  ["lighting/diffuse-toward", "lighting.wgsl", "return max(dot(l, n), 0.0);", "return dot(l, n);", "incidence-unclamped"],
  ["lighting/diffuse-travel", "lighting.wgsl", "return max(dot(l, n), 0.0);", "return abs(dot(l, n));", "incidence-of-both-sides"],
  ["lighting/phong", "lighting.wgsl", "return vector_cosine_power(vector_reflect(-l, n), v, shininess);", "return vector_cosine_power(n, vector_halfway(v, l), shininess);", "blinn-for-phong"],
  ["lighting/blinn", "lighting.wgsl", "return vector_cosine_power(n, vector_halfway(v, l), shininess);", "return vector_cosine_power(n, vector_halfway(v, l), 4.0 * shininess);", "shininess-times-4"],
  ["attenuation/point", "attenuation.wgsl", "return attenuation_polynomial(kc, kl, kq, distance(light, p));", "return min(attenuation_polynomial(kc, kl, kq, distance(light, p)), 1.0);", "attenuation-at-most-one"],
  ["vector/reflect", "vector.wgsl", "return i - 2.0 * dot(i, n) * n;", "return i + 2.0 * dot(i, n) * n;", "reflect-with-plus"],
  ["vector/halfway", "vector.wgsl", "return vector_normalize(v + l);", "return v + l;", "half-vector-not-normalised"],
];

async function mistakesAreNamedThroughTheBrowser() {
  for (const [formula, file, right, wrong, name] of MISTAKES) {
    const copy = shaders(file, right, wrong);
    const { code, out, err } = await run({}, formula, "--shaders", copy, "--cases", "512");
    rmSync(copy, { recursive: true });
    assert.equal(code, 1, `${formula}: ${out}${err}`);
    assert.ok(out.includes(`(${name})`), `${formula}: ${name} is not named in\n${out}`);
  }
}

// A network of its own, as another machine has, where this may be made: two addresses of a range that is meant for tests.
function network() {
  const [name, here, there] = ["lightmeter-tls", "198.18.77.1", "198.18.77.2"];
  const ip = (...words) => spawnSync("ip", words, { encoding: "utf8" });
  ip("netns", "delete", name);
  for (const words of [
    ["netns", "add", name],
    ["link", "add", "lightmeter0", "type", "veth", "peer", "name", "lightmeter1", "netns", name],
    ["address", "add", `${here}/30`, "dev", "lightmeter0"],
    ["link", "set", "lightmeter0", "up"],
    ["-n", name, "address", "add", `${there}/30`, "dev", "lightmeter1"],
    ["-n", name, "link", "set", "lightmeter1", "up"],
    ["-n", name, "link", "set", "lo", "up"],
  ]) {
    const { status, stderr, error } = ip(...words);
    if (status !== 0) return { why: `ip ${words.join(" ")}: ${error ?? stderr.trim()}` };
  }
  return { there, inside: (...words) => ["ip", ["netns", "exec", name, ...words]], end: () => ip("netns", "delete", name) };
}

// The fingerprint of the certificate that a server shows.
function fingerprint(url) {
  const { hostname, port } = new URL(url);
  return new Promise((resolve, reject) => {
    const socket = connect({ host: hostname, port, rejectUnauthorized: false }, () => {
      resolve(socket.getPeerCertificate().fingerprint256);
      socket.destroy();
    });
    socket.on("error", reject);
  });
}

async function anotherMachineReachesItByTlsAlone() {
  const { why, there, inside, end } = network();
  if (why) return `not tried, since no network namespace can be made here: ${why}`;
  try {
    const server = await served(...inside(lightmeter, "serve", "fog/*", "--format", "json", "--listen", `${there}:0`));
    assert.match(server.url, new RegExp(`^https://${there.replaceAll(".", "[.]")}:\\d+/[0-9a-f]{32}/$`));
    const plain = await fetch(server.url.replace("https:", "http:")).then(() => "answered", () => "nothing");
    assert.equal(plain, "nothing", "http is not spoken");
    const shown = await fingerprint(server.url);
    const context = await browser.newContext({ ignoreHTTPSErrors: true });
    const page = await context.newPage();
    await page.goto(server.url);
    await isOver(page);
    const { code, out, err } = await server.ended;
    assert.equal(code, 0, err);
    assert.ok(err.includes(shown), `the printed fingerprint is ${shown}: ${err}`);
    assert.equal(JSON.parse(out).totals.failed, 0);
    await context.close();
    // Without going on past the warning nothing is loaded.
    const other = await served(...inside(lightmeter, "serve", "fog/exp", "--listen", `${there}:0`));
    const strict = await browser.newContext();
    const refused = await (await strict.newPage()).goto(other.url).then(() => "loaded", (error) => String(error));
    assert.match(refused, /ERR_CERT_AUTHORITY_INVALID/);
    await strict.close();
    other.child.kill("SIGINT");
    await other.ended;
  } finally {
    end();
  }
}

// The processes of Chromium whose profiles lie in a folder.
function browsers(folder) {
  return spawnSync("pgrep", ["--full", `user-data-dir=${folder}/lightmeter-chromium-`], { encoding: "utf8" }).stdout.split("\n").filter(Boolean);
}

async function aChromiumThatIsKilledEndsTheRunWithWhatWasJudged() {
  const folder = mkdtempSync(join(tmpdir(), "lightmeter-killed-"));
  // It holds once something was judged, until a byte comes on its standard input.
  const env = { ...process.env, TMPDIR: folder, LIGHTMETER_EVENTS: "2", LIGHTMETER_HOLD: "advanced:1@0" };
  const child = spawn(lightmeter, ["run", "--adapter", "chromium", "lighting/*", "--cases", "100000"], { env });
  let [out, err] = ["", ""];
  child.stdout.on("data", (data) => { out += data; });
  const ended = new Promise((resolve) => child.on("close", resolve));
  await new Promise((resolve) => createInterface(child.stderr).on("line", (line) => {
    if (!line.startsWith('{"event":')) err += line + "\n";
    else if (JSON.parse(line).event === "advanced") resolve();
  }).on("close", resolve));
  // The one that the run started is the parent of the others.
  const pid = browsers(folder).find((pid) => spawnSync("ps", ["-o", "ppid=", "-p", pid], { encoding: "utf8" }).stdout.trim() === String(child.pid));
  assert.ok(pid, "Chromium is a child of the run");
  process.kill(Number(pid), "SIGKILL");
  child.stdin.end("\n");
  assert.equal(await ended, 4, out + err);
  assert.match(out + err, /Chromium ended with signal: 9/);
  assert.match(out, /lighting\/|verdicts/);
  rmSync(folder, { recursive: true, force: true });
}

async function aRunThatEndsAtItsFirstFailureEndsItsChromium() {
  const folder = mkdtempSync(join(tmpdir(), "lightmeter-ended-"));
  const copy = shaders("fog.wgsl", "return clamp(exp(-(density * distance)), 0.0, 1.0);", "return 0.5;");
  const { code, out } = await run({ TMPDIR: folder }, "fog/*", "--shaders", copy, "--fail-fast");
  rmSync(copy, { recursive: true });
  assert.equal(code, 1, out);
  await until("the end of the Chromium that was started", () => browsers(folder).length === 0);
  rmSync(folder, { recursive: true, force: true });
}

async function shadersAreJudgedAsTheyAreTyped() {
  const { url, ended, child } = await serve("--playground");
  const page = await open(url);
  const said = (pattern) => page.waitForFunction((source) => new RegExp(source).test(document.querySelector("#played").textContent), pattern.source, limit).catch(async () => assert.match(await page.textContent("#played"), pattern));
  await page.waitForSelector("#playground:not([hidden])");
  // Each example says in its title whether it is right.
  const examples = await page.locator("#example option:not([value=''])").allTextContents();
  assert.ok(examples.length >= 5, String(examples));
  for (const title of examples) {
    await page.evaluate(() => { document.querySelector("#played").textContent = ""; });
    await page.selectOption("#example", title);
    await said(title.includes("right") ? /^✓ This is [a-z0-9/-]+: [\d,]+ values, all legal/ : /^✗ [^]*explained by/);
    assert.equal(await page.locator("#drawn img").count(), 3, title);
    const wrong = /([\d,]+) of [\d,]+ pixels are wrong/.exec(await page.textContent("#drawn-says"))[1];
    assert.equal(wrong === "0", title.includes("right"), `${title}: ${wrong} pixels are wrong`);
    const sizes = await page.locator("#drawn img").evaluateAll((images) => images.map(({ naturalWidth }) => naturalWidth));
    assert.ok(sizes.every((width) => width >= 96), `the pictures are shown: ${sizes}`);
  }
  // A mistake is named, and gone when it is mended.
  await page.selectOption("#example", examples[0]);
  await said(/^✓ This is lighting.blinn/);
  const right = await page.inputValue("#text");
  await page.fill("#text", right.replace("normalize(l + v)", "normalize(v - l)"));
  await said(/half-vector-by-difference/);
  if (shots) await page.screenshot({ path: `${shots}/playground-desktop.png`, fullPage: true });
  // The address holds the shader: another page that opens it has the same one.
  const link = await page.evaluate(() => location.href);
  const other = await open(link);
  await other.waitForFunction(() => /half-vector-by-difference/.test(document.querySelector("#played").textContent), null, limit);
  assert.equal(await other.inputValue("#text"), await page.inputValue("#text"));
  assert.deepEqual(other.problems, []);
  await other.context().close();
  // No formula chosen: the nearest one is found.
  await page.fill("#text", right);
  await page.selectOption("#formula", "");
  await said(/^✓ This is lighting.blinn/);
  assert.match(await page.textContent("#told"), /What its variables are taken to be/);
  assert.doesNotMatch(await page.textContent("#result"), /lightmeter run/, "what was typed has no command line");
  // An example that was changed can be chosen again.
  await page.selectOption("#example", examples[0]);
  await page.fill("#text", `${right}\n`);
  assert.equal(await page.inputValue("#example"), "");
  await page.selectOption("#example", examples[0]);
  assert.equal(await page.inputValue("#text"), right);
  await page.selectOption("#formula", "");
  // What is no name of a function, no input and no formula is said to be none.
  await page.evaluate(() => { for (const place of document.querySelectorAll("details")) place.open = true; });
  for (const [field, text, pattern] of [["function", "--shader=/etc/passwd", /is no function's name/], ["constant", "glossiness=3", /the constant `glossiness=3`: no formula has an input `glossiness`/]]) {
    await page.fill(`#${field}`, text);
    await said(pattern);
    assert.equal(await page.locator("#drawn img").count(), 0, "no picture of an earlier shader is left");
    await page.fill(`#${field}`, "");
  }
  await said(/^✓ This is lighting.blinn/);
  const refused = await page.evaluate(async (text) => {
    const session = performance.getEntriesByType("resource").map(({ name }) => /state\?(session=\w+&page=\d+)/.exec(name)).filter((found) => found).pop()[1];
    const shader = { language: "glsl", text, function: "", formula: "--every", bind: [], constant: [] };
    const response = await fetch(`play?${session}`, { method: "POST", body: JSON.stringify(shader) });
    return (await response.json()).refused;
  }, right);
  assert.match(refused, /there is no formula `--every`/);
  await page.fill("#text", "");
  await said(/^Nothing is judged yet/);
  assert.equal(await page.locator("#drawn img").count(), 0, "nothing is drawn of no shader");
  const spoilt = await open(`${url}#shader=%7Bnothing`);
  await spoilt.waitForFunction(() => /the link's shader cannot be read/.test(document.querySelector("#played").textContent), null, limit);
  await spoilt.context().close();
  // What cannot be judged is refused in words that name no file of this machine, and the next shader is judged.
  for (const [text, pattern] of [["void main() { not glsl }", /^Not judged: /], ["(".repeat(30_000), /^Not judged: /], ["x".repeat(70_000), /65536 bytes/]]) {
    await page.fill("#text", text);
    await said(pattern);
    assert.doesNotMatch(await page.textContent("#played"), /\/tmp/);
  }
  const endless = right.replace("vec3 h =", "float x = 0.0; for (int i = 0; x < 1.0; i++) { x = x * 0.5; } vec3 h =");
  await page.fill("#text", endless);
  await said(/^✗ The nearest is lighting[^]*is NaN/);
  await page.fill("#text", right);
  await said(/^✓ This is lighting.blinn/);
  const { violations } = await page.evaluate(`${axe.source}; axe.run()`);
  assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes[0].html]), []);
  await page.emulateMedia({ colorScheme: "dark" });
  await page.setViewportSize({ width: 390, height: 800 });
  if (shots) await page.screenshot({ path: `${shots}/playground-phone-dark.png`, fullPage: true });
  assert.equal(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth), false, "nothing is wider than a phone");
  // The refused message of 70,000 bytes is the browser's only complaint.
  assert.deepEqual(page.problems.filter((problem) => !problem.includes("413")), []);
  child.kill("SIGINT");
  await said(/^lightmeter has ended/);
  assert.equal((await ended).code, 0);
  await page.context().close();
}

const tests = [
  aRunIsShownAndItsReportIsKept, aReloadLosesNothing, aClosedTabEndsTheRun, twoBrowsersAtOnceAreJudgedEachByItself,
  rubbishIsToldAndNothingIsJudgedByIt, aSlowBrowserIsWaitedFor, aBrowserWithoutWebGpuIsToldWhatToDo,
  mistakesAreNamedThroughTheBrowser, aSceneThatFailsIsShownWithItsPictures, aBenchWaitsForABrowserAndTellsTheStepsOfItsClock, anotherMachineReachesItByTlsAlone, aChromiumThatIsKilledEndsTheRunWithWhatWasJudged,
  aRunThatEndsAtItsFirstFailureEndsItsChromium, shadersAreJudgedAsTheyAreTyped,
];
for (const test of tests) {
  if (only && !test.name.includes(only)) continue;
  const began = performance.now();
  const not = await test();
  console.log(`${not ?? "ok"} ${test.name.replace(/[A-Z]/g, (letter) => ` ${letter.toLowerCase()}`)} (${((performance.now() - began) / 1000).toFixed(1)} s)`);
}
await browser.close();
