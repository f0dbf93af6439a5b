// three.js in headless Chromium as a renderer that speaks lightmeter.protocol/1: lines here, drawing in `page.js`.
import { createHash } from "node:crypto";
import { readdir, readFile, writeFile } from "node:fs/promises";
import { join, normalize } from "node:path";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { REVISION } from "three";

const HERE = fileURLToPath(new URL(".", import.meta.url));
const HOST = "http://three.localhost/";
const ARGUMENTS = [
  "--no-sandbox",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--no-first-run",
];

async function open() {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    headless: true,
    args: ARGUMENTS,
  });
  const page = await browser.newPage();
  page.on("console", (message) => console.error(message.text()));
  page.on("pageerror", (error) => console.error(error.message));
  // Nothing is fetched: files of this folder are all there is.
  await page.route("**/*", async (route) => {
    const path = new URL(route.request().url()).pathname;
    if (path === "/") return route.fulfill({ contentType: "text/html", body: "<!doctype html><title>three.js</title>" });
    const body = await readFile(join(HERE, normalize(path))).catch(() => null);
    return body ? route.fulfill({ contentType: "text/javascript", body }) : route.fulfill({ status: 404 });
  });
  await page.goto(HOST);
  await page.evaluate(async () => {
    window.renderer = await import("/page.js");
  });
  return { browser, page };
}

const NAMED = { NaN: Number.NaN, Inf: Infinity, "-Inf": -Infinity };
const parsed = (value) => (Array.isArray(value) ? value.map(parsed) : typeof value === "string" ? NAMED[value] : value);
const written = (x) => (Number.isFinite(x) ? x : Number.isNaN(x) ? "NaN" : x > 0 ? "Inf" : "-Inf");

// An image as NPY: bytes or f32, rows from the top.
function npy({ base64, width, height, floats }) {
  const shape = `(${height}, ${width}, 4)`;
  const text = `{'descr': '${floats ? "<f4" : "|u1"}', 'fortran_order': False, 'shape': ${shape}, }`;
  const header = text.padEnd(Math.ceil((text.length + 11) / 64) * 64 - 11) + "\n";
  const start = Buffer.from([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, header.length & 255, header.length >> 8]);
  return Buffer.concat([start, Buffer.from(header, "latin1"), Buffer.from(base64, "base64")]);
}

async function answerScene(page, folder, request) {
  const scene = JSON.parse(await readFile(request.scene, "utf8"));
  const drawn = await page.evaluate((scene) => window.renderer.drawScene(scene), scene);
  if (drawn.skip) return [{ id: request.id, skip: drawn.skip }];
  const image = request.id.replaceAll("/", "-") + ".npy";
  await writeFile(join(folder, image), npy(drawn));
  return [{ id: request.id, image }];
}

async function answerFormula(page, formula, requests) {
  const cases = requests.map(({ inputs }) => Object.fromEntries(Object.entries(inputs).map(([k, v]) => [k, parsed(v)])));
  const values = await page.evaluate(([formula, cases]) => window.renderer.evaluate(formula, cases), [formula, cases]);
  return values.map((value, k) =>
    value.skip ? { id: requests[k].id, skip: value.skip } : { id: requests[k].id, value: value.map(written) },
  );
}

async function answers(page, folder, formula, requests) {
  try {
    return await (formula ? answerFormula(page, formula, requests) : answerScene(page, folder, requests[0]));
  } catch (error) {
    return requests.map(({ id }) => ({ id, error: String(error.message).slice(0, 500) }));
  }
}

/** What tells the code of this folder from other code of the same three.js. */
async function digest() {
  const code = createHash("sha256");
  for (const name of (await readdir(HERE)).filter((name) => /\.m?js$/.test(name)).sort()) {
    const text = await readFile(join(HERE, name));
    code.update(`${name} ${text.length}\n`).update(text);
  }
  return code.digest("hex").slice(0, 16);
}

const write = (answer) => process.stdout.write(JSON.stringify(answer) + "\n");
const { browser, page } = await open();
let folder = ".";
let waiting = new Map();
for await (const line of createInterface({ input: process.stdin })) {
  const request = JSON.parse(line);
  if (request.hello) {
    folder = request.folder;
    const declared = await page.evaluate(() => ({ ...window.renderer.declared, device: window.renderer.device() }));
    const about = { version: `0.${REVISION}.0`, build: await digest(), profile: "opengl" };
    write({ hello: request.hello, renderer: "three.js", ...about, ...declared });
  } else if (request.batch) {
    for (const [key, requests] of waiting) {
      (await answers(page, folder, requests[0].formula, requests)).forEach(write);
    }
    waiting = new Map();
  } else {
    const key = request.formula ?? request.id;
    if (!waiting.has(key)) waiting.set(key, []);
    waiting.get(key).push(request);
  }
}
await browser.close();
