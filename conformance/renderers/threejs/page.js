// What three.js draws: cases of formulas, a pixel each, and scenes.
import { blendFormulas } from "./blending.js";
import { drawScene, EFFECTS } from "./scenes.js";
import { surfaceFormulas } from "./surfaces.js";

const FORMULAS = { ...surfaceFormulas, ...blendFormulas };
const matches = (pattern, formula) => (pattern.endsWith("/*") ? formula.startsWith(pattern.slice(0, -1)) : formula === pattern);

export const declared = {
  formulas: Object.keys(FORMULAS),
  scenes: ["scene"],
  effects: EFFECTS,
  formats: ["rgba8unorm", "bgra8unorm", "rgba16float", "rgba32float"],
};

// A value a case: numbers, or {skip: reason}.
export function evaluate(formula, cases) {
  const pattern = Object.keys(FORMULAS).find((pattern) => matches(pattern, formula));
  return FORMULAS[pattern](cases, formula);
}

export { drawScene };
