// The renderer, and a float target of one pixel a case.
import * as THREE from "./node_modules/three/build/three.module.js";

// Values are handed through as they are.
THREE.ColorManagement.enabled = false;
export const renderer = new THREE.WebGLRenderer({ premultipliedAlpha: false, antialias: false });
renderer.autoClear = false;
renderer.sortObjects = false;
renderer.toneMapping = THREE.NoToneMapping;
renderer.outputColorSpace = THREE.LinearSRGBColorSpace;

export const SIDE = 64;
export const FLOATS = { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
export const target = new THREE.WebGLRenderTarget(SIDE, SIDE, { ...FLOATS, depthBuffer: true });
export const camera = new THREE.Camera();
camera.matrixAutoUpdate = false;

export function clear(to = target, color = [0, 0, 0, 0]) {
  to.viewport.set(0, 0, to.width, to.height);
  renderer.setRenderTarget(to);
  renderer.setClearColor(new THREE.Color(...color.slice(0, 3)), color[3]);
  renderer.clear();
}

// The colour of each case's pixel.
export function read(count) {
  const pixels = new Float32Array(4 * SIDE * SIDE);
  renderer.readRenderTargetPixels(target, 0, 0, SIDE, SIDE, pixels);
  return Array.from({ length: count }, (_, k) => Array.from(pixels.subarray(4 * k, 4 * k + 4)));
}

export function toPixel(k) {
  target.viewport.set(k % SIDE, Math.floor(k / SIDE), 1, 1);
  renderer.setRenderTarget(target);
}

export { THREE };
