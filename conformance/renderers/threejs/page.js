// What three.js draws: cases of formulas, a pixel each, and scenes.
import { blendFormulas } from "./blending.js";
import { drawScene, EFFECTS } from "./scenes.js";
import { renderer } from "./stage.js";
import { surfaceFormulas } from "./surfaces.js";

const FORMULAS = { ...surfaceFormulas, ...blendFormulas };
const matches = (pattern, formula) => (pattern.endsWith("/*") ? formula.startsWith(pattern.slice(0, -1)) : formula === pattern);

export const declared = {
  formulas: Object.keys(FORMULAS),
  scenes: ["scene"],
  effects: EFFECTS,
  skips: [
    ...[
      "blend/*/*constant-color/*constant-alpha",
      "blend/*/*constant-alpha/*constant-color",
      "blend/separate/*.*constant-color.*constant-alpha",
      "blend/separate/*.*constant-alpha.*constant-color",
    ].map((id) => ({ id, reason: "WebGL refuses a constant colour and a constant alpha together" })),
    ...["scene/attached-lights", "scene/many-points"].map((id) => ({
      id,
      reason: "light falls off by a power of the distance, not by a polynomial",
    })),
    { id: "scene/viewer", reason: "the viewer is local, but with an orthographic camera" },
  ],
  formats: ["rgba8unorm", "bgra8unorm", "rgba16float", "rgba32float"],
};

// A value a case: numbers, or {skip: reason}.
export function evaluate(formula, cases) {
  const pattern = Object.keys(FORMULAS).find((pattern) => matches(pattern, formula));
  return FORMULAS[pattern](cases, formula);
}

// What WebGL draws on, as the browser names it.
export function device() {
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
}

export { drawScene };
