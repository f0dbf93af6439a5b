// Scenes by three.js's own materials: MeshPhongMaterial for what has a highlight, MeshLambertMaterial for what has none,
// MeshBasicMaterial for what no light falls on.
import { custom } from "./blending.js";
import { camera, clear, renderer, THREE } from "./stage.js";
import { decayOf, directional, NO_POLYNOMIAL, PI, point, spot } from "./surfaces.js";

// MeshPhongMaterial's highlight is Blinn's; scenes of Phong's are drawn with it all the same, and judged.
export const EFFECTS = [
  "phong", "inverse_transpose", "emissive", "ambient_product", "ambient_constant", "light_ambient", "diffuse",
  "specular_phong", "specular_blinn", "local_viewer", "gate", "directional", "point", "spot", "attenuation", "vertex_color",
  "texture_nearest", "texture_bilinear", "texture_replace", "lightmap_nearest", "lightmap_bilinear", "cutout",
  "fog_linear", "fog_exp2_opengl",
];

const TYPES = { rgba16float: THREE.HalfFloatType, rgba32float: THREE.FloatType };
const COMPARES = {
  never: THREE.NeverDepth,
  less: THREE.LessDepth,
  equal: THREE.EqualDepth,
  "less-equal": THREE.LessEqualDepth,
  greater: THREE.GreaterDepth,
  "not-equal": THREE.NotEqualDepth,
  "greater-equal": THREE.GreaterEqualDepth,
  always: THREE.AlwaysDepth,
};
const SIDES = { none: THREE.DoubleSide, back: THREE.FrontSide, front: THREE.BackSide };
const color = (rgb) => new THREE.Color(...rgb);
const sum = (a, b) => a.map((x, k) => x + b[k]);
const product = (a, b) => a.map((x, k) => x * b[k]);
const isBlack = (rgb) => rgb.every((x) => x === 0);

class Skip extends Error {}

function makeTexture(texture, { filter, wrap }) {
  const texels = new Float32Array(texture.texels.flat());
  const map = new THREE.DataTexture(texels, texture.width, texture.height, THREE.RGBAFormat, THREE.FloatType);
  map.minFilter = map.magFilter = filter === "nearest" ? THREE.NearestFilter : THREE.LinearFilter;
  map.wrapS = map.wrapT = wrap === "repeat" ? THREE.RepeatWrapping : THREE.ClampToEdgeWrapping;
  map.needsUpdate = true;
  return map;
}

function makeGeometry(mesh) {
  const geometry = new THREE.BufferGeometry();
  const attributes = { position: "positions", normal: "normals", uv: "uvs", uv1: "lightmap_uvs", color: "colors" };
  for (const [name, from] of Object.entries(attributes)) {
    if (!mesh[from].length) continue;
    geometry.setAttribute(name, new THREE.Float32BufferAttribute(mesh[from].flat(), mesh[from][0].length));
  }
  geometry.setIndex(mesh.triangles.flat());
  return geometry;
}

// A light has one colour in three.js. Where its diffuse and its specular colour differ and it is alone, it is white and the
// material takes their products.
function makeLight(light, rgb) {
  const { place } = light;
  if (place.kind === "directional") return directional(place.toward, rgb);
  const decay = decayOf(place.falloff);
  if (decay === null) throw new Skip(NO_POLYNOMIAL);
  if (place.kind === "point") return point(place.position, rgb, decay);
  if (place.exponent) throw new Skip("a spotlight of three.js has no exponent");
  return spot(place.position, rgb, decay, place.axis, place.cutoff_cosine);
}

function makeLights(scene) {
  const differs = scene.lights.some(({ diffuse, specular }) => diffuse.some((x, k) => x !== specular[k]));
  const shiny = scene.draws.some((draw) => draw.shading && !isBlack(draw.material.specular));
  if (differs && shiny && scene.lights.length > 1) throw new Skip("a light of three.js has one colour for both terms");
  const white = differs && shiny;
  return {
    lights: scene.lights.map((light) => makeLight(light, white ? [1, 1, 1] : light.diffuse)),
    tint: white ? scene.lights[0] : { diffuse: [1, 1, 1], specular: [1, 1, 1] },
  };
}

function makeMaterial(scene, draw, tint) {
  const of = draw.material;
  const options = {
    // A texture in place of the colour is in place of its alpha, too.
    opacity: draw.texture?.replaces ? 1 : draw.alpha,
    transparent: true,
    vertexColors: draw.vertex_colors,
    side: SIDES[draw.cull],
    depthTest: draw.depth !== null,
    depthWrite: draw.depth?.write ?? false,
    depthFunc: COMPARES[draw.depth?.compare ?? "always"],
    alphaTest: draw.cutout ?? 0,
    blending: THREE.NoBlending,
  };
  if (draw.texture) options.map = makeTexture(scene.textures[draw.texture.texture], draw.texture);
  if (draw.blend) {
    const state = ({ equation, src, dst }) => [equation, src, dst];
    Object.assign(options, custom(state(draw.blend.color), state(draw.blend.alpha)));
    options.blendColor = color(draw.blend.constant.slice(0, 3));
    options.blendAlpha = draw.blend.constant[3];
  }
  if (draw.texture?.replaces) return new THREE.MeshBasicMaterial(options);
  if (!draw.shading) {
    if (draw.lightmap) {
      options.lightMap = makeTexture(scene.textures[draw.lightmap.texture], draw.lightmap);
      options.lightMap.channel = 1;
      // As diffuse light is, a lightmap is divided by π.
      options.lightMapIntensity = PI;
    }
    return new THREE.MeshBasicMaterial({ ...options, color: color(of.diffuse) });
  }
  if (draw.shading.normals !== "inverse-transpose") throw new Skip("normals go by the inverse transpose of the modelview");
  if (draw.shading.viewer !== "local") throw new Skip("the viewer is local, but with an orthographic camera");
  if (draw.lightmap) throw new Skip("a lightmap of three.js is light and takes part in the sum");
  options.emissive = color(scene.ambient_form === "constant" ? sum(of.emissive, scene.ambient) : of.emissive);
  options.color = color(product(of.diffuse, tint.diffuse));
  // Schlick's term leaves a highlight on a material whose specular colour is black.
  if (isBlack(of.specular)) return new THREE.MeshLambertMaterial(options);
  return new THREE.MeshPhongMaterial({ ...options, specular: color(product(of.specular, tint.specular)), shininess: of.shininess });
}

// Light from everywhere that gives a draw its ambient term: the material has no ambient colour of its own, so that the light
// is what the term is over the diffuse one.
function makeAmbient(scene, draw, material) {
  const of = draw.material;
  if (!draw.shading || !material.emissive) return new THREE.AmbientLight(0);
  const everywhere = scene.ambient_form === "product" ? scene.ambient : [0, 0, 0];
  const term = product(scene.lights.reduce((all, light) => sum(all, light.ambient), everywhere), of.ambient);
  const diffuse = material.color.toArray();
  if (term.some((x, k) => x > 0 && diffuse[k] === 0)) throw new Skip("no ambient term where the diffuse colour is black");
  return new THREE.AmbientLight(color(term.map((x, k) => (x > 0 ? x / diffuse[k] : 0))), PI);
}

function makeFog(fog) {
  if (!fog) return null;
  if (fog.distance === "radial") throw new Skip("fog of three.js goes by the depth");
  const { form } = fog;
  return form.kind === "linear" ? new THREE.Fog(color(fog.color), form.dmin, form.dmax) : new THREE.FogExp2(color(fog.color), form.density);
}

// Clip space with depth from 0 to 1 to WebGL's, from −1.
function setProjection(columns) {
  const toWebgl = new THREE.Matrix4().set(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, -1, 0, 0, 0, 1);
  camera.projectionMatrix.fromArray(columns.flat()).premultiply(toWebgl);
}

function draw(scene) {
  const { width, height, format } = scene.target;
  const type = TYPES[format] ?? THREE.UnsignedByteType;
  const target = new THREE.WebGLRenderTarget(width, height, { type, depthBuffer: true });
  target.depthTexture = new THREE.DepthTexture(width, height, THREE.FloatType);
  try {
    const { lights, tint } = makeLights(scene);
    const all = new THREE.Scene();
    all.fog = makeFog(scene.fog);
    all.add(...lights, ...lights.filter((light) => light.target).map((light) => light.target));
    setProjection(scene.projection);
    renderer.state.buffers.depth.setClear(scene.clear_depth);
    clear(target, scene.background);
    // In the scene's order, which three.js would not keep between opaque and transparent objects.
    for (const one of scene.draws) {
      const mesh = new THREE.Mesh(makeGeometry(scene.meshes[one.mesh]), makeMaterial(scene, one, tint));
      const ambient = makeAmbient(scene, one, mesh.material);
      mesh.frustumCulled = false;
      mesh.matrixAutoUpdate = false;
      mesh.matrix.fromArray(one.modelview.flat());
      all.add(mesh, ambient);
      renderer.render(all, camera);
      all.remove(mesh, ambient);
      mesh.geometry.dispose();
    }
    return { ...readImage(target, type), width, height };
  } finally {
    renderer.state.buffers.depth.setClear(1);
    target.dispose();
  }
}

function readImage(target, type) {
  const { width, height } = target;
  const count = 4 * width * height;
  const halves = type === THREE.HalfFloatType;
  const pixels = type === THREE.UnsignedByteType ? new Uint8Array(count) : halves ? new Uint16Array(count) : new Float32Array(count);
  renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
  const wide = halves ? Float32Array.from(pixels, THREE.DataUtils.fromHalfFloat) : pixels;
  const row = 4 * width;
  const upright = new wide.constructor(count);
  for (let y = 0; y < height; y++) upright.set(wide.subarray(y * row, (y + 1) * row), (height - 1 - y) * row);
  const bytes = new Uint8Array(upright.buffer);
  let text = "";
  for (let k = 0; k < bytes.length; k += 32768) text += String.fromCharCode(...bytes.subarray(k, k + 32768));
  return { base64: btoa(text), floats: type !== THREE.UnsignedByteType };
}

export function drawScene(scene) {
  try {
    return draw(scene);
  } catch (error) {
    if (error instanceof Skip) return { skip: error.message };
    throw error;
  }
}
