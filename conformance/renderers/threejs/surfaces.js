// Lighting, attenuation, fog, textures and normals by three.js's materials: a triangle a case, which covers its pixel and has
// the case's point in its middle.
import { camera, clear, read, renderer, THREE, toPixel } from "./stage.js";

// three.js divides diffuse light by π; its migration guide has lights multiplied by as much.
export const PI = Math.PI;
const SPREAD = 1 / 64;
const CORNERS = [[-1, -1], [3, -1], [-1, 3]];
const AHEAD = [0, 0, 1];
const WHITE = [1, 1, 1];
const product = (a, b) => a.map((x, k) => x * b[k]);
const color = (rgb) => new THREE.Color(...rgb);

function triangle(material, p = [0, 0, -1], normal = AHEAD) {
  const geometry = new THREE.BufferGeometry();
  const corners = CORNERS.flatMap(([x, y]) => [p[0] + x * SPREAD, p[1] + y * SPREAD, p[2]]);
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute([...normal, ...normal, ...normal], 3));
  geometry.setAttribute("uv", new THREE.Float32BufferAttribute(new Array(6).fill(0.5), 2));
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

// A point in eye space to the middle of the viewport, at a scale that has the triangle cover it.
function lookAt(p) {
  camera.projectionMatrix.set(1 / SPREAD, 0, 0, -p[0] / SPREAD, 0, 1 / SPREAD, 0, -p[1] / SPREAD, 0, 0, 0, 0, 0, 0, 0, 1);
}

// Draws each case: `scene(case)` makes what is drawn, and where.
function each(cases, scene, outputs) {
  clear();
  const skipped = new Map();
  cases.forEach((one, k) => {
    const { mesh, lights = [], fog = null, p = [0, 0, -1], skip } = scene(one);
    if (skip) return skipped.set(k, { skip });
    const all = new THREE.Scene();
    all.fog = fog;
    all.add(mesh, ...lights, ...lights.filter((light) => light.target).map((light) => light.target));
    lookAt(p);
    toPixel(k);
    renderer.render(all, camera);
    // Materials stay: with the last one of its kind a program would go, and be compiled again.
    mesh.geometry.dispose();
    mesh.material.map?.dispose();
  });
  return read(cases.length).map((value, k) => skipped.get(k) ?? value.slice(0, outputs));
}

export function directional(toward, rgb, intensity = PI) {
  const light = new THREE.DirectionalLight(color(rgb), intensity);
  light.position.set(...toward);
  return light;
}

export function point(position, rgb, decay, intensity = PI) {
  const light = new THREE.PointLight(color(rgb), intensity, 0, decay);
  light.position.set(...position);
  return light;
}

export function spot(position, rgb, decay, axis, cutoffCosine) {
  const light = new THREE.SpotLight(color(rgb), PI, 0, Math.acos(cutoffCosine), 0, decay);
  light.position.set(...position);
  light.target.position.set(...position.map((x, k) => x + axis[k]));
  return light;
}

// The power of the distance that light weakens by; three.js has no polynomial.
export function decayOf([kc, kl, kq]) {
  const powers = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const decay = powers.findIndex((power) => power.every((x, k) => x === [kc, kl, kq][k]));
  return decay < 0 ? null : decay;
}
export const NO_POLYNOMIAL = "three.js weakens light by a power of the distance, not by a polynomial";

const lambert = (rgb, emissive = [0, 0, 0]) =>
  new THREE.MeshLambertMaterial({ color: color(rgb), emissive: color(emissive), side: THREE.FrontSide });

function diffuse(cases, toward) {
  return each(cases, (c) => ({ mesh: triangle(lambert(c.md), [0, 0, -1], c.n), lights: [directional(toward(c), c.ld)] }), 3);
}

// One light has one colour, and the material no ambient one: products are formed beforehand.
function phong(c) {
  return new THREE.MeshPhongMaterial({
    color: color(product(c.ld, c.md)),
    specular: color(product(c.ls, c.ms)),
    emissive: color(product(c.la, c.ma)),
    shininess: c.shininess,
  });
}

function blinn(cases) {
  return each(cases, (c) => {
    const lights = [directional(c.direction.map((x) => -x), WHITE)];
    return { mesh: triangle(phong(c), c.p, c.normal), lights, p: c.p };
  }, 4);
}

function weakened(cases, decay) {
  return each(cases, (c) => ({ mesh: triangle(lambert(WHITE)), lights: [point([0, 0, c.d - 1], WHITE, decay)] }), 1);
}

// The light ahead of a surface at the origin of which the cone is tested, turned so that it stands at l.
function inCone(cases) {
  return each(cases, (c) => {
    const p = [0, 0, 0];
    return { mesh: triangle(lambert(WHITE), p, c.l), lights: [spot(c.l, WHITE, 0, c.axis, c.cutoff_cosine)], p };
  }, 1);
}

const basic = (rgb) => new THREE.MeshBasicMaterial({ color: color(rgb) });

// The factor as white in black fog, then the colour.
function fog(cases, make) {
  const draw = (fogOf, shadedOf) =>
    each(cases, (c) => ({ mesh: triangle(basic(shadedOf(c)), c.p), fog: make(c, color(fogOf(c))), p: c.p }), 3);
  const factors = draw(() => [0, 0, 0], () => WHITE);
  const colors = draw((c) => c.fog, (c) => c.shaded);
  return factors.map(([f], k) => [f, ...colors[k]]);
}

function modulate(cases) {
  return each(cases, (c) => {
    const map = new THREE.DataTexture(new Float32Array(c.texel), 1, 1, THREE.RGBAFormat, THREE.FloatType);
    map.needsUpdate = true;
    const opacity = c.color[3];
    const options = { color: color(c.color.slice(0, 3)), opacity, map, transparent: true, blending: THREE.NoBlending };
    return { mesh: triangle(new THREE.MeshBasicMaterial(options)) };
  }, 4);
}

export const surfaceFormulas = {
  "lighting/ambient": (cases) =>
    each(cases, (c) => ({ mesh: triangle(lambert(c.ma)), lights: [new THREE.AmbientLight(color(c.la), PI)] }), 3),
  "lighting/diffuse-toward": (cases) => diffuse(cases, (c) => c.l),
  "lighting/diffuse-travel": (cases) => diffuse(cases, (c) => c.i.map((x) => -x)),
  "lighting/blinn": blinn,
  "attenuation/constant": (cases) => weakened(cases, 0),
  "attenuation/linear": (cases) => weakened(cases, 1),
  "attenuation/square": (cases) => weakened(cases, 2),
  "attenuation/spot-cutoff": inCone,
  "fog/linear": (cases) => fog(cases, (c, rgb) => new THREE.Fog(rgb, c.dmin, c.dmax)),
  "fog/exp2-opengl": (cases) => fog(cases, (c, rgb) => new THREE.FogExp2(rgb, c.density)),
  "color/uniform": (cases) => each(cases, (c) => ({ mesh: triangle(basic(c.color)) }), 4),
  "color/modulate": modulate,
};
