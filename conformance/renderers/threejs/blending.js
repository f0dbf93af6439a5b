// three.js's blending modes: CustomBlending for each state, and the named ones. A point a case.
import { camera, clear, read, renderer, SIDE, THREE, toPixel } from "./stage.js";

const FACTORS = {
  zero: THREE.ZeroFactor,
  one: THREE.OneFactor,
  "src-color": THREE.SrcColorFactor,
  "one-minus-src-color": THREE.OneMinusSrcColorFactor,
  "dst-color": THREE.DstColorFactor,
  "one-minus-dst-color": THREE.OneMinusDstColorFactor,
  "src-alpha": THREE.SrcAlphaFactor,
  "one-minus-src-alpha": THREE.OneMinusSrcAlphaFactor,
  "dst-alpha": THREE.DstAlphaFactor,
  "one-minus-dst-alpha": THREE.OneMinusDstAlphaFactor,
  "constant-color": THREE.ConstantColorFactor,
  "one-minus-constant-color": THREE.OneMinusConstantColorFactor,
  "constant-alpha": THREE.ConstantAlphaFactor,
  "one-minus-constant-alpha": THREE.OneMinusConstantAlphaFactor,
  "src-alpha-saturate": THREE.SrcAlphaSaturateFactor,
};
const EQUATIONS = {
  add: THREE.AddEquation,
  subtract: THREE.SubtractEquation,
  "reverse-subtract": THREE.ReverseSubtractEquation,
  min: THREE.MinEquation,
  max: THREE.MaxEquation,
};

// Settings of a material from (equation, source, destination) of colour and of alpha.
export function custom(rgb, alpha) {
  return {
    blending: THREE.CustomBlending,
    blendEquation: EQUATIONS[rgb[0]],
    blendSrc: FACTORS[rgb[1] ?? "one"],
    blendDst: FACTORS[rgb[2] ?? "one"],
    blendEquationAlpha: EQUATIONS[alpha[0]],
    blendSrcAlpha: FACTORS[alpha[1] ?? "one"],
    blendDstAlpha: FACTORS[alpha[2] ?? "one"],
  };
}

const material = new THREE.PointsMaterial({ size: 1, sizeAttenuation: false, vertexColors: true });
material.transparent = true;
material.depthTest = false;
const geometry = new THREE.BufferGeometry();
const places = Array.from({ length: SIDE * SIDE }, (_, k) => [
  (2 * (k % SIDE) + 1) / SIDE - 1,
  (2 * Math.floor(k / SIDE) + 1) / SIDE - 1,
  0,
]);
geometry.setAttribute("position", new THREE.Float32BufferAttribute(places.flat(), 3));
geometry.setAttribute("color", new THREE.Float32BufferAttribute(new Float32Array(4 * SIDE * SIDE), 4));
const points = new THREE.Points(geometry, material);
points.frustumCulled = false;
const scene = new THREE.Scene().add(points);

function draw(colors, settings) {
  Object.assign(material, { blending: THREE.NoBlending, premultipliedAlpha: false, colorWrite: true }, settings);
  material.needsUpdate = true;
  geometry.attributes.color.array.set(colors.flat());
  geometry.attributes.color.needsUpdate = true;
  geometry.setDrawRange(0, colors.length);
  renderer.render(scene, camera);
}

const COLORS = [THREE.ConstantColorFactor, THREE.OneMinusConstantColorFactor];
const ALPHAS = [THREE.ConstantAlphaFactor, THREE.OneMinusConstantAlphaFactor];

// WebGL 1.0 §6.13: an invalid operation, so that the state before it would stay.
function refused({ blendSrc, blendDst }) {
  const either = (a, b) => a.includes(blendSrc) && b.includes(blendDst);
  return either(COLORS, ALPHAS) || either(ALPHAS, COLORS);
}

function blend(cases, settings) {
  if (refused(settings)) return cases.map(() => ({ skip: "WebGL refuses a constant colour and a constant alpha together" }));
  camera.projectionMatrix.identity();
  clear();
  draw(cases.map(({ dst }) => (dst.length === 4 ? dst : [...dst, 1])), {});
  const reads = Object.values(settings).some((value) => value >= THREE.ConstantColorFactor && value <= THREE.OneMinusConstantAlphaFactor);
  if (reads) {
    draw([], settings);
    geometry.attributes.color.array.set(cases.flatMap(({ src }) => src));
    geometry.attributes.color.needsUpdate = true;
    cases.forEach(({ constant }, k) => {
      material.blendColor = new THREE.Color(...constant.slice(0, 3));
      material.blendAlpha = constant[3];
      geometry.setDrawRange(k, 1);
      renderer.render(scene, camera);
    });
  } else {
    draw(cases.map(({ src }) => src), settings);
  }
  return read(cases.length);
}

const named = (settings) => (cases) => blend(cases, settings).map((value) => value.slice(0, 3));
function same(cases, formula) {
  const state = formula.split("/").slice(1);
  return blend(cases, custom(state, state));
}
const over = custom(["add", "src-alpha", "one-minus-src-alpha"], ["add", "src-alpha", "one-minus-src-alpha"]);

export const blendFormulas = {
  "blend/mode-solid": named({ blending: THREE.NoBlending }),
  "blend/mode-alpha": named({ blending: THREE.NormalBlending }),
  // three.js has it for premultiplied alpha alone.
  "blend/mode-mul": named({ blending: THREE.MultiplyBlending, premultipliedAlpha: true }),
  "blend/mode-add": named({ blending: THREE.AdditiveBlending }),
  "blend/write-mask/none": (cases) => blend(cases, { ...over, colorWrite: false }),
  "blend/write-mask/rgba": (cases) => blend(cases, { ...over, colorWrite: true }),
  "blend/separate/*": (cases, formula) => {
    const [rgb, alpha] = formula.split("/").slice(2).map((state) => state.split("."));
    return blend(cases, custom(rgb, alpha));
  },
  ...Object.fromEntries(Object.keys(EQUATIONS).map((equation) => [`blend/${equation}/*`, same])),
};
