// Looks at the pages in a folder as people would: filters, links, slider, keyboard; nothing fetched, nothing said on the console, no
// script of others, and nothing that axe-core finds wrong. `report.mjs FOLDER [SCREENSHOTS]`
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readdir, readFile, stat } from "node:fs/promises";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";
import { limit } from "./limit.mjs";

const [made, screenshots] = process.argv.slice(2);
const axe = await readFile(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox", "--disable-dev-shm-usage"] });
const address = (name, fragment = "") => pathToFileURL(join(made, name)).href + fragment;

// Opens a page, does something with it, and holds what holds of every page.
async function on(name, { fragment = "", width = 1280, height = 900, dark = false, bypassCSP = false } = {}, then = async () => {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? "dark" : "light", bypassCSP });
  const page = await context.newPage();
  const said = [];
  page.on("console", (message) => said.push(message.text()));
  page.on("pageerror", (error) => said.push(error.message));
  page.on("request", (request) => {
    const url = request.url();
    if (!url.startsWith("data:") && !url.startsWith(pathToFileURL(made).href)) said.push(`it asks for ${url}`);
  });
  await page.goto(address(name, fragment));
  await then(page);
  assert.deepEqual(said, [], `${name} says nothing on the console`);
  assert.equal(await page.evaluate(() => window.hacked), undefined, `${name} runs no script of others`);
  const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
  assert.ok(overflow <= 0, `${name} is ${overflow} pixels wider than a window of ${width}`);
  if (screenshots) await page.screenshot({ path: join(screenshots, `${name.replace(/\W+/g, "-")}-${width}${dark ? "-dark" : ""}.png`) });
  await context.close();
}

const shown = (page) => page.locator("#matrix tbody tr:visible").count();
const tests = {
  async "a failing run is small"() {
    assert.ok((await stat(join(made, "fail.html"))).size < 10e6);
    await on("fail.html", {}, async (page) => {
      assert.ok(await page.locator("details.card").count() > 5);
    });
  },

  async "filters keep their state in the address"() {
    await on("fail.html", {}, async (page) => {
      const all = await shown(page);
      await page.fill("#q", "fog");
      const fog = await shown(page);
      assert.ok(fog > 5 && fog < all, `${fog} of ${all}`);
      await page.selectOption("select[name=show]", "fail");
      const failing = await shown(page);
      assert.ok(failing > 0 && failing < fog, `${failing} of ${fog}`);
      const link = page.url();
      assert.match(link, /#q=fog&show=fail/);
      await page.goto("about:blank");
      await page.goto(link);
      assert.equal(await shown(page), failing);
      assert.equal(await page.inputValue("#q"), "fog");
      assert.match(await page.textContent("#count"), new RegExp(`^${failing} of ${all}$`));
      await page.selectOption("select[name=family]", "blend");
      assert.equal(await shown(page), 0);
    });
  },

  async "a cell leads to its card, and the card has the formula, the steps and the command"() {
    await on("fail.html", { fragment: "#q=fog/exp&show=fail" }, async (page) => {
      const link = page.locator("#matrix td.fail a:visible").first();
      const card = page.locator(await link.getAttribute("href"));
      await card.evaluate((card) => (card.open = false));
      await link.click();
      assert.notEqual(await card.getAttribute("open"), null);
      assert.match(page.url(), /&card=fails-fog-exp/);
      for (const what of ["fog-base-two", "legal", "departs here", "lightmeter run"]) {
        assert.ok((await card.textContent()).includes(what), what);
      }
      assert.ok(await card.locator("figure.plot path.mistaken").count() > 0);
    });
  },

  async "a link to a card shows the card"() {
    for (const width of [1280, 390]) {
      await on("fail.html", { fragment: "#card=" + (await lastFormula()), width }, async (page) => {
        const card = await lastFormula();
        await page.waitForFunction((card) => {
          const { top } = document.querySelector(card).getBoundingClientRect();
          return top >= -2 && top < 400;
        }, `#${card}`, limit);
      });
    }
  },

  async "a subject's cells stand below its own heads"() {
    await on("matrix.html", {}, async (page) => {
      const subjects = await page.locator("select[name=subject] option").evaluateAll((all) => all.map((one) => one.value).filter(Boolean));
      assert.ok(subjects.length > 1, `${subjects}`);
      for (const subject of subjects) {
        await page.selectOption("select[name=subject]", subject);
        const [heads, rows] = await page.evaluate(() => {
          const places = (row) => [...row.children].map((cell, k) => (cell.hidden ? null : k)).filter((k) => k !== null).join();
          const all = [...document.querySelectorAll("#matrix tbody tr")].map(places);
          // The first cell of a row is the formula's name, whose head spans both rows of heads.
          const heads = places(document.querySelectorAll("#matrix thead tr")[1]).split(",").map((k) => Number(k) + 1);
          return [[0, ...heads].join(), [...new Set(all)]];
        });
        assert.deepEqual(rows, [heads], subject);
        assert.equal(await page.locator("#matrix thead tr").first().locator("th:visible").count(), 2);
      }
      assert.equal(await page.locator('#matrix td a').count(), 0, "a matrix has no cards to lead to");
    });
  },

  async "j and k go through the cards, and / to the filter"() {
    await on("fail.html", {}, async (page) => {
      const focused = () => page.evaluate(() => document.activeElement.closest("details.card")?.id ?? document.activeElement.id);
      await page.keyboard.press("j");
      const first = await focused();
      await page.keyboard.press("j");
      const second = await focused();
      assert.ok(first.startsWith("fails-") && second.startsWith("fails-") && first !== second);
      await page.keyboard.press("k");
      assert.equal(await focused(), first);
      await page.keyboard.press("/");
      assert.equal(await focused(), "q");
      await page.keyboard.type("j");
      assert.equal(await page.inputValue("#q"), "j");
    });
  },

  async "a scene's slider, marks and pixels work by pointer and by keyboard"() {
    await on("fail.html", {}, async (page) => {
      const card = page.locator("details.scene").first();
      const range = card.locator("input[type=range]");
      const clip = () => card.locator("img.reference").evaluate((image) => image.style.clipPath);
      await range.focus();
      await page.keyboard.press("End");
      assert.equal(await clip(), "inset(0px 0% 0px 0px)");
      await page.keyboard.press("Home");
      assert.equal(await clip(), "inset(0px 100% 0px 0px)");
      const said = card.locator("output.pixel");
      await card.locator(".slider").hover({ position: { x: 20, y: 20 } });
      assert.match(await said.textContent(), /^pixel \d+, \d+ +reference (\d+ ){3}\d+/);
      await card.locator("table.worst button").first().focus();
      await page.keyboard.press("Enter");
      const told = await said.textContent();
      for (const what of ["reference", "legal from", "drawn"]) assert.ok(told.includes(what), told);
      await card.locator("input.marked").check();
      const marked = await card.locator("canvas.marks").evaluate((canvas) => {
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return data.filter((_, k) => k % 4 === 3 && data[k] > 0).length;
      });
      assert.ok(marked > 10, `${marked} pixels are marked`);
    });
  },

  async "hostile names are text"() {
    await on("hostile.html", {}, async (page) => {
      await page.locator("details.card").evaluateAll((cards) => cards.forEach((card) => (card.open = true)));
      assert.ok((await page.textContent("h1")).includes("<script>window.hacked"));
      assert.equal(await page.locator("img[onerror]").count(), 0);
      await page.fill("#q", "<script>");
      assert.equal(await shown(page), 0);
    });
    await on("matrix.html");
  },

  async "a policy of the page's own forbids scripts of others"() {
    await on("pass.html", {}, async (page) => {
      const policy = await page.getAttribute("meta[http-equiv=Content-Security-Policy]", "content");
      assert.match(policy, /default-src 'none'/);
      assert.ok(!policy.includes("unsafe"), policy);
    });
  },

  async "every page fits a phone, by day and by night"() {
    const pages = (await readdir(made)).filter((name) => name.endsWith(".html")).concat(await book());
    for (const name of pages) {
      for (const dark of [false, true]) await on(name, { width: 390, height: 800, dark });
      if (screenshots) await on(name, { dark: true });
    }
  },

  async "no page of the book is wider than a phone"() {
    const context = await browser.newContext({ viewport: { width: 390, height: 800 } });
    const page = await context.newPage();
    const wide = [];
    for (const name of await everything("book")) {
      await page.goto(address(name));
      const overflow = await page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);
      if (overflow > 0) wide.push(`${name} by ${overflow}`);
    }
    await context.close();
    assert.deepEqual(wide, []);
  },

  async "axe-core finds nothing wrong"() {
    const pages = (await readdir(made)).filter((name) => name.endsWith(".html")).concat(await book());
    for (const name of pages) {
      for (const dark of [false, true]) {
        await on(name, { dark, bypassCSP: true }, async (page) => {
          await page.evaluate(axe);
          const { violations } = await page.evaluate(() => window.axe.run());
          const told = violations.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((node) => node.html.slice(0, 160)).join(" | ")}`);
          assert.deepEqual(told, [], `${name}${dark ? ", dark" : ""}`);
        });
      }
    }
  },

  async "the book is searched by words, and a link holds them"() {
    await on("book/search.html", {}, async (page) => {
      await page.fill("#q", "exp2 opengl");
      const first = page.locator("#found li").first();
      assert.match(await first.textContent(), /fog\/exp2-opengl/);
      assert.match(await page.textContent("#count"), /^\d+ of \d+ pages$/);
      const link = page.url();
      await page.goto("about:blank");
      await page.goto(link);
      assert.equal(await page.inputValue("#q"), "exp2 opengl");
      await page.locator("#found li a").first().click();
      assert.match(await page.textContent("h1"), /fog\/exp2-opengl/);
    });
    // A word that stands on most pages is found there, too, and a bare fragment is what is looked for.
    await on("book/search.html", { fragment: "#opengl" }, async (page) => {
      const pages = (await everything("book")).filter((name) => name !== "book/search.html");
      const have = await Promise.all(pages.map(async (name) => /\bopengl/i.test((await readFile(join(made, name), "utf8")).replace(/<nav[^]*?<\/nav>|<[^>]*>/g, " "))));
      const [found] = (await page.textContent("#count")).split(" of ").map(Number);
      assert.ok(found >= 100 && Math.abs(found - have.filter(Boolean).length) <= 2, `${found} of ${have.filter(Boolean).length}`);
    });
    await on("book/search.html", { fragment: "#q=no-such-word" }, async (page) => {
      assert.equal(await page.locator("#found li").count(), 0);
      assert.match(await page.textContent("#count"), /^0 of/);
    });
  },

  async "every link of the book leads somewhere"() {
    const pages = await everything("book");
    assert.ok(pages.length > 60, `${pages.length} pages`);
    const ids = new Map();
    const texts = new Map();
    for (const name of pages) {
      const text = await readFile(join(made, name), "utf8");
      texts.set(name, text);
      ids.set(name, new Set([...text.matchAll(/ id="([^"]*)"/g)].map((found) => found[1])));
    }
    const broken = [];
    for (const [name, text] of texts) {
      for (const [, link] of text.matchAll(/ (?:href|src)="([^"]*)"/g)) {
        if (/^(https?:|data:)/.test(link)) continue;
        const [path, fragment] = link.replaceAll("&amp;", "&").split("#");
        const target = path === "" ? name : join(name, "..", decodeURIComponent(path));
        const is_there = ids.has(target) || (await stat(join(made, target)).catch(() => null))?.isFile();
        if (!is_there || (fragment && !ids.get(target)?.has(fragment))) broken.push(`${name}: ${link}`);
      }
    }
    assert.deepEqual(broken, []);
  },
};

// The card of the last formula that fails, before which there are many.
async function lastFormula() {
  const text = await readFile(join(made, "fail.html"), "utf8");
  return [...text.matchAll(/<details class="card" id="(fails-(?!scene)[^"]*)"/g)].at(-1)[1];
}

// All pages below a folder.
async function everything(folder) {
  const entries = await readdir(join(made, folder), { recursive: true }).catch(() => []);
  return entries.filter((name) => name.endsWith(".html")).map((name) => join(folder, name)).sort();
}

// Some pages of the book, one of each kind.
async function book() {
  const kinds = new Map();
  for (const name of await everything("book")) kinds.set(name.split("/").slice(1, -1).join("/"), name);
  return [...kinds.values(), ...((await everything("book")).filter((name) => name === "book/index.html"))];
}

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test();
    console.log(`ok ${name}`);
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${name}\n${error.stack}`);
  }
}
await browser.close();
process.exit(failed > 0 ? 1 : 0);
