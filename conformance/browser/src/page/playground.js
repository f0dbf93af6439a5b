// Shaders that are typed into the page: each change is sent to the server, which has this browser's GPU judge it, and the result is shown.
//
// One shader is under way at a time; what was typed meanwhile is sent when its result is there. The address's fragment holds the shader, so that a
// link opens it again.

import { EXAMPLES } from "./examples.js";

const shown = (id) => document.getElementById(id);
// Milliseconds without a change until a shader is sent.
const PAUSE = 500;
const FIELDS = ["language", "formula", "function", "text", "bind", "constant"];
const PICTURES = ["the reference", "your shader, on this GPU", "the error map: blue is legal, yellow to violet is wrong"];

let send = null;
let [timer, isUnderWay, isChanged, isOver] = [0, false, false, false];

const typed = () => Object.fromEntries(FIELDS.map((name) => [name, shown(name).value]));
const listed = (text) => text.split("\n").map((line) => line.trim()).filter((line) => line);
const count = (number, noun) => `${number.toLocaleString("en")} ${noun}${number === 1 ? "" : "s"}`;

// Text as base64 for addresses, and back.
function packed(value) {
  const bytes = new TextEncoder().encode(JSON.stringify(value));
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join("")).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function unpacked(text) {
  const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(bytes));
}

function fill(values) {
  for (const name of FIELDS) shown(name).value = typeof values[name] === "string" ? values[name] : "";
  // A formula or a language that is none of the list leaves none chosen.
  if (shown("language").selectedIndex < 0) shown("language").value = "glsl";
  if (shown("formula").selectedIndex < 0) shown("formula").value = "";
}

const wrong = ({ verdicts, failed }) => `${failed.toLocaleString("en")} of ${count(verdicts, "value")} are wrong`;
const lacks = ({ missing }) => (missing.length > 0 ? `\nThe shader does not give ${missing.join(" and ")}, which is not judged.` : "");

function say(text, state) {
  shown("played").textContent = text;
  shown("played").className = state;
}

function show({ refused = null, told = "", formulas = [], result = "", picture = null }) {
  const [nearest, ...others] = formulas;
  if (refused !== null) say(`Not judged: ${refused}`, "failed");
  else if (!nearest) say("Nothing is judged yet.", "");
  else if (nearest.verdicts === 0) say(`Nothing of ${nearest.id} was judged: of these inputs nothing is promised, or the device refused the shader.`, "failed");
  else if (nearest.failed > 0) say(`✗ The nearest is ${nearest.id}: ${wrong(nearest)}.\n${nearest.why ?? "No mistake of the catalogue explains them."}${lacks(nearest)}`, "failed");
  else if (nearest.why !== null) say(`✗ This is ${nearest.id}, and each of ${count(nearest.verdicts, "value")} is legal, but not all of them together.\n${nearest.why}${lacks(nearest)}`, "failed");
  else say(`✓ This is ${nearest.id}: ${count(nearest.verdicts, "value")}, all legal.${lacks(nearest)}`, "passed");
  shown("nearest").replaceChildren(...others.map((other) => {
    const line = document.createElement("li");
    const { id, verdicts, failed, why } = other;
    if (verdicts === 0) line.textContent = `By ${id} nothing was judged.`;
    else line.textContent = failed === 0 && why === null ? `It is ${id}, too.` : `By ${id} ${wrong(other)}${why ? `: ${why}` : "."}`;
    return line;
  }));
  shown("drawn").replaceChildren(...(picture?.files ?? []).map((file, k) => {
    const [figure, image, caption] = ["figure", "img", "figcaption"].map((name) => document.createElement(name));
    image.src = file;
    image.alt = `${picture.caption}: ${PICTURES[k]}`;
    caption.textContent = PICTURES[k];
    figure.append(image, caption);
    return figure;
  }));
  shown("drawn-says").textContent = picture ? `${picture.caption[0].toUpperCase()}${picture.caption.slice(1)}. ${picture.wrong.toLocaleString("en")} of ${count(picture.drawn, "pixel")} are wrong.` : "";
  for (const [place, inside, text] of [["whole", "result", result], ["taken", "told", told]]) {
    shown(inside).textContent = text;
    shown(place).hidden = text === "";
  }
  // Why a right shader is taken for a wrong one mostly stands there.
  shown("taken").open ||= nearest?.failed > 0;
}

async function judge() {
  if (isOver) return;
  if (isUnderWay) {
    isChanged = true;
    return;
  }
  const shader = typed();
  if (shader.text.trim() === "") {
    show({});
    return;
  }
  isUnderWay = true;
  say("Judging …", "");
  try {
    const response = await send({ ...shader, bind: listed(shader.bind), constant: listed(shader.constant) });
    const result = response.status === 200 ? await response.json() : null;
    if (isOver) return;
    if (result) show(result);
    else isChanged = true;
  } catch (error) {
    if (isOver) return;
    if (!isChanged) show({ refused: error.message });
  }
  isUnderWay = false;
  if (isChanged) {
    isChanged = false;
    judge();
  }
}

// Keeps the shader in the address. A browser may refuse that where it is done too often.
function keep() {
  const values = typed();
  try {
    history.replaceState(null, "", values.text === "" ? "#" : `#shader=${packed(values)}`);
  } catch {
    shown("copied").textContent = "The browser does not let the address follow so fast.";
  }
}

function changed(event) {
  // What was changed is no example any more, and each can be chosen again.
  if (event) shown("example").value = "";
  shown("copied").textContent = "";
  clearTimeout(timer);
  timer = setTimeout(() => {
    keep();
    judge();
  }, PAUSE);
}

function offerExamples() {
  for (const [k, { title }] of EXAMPLES.entries()) shown("example").append(new Option(title, k));
  shown("example").addEventListener("change", ({ target }) => {
    if (target.value === "") return;
    fill(EXAMPLES[target.value]);
    changed();
  });
}

// What the address's fragment holds.
function fromAddress() {
  const [, link] = /^#shader=(.*)$/.exec(location.hash) ?? [];
  if (link === undefined) return;
  try {
    fill(unpacked(link));
  } catch {
    show({ refused: "the link's shader cannot be read. It may have been cut: copy all of the link." });
    return;
  }
  judge();
}

// Nothing is judged any more, and why.
export function endPlayground(text) {
  isOver = true;
  clearTimeout(timer);
  if (!shown("playground").hidden) say(text, "failed");
}

export function openPlayground(formulas, sender) {
  const [isFirst, isSame] = [send === null, send === sender];
  send = sender;
  // After a lost device, what was under way is judged again.
  if (!isFirst && !isSame) judge();
  if (!isFirst) return;
  for (const id of formulas) shown("formula").append(new Option(id, id));
  offerExamples();
  for (const name of FIELDS) shown(name).addEventListener("input", changed);
  shown("copy").addEventListener("click", async () => {
    keep();
    try {
      await navigator.clipboard.writeText(location.href);
      shown("copied").textContent = "Copied. It opens as long as lightmeter serves this page; what follows # is the shader, and opens in later playgrounds too.";
    } catch {
      shown("copied").textContent = "The browser lets no page copy: the address of this page is the link.";
    }
  });
  addEventListener("hashchange", fromAddress);
  shown("playground").hidden = false;
  for (const place of ["progress", "judged"]) shown(place).hidden = true;
  fromAddress();
}
