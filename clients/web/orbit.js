/**
 * The page's own camera: round a target at a distance (docs/PROTOCOL.md, 5.3: azimuth about +Y from +Z, elevation upwards,
 * radians). Pure: each function answers a new orbit.
 *
 * @import {CameraMessage, Vec3} from "./protocol_types.js"
 */

/**
 * @typedef {object} Orbit
 * @property {number} azimuth
 * @property {number} elevation
 * @property {number} distance
 * @property {Vec3} target
 */

/** Short of the poles, where left and right change sides. */
const kSteepest = Math.PI / 2 - 0.01;
/** A drag across the height of the picture turns by half a turn. */
const kTurnPerHeight = Math.PI;

/**
 * @param {number} value
 * @param {number} low
 * @param {number} high
 */
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/**
 * @param {Pick<CameraMessage, "eye" | "target">} camera
 * @returns {Orbit}
 */
export function orbit_of(camera) {
  const [x, y, z] = [0, 1, 2].map((i) => (camera.eye[i] ?? 0) - (camera.target[i] ?? 0));
  const distance = Math.hypot(x ?? 0, y ?? 0, z ?? 0);
  return {
    azimuth: Math.atan2(x ?? 0, z ?? 0),
    elevation: clamp(distance > 0 ? Math.asin((y ?? 0) / distance) : 0, -kSteepest, kSteepest),
    distance: distance > 0 ? distance : 1,
    target: [...camera.target],
  };
}

/**
 * @param {Orbit} orbit
 * @returns {Vec3} where the camera stands
 */
export function eye_of({ azimuth, elevation, distance, target }) {
  const level = distance * Math.cos(elevation);
  return [
    target[0] + level * Math.sin(azimuth),
    target[1] + distance * Math.sin(elevation),
    target[2] + level * Math.cos(azimuth),
  ];
}

/**
 * Turned so that the scene follows the pointer.
 * @param {Orbit} orbit
 * @param {number} dx  pixels to the right
 * @param {number} dy  pixels downwards
 * @param {number} height  of the picture, in the same pixels
 * @returns {Orbit}
 */
export function turned(orbit, dx, dy, height) {
  const per_pixel = kTurnPerHeight / Math.max(height, 1);
  return {
    ...orbit,
    azimuth: Math.atan2(Math.sin(orbit.azimuth - dx * per_pixel), Math.cos(orbit.azimuth - dx * per_pixel)),
    elevation: clamp(orbit.elevation + dy * per_pixel, -kSteepest, kSteepest),
  };
}

/**
 * @param {Orbit} orbit
 * @param {number} factor  of the distance: below 1 comes nearer
 * @param {{near: number, far: number}} planes  nothing outside of them is seen, so the target stays between
 * @returns {Orbit}
 */
export function zoomed(orbit, factor, planes) {
  return { ...orbit, distance: clamp(orbit.distance * factor, planes.near * 2, planes.far * 0.9) };
}

/**
 * Moved sideways so that what is at the target's distance stays under the pointer.
 * @param {Orbit} orbit
 * @param {number} dx  pixels to the right
 * @param {number} dy  pixels downwards
 * @param {number} height  of the picture, in the same pixels
 * @param {number} fov_y   radians
 * @returns {Orbit}
 */
export function panned(orbit, dx, dy, height, fov_y) {
  const { azimuth: a, elevation: e, distance, target } = orbit;
  const per_pixel = (2 * distance * Math.tan(fov_y / 2)) / Math.max(height, 1);
  const right = [Math.cos(a), 0, -Math.sin(a)];
  const up = [-Math.sin(a) * Math.sin(e), Math.cos(e), -Math.cos(a) * Math.sin(e)];
  /** @param {0 | 1 | 2} i */
  const moved = (i) => target[i] + per_pixel * (dy * (up[i] ?? 0) - dx * (right[i] ?? 0));
  return { ...orbit, target: [moved(0), moved(1), moved(2)] };
}
